// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// The eye, and the hands that move it. Angles in radians: yaw about the vertical, pitch 0 level, pi/2 down.

const kFieldOfView = 0.7;
const kViews = {
  top: { yaw: 0, pitch: Math.PI / 2, parallel: true, axis: 2 },
  front: { yaw: 0, pitch: 0, parallel: true, axis: 1 },
  side: { yaw: Math.PI / 2, pitch: 0, parallel: true, axis: 0 },
  free: { yaw: -0.55, pitch: 0.62, parallel: false, axis: -1 },
};

const axesOf = ({ yaw, pitch }) => {
  const right = [Math.cos(yaw), Math.sin(yaw), 0];
  const forward = [-Math.sin(yaw) * Math.cos(pitch), Math.cos(yaw) * Math.cos(pitch), -Math.sin(pitch)];
  return { right, forward, up: cross(right, forward) };
};

/** Everything that drawing needs to know of the eye; `reach` is the size of all there is, metres. */
const projectionOf = (camera, aspect, reach) => {
  const { right, up, forward } = axesOf(camera);
  const distance = camera.parallel ? reach : camera.height / 2 / Math.tan(kFieldOfView / 2);
  const eye = sub(camera.centre, scaled(forward, distance));
  const eyeFromView = fromAxes(right, up, scaled(forward, -1));
  [right, up, scaled(forward, -1)].forEach((axis, k) => { eyeFromView[12 + k] = -dot(axis, eye); });
  const near = camera.parallel ? 0 : Math.max(0.02, distance * 0.02);
  const far = distance + reach;
  const h = camera.height / 2;
  const w = h * aspect;
  const f = 1 / Math.tan(kFieldOfView / 2);
  const clipFromEye = camera.parallel
    ? [1 / w, 0, 0, 0, 0, 1 / h, 0, 0, 0, 0, -2 / (far - near), 0, 0, 0, -(far + near) / (far - near), 1]
    : [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, -(far + near) / (far - near), -1, 0, 0, -2 * far * near / (far - near), 0];
  return {
    clipFromView: times(clipFromEye, eyeFromView), eye: camera.parallel ? scaled(forward, -1) : eye,
    range: [near, far], right, up, forward, position: eye,
  };
};

/** A camera that shows the whole box from the view's direction. */
const fitted = (name, box, aspect) => {
  const view = kViews[name];
  const { right, up, forward } = axesOf(view);
  const span = sub(box.high, box.low);
  const size = (axis) => Math.abs(axis[0]) * span[0] + Math.abs(axis[1]) * span[1] + Math.abs(axis[2]) * span[2];
  const height = Math.max(size(up), size(right) / aspect, 0.1) * (view.parallel ? 1.16 : 1.04) + (view.parallel ? 0 : 0.25 * size(forward));
  return { ...view, name, height, centre: scaled(add(box.low, box.high), 0.5) };
};

const betweenCameras = (a, b, t) => ({
  ...b, yaw: a.yaw + t * (b.yaw - a.yaw), pitch: a.pitch + t * (b.pitch - a.pitch),
  height: a.height * (b.height / a.height) ** t, centre: mixed(a.centre, b.centre, t),
  parallel: t < 1 ? a.parallel && b.parallel : b.parallel,
});

const rotated = (camera, dx, dy) => ({
  ...camera, yaw: camera.yaw - dx, pitch: clamp(camera.pitch + dy, -Math.PI / 2, Math.PI / 2),
});

/** Shifted by shares of the view's height. */
const panned = (camera, dx, dy) => {
  const { right, up } = axesOf(camera);
  const shift = add(scaled(right, -dx * camera.height), scaled(up, dy * camera.height));
  return { ...camera, centre: add(camera.centre, shift) };
};

const zoomed = (camera, factor) => ({ ...camera, height: clamp(camera.height * factor, 0.02, 20000) });

/** Mouse, pen and fingers: one turns (shifts, where the view is fixed or with the other button), two zoom. */
const listen = (canvas, { get, set, click }) => {
  const pointers = new Map();
  let moved = 0;
  let pinch = 0;
  const spread = () => {
    const [a, b] = [...pointers.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    moved = pointers.size > 1 ? 99 : 0;
    if (pointers.size === 2) pinch = spread();
  });
  canvas.addEventListener('pointermove', (event) => {
    const last = pointers.get(event.pointerId);
    if (!last) return;
    const dx = event.clientX - last.x;
    const dy = event.clientY - last.y;
    Object.assign(last, { x: event.clientX, y: event.clientY });
    moved += Math.abs(dx) + Math.abs(dy);
    const shift = get().parallel || event.shiftKey || (event.buttons & 6) !== 0;
    const share = canvas.clientHeight;
    if (pointers.size === 2) {
      const now = spread();
      set(panned(zoomed(get(), pinch / Math.max(now, 1)), dx / 2 / share, dy / 2 / share));
      pinch = now;
    } else if (moved > 3) {
      set(shift ? panned(get(), dx / share, dy / share) : rotated(get(), dx * 0.007, dy * 0.007));
    }
  });
  const release = (event) => {
    if (!pointers.delete(event.pointerId) || event.type === 'pointercancel') return;
    const box = canvas.getBoundingClientRect();
    if (moved <= 3) click(event.clientX - box.left, event.clientY - box.top);
  };
  canvas.addEventListener('pointerup', release);
  canvas.addEventListener('pointercancel', release);
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    set(zoomed(get(), Math.exp(clamp(event.deltaY, -200, 200) * 0.0015)));
  }, { passive: false });
};
