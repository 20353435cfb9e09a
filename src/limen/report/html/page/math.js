// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
'use strict';

// Vectors are arrays of three numbers; matrices are 16 numbers column by column, as WebGL takes them. All in
// double precision until they go to the graphics card.

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = (a) => Math.hypot(a[0], a[1], a[2]);
const mixed = (a, b, t) => [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])];

/** Four rows of four, as JSON holds them. */
const fromRows = (rows) => [0, 1, 2, 3].flatMap((column) => rows.map((row) => row[column]));

/** The rotation with these rows. */
const fromAxes = (x, y, z) => [x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0, 0, 0, 0, 1];

const times = (a, b) => {
  const out = new Array(16).fill(0);
  for (let column = 0; column < 4; ++column) {
    for (let row = 0; row < 4; ++row) {
      for (let k = 0; k < 4; ++k) out[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    }
  }
  return out;
};

const apply = (m, x) => [0, 1, 2].map((row) => m[row] * x[0] + m[4 + row] * x[1] + m[8 + row] * x[2] + m[12 + row]);
const turn = (m, x) => [0, 1, 2].map((row) => m[row] * x[0] + m[4 + row] * x[1] + m[8 + row] * x[2]);

/** The inverse of a rigid motion. */
const inverseRigid = (m) => {
  const t = [m[12], m[13], m[14]];
  const columns = [0, 1, 2].map((k) => [m[4 * k], m[4 * k + 1], m[4 * k + 2]]);
  return [m[0], m[4], m[8], 0, m[1], m[5], m[9], 0, m[2], m[6], m[10], 0,
    -dot(columns[0], t), -dot(columns[1], t), -dot(columns[2], t), 1];
};

/** Unit quaternion (w, x, y, z) of a rotation matrix. */
const quaternionOf = (m) => {
  const trace = m[0] + m[5] + m[10];
  let q;
  if (trace > 0) {
    q = [1 + trace, m[6] - m[9], m[8] - m[2], m[1] - m[4]];
  } else if (m[0] > m[5] && m[0] > m[10]) {
    q = [m[6] - m[9], 1 + m[0] - m[5] - m[10], m[1] + m[4], m[8] + m[2]];
  } else if (m[5] > m[10]) {
    q = [m[8] - m[2], m[1] + m[4], 1 - m[0] + m[5] - m[10], m[6] + m[9]];
  } else {
    q = [m[1] - m[4], m[8] + m[2], m[6] + m[9], 1 - m[0] - m[5] + m[10]];
  }
  const length = Math.hypot(...q);
  return q.map((c) => c / length);
};

const rotationOf = ([w, x, y, z]) => [
  1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y), 0,
  2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x), 0,
  2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y), 0,
  0, 0, 0, 1];

/** A share of the way from one rotation to another, along the shortest turn. */
const slerp = (a, b, t) => {
  let cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const sign = cosine < 0 ? -1 : 1;
  cosine = Math.min(1, Math.abs(cosine));
  const angle = Math.acos(cosine);
  if (angle < 1e-6) return t < 0.5 ? a : b.map((c) => sign * c);
  const left = Math.sin((1 - t) * angle) / Math.sin(angle);
  const right = sign * Math.sin(t * angle) / Math.sin(angle);
  return a.map((c, k) => left * c + right * b[k]);
};

const clamp = (x, low, high) => Math.min(high, Math.max(low, x));
const smooth = (t) => t * t * (3 - 2 * t);

/** 1, 2 or 5 times a power of ten, at most `most`. */
const roundBelow = (most) => {
  const power = 10 ** Math.floor(Math.log10(most));
  return power * (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1);
};

/** Texts of the page's language by the English ones; null in English. */
const kTexts = JSON.parse(document.getElementById('texts')?.textContent ?? 'null');
/** In the page's language: t`End ${k + 1}`. Numbers get its decimal sign; names of states go through t([state]). */
const t = (parts, ...values) => {
  const english = parts.join('{}');
  const shown = values.map((value) => (kTexts ? String(value).replace(/(\d)\.(?=\d)/, '$1,') : value));
  let next = 0;
  return (kTexts?.[english] ?? english).replace(/\{(\d*)\}/g, (_, at) => shown[at === '' ? next++ : +at]);
};

const metres = (x) => (Math.abs(x) < 1 ? t`${+(100 * x).toPrecision(6)} cm` : t`${+x.toPrecision(6)} m`);
const millimetres = (x) => t`${x < 0 ? '−' : ''}${(1000 * Math.abs(x)).toFixed(1)} mm`;
