// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
'use strict';

const byId = (id) => document.getElementById(id);

/** Text as it is shown: characters that turn the direction of a line or end it are written as their numbers. */
const escaped = (text) => (typeof text !== 'string' ? text
  : text.replace(/[\u061C\u200E\u200F\u2028-\u202E\u2066-\u2069]/g, (c) => `\\u${c.charCodeAt(0).toString(16).toUpperCase().padStart(4, '0')}`));

/** An element with properties and children; texts stay texts, whatever they hold. */
const make = (tag, properties = {}, ...children) => {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.includes('-') || name === 'role' || name === 'for') node.setAttribute(name, escaped(value));
    else node[name] = name === 'textContent' ? escaped(value) : value;
  }
  node.append(...children.map(escaped));
  return node;
};

const sizeOf = (bytes) => {
  const units = ['B', 'kB', 'MB', 'GB', 'TB'];
  let k = 0;
  for (; bytes >= 1000 && k < units.length - 1; ++k) bytes /= 1000;
  return `${k === 0 ? bytes : bytes.toFixed(bytes < 10 ? 1 : 0)} ${units[k]}`;
};
const timeOf = (seconds) => (seconds < 60 ? `${seconds.toFixed(seconds < 10 ? 1 : 0)} s` : `${Math.floor(seconds / 60)} min ${Math.round(seconds % 60)} s`);

const say = (text, fault = false) => {
  byId('said').textContent = text;
  byId('said').className = fault ? 'fault' : '';
};

const ask = async (path, options = {}) => {
  const response = await fetch(path, { credentials: 'omit', redirect: 'error', ...options });
  const json = await response.json();
  if (!response.ok) throw new Error(json.error ?? `status ${response.status}`);
  return json;
};
const post = (path, json) => ask(path, { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(json ?? {}) });

let state = { files: [], jobs: [], most_upload_bytes: 0 };
// Kept while the tab lives: what was selected is selected after a reload.
const ticked = new Set(JSON.parse(sessionStorage.getItem('ticked') ?? '[]'));

// Files

const upload = (file) => {
  const name = file.name.replace(/\s+/g, '_');
  const bar = make('progress', { max: 1, value: 0, 'aria-label': `Upload of ${name}` });
  const size = make('span', { textContent: sizeOf(file.size) });
  const item = make('li', {}, make('span', { textContent: name }), size, bar);
  byId('uploads').append(item);
  return new Promise((resolve) => {
    const end = (fault) => {
      if (fault) {
        bar.remove();
        size.textContent = '';
        item.append(make('span', { className: 'fault', role: 'alert', textContent: fault }));
        item.append(make('button', { className: 'plain', textContent: 'Dismiss', onclick: () => item.remove() }));
      } else {
        item.remove();
        ticked.add(name);
      }
      resolve(!fault);
    };
    if (state.most_upload_bytes > 0 && file.size > state.most_upload_bytes) {
      end(`larger than ${sizeOf(state.most_upload_bytes)}, which is the upload limit`);
      return;
    }
    const request = new XMLHttpRequest();
    request.open('PUT', `files/${encodeURIComponent(name)}`);
    request.upload.onprogress = (event) => { bar.value = event.total > 0 ? event.loaded / event.total : 0; };
    request.onerror = () => end('the connection was lost');
    request.onload = () => {
      let told_ = {};
      try { told_ = JSON.parse(request.responseText); } catch { /* no words, then */ }
      end(request.status === 201 ? '' : told_.error ?? `status ${request.status}`);
    };
    request.send(file);
  });
};

const uploadAll = async (files) => {
  for (const file of files) await upload(file);
  await refresh();
};

const removeFile = async (name) => {
  if (!confirm(`Remove ${name}?`)) return;
  try {
    await ask(`files/${encodeURIComponent(name)}`, { method: 'DELETE' });
    ticked.delete(name);
    say(`${name} was removed.`);
  } catch (error) { say(error.message, true); }
  await refresh();
};

const showTicked = () => {
  sessionStorage.setItem('ticked', JSON.stringify([...ticked]));
  const names = state.files.map((file) => file.name).filter((name) => ticked.has(name));
  byId('ticked').textContent = names.length ? `${names.length} selected: ${names.join(', ')}` : 'Select files above.';
  for (const button of byId('many').querySelectorAll('button')) button.disabled = names.length === 0;
};

const fileRow = ({ name, bytes }) => {
  const box = make('input', { type: 'checkbox', checked: ticked.has(name), 'aria-label': `Select ${name}` });
  box.onchange = () => {
    if (box.checked) ticked.add(name); else ticked.delete(name);
    showTicked();
  };
  return make('tr', {}, make('td', {}, box), make('td', { className: 'name', textContent: name }),
    make('td', { className: 'n', textContent: sizeOf(bytes) }),
    make('td', {}, make('button', { className: 'plain', type: 'button', textContent: 'Remove', 'aria-label': `Remove ${name}`, onclick: () => removeFile(name) })));
};

/** Choices of a list, with what was chosen kept. */
const fill = (select, values, fallback) => {
  const chosen = values.includes(select.value) ? select.value : fallback ?? '';
  select.replaceChildren(...values.map((value) => make('option', { value, textContent: value || 'none' })));
  select.value = chosen;
};

let filesShown = '';
const showFiles = () => {
  const key = JSON.stringify(state.files);
  if (key === filesShown) return;
  filesShown = key;
  const names = state.files.map((file) => file.name);
  byId('files').replaceChildren(...state.files.map(fileRow));
  byId('no-files').hidden = names.length > 0;
  fill(byId('source'), names, names[0]);
  fill(byId('target'), names, names[1] ?? names[0]);
  for (const id of ['control', 'poses']) fill(byId(id), ['', ...names.filter((name) => /\.csv$/i.test(name))]);
  for (const button of byId('register').querySelectorAll('button')) button.disabled = names.length < 2;
  showTicked();
};

// Work

const kinds = { register: 'Register', project: 'Project', view: 'View', place: 'Move', decide: 'Answer', link: 'Link', deviation: 'Deviation' };
const results = new Map();  // what a job's result says, once it was read

const start = async (work) => {
  try {
    await post('jobs', work);
    say('Started: see the jobs.');
  } catch (error) { say(error.message, true); }
  await refresh();
};

const link = (job, { name, bytes }) => make('a', { href: `results/${job.id}/${encodeURIComponent(name)}`, target: '_blank', rel: 'noopener noreferrer', textContent: `${name} (${sizeOf(bytes)})` });

const button = (text, work, label) => make('button', { type: 'button', textContent: text, onclick: () => start(work), ...(label ? { 'aria-label': label } : {}) });

/** Cut, not rounded: nothing is certain. */
const percent = (p) => {
  if (p == null) return '';
  if (p > 0.9999) return 'more than 99.99 %';
  const digits = p < 0.99 ? 1 : 2;
  return p < 0.001 ? '< 0.1 %' : `${(Math.floor(p * 100 * 10 ** digits + 1e-9) / 10 ** digits).toFixed(digits)} %`;
};

const alternativesOf = (job, result) => {
  const list = result.alternatives ?? [];
  if (list.length === 0) return [];
  const rooms = list.some((other) => other.room);
  const rows = list.slice(0, 50).map((other, k) => make('tr', {}, make('td', { textContent: k + 1 }),
    make('td', { textContent: percent(other.probability) }), ...(rooms ? [make('td', { className: 'name', textContent: other.room ?? '' })] : []),
    make('td', {}, button('View', { kind: 'view', of: job.id, alternative: k + 1 }, `View alternative ${k + 1}`), ' ',
      button('Choose', { kind: 'place', of: job.id, alternative: k + 1 }, `Choose alternative ${k + 1}: move the scan there`))));
  const head = make('tr', {}, ...['Number', 'Probability', rooms ? 'Room' : '', 'Action'].filter((word) => word).map((textContent) => make('th', { scope: 'col', textContent })));
  return [make('details', { open: result.outcome === 'ambiguous' }, make('summary', { textContent: `Other places (${list.length})` }),
    make('div', { className: 'scroll', tabIndex: 0, role: 'region', 'aria-label': `Other places of ${job.title}` }, make('table', {}, make('thead', {}, head), make('tbody', {}, ...rows))))];
};

/** What a button says for an answer, and the scans that it is about. */
const captionOf = (answer, several) => {
  const [kind] = answer.split(' ', 1);
  const pose = kind === 'choose' ? answer.slice(answer.lastIndexOf(' ') + 1) : '';
  return { accept: several ? 'Yes, at the best pose' : 'Yes', choose: `Yes, at pose ${pose}`, reject: 'No', forget: 'Don\u2019t know', start: 'Linked by hand' }[kind] ?? answer;
};
const scansOf = (asked) => asked.replaceAll('files/', '');
const askedOf = (answer) => answer.replace(/^choose (.*) \d+$/, '$1').replace(/^(accept|reject|forget|start) /, '');

const answered = new Map();  // of a job and a pair of scans: the answer that was given
const answersOf = (job, asked, answers) => {
  const key = `${job.id} ${asked}`;
  const several = answers.some((answer) => answer.startsWith('choose '));
  const buttons = answers.map((answer) => {
    const choose = button(captionOf(answer, several), null);
    choose.setAttribute('aria-pressed', answered.get(key) === answer);
    choose.onclick = async () => {
      answered.set(key, answer);
      for (const other of buttons) other.setAttribute('aria-pressed', other === choose);
      await start({ kind: 'decide', of: job.id, answer });
    };
    return choose;
  });
  return make('p', { className: 'answers' }, ...buttons);
};

/** Scans that can be linked by hand: one a file, and no model; those that nothing joined come first. */
const linkable = (project) => {
  const scans = (project.scans ?? []).filter((scan) => scan.readable !== false && !scan.copy_of && isScan(scan.file));
  const alone = scans.filter(({ file }) => scans.filter((other) => other.file === file).length === 1);
  return [...alone.filter(({ state: how }) => how === 'floating'), ...alone.filter(({ state: how }) => how !== 'floating')].map(({ file }) => file.replace('files/', ''));
};

/** What became of links that were made by hand. */
const byHandOf = (project) => (project.decisions ?? []).filter(({ decision }) => decision.startsWith('start '))
  .map(({ decision, state: how, reason }) => make('p', { textContent: `Linked by hand: ${scansOf(decision.replace(/^start /, '').replace(/ \S+=\S+/g, ''))}: ${how}${reason ? `, ${reason}` : ''}` }));

const questionsOf = (job, project) => {
  const list = project.questions ?? [];
  let number = 0;
  const parts = list.slice(0, 50).map((question) => {
    const card = make('div', { className: 'question' }, make('p', { textContent: question.text }));
    for (const asked of new Set((question.answers ?? []).map(askedOf))) {
      const picture = `question_${++number}.svg`;
      card.append(make('p', { textContent: `Are these two the same place, fitted together as shown? ${scansOf(asked)}` }));
      if (job.outputs.some(({ name }) => name === picture)) card.append(make('img', { src: `results/${job.id}/${picture}?${job.seconds}`, alt: `Both scans from above, one by one and together: ${scansOf(asked)}` }));
      card.append(answersOf(job, asked, question.answers.filter((answer) => askedOf(answer) === asked)));
    }
    return card;
  });
  if (parts.length > 0) parts.unshift(make('p', {}, make('strong', { textContent: 'Questions to somebody who knows the building' })));
  const scans = linkable(project);
  const byHand = make('button', { type: 'button', textContent: 'Link two scans by hand', 'aria-label': `Link two scans of ${job.title} by hand`, disabled: scans.length < 2, onclick: () => openLink(scans, scans[0], scans[1], job.id) });
  parts.push(...byHandOf(project), make('p', {}, byHand, ' ', button(list.length ? 'Run again with the answers' : 'Run again', { kind: 'again', of: job.id }, `Run ${job.title} again`)));
  return parts;
};

const length = (metres) => (metres < 0.1 ? `${(1000 * metres).toFixed(metres < 0.01 ? 1 : 0)} mm` : `${metres.toFixed(2)} m`);

/** How sure and how exact it is. */
const figuresOf = (result) => {
  const parts = [];
  if (result.probability != null) parts.push(`Probability ${percent(result.probability)}`);
  const { middle, far_end: far } = result.precision ?? {};
  if (middle) parts.push(`accuracy (95 %) ${length(middle.radius_m)} at the centre, ${length(far.radius_m)} at the far end`);
  const scans = result.scans ?? [];
  const radii = scans.map((scan) => scan.radius_95_m).filter((radius) => radius != null);
  if (radii.length) parts.push(`Accuracy (95 %) ${length(Math.max(...radii))} at worst`);
  const doubts = scans.filter((scan) => scan.component === 0 && scan.doubt != null).map((scan) => scan.doubt);
  if (doubts.length) parts.push(`each scan in its place with a probability of ${Math.max(...doubts) < 1e-4 ? '' : 'at least '}${percent(1 - Math.max(...doubts))}`);
  if (result.bundle) parts.push(`bundle error ${length(result.bundle.rms_m)}`);
  return parts.length ? [make('p', { className: 'figures', textContent: `${parts.join('; ')}.` })] : [];
};

/** Files of a project that could not be read, and why. */
const unreadableOf = (result) => (result.scans ?? []).filter((scan) => scan.readable === false)
  .map((scan) => make('p', { className: 'fault', textContent: `${scan.file.replace('files/', '')}: ${scan.reason}` }));

/** What is done in a shell has its button here. */
const isForHere = (step) => !/(^|\W)(limen|--\w|-o )/.test(step);

const outcomeOf = (job, result) => {
  if (job.state !== 'done') return '';
  const words = { registered: 'registered', probable: 'pose found, but less certain than registered', ambiguous: 'not decided: several places fit', under_constrained: 'some direction is undetermined', no_match: 'no reliable overlap was found', partial: 'some scans are registered, some are not' };
  return words[result?.outcome] ?? '';
};

const classOf = (job, result) => (job.state !== 'done' ? job.state : result?.outcome && result.outcome !== 'registered' ? 'undecided' : 'registered');

const jobCard = (job) => {
  const result = results.get(job.id)?.json;
  const title = make('h3', {}, `${kinds[job.kind] ?? job.kind}: `, make('span', { textContent: job.kind === 'decide' ? `${captionOf(job.title, false)}: ${scansOf(askedOf(job.title))}` : job.title }));
  const stateLine = make('p', {}, make('span', { className: 'state', textContent: outcomeOf(job, result) || job.state }), ' ', make('span', { className: 'soft time' }));
  const parts = [title, stateLine];
  if (job.state === 'running' || job.state === 'queued') {
    parts.push(make('progress', { max: 1, 'aria-label': `${job.title}: progress` }));
    parts.push(make('p', {}, make('button', { type: 'button', textContent: 'Stop', 'aria-label': `Stop ${job.title}`, onclick: async () => {
      try { await post(`jobs/${job.id}/stop`); } catch (error) { say(error.message, true); }
      await refresh();
    } })));
  }
  if (result?.reason) parts.push(make('p', { textContent: result.reason }));
  if (result) parts.push(...figuresOf(result), ...unreadableOf(result));
  const steps = (result?.next_steps ?? []).filter(isForHere);
  if (job.state === 'done' && steps.length) parts.push(make('ul', {}, ...steps.map((textContent) => make('li', { textContent }))));
  if (job.outputs.length > 0) parts.push(make('p', { className: 'links' }, ...job.outputs.filter(({ name }) => !/^question_\d+\.svg$/.test(name)).map((file) => link(job, file))));
  const placed = result && (result.target_from_source || (result.scans ?? []).some((scan) => scan.frame_from_scan));
  if (job.state === 'done' && placed) parts.push(make('p', {}, button('Look at it', { kind: 'view', of: job.id }, `Look at ${job.title}`), ' ', button(job.kind === 'project' ? 'Move all scans there' : 'Move the scan there', { kind: 'place', of: job.id })));
  const inModel = job.kind === 'project' ? (result?.scans ?? []).some(({ kind }) => kind === 'model') : ['registered', 'probable'].includes(result?.outcome) && (result.inputs.source.kind === 'model') !== (result.inputs.target.kind === 'model');
  if (job.state === 'done' && placed && inModel) parts.at(-1).append(' ', button('Compare with the model', { kind: 'deviation', of: job.id, pdf: byId('pdf').checked }, `Compare ${job.title} with the model`));
  if (result && ['register', 'link'].includes(job.kind)) parts.push(...alternativesOf(job, result));
  if (result && job.kind === 'project') parts.push(...questionsOf(job, result));
  if (job.said) {
    const failed = job.state === 'failed';
    parts.push(failed ? make('pre', { className: 'fault', tabIndex: 0, textContent: job.said }) : make('details', {}, make('summary', { textContent: 'Messages' }), make('pre', { tabIndex: 0, textContent: job.said })));
  }
  return make('article', { className: `job ${classOf(job, result)}`, id: `job-${job.id}` }, ...parts);
};

/** What changes all the time: written into the card that stands. */
const showProgress = (job) => {
  const card = byId(`job-${job.id}`);
  const bar = card?.querySelector('progress');
  card.querySelector('.time').textContent = job.state === 'queued' ? 'waits' : `${job.stage ? `${job.stage}, ` : ''}${timeOf(job.seconds)}`;
  if (!bar) return;
  if (job.share == null) bar.removeAttribute('value'); else bar.value = job.share;
};

const readResult = async (job) => {
  const file = { register: 'result.json', link: 'result.json', project: 'project.json' }[job.kind];
  if (job.state !== 'done' || !file || !job.outputs.some(({ name }) => name === file)) return;
  const key = `${job.seconds}`;
  if (results.get(job.id)?.key === key) return;
  try {
    results.set(job.id, { key, json: await ask(`results/${job.id}/${file}`) });
  } catch { /* it is asked for again */ }
};

const shown = new Map();
const showJobs = async () => {
  for (const job of state.jobs) await readResult(job);
  const jobs = state.jobs.filter(({ kind }) => kind !== 'plan');
  byId('no-work').hidden = jobs.length > 0;
  const list = byId('jobs');
  for (const job of jobs) {
    const { seconds, stage, share, ...rest } = job;
    if (job.state === 'running') rest.said = '';
    const key = JSON.stringify([rest, results.get(job.id)?.key]);
    if (shown.get(job.id) !== key) {
      const card = jobCard(job.state === 'running' ? { ...job, said: '' } : job);
      const before = byId(`job-${job.id}`);
      if (before) before.replaceWith(card); else list.prepend(card);
      shown.set(job.id, key);
    }
    showProgress(job);
  }
};

// All of it

let missed = 0;
const refresh = async () => {
  try {
    state = await ask('state');
    missed = 0;
  } catch {
    missed += 1;
  }
  byId('gone').hidden = missed < 3;
  if (missed > 0) return;
  byId('folder').textContent = state.folder;
  byId('version').textContent = `limen ${state.version}`;
  byId('prints').hidden = !state.prints;
  document.title = state.jobs.some((job) => job.state === 'running') ? 'limen: at work' : 'limen';
  showFiles();
  await showJobs();
  document.documentElement.dataset.ready = '1';
};

const again = async () => {
  await refresh();
  setTimeout(again, missed > 3 ? 5000 : 700);
};

byId('choose').onchange = async (event) => {
  const files = [...event.target.files];
  event.target.value = '';
  await uploadAll(files);
};
for (const name of ['dragover', 'dragleave', 'drop']) {
  document.addEventListener(name, (event) => {
    event.preventDefault();
    byId('drop').classList.toggle('over', name === 'dragover');
    if (name === 'drop' && event.dataTransfer?.files?.length) uploadAll([...event.dataTransfer.files]);
  });
}
for (const id of ['source-units', 'target-units']) {
  byId(id).append(make('option', { value: '', textContent: 'as in the file' }), ...['mm', 'cm', 'm', 'ft', 'us-ft', 'in', 'km'].map((value) => make('option', { value, textContent: value })));
}
byId('register').onsubmit = (event) => {
  event.preventDefault();
  start({ kind: 'register', source: byId('source').value, target: byId('target').value, source_units: byId('source-units').value, target_units: byId('target-units').value, no_repeats: byId('no-repeats').checked, pdf: byId('pdf').checked });
};
byId('many').onsubmit = (event) => {
  event.preventDefault();
  const tenths = (id) => Math.round(10 * (byId(id).valueAsNumber || 0));
  start({
    kind: event.submitter.value, files: state.files.map((file) => file.name).filter((name) => ticked.has(name)), pdf: byId('pdf').checked,
    control: byId('control').value, poses: byId('poses').value, sphere: tenths('sphere'), board: tenths('board'), no_repeats: byId('no-repeats').checked,
  });
};
again();
