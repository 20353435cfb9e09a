// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// Draws, and brings the parts together.

const kMoveMs = 700;

const startViewer = (gl, canvas) => {
  const scene = loadScene();
  const still = matchMedia('(prefers-reduced-motion: reduce)');
  const dark = matchMedia('(prefers-color-scheme: dark)');
  const noCloud = [scene.source, scene.target].every((side) => side.shape === 'none');
  const layersOf = () => ({ cloud: true, planes: false, openings: true, segments: noCloud, walls: true });
  const state = {
    pose: 0, after: scene.poses.length > 0, view: 'free', colouring: 'side', size: 2, seeThrough: true,
    layers: { source: layersOf(), target: layersOf() },
    cut: { on: false, axis: 2, place: scene.cut.slice(), thickness: 0.3 },
  };
  const gpu = makeGpu(gl, scene);
  const before = placeBefore(scene);
  const after = () => times(scene.viewFromTarget, scene.poses[state.pose].matrix);
  const currentPlace = () => (state.after ? after() : before);
  let place = currentPlace();
  let camera = null;
  let motion = null;
  let picked = null;
  let look = null;
  let asked = false;

  const aspect = () => canvas.clientWidth / Math.max(1, canvas.clientHeight);
  const union = (a, b) => ({ low: a.low.map((c, k) => Math.min(c, b.low[k])), high: a.high.map((c, k) => Math.max(c, b.high[k])) });
  const focusBox = () => {
    const box = { low: scene.low, high: scene.high };
    // Another pose may be elsewhere, and so is the source before.
    return state.after && state.pose === 0 ? box : union(box, boxOf(scene.source, currentPlace()));
  };
  const all = union(union(boxOf(scene.target, scene.viewFromTarget), { low: scene.low, high: scene.high }), boxOf(scene.source, before));
  const reach = 3 * norm(sub(all.high, all.low)) + 20;
  const cutRange = (axis) => [scene.low[axis], scene.high[axis]];

  const redraw = () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame((now) => { asked = false; step(now); });
  };
  const moveTo = (goal, goalPlace) => {
    motion = { from: camera, to: goal, fromPlace: place, toPlace: goalPlace, start: performance.now() };
    if (still.matches || !camera) { finish(); }
    redraw();
  };
  const finish = () => { camera = motion.to; place = motion.toPlace; motion = null; };
  const step = (now) => {
    if (motion) {
      const share = smooth(clamp((now - motion.start) / kMoveMs, 0, 1));
      if (share >= 1) finish();
      else {
        camera = betweenCameras(motion.from, motion.to, share);
        place = betweenPlaces(scene, motion.fromPlace, motion.toPlace, share);
        redraw();
      }
    }
    draw();
  };

  const draw = () => {
    const ratio = Math.min(2, devicePixelRatio || 1);
    const [width, height] = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
    if (width < 2 || height < 2) return;
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const axis = [0, 1, 2].map((k) => (state.cut.on && k === state.cut.axis ? 1 : 0));
    const at = state.cut.place[state.cut.axis];
    look = {
      ...projectionOf(camera, width / height, reach), parallel: camera.parallel, seeThrough: state.seeThrough && !state.cut.on,
      cutAxis: axis, cutRange: [at - state.cut.thickness / 2, at + state.cut.thickness / 2],
      css: [canvas.clientWidth, canvas.clientHeight], metresPerPx: camera.height / canvas.clientHeight,
      distance: camera.height / 2 / Math.tan(kFieldOfView / 2),
    };
    const residual = state.after && state.pose === 0 && !motion && scene.residual_range !== undefined;
    gpu.draw({ look, state, places: { source: place, target: scene.viewFromTarget }, size: [width, height], ratio, residual, height: camera.height, picked });
    overlay(residual);
    canvas.dataset.frames = String(+(canvas.dataset.frames ?? 0) + 1);
    canvas.dataset.moving = String(motion !== null);
  };

  const onScreen = (x) => {
    const c = look.clipFromView;
    const w = c[3] * x[0] + c[7] * x[1] + c[11] * x[2] + c[15];
    if (w <= 0) return null;
    const ndc = [0, 1].map((row) => (c[row] * x[0] + c[4 + row] * x[1] + c[8 + row] * x[2] + c[12 + row]) / w);
    return [(ndc[0] * 0.5 + 0.5) * look.css[0], (0.5 - ndc[1] * 0.5) * look.css[1]];
  };
  const put = (node, x, shown) => {
    const at = shown ? onScreen(x) : null;
    node.hidden = !at;
    if (at) node.style.transform = `${node.dataset.shift ?? ''} translate(${at[0].toFixed(1)}px, ${at[1].toFixed(1)}px)`;
  };
  const overlay = (residual) => {
    const length = roundBelow(110 * look.metresPerPx);
    element('scale-bar').style.width = `${length / look.metresPerPx}px`;
    element('scale-text').textContent = camera.parallel ? metres(length) : t`${metres(length)} at the centre`;
    const apart = !state.after || (motion !== null);
    for (const [name, viewFromSide] of [['source', place], ['target', scene.viewFromTarget]]) {
      const tag = element(`tag-${name}`);
      tag.hidden = !apart;
      if (!apart) continue;
      const box = name === 'target' && scene.poses.length ? { low: scene.low, high: scene.high } : boxOf(scene[name], viewFromSide);
      const top = scaled(add(box.low, box.high), 0.5);
      top[2] = box.high[2];
      put(tag, top, true);
    }
    put(element('pin'), picked ? pinPlace() : [0, 0, 0], picked !== null);
    showLegend(scene, state, residual);
  };
  const pinPlace = () => apply(picked.side.side === 'source' ? place : scene.viewFromTarget, picked.local);

  const choosePose = (pose) => {
    if (!scene.poses.length) return;
    state.pose = (pose + scene.poses.length) % scene.poses.length;
    state.after = true;
    goOn();
  };
  const toggle = (afterWards) => {
    if (!scene.poses.length) return;
    state.after = afterWards;
    goOn();
  };
  const chooseView = (name) => {
    state.view = name;
    const { axis } = kViews[name];
    state.cut.on = axis >= 0;
    if (axis >= 0) state.cut.axis = axis;
    goOn(true);
  };
  /** After a change of what is where: the eye keeps its direction unless a view was chosen. */
  const goOn = (turned = false) => {
    forget();
    const goal = fitted(state.view, focusBox(), aspect());
    if (!turned && camera) Object.assign(goal, { yaw: camera.yaw, pitch: camera.pitch });
    if (camera) goal.yaw += 2 * Math.PI * Math.round((camera.yaw - goal.yaw) / (2 * Math.PI));
    showPose(scene, state);
    changed();
    moveTo(goal, currentPlace());
  };
  const forget = () => {
    picked = null;
    element('picked').replaceChildren(made('p', { class: 'soft' }, t`Click a point or a surface for details.`));
  };
  const pickAt = (px, py) => {
    const sides = [['source', place], ['target', scene.viewFromTarget]]
      .filter(([name]) => state.layers[name].cloud || state.layers[name].planes).map(([name, at]) => ({ side: scene[name], place: at }));
    const found = pick(sides, look, px, py);
    if (!found) { forget(); redraw(); return; }
    picked = { ...found, local: apply(inverseRigid(found.side.side === 'source' ? place : scene.viewFromTarget), found.at) };
    const lines = describe(scene, found, { targetFromView: inverseRigid(scene.viewFromTarget), residual: state.after && state.pose === 0 });
    element('picked').replaceChildren(made('dl', {}, ...lines.flatMap(([name, value]) => [made('dt', {}, name), made('dd', {}, value)])));
    redraw();
  };
  const setCamera = (next) => { motion = null; place = currentPlace(); camera = next; redraw(); };

  const showSection = buildSection(state, cutRange, () => changed());
  const changed = () => { showSection(); gpu.cut(state.cut, { source: currentPlace(), target: scene.viewFromTarget }); redraw(); };
  buildLayers(scene, state, redraw);
  const colourings = buildColours(scene, state, redraw);
  listen(canvas, { get: () => camera, set: setCamera, click: pickAt });
  const actions = {
    choosePose, toggle, chooseView, pickAt, setCamera, state, changed, redraw, colourings,
    camera: () => camera, fit: () => goOn(), cutRange, middle: () => pickAt(look.css[0] / 2, look.css[1] / 2),
  };
  bindControls(scene, actions);
  bindKeys(canvas, actions);
  new ResizeObserver(redraw).observe(canvas);
  dark.addEventListener('change', redraw);
  goOn(true);
};

const makeGpu = (gl, scene) => {
  const programs = makePrograms(gl);
  const paintSurfaces = makeSurfacePainter(gl, programs);
  const parts = {};
  for (const name of ['source', 'target']) {
    const side = scene[name];
    parts[name] = {
      cloud: makeCloud(gl, side), planes: makeLines(gl).replace(side.planes.flatMap(outlineOf)),
      openings: makeLines(gl).replace(openingLines(side)), segments: makeLines(gl).replace(side.segments),
      walls: makeLines(gl), picked: makeLines(gl),
    };
  }
  const open = makeLines(gl).replace(openLines(scene));

  const drawPoints = (name, frame, tint) => {
    const { cloud } = parts[name];
    if (!cloud || cloud.shape !== 'points' || !frame.state.layers[name].cloud) return;
    const { look, state, ratio } = frame;
    const place = frame.places[name];
    programs.points.use();
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, cloud.normals);
    const colouring = state.colouring === 'residual' && !frame.residual ? 'side' : state.colouring;
    programs.points.set({
      ...look, normals: 0, viewFromNumbers: times(place, scene[name].fromNumbers), tint, plain: frame.plain,
      viewFromSide: [0, 1, 2].flatMap((k) => place.slice(4 * k, 4 * k + 3)),
      colouring: ['side', 'own', 'residual'].indexOf(colouring), size: state.size * ratio,
    });
    gl.bindVertexArray(cloud.array);
    gl.drawArrays(gl.POINTS, 0, cloud.count);
  };
  const drawFaces = (name, frame, tint) => {
    const { cloud } = parts[name];
    if (!cloud || cloud.shape !== 'faces' || !frame.state.layers[name].cloud) return;
    programs.faces.use();
    programs.faces.set({ ...frame.look, viewFromNumbers: times(frame.places[name], scene[name].fromNumbers), tint, alpha: frame.state.cut.on ? 0.3 : 0.09 });
    gl.bindVertexArray(cloud.array);
    gl.drawArrays(gl.TRIANGLES, 0, cloud.count);
  };
  const drawLines = (lines, frame, place, style) => {
    if (!lines.count) return;
    programs.lines.use();
    programs.lines.set({
      ...frame.look, cutAxis: style.whole ? [0, 0, 0] : frame.look.cutAxis, viewFromSide: place, screen: frame.size,
      width: style.width * frame.ratio, dash: (style.dash ?? 0) * frame.ratio, colour: [...style.colour, style.alpha ?? 1],
    });
    gl.bindVertexArray(lines.array);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, lines.count);
  };
  const drawSideLines = (name, frame, colour) => {
    const layers = frame.state.layers[name];
    const place = frame.places[name];
    const dash = name === 'source' ? 9 : 0;
    const { planes, openings, segments, walls, picked } = parts[name];
    if (layers.planes) drawLines(planes, frame, place, { colour, width: 1.2, alpha: 0.75, dash });
    if (layers.segments) drawLines(segments, frame, place, { colour, width: 1.6, dash });
    const glass = scene[name].shape === 'faces';
    if (layers.openings) drawLines(openings, frame, place, { colour, width: glass ? 1.4 : 2.4, alpha: glass ? 0.55 : 1, dash });
    if (layers.walls && frame.state.cut.on) drawLines(walls, frame, place, { colour, width: 2.6, dash, whole: true });
    if (frame.picked?.side.side === name && frame.picked.plane >= 0) {
      picked.replace(outlineOf(scene[name].planes[frame.picked.plane]));
      drawLines(picked, frame, place, { colour: frame.ink, width: 2.6 });
    }
  };
  const draw = (frame) => {
    const tints = { source: styleColour('--source'), target: styleColour('--target') };
    Object.assign(frame, { plain: styleColour('--line'), ink: styleColour('--ink'), shadow: styleColour('--ink').map((c) => (c > 0.5 ? 0.02 : c * 0.6)) });
    const drawEach = (drawSide) => () => { for (const name of ['target', 'source']) drawSide(name, frame, tints[name]); };
    paintSurfaces(frame, drawEach(drawPoints), drawEach(drawFaces));
    drawEach(drawSideLines)();
    if (frame.state.after) drawLines(open, frame, frame.places.target, { colour: frame.ink, width: 2, whole: true });
  };
  const cut = ({ on, axis, place }, places) => {
    for (const name of ['source', 'target']) {
      const back = inverseRigid(places[name]);
      const normal = turn(back, [0, 1, 2].map((k) => (k === axis ? 1 : 0)));
      const at = apply(back, [0, 1, 2].map((k) => (k === axis ? place[axis] : 0)));
      parts[name].walls.replace(on ? cutLines(scene[name], normal, dot(normal, at)) : []);
    }
  };
  return { draw, cut };
};

const bindControls = (scene, actions) => {
  const on = (id, type, action) => element(id)?.addEventListener(type, action);
  on('before', 'click', () => actions.toggle(false));
  on('after', 'click', () => actions.toggle(true));
  on('previous', 'click', () => actions.choosePose(actions.state.pose - 1));
  on('next', 'click', () => actions.choosePose(actions.state.pose + 1));
  on('size', 'input', (event) => { actions.state.size = +event.target.value; actions.redraw(); });
  on('backs', 'change', (event) => { actions.state.seeThrough = event.target.checked; actions.redraw(); });
  element('poses').hidden = scene.poses.length < 2;
  element('toggle').hidden = scene.poses.length === 0;
  for (const button of document.querySelectorAll('[data-view]')) button.addEventListener('click', () => actions.chooseView(button.dataset.view));
  for (const button of document.querySelectorAll('button[data-pose]')) {
    button.addEventListener('click', () => { actions.choosePose(+button.dataset.pose); element('viewer').scrollIntoView({ block: 'nearest' }); });
  }
};

const bindKeys = (canvas, actions) => listenKeys(canvas, {
  b: () => actions.toggle(!actions.state.after), n: () => actions.choosePose(actions.state.pose + 1),
  p: () => actions.choosePose(actions.state.pose - 1),
}, actions);

const start = () => {
  const canvas = element('canvas');
  const gl = canvas.getContext('webgl2', { antialias: true, alpha: true, preserveDrawingBuffer: true });
  element('copy')?.addEventListener('click', copyMatrix);
  if (!gl) { element('fallback').hidden = false; return; }
  element('viewer').hidden = false;
  try {
    startViewer(gl, canvas);
  } catch (error) {
    element('viewer').hidden = true;
    element('fallback').hidden = false;
    throw error;
  }
  document.documentElement.dataset.ready = 'true';
};

start();
