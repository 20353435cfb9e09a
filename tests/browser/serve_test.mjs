// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// What somebody does with the page of `limen serve`: drop files, register, choose, answer, look, download.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { accessibilityFaults, limen, openBrowser } from './browser.mjs';

const program = process.env.LIMEN_PROGRAM;
const playwright = await import('playwright-core');
const folder = mkdtempSync(join(tmpdir(), 'limen-serve-'));
const shots = process.env.LIMEN_SCREENSHOTS;
const museum = (name) => join(folder, 'museum', name);
let browser; let server; let address; let page;
const record = { problems: [], requests: [] };

/** Starts it and waits for the address that it tells. */
const serve = async () => {
  server = spawn(program, ['serve', join(folder, 'site'), '--most-upload', '100M', '--json'], { stdio: ['ignore', 'pipe', 'inherit'] });
  let printed = '';
  for await (const piece of server.stdout) {
    printed += piece;
    if (printed.includes('}')) break;
  }
  return JSON.parse(printed).address;
};

const openPage = async (scheme = 'light', viewport) => {
  const opened = await browser.context.newPage();
  if (viewport) await opened.setViewportSize(viewport);
  await opened.emulateMedia({ colorScheme: scheme, reducedMotion: 'reduce' });
  opened.on('console', (message) => ['error', 'warning'].includes(message.type()) && record.problems.push(message.text()));
  opened.on('pageerror', (error) => record.problems.push(String(error.stack ?? error)));
  opened.on('request', (request) => record.requests.push(request.url()));
  await opened.goto(address);
  await opened.waitForSelector('html[data-ready]', { timeout: 20000 });
  return opened;
};

/** The stages that the server tells of a piece of work until it has ended, asked far more often than the page asks. */
const stagesOf = (id) => page.evaluate(async (of) => {
  const stages = new Set();
  for (const last = Date.now() + 120000; Date.now() < last;) {
    const state = await (await fetch('state')).json();
    const job = state.jobs.find((one) => one.id === of);
    if (job.stage) stages.add(job.stage);
    if (!['queued', 'running'].includes(job.state)) break;
    await new Promise((resolve) => { setTimeout(resolve, 10); });
  }
  return [...stages];
}, id);

/** The card of a piece of work once it has ended. */
const ended = async (id) => {
  await page.waitForSelector(`#job-${id}:not(.running):not(.queued)`, { timeout: 120000 });
  return page.locator(`#job-${id}`);
};

before(async () => {
  limen(program, 'simulate', 'museum', '-o', join(folder, 'museum'), '--points-indoor', '100000', '--points-outdoor', '400000');
  limen(program, 'simulate', 'room', '-o', join(folder, 'room'), '--points-indoor', '60000');
  limen(program, 'simulate', 'office', '-o', join(folder, 'office'), '--points-indoor', '60000');
  copyFileSync(join(folder, 'office', 'scan_01.ply'), join(folder, 'room_of_office.ply'));
  writeFileSync(join(folder, 'a <b>&.ply'), readFileSync(join(folder, 'room', 'indoor_00.ply')));
  browser = await openBrowser(playwright);
  address = await serve();
  page = await openPage();
  if (shots) mkdirSync(shots, { recursive: true });
});

after(async () => {
  await browser?.close();
  server?.kill('SIGKILL');
  rmSync(folder, { recursive: true, force: true });
});

describe('a page to drop files on', () => {
  test('is empty at first, and everybody can use it', async () => {
    assert.match(await page.locator('#no-files').innerText(), /No file yet/);
    assert.ok(await page.locator('#register .main').isDisabled());
    assert.deepEqual(await accessibilityFaults(page), []);
    if (shots) await page.screenshot({ path: join(shots, 'serve-empty.png') });
  });

  test('takes files, shows them as text, and refuses a second of one name', async () => {
    await page.setInputFiles('#choose', [museum('indoor_00.ply'), museum('outdoor.ply'), join(folder, 'a <b>&.ply')]);
    await page.waitForFunction(() => document.querySelectorAll('#files tr').length === 3);
    const names = await page.locator('#files td.name').allInnerTexts();
    assert.deepEqual(names, ['a_<b>&.ply', 'indoor_00.ply', 'outdoor.ply']);
    assert.equal(statSync(join(folder, 'site', 'files', 'outdoor.ply')).size, statSync(museum('outdoor.ply')).size);
    await page.setInputFiles('#choose', [museum('outdoor.ply')]);
    await page.waitForSelector('#uploads .fault');
    assert.match(await page.locator('#uploads').innerText(), /a file of this name exists/);
    await page.click('#uploads button');
    record.problems = record.problems.filter((text) => !/409/.test(text));
  });

  test('refuses what is neither a scan nor a model', async () => {
    await page.setInputFiles('#choose', [{ name: 'photo.jpg', mimeType: 'image/jpeg', buffer: Buffer.from([0xff, 0xd8, 0xff, 0xe0, 0, 16, 74, 70, 73, 70, 0, 1, 1, 0]) }]);
    await page.waitForSelector('#uploads .fault');
    assert.match(await page.locator('#uploads').innerText(), /photo\.jpg[\s\S]*E57, LAS/);
    assert.ok(!existsSync(join(folder, 'site', 'files', 'photo.jpg')));
    await page.click('#uploads button');
    record.problems = record.problems.filter((text) => !/415/.test(text));
  });

  test('keeps what is selected after a reload', async () => {
    await page.setChecked('input[aria-label="Select outdoor.ply"]', true);
    await page.setChecked('input[aria-label="Select indoor_00.ply"]', false);
    await page.reload();
    await page.waitForSelector('html[data-ready]');
    assert.ok(await page.isChecked('input[aria-label="Select outdoor.ply"]'));
    assert.ok(!await page.isChecked('input[aria-label="Select indoor_00.ply"]'));
    assert.match(await page.locator('#ticked').innerText(), /outdoor\.ply/);
  });

  test('takes a file that is dropped', async () => {
    await page.evaluate(() => {
      const data = new DataTransfer();
      data.items.add(new File(['0 0 0\n'], 'dropped.xyz'));
      document.getElementById('drop').dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
    });
    await page.waitForFunction(() => [...document.querySelectorAll('#files td.name')].some((cell) => cell.textContent === 'dropped.xyz'));
  });

  test('removes one', async () => {
    page.once('dialog', (dialog) => dialog.accept());
    await page.click('button[aria-label="Remove dropped.xyz"]');
    await page.waitForFunction(() => ![...document.querySelectorAll('#files td.name')].some((cell) => cell.textContent === 'dropped.xyz'));
    assert.ok(!existsSync(join(folder, 'site', 'files', 'dropped.xyz')));
  });
});

describe('work', () => {
  test('two files are registered, with progress, and the report can be looked at', async () => {
    await page.selectOption('#source', 'indoor_00.ply');
    await page.selectOption('#target', 'outdoor.ply');
    await page.check('#pdf');
    await page.click('#register button');
    await page.uncheck('#pdf');
    assert.match((await stagesOf(1)).join(' '), /(reading|features|scoring|refinement|hypotheses)/);
    const card = await ended(1);
    assert.match(await card.innerText(), /registered/);
    assert.match(await card.innerText(), /Probability [\s\S]*%; accuracy \(95 %\) [\d.]+ mm at the centre/);
    assert.doesNotMatch(await card.innerText(), /limen (transform|deviation|view|info)| --/, 'no lines for a shell');
    const printed = await page.request.get(await card.locator('a', { hasText: 'report.pdf' }).evaluate((link) => link.href));
    assert.equal(printed.headers()['content-type'], 'application/pdf');
    assert.equal((await printed.body()).subarray(0, 5).toString(), '%PDF-');
    const [report] = await Promise.all([page.context().waitForEvent('page'), card.locator('a', { hasText: 'report.html' }).click()]);
    await report.waitForSelector('html[data-ready]', { timeout: 60000 });
    assert.match(await report.locator('h1').innerText(), /fit/i);
    assert.equal(await report.evaluate(() => origin), 'null', 'a result has no origin: it can ask nothing');
    assert.equal(await report.evaluate((url) => fetch(url).then(() => 'asked', () => 'refused'), `${address}state`), 'refused');
    await report.close();
  });

  test('the stage that is reported is shown, with the share of it', async () => {
    // How long work takes is the machine's affair: the server states some that still runs.
    await page.route('**/state', async (route) => {
      const response = await route.fetch();
      const state = await response.json();
      Object.assign(state.jobs.find((job) => job.id === 1), { state: 'running', stage: 'scoring', share: 0.25, seconds: 3, said: '' });
      await route.fulfill({ response, json: state });
    });
    await page.waitForSelector('#job-1.running');
    assert.match(await page.locator('#job-1 .time').innerText(), /scoring, 3/);
    assert.equal(await page.locator('#job-1 progress').evaluate((bar) => bar.value / bar.max), 0.25);
    if (shots) await page.screenshot({ path: join(shots, 'serve-running.png') });
    await page.unrouteAll({ behavior: 'wait' });
    await ended(1);
  });

  test('the scan is moved there and can be downloaded', async () => {
    await page.click('#job-1 button:has-text("Move the scan there")');
    const card = await ended(2);
    const [download] = await Promise.all([page.waitForEvent('download'), card.locator('a', { hasText: 'indoor_00_placed.ply' }).evaluate((node) => { node.removeAttribute('target'); node.click(); })]);
    const bytes = readFileSync(await download.path());
    assert.equal(bytes.length, statSync(join(folder, 'site', 'results', '2', 'indoor_00_placed.ply')).size);
    assert.equal(bytes.subarray(0, 4).toString(), 'ply\n');
  });

  test('both can be looked at together', async () => {
    await page.click('#job-1 button:has-text("Look at it")');
    const card = await ended(3);
    const [view] = await Promise.all([page.context().waitForEvent('page'), card.locator('a', { hasText: 'view.html' }).click()]);
    await view.waitForSelector('html[data-ready]', { timeout: 60000 });
    assert.equal(await view.title(), 'indoor_00.ply, outdoor.ply');
    await view.close();
  });

  test('other places are a choice', async () => {
    await page.setInputFiles('#choose', [join(folder, 'room_of_office.ply'), join(folder, 'office', 'model.ifc')]);
    await page.waitForFunction(() => [...document.querySelectorAll('#files td.name')].some((cell) => cell.textContent === 'model.ifc'));
    await page.selectOption('#source', 'room_of_office.ply');
    await page.selectOption('#target', 'model.ifc');
    await page.click('#register button');
    const card = await ended(4);
    await card.locator('details').first().evaluate((node) => { node.open = true; });
    assert.match(await card.innerText(), /Other places \(\d+\)/);
    assert.deepEqual(await accessibilityFaults(page), []);
    if (shots) await page.screenshot({ path: join(shots, 'serve-alternatives.png'), fullPage: true });
    await card.locator('button[aria-label^="Choose alternative 1"]').click();
    const moved = await ended(5);
    assert.match(await moved.innerText(), /alternative 1/);
    assert.ok(existsSync(join(folder, 'site', 'results', '5', 'room_of_office_placed.ply')));
  });

  test('a project is made of the files that are selected, and run again', async () => {
    for (const name of ['room_of_office.ply', 'model.ifc', 'outdoor.ply', 'indoor_00.ply']) await page.setChecked(`input[aria-label="Select ${name}"]`, ['indoor_00.ply', 'outdoor.ply'].includes(name));
    await page.setChecked('input[aria-label="Select a_<b>&.ply"]', false);
    await page.click('button[value="project"]');
    const card = await ended(6);
    assert.match(await card.innerText(), /project\.json/);
    assert.match(await card.innerText(), /Accuracy \(95 %\) [\d.]+ mm at worst/);
    await card.locator('button', { hasText: /^Run again/ }).click();
    await page.waitForSelector('#job-6.running, #job-6.queued');
    await ended(6);
  });

  test('a question is answered as limen project decide would', async () => {
    // The question itself is put there: which pairs leave one open is not what is tested here.
    const path = join(folder, 'site', 'results', '6', 'project.json');
    const project = JSON.parse(readFileSync(path));
    const answer = 'accept files/indoor_00.ply files/outdoor.ply';
    const others = ['reject', 'forget'].map((kind) => answer.replace('accept', kind));
    project.questions = [{ text: 'Do the two stand so?', answers: [answer, ...others, 'accept files/indoor_00.ply -oevil'], scans: [], for_the_present_place: [], for_another_place: [] }];
    writeFileSync(path, JSON.stringify(project));
    await page.reload();
    await page.waitForSelector('#job-6 .question');
    const question = page.locator('#job-6 .question');
    assert.match(await question.innerText(), /Are these two the same place, fitted together as shown\? indoor_00\.ply outdoor\.ply/);
    assert.doesNotMatch(await question.innerText(), /accept|reject|forget/);
    const press = (text) => page.locator('#job-6 .answers').first().getByText(text, { exact: true }).click();
    const kept = () => JSON.parse(readFileSync(join(folder, 'site', 'results', '6', 'decisions.json'), 'utf8')).decisions;
    await press('Yes');
    const card = await ended(7);
    assert.match(await card.innerText(), /Answer:/);
    await press('Yes');
    await ended(8);
    assert.deepEqual(kept(), [{ accept: ['files/indoor_00.ply', 'files/outdoor.ply'] }], 'twice is once');
    await press('Don\u2019t know');
    await ended(9);
    assert.deepEqual(kept(), []);
    const refused = await page.evaluate(() => fetch('jobs', { method: 'POST', body: JSON.stringify({ kind: 'decide', of: 6, answer: 'forget x' }) }).then((response) => response.status));
    assert.equal(refused, 400);
    record.problems = record.problems.filter((text) => !/400/.test(text));
  });

  test('what fails says why, in the words of the program', async () => {
    await page.setInputFiles('#choose', [{ name: 'broken.las', mimeType: 'application/octet-stream', buffer: Buffer.from('\u001b[31mno cloud at all'.repeat(40)) }]);
    await page.waitForFunction(() => [...document.querySelectorAll('#files td.name')].some((cell) => cell.textContent === 'broken.las'));
    await page.selectOption('#source', 'broken.las');
    await page.selectOption('#target', 'outdoor.ply');
    await page.click('#register button');
    const card = await ended(10);
    assert.match(await card.innerText(), /failed[\s\S]*broken\.las: this is not a LAS file/);
  });

  test('can be stopped', async () => {
    await page.selectOption('#source', 'indoor_00.ply');
    await page.click('#register button');
    // Found and clicked at once: it is gone as soon as the work has ended.
    await page.waitForFunction(() => {
      const stop = [...document.querySelectorAll('#job-11 button')].find((button) => button.textContent.startsWith('Stop'));
      stop?.click();
      return Boolean(stop);
    }, null, { polling: 20 });
    await ended(11);
    assert.match(await page.locator('#job-11').innerText(), /stopped|registered/);
  });
});

describe('a project with a file that cannot be read', () => {
  test('says which, and why', async () => {
    for (const name of ['broken.las', 'indoor_00.ply', 'outdoor.ply', 'room_of_office.ply', 'model.ifc', 'a_<b>&.ply']) await page.setChecked(`input[aria-label="Select ${name}"]`, ['broken.las', 'indoor_00.ply', 'outdoor.ply'].includes(name));
    await page.click('button[value="project"]');
    const card = await ended(12);
    assert.match(await card.locator('.fault').first().innerText(), /^broken\.las: cannot be read: /);
  });
});

describe('two scans linked by hand', () => {
  const names = ['room_a.ply', 'room_b.ply'];
  const site = () => join(folder, 'site', 'results');
  const truth = () => JSON.parse(readFileSync(join(folder, 'room', 'truth', 'truth.json'))).scans.map((scan) => scan.world_from_scan);
  const said = () => page.locator('#link-said').innerText();
  const plansThere = () => page.waitForFunction(() => linking.ready() && planViews.every((plan) => plan.canvas.dataset.view));

  /** Where on the two canvases three places of the room are that both sections show. */
  const corners = () => page.evaluate(([a, b]) => {
    const apply = (m, p) => [0, 1, 2].map((i) => m[i][0] * p[0] + m[i][1] * p[1] + m[i][2] * p[2] + m[i][3]);
    const back = (m, p) => [0, 1, 2].map((i) => [0, 1, 2].reduce((sum, j) => sum + m[j][i] * (p[j] - m[j][3]), 0));
    const { x, y, z, floor, count } = linking.sides[0];
    const cut = Plan.section();
    const shown = [];
    for (let k = 0; k < count && shown.length < 400; k += 23) {
      if (!cut(z[k] - floor)) continue;
      const place = [x[k], y[k], z[k]];
      const other = planViews[1].toCanvas(back(b, apply(a, place)));
      const at = [planViews[0].toCanvas(place), other];
      const inside = at.every(([px, py], side) => px > 5 && py > 5 && px < planViews[side].canvas.clientWidth - 5 && py < planViews[side].canvas.clientHeight - 5);
      if (inside && planViews[1].nearest(other)) shown.push({ place, at });
    }
    const far = (one, others) => Math.min(...others.map(({ place }) => Math.hypot(place[0] - one.place[0], place[1] - one.place[1])));
    const chosen = [shown[0]];
    while (chosen.length < 3) chosen.push(shown.reduce((best, one) => (far(one, chosen) > far(best, chosen) ? one : best)));
    return chosen.map(({ at }) => at);
  }, truth());
  const click = async (side, [x, y]) => page.locator(['#plan-source', '#plan-target'][side]).click({ position: { x, y } });
  const pointOut = async (places) => {
    for (const at of places) for (const side of [0, 1]) await click(side, at[side]);
    assert.match(await page.locator('#link-count').innerText(), /3 of 3/);
    if (shots) await page.screenshot({ path: join(shots, 'serve-link.png') });
    await page.click('#link-go');
    await page.waitForSelector('#link:not([open])', { state: 'attached' });
  };
  const cardOf = async (text) => {
    const card = page.locator('.job:not(.running):not(.queued)', { has: page.locator('h3', { hasText: text }) }).first();
    await card.waitFor({ timeout: 120000 });
    return card;
  };

  before(async () => {
    for (const [k, name] of names.entries()) copyFileSync(join(folder, 'room', `indoor_0${k}.ply`), join(folder, name));
    await page.setInputFiles('#choose', names.map((name) => join(folder, name)));
    await page.waitForFunction(() => [...document.querySelectorAll('#files td.name')].some((cell) => cell.textContent === 'room_b.ply'));
    await page.selectOption('#source', names[0]);
    await page.selectOption('#target', names[1]);
  });

  test('what gives no pose is said in one sentence', async () => {
    await page.click('#link-files');
    await plansThere();
    assert.ok(await page.locator('#link-go').isDisabled());
    const [[first, other], [second, third]] = await corners();
    for (const at of [first, first, second]) await click(0, at);
    for (const at of [other, third, third]) await click(1, at);
    await page.click('#link-go');
    await page.waitForSelector('#link-said.fault');
    assert.match(await said(), /^points 1 and 2 are the same place of the moving scan: show three places in both/);
    await page.click('#link-clear');
    await click(0, [12, await page.locator('#plan-source').evaluate((canvas) => canvas.clientHeight - 12)]);
    assert.match(await said(), /No point is near enough/);
    record.problems = record.problems.filter((text) => !/400/.test(text));
  });

  test('by keys alone a place is set, and a scan is moved over the other', async () => {
    await page.focus('#plan-source');
    const [[at]] = await corners();
    const { width, height } = await page.locator('#plan-source').evaluate(({ clientWidth: width, clientHeight: height }) => ({ width, height }));
    for (const [axis, keys] of [[at[0] - width / 2, ['ArrowLeft', 'ArrowRight']], [at[1] - height / 2, ['ArrowUp', 'ArrowDown']]]) {
      for (let k = Math.round(Math.abs(axis) / 10); k > 0; --k) await page.keyboard.press(keys[axis > 0 ? 1 : 0]);
    }
    await page.keyboard.press('Enter');
    assert.match(await said(), /Place 1 is set/);
    await page.click('#link-clear');
    await page.focus('#plan-both');
    await page.keyboard.press('ArrowLeft');
    await page.keyboard.press('.');
    assert.match(await page.locator('#link-count').innerText(), /dragged/);
    assert.ok(await page.locator('#link-go').isEnabled());
    await page.click('#link-clear');
  });

  for (const [width, height, scheme] of [[390, 844, 'light'], [1920, 1080, 'dark'], [1280, 900, 'light']]) {
    test(`${width} px, ${scheme}: nothing sticks out, and everybody can use it`, async () => {
      await page.setViewportSize({ width, height });
      await page.emulateMedia({ colorScheme: scheme, reducedMotion: 'reduce' });
      assert.ok(await page.evaluate(() => byId('link').scrollWidth <= byId('link').clientWidth && document.documentElement.scrollWidth <= innerWidth));
      assert.deepEqual(await accessibilityFaults(page), []);
      if (shots) await page.screenshot({ path: join(shots, `serve-link-${width}.png`) });
    });
  }

  test('three pairs of clicks, and the pair is registered', async () => {
    await page.keyboard.press('0');
    await pointOut(await corners());
    const card = await cardOf('Link: room_a.ply into room_b.ply');
    assert.match(await card.innerText(), /registered[\s\S]*Probability [\s\S]*%; accuracy \(95 %\)/);
    assert.match(await card.innerText(), /report\.html/);
  });

  test('a link of a project is kept, and used in its next run', async () => {
    for (const row of await page.locator('#files input').all()) await row.setChecked(false);
    for (const name of names) await page.setChecked(`input[aria-label="Select ${name}"]`, true);
    await page.click('button[value="project"]');
    const card = await cardOf('Project: room_a.ply, room_b.ply');
    await card.locator('button', { hasText: 'Link two scans by hand' }).click();
    await plansThere();
    await pointOut(await corners());
    await cardOf('Answer: Linked by hand: room_a.ply room_b.ply');
    const id = (await card.getAttribute('id')).replace('job-', '');
    const { decisions } = JSON.parse(readFileSync(join(site(), id, 'decisions.json'), 'utf8'));
    assert.deepEqual(decisions.map(({ start, points }) => [start, points.length]), [[names.map((name) => `files/${name}`), 3]]);
    await card.locator('button', { hasText: /^Run again/ }).click();
    await page.waitForFunction((of) => /Linked by hand: room_a\.ply room_b\.ply: kept/.test(byId(`job-${of}`).innerText), id, { timeout: 120000 });
    assert.match(await card.innerText(), /registered/);
  });
});

describe('nobody else', () => {
  test('a page of another origin gets nothing, with the token or without', async () => {
    const other = await browser.context.newPage();
    await other.goto('data:text/html,<title>elsewhere</title>');
    for (const url of [`${address}state`, address.replace(/\/[0-9a-f]{32}\//, '/state')]) {
      const got = await other.evaluate((to) => fetch(to, { method: 'POST', body: '{}' }).then(() => 'asked', () => 'refused'), url);
      assert.equal(got, 'refused');
    }
    await other.close();
  });
});

describe('on every screen', () => {
  for (const [width, height, scheme] of [[1280, 900, 'light'], [1280, 900, 'dark'], [390, 844, 'light'], [1920, 1080, 'light']]) {
    test(`${width} px, ${scheme}: nothing sticks out, and everybody can use it`, async () => {
      const opened = await openPage(scheme, { width, height });
      assert.ok(await opened.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
      if (shots) await opened.screenshot({ path: join(shots, `serve-${width}-${scheme}.png`), fullPage: true });
      assert.deepEqual(await accessibilityFaults(opened), []);
      await opened.close();
    });
  }

  test('it complains of nothing, asks nobody else, and says when the server has ended', async () => {
    assert.deepEqual(record.problems, []);
    assert.deepEqual(record.requests.filter((url) => !url.startsWith(address) && !url.startsWith('data:')), []);
    const closed = new Promise((resolve) => { server.on('exit', (code) => resolve(code)); });
    server.kill('SIGINT');
    assert.equal(await closed, 0);
    await page.waitForSelector('#gone:not([hidden])', { timeout: 30000 });
  });
});
