// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// Buttons, boxes and sliders around the view. They change `state` and call `changed`.

const kLayers = [['cloud', t`Points`], ['planes', t`Outlines`], ['openings', t`Openings`], ['segments', t`Edges`], ['walls', t`Cut walls`]];

const made = (tag, attributes = {}, ...children) => {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
    else if (value !== false) node.setAttribute(name, value === true ? '' : value);
  }
  node.append(...children);
  return node;
};

const hasLayer = (side, layer) => {
  if (layer === 'cloud') return side.shape !== 'none';
  return layer === 'walls' ? side.planes.length > 0 : side[layer].length > 0;
};

const buildLayers = (scene, state, changed) => {
  const grid = element('layers');
  grid.append(made('span'), made('span', { class: 'head', style: 'color:var(--source-ink)' }, t`Source`),
    made('span', { class: 'head', style: 'color:var(--target)' }, t`Target`));
  for (const [layer, text] of kLayers) {
    if (!hasLayer(scene.source, layer) && !hasLayer(scene.target, layer)) continue;
    const faces = layer === 'cloud' && [scene.source, scene.target].some((side) => side.shape === 'faces');
    const label = faces ? t`Points, faces` : text;
    grid.append(made('span', {}, label));
    for (const name of ['source', 'target']) {
      const there = hasLayer(scene[name], layer);
      grid.append(made('input', {
        type: 'checkbox', 'aria-label': `${label}: ${name === 'source' ? t`Source` : t`Target`}`, 'data-layer': `${name}-${layer}`,
        disabled: !there, checked: there && state.layers[name][layer],
        onchange: (event) => { state.layers[name][layer] = event.target.checked; changed(); },
      }));
    }
  }
};

const kColourings = [['side', t`By side`], ['own', t`As measured`], ['residual', t`Residual`]];

const buildColours = (scene, state, changed) => {
  const offered = {
    side: true, own: scene.source.own || scene.target.own,
    residual: scene.residual_range !== undefined && scene.source.shape === 'points',
  };
  const box = element('colours');
  for (const [value, text] of kColourings.filter(([value]) => offered[value])) {
    box.append(made('label', { class: 'line' }, made('input', {
      type: 'radio', name: 'colouring', value, checked: value === state.colouring,
      onchange: () => { state.colouring = value; changed(); },
    }), text));
  }
  return kColourings.map(([value]) => value).filter((value) => offered[value]);
};

/** From the slider's 0 … 100 to 2 cm … 50 m, evenly in its logarithm. */
const thicknessOf = (value) => 0.02 * 2500 ** (value / 100);
const sliderOf = (thickness) => Math.round(100 * Math.log(thickness / 0.02) / Math.log(2500));

const buildSection = (state, range, changed) => {
  const [cut, axis, place, thickness] = ['cut', 'cut-axis', 'cut-place', 'cut-thickness'].map(element);
  const show = () => {
    const [low, high] = range(state.cut.axis);
    cut.checked = state.cut.on;
    axis.value = String(state.cut.axis);
    place.value = String(1000 * (state.cut.place[state.cut.axis] - low) / (high - low));
    thickness.value = String(sliderOf(state.cut.thickness));
    element('cut-place-text').value = metres(+(state.cut.place[state.cut.axis] - low).toFixed(2));
    element('cut-thickness-text').value = metres(+state.cut.thickness.toPrecision(2));
  };
  cut.addEventListener('change', () => { state.cut.on = cut.checked; changed(); });
  axis.addEventListener('change', () => { state.cut.axis = +axis.value; state.cut.on = true; changed(); });
  place.addEventListener('input', () => {
    const [low, high] = range(state.cut.axis);
    state.cut.place[state.cut.axis] = low + place.value / 1000 * (high - low);
    state.cut.on = true;
    changed();
  });
  thickness.addEventListener('input', () => { state.cut.thickness = thicknessOf(thickness.value); state.cut.on = true; changed(); });
  return show;
};

const rampCss = () => `linear-gradient(90deg, ${kRamp.map((c) => `rgb(${c.map((x) => Math.round(255 * x)).join(' ')})`).join(', ')})`;

const showLegend = (scene, state, residual) => {
  const legend = element('legend');
  // Asked for every frame; what has not changed is not written again.
  const shown = `${state.colouring} ${residual}`;
  if (legend.dataset.shown === shown) return;
  legend.dataset.shown = shown;
  legend.replaceChildren();
  if (state.colouring === 'residual' && residual) {
    legend.append(made('span', {}, t`Residual 0`, made('span', { class: 'ramp', style: `background:${rampCss()}` }),
      t`${1000 * scene.residual_range} mm and more; grey: not matched`));
  } else if (state.colouring === 'residual') {
    legend.append(t`Residuals are shown for the best pose only, after registration`);
  } else {
    for (const name of ['source', 'target']) {
      legend.append(made('span', { class: `chip ${name}` }, made('span', { class: 'mark' }), name === 'source' ? t`Source` : t`Target`));
    }
  }
};

const numbersOf = (pose) => {
  const words = [];
  if (pose.segments) words.push(t`${pose.segments} segments, ${pose.length.toFixed(1)} m in common`);
  else words.push(t`${pose.agreeing.toFixed(1)} m² agree`, t`${pose.contradicted.toFixed(1)} m² contradict`);
  if (pose.rms > 0) words.push(t`residual ${millimetres(pose.rms)}`);
  if (pose.probability) words.push(pose.probability);
  if (pose.room) words.push(pose.room);
  return words.join(' · ');
};

/** Freedoms and numbers of the pose that is shown; what they hold was made safe where the page was written. */
const showTables = (pose) => {
  for (const [id, table] of [['sigma-of-pose', pose.sigma], ['key-of-pose', pose.key]]) {
    const box = element(id);
    if (box && box.dataset.shown !== table) { box.innerHTML = table; box.dataset.shown = table; }
  }
};

const showPose = (scene, state) => {
  const count = scene.poses.length;
  const best = count > 1 ? t`Best of ${count}` : t`Best`;
  element('pose').value = state.pose === 0 ? best : t`Alternative ${state.pose} / ${count - 1}`;
  element('numbers').textContent = count && state.after ? numbersOf(scene.poses[state.pose]) : '';
  if (count) {
    element('matrix').textContent = scene.poses[state.pose].text;
    element('matrix-pose').textContent = state.pose === 0 ? t`The best pose, as in transform.txt.`
      : t`Alternative ${state.pose}, not the pose of transform.txt.`;
    showTables(scene.poses[state.pose]);
  }
  for (const row of document.querySelectorAll('tr[data-pose]')) {
    row.setAttribute('aria-selected', String(+row.dataset.pose === state.pose));
  }
  element('before').setAttribute('aria-pressed', String(!state.after));
  element('after').setAttribute('aria-pressed', String(state.after));
  for (const button of document.querySelectorAll('[data-view]')) {
    button.setAttribute('aria-pressed', String(button.dataset.view === state.view));
  }
};

/** Copies the matrix; where the browser forbids it, marks the text so that the reader's own copy works. */
const copyMatrix = async () => {
  const said = element('copied');
  try {
    await navigator.clipboard.writeText(element('matrix').textContent);
    said.textContent = t`Copied`;
  } catch {
    getSelection().selectAllChildren(element('matrix'));
    said.textContent = document.execCommand('copy') ? t`Copied` : t`Selected: copy it with Ctrl+C`;
  }
};
