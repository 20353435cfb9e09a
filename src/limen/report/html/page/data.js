// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// What the page carries, unpacked.

const element = (id) => document.getElementById(id);

/** Bytes of a base64 element, which is emptied: its text is not needed twice. */
const bytesOf = (id) => {
  const holder = element(id);
  if (!holder) return new Uint8Array(0);
  const text = atob(holder.textContent);
  holder.textContent = '';
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
};

/** Red, green, blue and a spare byte of every point: its own colour, its intensity as grey, or mid-grey. */
const coloursOf = (name, count) => {
  const packed = bytesOf(`${name}-colours`);
  const intensities = bytesOf(`${name}-intensities`);
  const colours = new Uint8Array(4 * count).fill(176);
  for (let i = 0; i < count; ++i) {
    if (packed.length) {
      const number = packed[2 * i] | packed[2 * i + 1] << 8;
      colours[4 * i] = (number >> 11) * 255 / 31;
      colours[4 * i + 1] = (number >> 5 & 63) * 255 / 63;
      colours[4 * i + 2] = (number & 31) * 255 / 31;
    } else if (intensities.length) {
      colours.fill(40 + intensities[i] * 0.8, 4 * i, 4 * i + 3);
    }
  }
  return { colours, own: packed.length > 0 || intensities.length > 0 };
};

/** Plane and residual of every point, two bytes each. */
const marksOf = (name, count) => {
  const planes = bytesOf(`${name}-planes`);
  const residuals = bytesOf(`${name}-residuals`);
  const marks = new Uint8Array(2 * count);
  for (let i = 0; i < count; ++i) {
    marks[2 * i] = planes[i] ?? 0;
    marks[2 * i + 1] = residuals[i] ?? 0;
  }
  return marks;
};

const loadSide = (json, name) => {
  const side = json[name];
  side.side = name;
  side.numbers = new Uint16Array(bytesOf(`${name}-points`).buffer);
  const points = side.shape === 'points' ? side.count : 0;
  Object.assign(side, coloursOf(name, points));
  side.marks = marksOf(name, points);
  const s = side.step;
  side.fromNumbers = [s[0] * 65535, 0, 0, 0, 0, s[1] * 65535, 0, 0, 0, 0, s[2] * 65535, 0, ...side.low, 1];
  return side;
};

/** Place of a point about its side's origin. */
const pointAt = (side, i) => [0, 1, 2].map((k) => side.low[k] + side.step[k] * side.numbers[3 * i + k]);

/** Box of everything a side shows, seen under `view_from_side`: the central part of its points. */
const boxOf = (side, viewFromSide) => {
  const places = [];
  const stride = Math.max(1, Math.floor(side.numbers.length / 3 / 4000));
  for (let i = 0; i < side.numbers.length / 3; i += stride) places.push(apply(viewFromSide, pointAt(side, i)));
  if (!places.length) {
    for (let i = 0; i < side.segments.length; i += 3) places.push(apply(viewFromSide, side.segments.slice(i, i + 3)));
  }
  const low = [0, 0, 0];
  const high = [0, 0, 0];
  for (let axis = 0; axis < 3 && places.length; ++axis) {
    const values = places.map((x) => x[axis]).sort((a, b) => a - b);
    const cut = Math.floor(0.03 * values.length);
    low[axis] = values[cut];
    high[axis] = values[values.length - 1 - cut];
  }
  return { low, high };
};

const loadScene = () => {
  const scene = JSON.parse(element('scene').textContent);
  scene.source = loadSide(scene, 'source');
  scene.target = loadSide(scene, 'target');
  scene.viewFromTarget = fromAxes(...scene.axes);
  for (const pose of scene.poses) pose.matrix = fromRows(pose.matrix);
  scene.beside = fromRows(scene.beside);
  scene.partner = new Map();
  for (const [source, target, distance] of scene.matches) {
    scene.partner.set(`source${source}`, { other: target, distance });
    if (!scene.partner.has(`target${target}`)) scene.partner.set(`target${target}`, { other: source, distance });
  }
  return scene;
};
