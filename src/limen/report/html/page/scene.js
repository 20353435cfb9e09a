// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// Lines of a side, and where the source stands before and after.

const inSpace = (plane, x, y) => [0, 1, 2].map((k) => plane.o[k] + x * plane.u[k] + y * plane.v[k]);

const closedLines = (corners, out) => {
  corners.forEach((corner, k) => out.push(...corner, ...corners[(k + 1) % corners.length]));
};

const ringCorners = (plane, ring) => {
  const corners = [];
  for (let k = 0; k + 1 < ring.length; k += 2) corners.push(inSpace(plane, ring[k], ring[k + 1]));
  return corners;
};

const outlineOf = (plane) => {
  const out = [];
  for (const part of plane.parts) for (const ring of part) closedLines(ringCorners(plane, ring), out);
  return out;
};

const openingLines = (side) => {
  const out = [];
  for (const flat of side.openings) {
    const corners = [];
    for (let k = 0; k < flat.length; k += 3) corners.push(flat.slice(k, k + 3));
    closedLines(corners, out);
  }
  return out;
};

/** Where the plane normal . x = offset (side's frame) goes through the side's planes: the cut walls. */
const cutLines = (side, normal, offset) => {
  const out = [];
  for (const plane of side.planes) {
    const along = cross(plane.n, normal);
    if (norm(along) < 0.05) continue;
    for (const part of plane.parts) {
      const found = [];
      for (const ring of part) {
        const corners = ringCorners(plane, ring);
        corners.forEach((a, k) => {
          const b = corners[(k + 1) % corners.length];
          const before = dot(normal, a) - offset;
          const after = dot(normal, b) - offset;
          if ((before < 0) !== (after < 0)) found.push(mixed(a, b, before / (before - after)));
        });
      }
      found.sort((a, b) => dot(along, a) - dot(along, b));
      for (let k = 0; k + 1 < found.length; k += 2) out.push(...found[k], ...found[k + 1]);
    }
  }
  return out;
};

/** Arrows both ways from the middle along every direction that is open. Target's frame. */
const openLines = (scene) => {
  const out = [];
  const centre = turn(inverseRigid(scene.viewFromTarget), scaled(add(scene.low, scene.high), 0.5));
  const reach = 0.3 * norm(sub(scene.high, scene.low));
  const up = scene.axes[2];
  for (const { rotation, direction } of scene.open) {
    if (rotation) continue;
    const aside = scaled(Math.abs(dot(up, direction)) > 0.9 ? scene.axes[0] : up, 0.05 * reach);
    for (const way of [1, -1]) {
      const tip = add(centre, scaled(direction, way * reach));
      const back = add(centre, scaled(direction, way * 0.9 * reach));
      out.push(...centre, ...tip, ...tip, ...add(back, aside), ...tip, ...sub(back, aside));
    }
  }
  return out;
};

/** The source before: in its own frame's directions, beside what both show; above where the target is wide. */
const placeBefore = (scene) => {
  if (!scene.poses.length) return times(scene.viewFromTarget, scene.beside);
  const own = boxOf(scene.source, scene.viewFromTarget);
  const target = boxOf(scene.target, scene.viewFromTarget);
  const middle = scaled(add(own.low, own.high), 0.5);
  const focus = scaled(add(scene.low, scene.high), 0.5);
  const span = sub(scene.high, scene.low);
  const wide = target.high[0] - target.low[0] > 2.5 * span[0];
  const to = wide
    ? [focus[0], focus[1], Math.max(scene.high[2], target.high[2]) + 0.3 * span[2] + 0.5 * (own.high[2] - own.low[2])]
    : [Math.max(scene.high[0], target.high[0]) + 0.12 * span[0] + 0.5 * (own.high[0] - own.low[0]), focus[1], focus[2]];
  const place = scene.viewFromTarget.slice();
  sub(to, middle).forEach((c, k) => { place[12 + k] = c; });
  return place;
};

/** Between two places of the source: it turns about its own middle, which goes straight. */
const betweenPlaces = (scene, from, to, share) => {
  if (share <= 0) return from;
  if (share >= 1) return to;
  const side = scene.source;
  const middle = side.middle ??= (() => {
    const box = boxOf(side, fromAxes([1, 0, 0], [0, 1, 0], [0, 0, 1]));
    return scaled(add(box.low, box.high), 0.5);
  })();
  const place = rotationOf(slerp(quaternionOf(from), quaternionOf(to), share));
  const at = mixed(apply(from, middle), apply(to, middle), share);
  sub(at, turn(place, middle)).forEach((c, k) => { place[12 + k] = c; });
  return place;
};
