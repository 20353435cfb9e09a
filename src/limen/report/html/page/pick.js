// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// What lies under a place on the screen: a point, or else a surface.

const kReachPx = 9;

/** Inside an odd number of rings. */
const insideRings = (part, x, y) => {
  let inside = false;
  for (const ring of part) {
    for (let k = 0, last = ring.length - 2; k < ring.length; last = k, k += 2) {
      const [xa, ya, xb, yb] = [ring[k], ring[k + 1], ring[last], ring[last + 1]];
      if ((ya > y) !== (yb > y) && x < xa + (y - ya) / (yb - ya) * (xb - xa)) inside = !inside;
    }
  }
  return inside;
};

const isCutAway = (look, x) => {
  const along = dot(look.cutAxis, x);
  return norm(look.cutAxis) > 0.5 && (along < look.cutRange[0] || along > look.cutRange[1]);
};

/** A plane that the view leaves out because it is seen from behind. */
const isBehind = (look, side, plane, place, x) => {
  if (!look.seeThrough || !plane || !plane.facing) return false;
  const towards = look.parallel ? look.eye : sub(look.eye, x);
  return dot(turn(place, plane.n), towards) < -0.03 * norm(towards);
};

/** The nearest point of a side to the ray through the place, or null. `look`: what the drawing used. */
const pickPoint = (side, place, look, px, py) => {
  if (side.shape !== 'points') return null;
  const clip = times(look.clipFromView, times(place, side.fromNumbers));
  const [w, h] = look.css;
  let best = null;
  for (let i = 0; i < side.count; ++i) {
    const x = side.numbers[3 * i] / 65535;
    const y = side.numbers[3 * i + 1] / 65535;
    const z = side.numbers[3 * i + 2] / 65535;
    const depth = clip[3] * x + clip[7] * y + clip[11] * z + clip[15];
    if (depth <= 0) continue;
    const dx = ((clip[0] * x + clip[4] * y + clip[8] * z + clip[12]) / depth * 0.5 + 0.5) * w - px;
    if (dx > kReachPx || dx < -kReachPx) continue;
    const dy = (0.5 - (clip[1] * x + clip[5] * y + clip[9] * z + clip[13]) / depth * 0.5) * h - py;
    if (dx * dx + dy * dy > kReachPx * kReachPx) continue;
    const at = apply(place, pointAt(side, i));
    const plane = side.planes[side.marks[2 * i] - 1];
    if (isCutAway(look, at) || isBehind(look, side, plane, place, at)) continue;
    // Nearer points win, a little aside counts as a little behind.
    const far = dot(look.forward, sub(at, look.position)) + Math.hypot(dx, dy) * 3 * look.metresPerPx;
    if (!best || far < best.far) best = { side, point: i, plane: side.marks[2 * i] - 1, far, at };
  }
  return best;
};

const pickSurface = (side, place, look, ray) => {
  const back = inverseRigid(place);
  const from = apply(back, ray.from);
  const way = turn(back, ray.way);
  let best = null;
  side.planes.forEach((plane, k) => {
    const slope = dot(plane.n, way);
    if (Math.abs(slope) < 1e-6) return;
    const far = (plane.d - dot(plane.n, from)) / slope;
    if (far <= 0 || (best && far >= best.far)) return;
    const x = add(from, scaled(way, far));
    const off = sub(x, plane.o);
    if (!plane.parts.some((part) => insideRings(part, dot(off, plane.u), dot(off, plane.v)))) return;
    const at = apply(place, x);
    if (isCutAway(look, at) || isBehind(look, side, plane, place, at)) return;
    best = { side, point: -1, plane: k, far, at };
  });
  return best;
};

const rayAt = (look, px, py) => {
  const [w, h] = look.css;
  const x = (px / w - 0.5) * 2;
  const y = (0.5 - py / h) * 2;
  const half = look.metresPerPx * h / 2;
  const aside = add(scaled(look.right, x * half * w / h), scaled(look.up, y * half));
  if (look.parallel) return { from: add(look.position, aside), way: look.forward };
  const centre = scaled(look.forward, look.distance);
  const way = add(centre, aside);
  return { from: look.position, way: scaled(way, 1 / norm(way)) };
};

/** What is under a place of the canvas, or null; `sides` are those that are shown, with their places. */
const pick = (sides, look, px, py) => {
  const nearest = (list) => list.filter(Boolean).sort((a, b) => a.far - b.far)[0] ?? null;
  return nearest(sides.map(({ side, place }) => pickPoint(side, place, look, px, py))) ??
    nearest(sides.map(({ side, place }) => pickSurface(side, place, look, rayAt(look, px, py))));
};

/** Lines of text about a pick: pairs of name and value. `frames`: how to tell its place. */
const describe = (scene, found, { targetFromView, residual }) => {
  const { side, point, plane } = found;
  const lines = [[side.side === 'source' ? t`Source` : t`Target`, side.name]];
  const local = apply(targetFromView, found.at);
  const world = add(local, scene.target.origin);
  lines.push([t`In target`, world.map((c) => t`${c.toFixed(3)}`).join('  ')]);
  const coarse = Math.max(...side.step);
  const kind = coarse > 0.001 ? t`point, drawn to ±${millimetres(coarse / 2)}` : t`point`;
  lines.push([t`Type`, point >= 0 ? kind : t`surface`]);
  if (plane >= 0) {
    const { area, rms } = side.planes[plane];
    const size = t`${area.toFixed(1)} m²`;
    lines.push([t`Plane`, rms > 0 ? t`${plane}, ${size}, residuals ${millimetres(rms)}` : `${plane}, ${size}`]);
    const partner = scene.partner.get(side.side + plane);
    if (partner && residual) {
      const distance = millimetres(partner.distance);
      const words = side.side === 'source' ? t`target plane ${partner.other}, distance ${distance}` : t`source plane ${partner.other}, distance ${distance}`;
      lines.push([t`Matched`, words]);
    }
  }
  const mark = point >= 0 ? side.marks[2 * point + 1] : 0;
  if (mark > 0 && residual) {
    const off = (mark - 128) / 127 * scene.residual_range;
    lines.push([t`Residual`, Math.abs(mark - 128) === 127 ? t`beyond ${millimetres(off)}` : millimetres(off)]);
  }
  return lines;
};
