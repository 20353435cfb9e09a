// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// Of a project: where its scans stand, which links join them, and one link alone.

const kWhereItIs = fromAxes([1, 0, 0], [0, 1, 0], [0, 0, 1]);
const kStateTints = {
  registered: '--good', verified: '--good', probable: '--doubt', ambiguous: '--doubt', bridge: '--doubt', under_constrained: '--doubt', rejected: '--bad', unreadable: '--bad',
};
const kDashes = { bridge: 9, ambiguous: 5, rejected: 3 };
const kMostSpots = 300;
const stateTint = (state) => kStateTints[state] ?? '--weak';

const kNothing = { low: [0, 0, 0], high: [0, 0, 0] };
const hasContent = (side) => side.numbers.length > 0 || side.planes.length > 0;
const joinedBoxes = (boxes) => (boxes.length ? {
  low: [0, 1, 2].map((k) => Math.min(...boxes.map(({ low }) => low[k]))),
  high: [0, 1, 2].map((k) => Math.max(...boxes.map(({ high }) => high[k]))),
} : kNothing);

/** A link alone: its target stays, the source goes from where its own file has it to where the link lays it. */
const makePair = (scene, number) => {
  const link = scene.links[number];
  const [source, target] = [scene.sides[link.source], scene.sides[link.target]];
  const still = target.place ?? kWhereItIs;
  const after = times(still, link.pose);
  const own = boxOf(source, kWhereItIs);
  const there = boxOf(target, still);
  const before = kWhereItIs.slice();
  const gap = 0.12 * (there.high[0] - there.low[0]) + 0.5;
  const to = [there.high[0] + gap + 0.5 * (own.high[0] - own.low[0]), 0.5 * (there.low[1] + there.high[1]), 0.5 * (there.low[2] + there.high[2])];
  sub(to, scaled(add(own.low, own.high), 0.5)).forEach((c, k) => { before[12 + k] = c; });
  const places = { before, after, still };
  const box = (share) => joinedBoxes([there, boxOf(source, share > 0.5 ? after : before)]);
  return { number, link, source, target, places, box, place: (share) => betweenPlaces({ source }, before, after, share) };
};

const kLinkWords = {
  verified: t`checked by at least one loop that closes`, bridge: t`single unchecked link: accepted, but in no loop`, ambiguous: t`another pose fits as well, of this link or elsewhere`,
  rejected: t`contradicts the loops, or probably matches two look-alike places`, weak: t`leaves a direction undetermined, or overlaps too little to count`, in_place: t`measured from where the other links place both scans`,
};

const describePair = ({ link, source, target }) => {
  const facts = [
    [t`Source`, source.name], [t`Target`, target.name], [t`State`, `${t([link.state])}: ${kLinkWords[link.state] ?? ''}`], [t`Result of the pair alone`, t([link.pair])],
    [t`Agrees`, t`${link.agreeing.toFixed(1)} m²`],
  ];
  if (link.misses_m !== null) facts.push([t`Residual`, t`${millimetres(link.misses_m)}, ${link.misses_deg.toFixed(3)}°`]);
  const list = made('dl', {}, ...facts.flatMap(([name, value]) => [made('dt', {}, name), made('dd', {}, value)]));
  const parts = [list, ...(link.reason ? [made('p', { class: 'soft' }, link.reason)] : [])];
  const table = (title, heads, rows) => made('table', {}, made('caption', {}, title),
    made('thead', {}, made('tr', {}, ...heads.map((head) => made('th', { scope: 'col' }, head)))),
    made('tbody', {}, ...rows.map((row) => made('tr', {}, ...row.map((cell) => made('td', {}, cell))))));
  if (link.matches.length) {
    parts.push(table(link.planes > link.matches.length ? t`Planes that agree, the largest ${link.matches.length} of ${link.planes}` : t`Planes that agree`, [t`Planes`, t`Distance`, t`Angle`, t`Overlap`],
      link.matches.map(([from, to, off, angle, area]) => [`${from} – ${to}`, millimetres(off), t`${angle.toFixed(2)}°`, t`${area.toFixed(1)} m²`])));
  }
  if (link.openings.length) {
    parts.push(table(t`Openings that agree`, [t`Openings`, t`Across`, t`Upwards`], link.openings.map(([from, to, across, up]) => [`${from} – ${to}`, millimetres(across), millimetres(up)])));
  }
  return parts;
};

/** Marks of the stations on the canvas. */
const makeSpots = (scene) => scene.sides.map((side, number) => ({ side, number })).filter(({ side }) => side.station && side.component === 0)
  .slice(0, kMostSpots).map(({ side, number }) => {
    const node = made('div', { class: `spot ${side.state}`, 'aria-hidden': 'true', hidden: true }, String(number));
    element('stage').append(node);
    return { node, number, at: side.station };
  });

/** Ends of the links between stations, by their state; `floor`: of those that one of its stations has, or null. */
const linkLines = (scene, floor) => {
  const lines = new Map();
  for (const { source, target, state } of scene.links) {
    const ends = [scene.sides[source], scene.sides[target]];
    if (ends.some((side) => !side.station || side.component !== 0)) continue;
    if (floor && ![source, target].some((scan) => floor.scans.includes(scan))) continue;
    if (!lines.has(state)) lines.set(state, []);
    lines.get(state).push(...ends[0].station, ...ends[1].station);
  }
  return lines;
};

/** How links of each state that there is are drawn. */
const linkLegend = (scene) => Object.keys(kLinkWords).filter((state) => scene.links.some((link) => link.state === state))
  .map((state) => made('span', { class: `chip ${state}` }, made('span', { class: 'mark' }), t([state])));

const buildPairs = (scene, { choose, showFloor }) => {
  if (scene.links.length) {
    const name = ({ source, target, state }, k) => t`${k}: ${source} and ${target}, ${t([state])}`;
    element('pair').append(made('option', { value: '' }, t`none: all scans`), ...scene.links.map((link, k) => made('option', { value: String(k) }, name(link, k))));
    element('pair').addEventListener('change', ({ target }) => choose(target.value === '' ? null : +target.value));
    element('pairs').hidden = false;
    element('with-links').hidden = false;
    document.addEventListener('click', ({ target }) => {
      const number = target.dataset?.link;
      if (number === undefined) return;
      choose(+number);
      element('viewer').scrollIntoView({ block: 'start' });
      element('canvas').focus({ preventScroll: true });
    });
  }
  if (scene.floors.length > 1) {
    element('floor').append(made('option', { value: '' }, t`all`), ...scene.floors.map(({ z }, k) => made('option', { value: String(k) }, t`${k + 1}, stations at ${(z + scene.rise).toFixed(1)} m`)));
    element('floor').addEventListener('change', ({ target }) => showFloor(target.value === '' ? null : scene.floors[+target.value]));
    element('floors').hidden = false;
  }
};
