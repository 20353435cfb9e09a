// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// Any clouds and models in one frame, or the scans of a project: looking, cutting, measuring.

const kTurnMs = 700;
const kTints = 8;
const kEyeHeight = 1.4;
const kWaysToColour = [['side', t`By file`], ['state', t`By state`], ['own', t`As measured`], ['height', t`Height`]];

/**
 * All sides with their places and boxes, and the box of all: of the central part, so that strays do not count. Without
 * places all lie in the page's axes; of a project those that stand nowhere, or in a frame of their own, are not shown.
 */
const loadView = () => {
  const scene = JSON.parse(element('scene').textContent);
  const project = scene.links !== undefined;
  scene.links ??= [];
  scene.floors ??= [];
  for (const link of scene.links) link.pose = fromRows(link.pose);
  scene.viewFromFrame = scene.axes ? fromAxes(...scene.axes) : kWhereItIs;
  scene.rise = dot(turn(scene.viewFromFrame, scene.origin), [0, 0, 1]);
  scene.sides = scene.sides.map((id, k) => {
    const side = loadSide(scene, id);
    const place = project ? side.place && fromRows(side.place) : kWhereItIs;
    const stands = !project || (Boolean(place) && side.component === 0 && hasContent(side));
    return Object.assign(side, { tint: `--side-${k % kTints}`, place, stands, shown: stands });
  });
  // Where there are stations they tell what is looked at: a pass sees the houses across the street as well.
  const standing = scene.sides.filter((side) => side.stands);
  const still = standing.filter((side) => !side.mobile);
  const { low, high } = joinedBoxes((still.length ? still : standing).map((side) => boxOf(side, side.place)));
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
    [t`Distance`, t`${norm(way).toFixed(3)} m` + (exact > 0.0005 ? ` ± ${millimetres(exact)}` : '')],
    [t`Horizontal`, t`${Math.hypot(way[0], way[1]).toFixed(3)} m`],
    [t`Vertical`, t`${signed(way[2], 3)} m`],
    [t`Slope`, t`${signed(Math.atan2(way[2], Math.hypot(way[0], way[1])) * 180 / Math.PI, 2)}°`],
  ];
};

const describePlace = (scene, { side, point, plane, at }, name) => {
  const inFrame = add(turn(inverseRigid(scene.viewFromFrame), at), scene.origin);
  const lines = [[name, inFrame.map((c) => t`${c.toFixed(3)}`).join('  ')], [t`File`, side.name]];
  if (point < 0 && plane >= 0) lines.push([t`Surface`, t`${side.planes[plane].area.toFixed(1)} m²`]);
  return lines;
};

const buildSides = (scene, changed) => {
  element('sides').append(...scene.sides.map((side, k) => made('label', { class: 'side' },
    made('input', { type: 'checkbox', 'data-side': k, checked: side.shown, disabled: !side.stands, onchange: (event) => { side.shown = event.target.checked; changed(); } }),
    made('span', { class: 'mark', style: `background:var(${side.tint})` }),
    made('span', { class: 'name' }, side.name, made('span', { class: 'soft' }, side.about)))));
};

const buildWaysToColour = (scene, state, changed) => {
  const points = scene.sides.some((side) => side.shape === 'points');
  const there = { side: true, state: scene.links.length > 0, own: points && scene.sides.some((side) => side.own), height: points };
  const offered = kWaysToColour.filter(([value]) => there[value]);
  element('colours').append(...offered.map(([value, text]) => made('label', { class: 'line' }, made('input', {
    type: 'radio', name: 'colouring', value, checked: value === state.colouring, onchange: () => { state.colouring = value; changed(); },
  }), text)));
  return offered.map(([value]) => value);
};

const showColourLegend = (scene, state) => {
  const legend = element('legend');
  legend.replaceChildren();
  if (state.colouring !== 'height') { legend.append(...linkLegend(scene)); return; }
  const [low, high] = [scene.low[2], scene.high[2]].map((z) => (z + scene.rise).toFixed(1));
  legend.append(made('span', {}, t`${low} m`, made('span', { class: 'ramp', style: `background:${rampCss()}` }), t`${high} m`));
};

const makeViewGpu = (gl, scene) => {
  const programs = makePrograms(gl);
  const paintSurfaces = makeSurfacePainter(gl, programs);
  const parts = scene.sides.map((side) => ({
    side, cloud: makeCloud(gl, side), outlines: makeLines(gl).replace(side.planes.flatMap(outlineOf)), openings: makeLines(gl).replace(openingLines(side)), walls: makeLines(gl),
  }));
  const links = [...linkLines(scene, null).keys()].map((state) => ({ state, lines: makeLines(gl) }));
  const join = (floor) => {
    const ends = linkLines(scene, floor);
    for (const { state, lines } of links) lines.replace(ends.get(state) ?? []);
  };
  join(null);
  const measured = makeLines(gl);
  const ways = ['side', 'own', 'residual', 'height'];
  const wayOf = (state) => Math.max(0, ways.indexOf(state.pair ? 'side' : state.colouring));

  const drawCloud = ({ side, cloud }, { look, state, ratio, plain, placeOf, tintOf }) => {
    const place = placeOf(side);
    if (!cloud || cloud.shape !== 'points' || !place) return;
    programs.points.use();
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, cloud.normals);
    programs.points.set({
      ...look, normals: 0, viewFromNumbers: times(place, side.fromNumbers), viewFromSide: [0, 1, 2].flatMap((k) => place.slice(4 * k, 4 * k + 3)),
      tint: styleColour(tintOf(side)), plain, colouring: wayOf(state), heights: [scene.low[2], scene.high[2]], size: state.size * ratio,
    });
    gl.bindVertexArray(cloud.array);
    gl.drawArrays(gl.POINTS, 0, cloud.count);
  };
  const drawModel = ({ side, cloud }, { look, state, placeOf, tintOf }) => {
    const place = placeOf(side);
    if (!cloud || cloud.shape !== 'faces' || !place) return;
    programs.faces.use();
    programs.faces.set({ ...look, viewFromNumbers: times(place, side.fromNumbers), tint: styleColour(tintOf(side)), alpha: state.cut.on ? 0.35 : 0.16 });
    gl.bindVertexArray(cloud.array);
    gl.drawArrays(gl.TRIANGLES, 0, cloud.count);
  };
  const drawLines = (lines, { look, size, ratio }, { colour, width, alpha = 1, whole = false, dash = 0, place = kWhereItIs }) => {
    if (!lines.count) return;
    programs.lines.use();
    programs.lines.set({
      ...look, cutAxis: whole ? [0, 0, 0] : look.cutAxis, viewFromSide: place, screen: size, width: width * ratio, dash: dash * ratio, colour: [...colour, alpha],
    });
    gl.bindVertexArray(lines.array);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, lines.count);
  };
  const draw = (frame) => {
    const ink = styleColour('--ink');
    Object.assign(frame, { plain: styleColour('--line'), shadow: ink.map((c) => (c > 0.5 ? 0.02 : c * 0.6)) });
    paintSurfaces(frame, () => { for (const part of parts) drawCloud(part, frame); }, () => { for (const part of parts) drawModel(part, frame); });
    const { ends, pair, cut, linksShown } = frame.state;
    const project = scene.links.length > 0;
    for (const { side, cloud, outlines, openings, walls } of parts) {
      const place = frame.placeOf(side);
      if (!place) continue;
      const colour = styleColour(frame.tintOf(side));
      // The outlines of many scans hide one another.
      if (!project || pair || !cloud) drawLines(outlines, frame, { colour, place, width: 1.1, alpha: 0.7 });
      if (pair) drawLines(openings, frame, { colour, place, width: 2.6 });
      if (cut.on) drawLines(walls, frame, { colour, place, width: 2.4, whole: true });
    }
    for (const { state, lines } of pair || !linksShown ? [] : links) {
      drawLines(lines, frame, { colour: styleColour(stateTint(state)), width: state === 'rejected' ? 1.2 : 2.6, dash: kDashes[state] ?? 0, alpha: state === 'rejected' ? 0.4 : 0.85, whole: true });
    }
    measured.replace(ends.length === 2 ? [...ends[0].at, ...ends[1].at] : []);
    drawLines(measured, frame, { colour: ink, width: 2.2, whole: true });
  };
  const cut = ({ on, axis, place }, placeOf) => {
    const normal = [0, 1, 2].map((k) => (k === axis ? 1 : 0));
    for (const { side, walls } of parts) {
      const at = on && placeOf(side);
      // The plane of the section, in the side's own axes.
      walls.replace(at ? cutLines(side, turn(inverseRigid(at), normal), place[axis] - dot(normal, at.slice(12, 15))) : []);
    }
  };
  return { draw, cut, join };
};

const runView = (gl, canvas) => {
  const scene = loadView();
  const still = matchMedia('(prefers-reduced-motion: reduce)');
  const middle = scaled(add(scene.low, scene.high), 0.5);
  const state = {
    view: 'free', colouring: scene.sides.length === 1 && scene.sides[0].own ? 'own' : 'side', size: 2, measuring: false, ends: [], pair: null, share: 1, linksShown: true, floor: null,
    cut: { on: false, axis: 2, place: [middle[0], middle[1], scene.eye], thickness: 0.5 },
  };
  const gpu = makeViewGpu(gl, scene);
  // A project is linked by its questions.
  const linking = typeof makeLinking === 'function' ? makeLinking(scene, () => { Object.assign(state, { measuring: false, ends: [] }); tell(); redraw(); }) : null;
  const spots = makeSpots(scene);
  const pictures = typeof makePictures === 'function' ? makePictures(scene) : [];
  let reach = 3 * norm(sub(scene.high, scene.low)) + 60;
  const placeOf = (side) => {
    const { pair, share } = state;
    if (!pair) return side.shown ? side.place : null;
    return side === pair.target ? pair.places.still : side === pair.source ? pair.place(share) : null;
  };
  const tintOf = (side) => {
    if (state.pair) return side === state.pair.target ? '--target' : '--source';
    return state.colouring === 'state' ? stateTint(side.state) : side.tint;
  };
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
      state.share = motion.shares[0] + share * (motion.shares[1] - motion.shares[0]);
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
    gpu.draw({ look, state, size, ratio, height: camera.height, placeOf, tintOf });
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
    element('scale-text').textContent = camera.parallel ? metres(length) : t`${metres(length)} at the centre`;
    for (const k of [0, 1]) put(element(`pin-${k}`), state.ends[k]?.at);
    const marked = (number) => !state.pair && state.linksShown && (!state.floor || state.floor.scans.includes(number));
    for (const { node, number, at } of spots) put(node, marked(number) ? at : null);
    for (const [node, at] of linking?.pins() ?? []) put(node, at);
    for (const { node, side, at } of pictures) put(node, side.shown ? at : null);
    const both = state.ends.length === 2;
    put(element('length'), both ? scaled(add(state.ends[0].at, state.ends[1].at), 0.5) : null);
    if (both) element('length').textContent = t`${norm(sub(state.ends[1].at, state.ends[0].at)).toFixed(3)} m`;
  };

  const tell = () => {
    const { ends, measuring } = state;
    const lines = ends.flatMap((end, k) => describePlace(scene, end, measuring ? t`End ${k + 1}` : t`At`));
    if (ends.length === 2) lines.unshift(...describeLength(ends));
    const ask = measuring ? (ends.length === 1 ? t`Click the other end.` : t`Click two points to measure between them.`) : t`Click a point or a surface for its coordinates.`;
    const list = made('dl', {}, ...lines.flatMap(([name, value]) => [made('dt', {}, name), made('dd', {}, value)]));
    element('picked').replaceChildren(...(lines.length ? [list] : []), ...(ends.length < 2 ? [made('p', { class: 'soft' }, ask)] : []));
    element('measure').setAttribute('aria-pressed', String(measuring));
    if (linking?.on) element('picked').replaceChildren(...linking.words());
  };
  const pickAt = (px, py) => {
    const found = pick(scene.sides.map((side) => ({ side, place: placeOf(side) })).filter(({ place }) => place), look, px, py);
    if (linking?.on) linking.add(found);
    else if (found) state.ends = state.measuring && state.ends.length === 1 ? [...state.ends, found] : [found];
    tell();
    redraw();
  };
  const setEnds = (measuring) => { Object.assign(state, { measuring, ends: [] }); tell(); redraw(); };
  const show = () => {
    for (const button of document.querySelectorAll('[data-view]')) button.setAttribute('aria-pressed', String(button.dataset.view === state.view));
  };
  const fit = (turned, share = state.share) => {
    const goal = fitted(state.view, state.pair ? state.pair.box(share) : scene, canvas.clientWidth / Math.max(1, canvas.clientHeight));
    if (!turned && camera) Object.assign(goal, { yaw: camera.yaw, pitch: camera.pitch });
    if (camera) goal.yaw += 2 * Math.PI * Math.round((camera.yaw - goal.yaw) / (2 * Math.PI));
    motion = camera && !still.matches ? { from: camera, to: goal, shares: [state.share, share], start: performance.now() } : null;
    if (!motion) { camera = goal; state.share = share; }
    redraw();
  };
  const chooseView = (name) => {
    Object.assign(state, { view: name, floor: null });
    element('floor').value = '';
    gpu.join(null);
    const { axis } = kViews[name];
    state.cut.on = axis >= 0;
    if (axis >= 0) state.cut.axis = axis;
    show();
    changed();
    fit(true);
  };
  const setCamera = (next) => {
    if (motion) [, state.share] = motion.shares;
    motion = null;
    camera = next;
    redraw();
  };
  const showPair = () => {
    const { pair } = state;
    element('pair-group').hidden = !pair;
    element('pair').value = pair ? String(pair.number) : '';
    element('pair-words').replaceChildren(...(pair ? describePair(pair) : []));
    for (const row of document.querySelectorAll('tr[data-of-link]')) row.setAttribute('aria-current', String(pair !== null && +row.dataset.ofLink === pair.number));
  };
  const toggle = (share) => {
    for (const [id, at] of [['before', 0], ['after', 1]]) element(id).setAttribute('aria-pressed', String(at === share));
    state.ends = [];
    fit(false, share);
    tell();
  };
  /** One link alone, or null: all scans. */
  const choosePair = (number) => {
    state.pair = number === null ? null : makePair(scene, number);
    if (motion) motion = null;
    state.share = 1;
    if (state.pair) reach = Math.max(reach, ...[0, 1].map((share) => { const box = state.pair.box(share); return 3 * norm(sub(box.high, box.low)) + 20; }));
    showPair();
    toggle(1);
    changed();
  };
  /** One floor from above, or null: all. */
  const showFloor = (floor) => {
    Object.assign(state, { view: floor ? 'top' : 'free', floor });
    Object.assign(state.cut, { on: floor !== null, axis: 2, thickness: 2 });
    if (floor) state.cut.place[2] = floor.z;
    gpu.join(floor);
    show();
    changed();
    fit(true);
  };
  const cutRange = (axis) => [scene.low[axis], scene.high[axis]];
  const showSection = buildSection(state, cutRange, () => changed());
  const changed = () => { showSection(); gpu.cut(state.cut, placeOf); redraw(); };
  buildSides(scene, changed);
  buildPairs(scene, { choose: choosePair, showFloor });
  element('before').addEventListener('click', () => toggle(0));
  element('after').addEventListener('click', () => toggle(1));
  element('all-scans').addEventListener('click', () => choosePair(null));
  element('links-shown').addEventListener('change', (event) => { state.linksShown = event.target.checked; redraw(); });
  const colourings = buildWaysToColour(scene, state, () => { showColourLegend(scene, state); redraw(); });
  listen(canvas, { get: () => camera, set: setCamera, click: pickAt });
  const actions = {
    chooseView, setCamera, state, changed, colourings, cutRange, camera: () => camera, fit: () => fit(false),
    middle: () => pickAt(look.css[0] / 2, look.css[1] / 2),
  };
  const measure = () => { if (linking?.on) linking.toggle(); setEnds(!state.measuring); };
  const clear = () => { if (linking?.on) linking.clear(); else setEnds(state.measuring); };
  listenKeys(canvas, { m: measure, escape: clear, ...(linking ? { l: linking.toggle } : {}) }, actions);
  element('measure').addEventListener('click', measure);
  element('clear').addEventListener('click', clear);
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
  // A project of which nothing could be read.
  if (!JSON.parse(element('scene').textContent).sides.length) return;
  const gl = canvas.getContext('webgl2', { antialias: true, alpha: true, preserveDrawingBuffer: true });
  if (!gl) { element('fallback').hidden = false; return; }
  element('viewer').hidden = false;
  runView(gl, canvas);
  document.documentElement.dataset.ready = '';
};

openView();
