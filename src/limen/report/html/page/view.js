// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// Any clouds and models in one frame: looking, cutting, measuring.

const kTurnMs = 700;
const kWhereItIs = fromAxes([1, 0, 0], [0, 1, 0], [0, 0, 1]);
const kTints = 8;
const kEyeHeight = 1.4;
const kWaysToColour = [['side', 'By file'], ['own', 'As measured'], ['height', 'Height']];

/** All sides with their boxes, and the box of all: of the central part, so that strays do not count. */
const loadView = () => {
  const scene = JSON.parse(element('scene').textContent);
  scene.sides = scene.sides.map((id, k) => Object.assign(loadSide(scene, id), { tint: `--side-${k % kTints}`, shown: true }));
  for (const side of scene.sides) side.box = boxOf(side, kWhereItIs);
  const low = [0, 1, 2].map((k) => Math.min(...scene.sides.map(({ box }) => box.low[k])));
  const high = [0, 1, 2].map((k) => Math.max(...scene.sides.map(({ box }) => box.high[k])));
  const margin = 0.03 * norm(sub(high, low)) + 0.2;
  // Sections begin at the height of an eye: through windows and doors.
  const eye = Math.min(low[2] + kEyeHeight, 0.5 * (low[2] + high[2]));
  return { ...scene, low: low.map((c) => c - margin), high: high.map((c) => c + margin), eye };
};

const signed = (x, digits) => `${x < 0 ? '−' : ''}${Math.abs(x).toFixed(digits)}`;

/** What lies between two places, in words: pairs of name and value. */
const describeLength = ([a, b]) => {
  const way = sub(b.at, a.at);
  const exact = [a, b].reduce((sum, { side, point }) => sum + (point >= 0 ? Math.hypot(...side.step) / 2 : 0), 0);
  return [
    ['Distance', `${norm(way).toFixed(3)} m${exact > 0.0005 ? ` ± ${millimetres(exact)}` : ''}`],
    ['Level', `${Math.hypot(way[0], way[1]).toFixed(3)} m`],
    ['Height', `${signed(way[2], 3)} m`],
    ['Slope', `${signed(Math.atan2(way[2], Math.hypot(way[0], way[1])) * 180 / Math.PI, 2)}°`],
  ];
};

const describePlace = (scene, { side, point, plane, at }, name) => {
  const lines = [[name, add(at, scene.origin).map((c) => c.toFixed(3)).join('  ')], ['Of', side.name]];
  if (point < 0 && plane >= 0) lines.push(['Surface', `${side.planes[plane].area.toFixed(1)} m²`]);
  return lines;
};

const buildSides = (scene, changed) => {
  element('sides').append(...scene.sides.map((side, k) => made('label', { class: 'side' },
    made('input', { type: 'checkbox', 'data-side': k, checked: true, onchange: (event) => { side.shown = event.target.checked; changed(); } }),
    made('span', { class: 'mark', style: `background:var(${side.tint})` }),
    made('span', { class: 'name' }, side.name, made('span', { class: 'soft' }, side.about)))));
};

const buildWaysToColour = (scene, state, changed) => {
  const points = scene.sides.some((side) => side.shape === 'points');
  const offered = kWaysToColour.filter(([value]) => value === 'side' || (points && (value !== 'own' || scene.sides.some((side) => side.own))));
  element('colours').append(...offered.map(([value, text]) => made('label', { class: 'line' }, made('input', {
    type: 'radio', name: 'colouring', value, checked: value === state.colouring, onchange: () => { state.colouring = value; changed(); },
  }), text)));
  return offered.map(([value]) => value);
};

const showColourLegend = (scene, state) => {
  const legend = element('legend');
  legend.replaceChildren();
  if (state.colouring !== 'height') return;
  const [low, high] = [scene.low[2], scene.high[2]].map((z) => (z + scene.origin[2]).toFixed(1));
  legend.append(made('span', {}, `${low} m`, made('span', { class: 'ramp', style: `background:${rampCss()}` }), `${high} m`));
};

const makeViewGpu = (gl, scene) => {
  const programs = makePrograms(gl);
  const paintSurfaces = makeSurfacePainter(gl, programs);
  const parts = scene.sides.map((side) => ({
    side, cloud: makeCloud(gl, side), outlines: makeLines(gl).replace(side.planes.flatMap(outlineOf)), walls: makeLines(gl),
  }));
  const measured = makeLines(gl);
  const ways = ['side', 'own', 'residual', 'height'];

  const drawCloud = ({ side, cloud }, { look, state, ratio, plain }) => {
    if (!cloud || cloud.shape !== 'points' || !side.shown) return;
    programs.points.use();
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, cloud.normals);
    programs.points.set({
      ...look, normals: 0, viewFromNumbers: side.fromNumbers, viewFromSide: [1, 0, 0, 0, 1, 0, 0, 0, 1], tint: styleColour(side.tint),
      plain, colouring: ways.indexOf(state.colouring), heights: [scene.low[2], scene.high[2]], size: state.size * ratio,
    });
    gl.bindVertexArray(cloud.array);
    gl.drawArrays(gl.POINTS, 0, cloud.count);
  };
  const drawModel = ({ side, cloud }, { look, state }) => {
    if (!cloud || cloud.shape !== 'faces' || !side.shown) return;
    programs.faces.use();
    programs.faces.set({ ...look, viewFromNumbers: side.fromNumbers, tint: styleColour(side.tint), alpha: state.cut.on ? 0.35 : 0.16 });
    gl.bindVertexArray(cloud.array);
    gl.drawArrays(gl.TRIANGLES, 0, cloud.count);
  };
  const drawLines = (lines, { look, size, ratio }, { colour, width, alpha = 1, whole = false }) => {
    if (!lines.count) return;
    programs.lines.use();
    programs.lines.set({
      ...look, cutAxis: whole ? [0, 0, 0] : look.cutAxis, viewFromSide: kWhereItIs, screen: size, width: width * ratio, dash: 0, colour: [...colour, alpha],
    });
    gl.bindVertexArray(lines.array);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, lines.count);
  };
  const draw = (frame) => {
    const ink = styleColour('--ink');
    Object.assign(frame, { plain: styleColour('--line'), shadow: ink.map((c) => (c > 0.5 ? 0.02 : c * 0.6)) });
    paintSurfaces(frame, () => { for (const part of parts) drawCloud(part, frame); }, () => { for (const part of parts) drawModel(part, frame); });
    for (const { side, outlines, walls } of parts) {
      if (!side.shown) continue;
      drawLines(outlines, frame, { colour: styleColour(side.tint), width: 1.1, alpha: 0.7 });
      if (frame.state.cut.on) drawLines(walls, frame, { colour: styleColour(side.tint), width: 2.4, whole: true });
    }
    const { ends } = frame.state;
    measured.replace(ends.length === 2 ? [...ends[0].at, ...ends[1].at] : []);
    drawLines(measured, frame, { colour: ink, width: 2.2, whole: true });
  };
  const cut = ({ on, axis, place }) => {
    const normal = [0, 1, 2].map((k) => (k === axis ? 1 : 0));
    for (const { side, walls } of parts) walls.replace(on ? cutLines(side, normal, place[axis]) : []);
  };
  return { draw, cut };
};

const runView = (gl, canvas) => {
  const scene = loadView();
  const still = matchMedia('(prefers-reduced-motion: reduce)');
  const middle = scaled(add(scene.low, scene.high), 0.5);
  const state = {
    view: 'free', colouring: scene.sides.length === 1 && scene.sides[0].own ? 'own' : 'side', size: 2, measuring: false, ends: [],
    cut: { on: false, axis: 2, place: [middle[0], middle[1], scene.eye], thickness: 0.5 },
  };
  const gpu = makeViewGpu(gl, scene);
  const reach = 3 * norm(sub(scene.high, scene.low)) + 20;
  let camera = null;
  let motion = null;
  let look = null;
  let asked = false;

  const redraw = () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame((now) => { asked = false; step(now); });
  };
  const step = (now) => {
    if (motion) {
      const share = smooth(clamp((now - motion.start) / kTurnMs, 0, 1));
      camera = share >= 1 ? motion.to : betweenCameras(motion.from, motion.to, share);
      if (share >= 1) motion = null; else redraw();
    }
    draw();
  };
  const draw = () => {
    const ratio = Math.min(2, devicePixelRatio || 1);
    const size = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
    if (size[0] < 2 || size[1] < 2) return;
    if (canvas.width !== size[0] || canvas.height !== size[1]) Object.assign(canvas, { width: size[0], height: size[1] });
    const { cut } = state;
    const at = cut.place[cut.axis];
    look = {
      ...projectionOf(camera, size[0] / size[1], reach), parallel: camera.parallel, seeThrough: false,
      cutAxis: [0, 1, 2].map((k) => (cut.on && k === cut.axis ? 1 : 0)), cutRange: [at - cut.thickness / 2, at + cut.thickness / 2],
      css: [canvas.clientWidth, canvas.clientHeight], metresPerPx: camera.height / canvas.clientHeight,
      distance: camera.height / 2 / Math.tan(kFieldOfView / 2),
    };
    gpu.draw({ look, state, size, ratio, height: camera.height });
    overlay();
    canvas.dataset.frames = String(+(canvas.dataset.frames ?? 0) + 1);
    canvas.dataset.moving = String(motion !== null);
  };
  const put = (node, x) => {
    const [c, w] = [look.clipFromView, x ? look.clipFromView[3] * x[0] + look.clipFromView[7] * x[1] + look.clipFromView[11] * x[2] + look.clipFromView[15] : 0];
    node.hidden = w <= 0;
    if (node.hidden) return;
    const [px, py] = [0, 1].map((row) => (c[row] * x[0] + c[4 + row] * x[1] + c[8 + row] * x[2] + c[12 + row]) / w);
    node.style.transform = `translate(${((px * 0.5 + 0.5) * look.css[0]).toFixed(1)}px, ${((0.5 - py * 0.5) * look.css[1]).toFixed(1)}px)`;
  };
  const overlay = () => {
    const length = roundBelow(110 * look.metresPerPx);
    element('scale-bar').style.width = `${length / look.metresPerPx}px`;
    element('scale-text').textContent = metres(length) + (camera.parallel ? '' : ' in the middle');
    for (const k of [0, 1]) put(element(`pin-${k}`), state.ends[k]?.at);
    const both = state.ends.length === 2;
    put(element('length'), both ? scaled(add(state.ends[0].at, state.ends[1].at), 0.5) : null);
    if (both) element('length').textContent = `${norm(sub(state.ends[1].at, state.ends[0].at)).toFixed(3)} m`;
  };

  const tell = () => {
    const { ends, measuring } = state;
    const lines = ends.flatMap((end, k) => describePlace(scene, end, measuring ? `End ${k + 1}` : 'At'));
    if (ends.length === 2) lines.unshift(...describeLength(ends));
    const ask = measuring ? (ends.length === 1 ? 'Click the other end.' : 'Click two points to measure between them.') : 'Click a point or a surface to learn where it is.';
    const list = made('dl', {}, ...lines.flatMap(([name, value]) => [made('dt', {}, name), made('dd', {}, value)]));
    element('picked').replaceChildren(...(lines.length ? [list] : []), ...(ends.length < 2 ? [made('p', { class: 'soft' }, ask)] : []));
    element('measure').setAttribute('aria-pressed', String(measuring));
  };
  const pickAt = (px, py) => {
    const found = pick(scene.sides.filter((side) => side.shown).map((side) => ({ side, place: kWhereItIs })), look, px, py);
    if (found) state.ends = state.measuring && state.ends.length === 1 ? [...state.ends, found] : [found];
    tell();
    redraw();
  };
  const setEnds = (measuring) => { Object.assign(state, { measuring, ends: [] }); tell(); redraw(); };
  const show = () => {
    for (const button of document.querySelectorAll('[data-view]')) button.setAttribute('aria-pressed', String(button.dataset.view === state.view));
  };
  const fit = (turned) => {
    const goal = fitted(state.view, scene, canvas.clientWidth / Math.max(1, canvas.clientHeight));
    if (!turned && camera) Object.assign(goal, { yaw: camera.yaw, pitch: camera.pitch });
    if (camera) goal.yaw += 2 * Math.PI * Math.round((camera.yaw - goal.yaw) / (2 * Math.PI));
    motion = camera && !still.matches ? { from: camera, to: goal, start: performance.now() } : null;
    if (!motion) camera = goal;
    redraw();
  };
  const chooseView = (name) => {
    state.view = name;
    const { axis } = kViews[name];
    state.cut.on = axis >= 0;
    if (axis >= 0) state.cut.axis = axis;
    show();
    changed();
    fit(true);
  };
  const setCamera = (next) => { motion = null; camera = next; redraw(); };
  const cutRange = (axis) => [scene.low[axis], scene.high[axis]];
  const showSection = buildSection(state, cutRange, () => changed());
  const changed = () => { showSection(); gpu.cut(state.cut); redraw(); };
  buildSides(scene, redraw);
  const colourings = buildWaysToColour(scene, state, () => { showColourLegend(scene, state); redraw(); });
  listen(canvas, { get: () => camera, set: setCamera, click: pickAt });
  const actions = {
    chooseView, setCamera, state, changed, colourings, cutRange, camera: () => camera, fit: () => fit(false),
    middle: () => pickAt(look.css[0] / 2, look.css[1] / 2),
  };
  listenKeys(canvas, { m: () => setEnds(!state.measuring), escape: () => setEnds(state.measuring) }, actions);
  element('measure').addEventListener('click', () => setEnds(!state.measuring));
  element('clear').addEventListener('click', () => setEnds(state.measuring));
  element('size').addEventListener('input', (event) => { state.size = +event.target.value; redraw(); });
  for (const button of document.querySelectorAll('[data-view]')) button.addEventListener('click', () => chooseView(button.dataset.view));
  new ResizeObserver(redraw).observe(canvas);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
  fit(true);
  show();
  changed();
  tell();
  showColourLegend(scene, state);
};

const openView = () => {
  const canvas = element('canvas');
  const gl = canvas.getContext('webgl2', { antialias: true, alpha: true, preserveDrawingBuffer: true });
  if (!gl) { element('fallback').hidden = false; return; }
  element('viewer').hidden = false;
  runView(gl, canvas);
  document.documentElement.dataset.ready = '';
};

openView();
