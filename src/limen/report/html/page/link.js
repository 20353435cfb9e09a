// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// Linking by hand: three places in each of two files give the line that registers them from there.

const kPlacesToLink = 3;

const quoted = (word) => (/^[\w./+-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

/** The line for a shell. `sides`: both files, each with its places in the frame of the view's numbers. */
const linkLine = (sides) => {
  const [from, to] = sides.map(({ side, places }) => places.map((x) => apply(fromRows(side.file_from_frame), x).map((c) => c.toFixed(4)).join(',')));
  const points = from.map((place, k) => `--start-points ${place}=${to[k]}`);
  return ['limen register', ...sides.map(({ side }) => quoted(side.path)), '-o linked', ...points].join(' ');
};

/** Null where fewer than two files can be linked. `changed`: something is to be written and drawn anew. */
const makeLinking = (scene, changed) => {
  if (scene.sides.filter((side) => side.path).length < 2) return null;
  let chosen = [];
  let note = '';
  const pins = [0, 1].map((file) => [0, 1, 2].map((k) => made('div', { class: 'spot', style: `border-color:var(--${file ? 'target' : 'source'})`, 'aria-hidden': 'true', hidden: true }, String(k + 1))));
  element('stage').append(...pins.flat());
  const linking = { on: false };
  const set = (on) => { linking.on = on; chosen = []; note = ''; button.setAttribute('aria-pressed', String(on)); changed(); };
  const button = made('button', { type: 'button', id: 'link', 'aria-pressed': 'false', 'aria-keyshortcuts': 'L', onclick: () => set(!linking.on) }, 'Link');
  element('measure').after(button);
  linking.toggle = () => set(!linking.on);
  linking.clear = () => set(linking.on);
  linking.add = (found) => {
    if (!found) return;
    let own = chosen.find(({ side }) => side === found.side);
    note = '';
    if (!found.side.path) note = `${found.side.name} is no scan that can be linked.`;
    else if (!own && chosen.length === 2) note = `${found.side.name} is a third file. Clear to begin anew.`;
    else if (own?.ends.length === kPlacesToLink) note = `${found.side.name} has three places. Untick it to reach the other file.`;
    if (note) return;
    if (!own) chosen.push(own = { side: found.side, ends: [] });
    own.ends.push(found.at);
    if (lineNow()) navigator.clipboard?.writeText(lineNow()).catch(() => {});
  };
  /** The line once all places are there, else nothing. */
  const lineNow = () => {
    if (chosen.length < 2 || chosen.some(({ ends }) => ends.length < kPlacesToLink)) return '';
    const back = inverseRigid(scene.viewFromFrame);
    return linkLine(chosen.map(({ side, ends }) => ({ side, places: ends.map((x) => add(turn(back, x), scene.origin)) })));
  };
  /** Nodes and where they are: null is hidden. */
  linking.pins = () => pins.flatMap((own, file) => own.map((node, k) => [node, linking.on ? chosen[file]?.ends[k] ?? null : null]));
  linking.words = () => {
    const line = lineNow();
    const counts = chosen.map(({ side, ends }) => made('p', {}, `${side.name}: ${ends.length} of ${kPlacesToLink}`));
    if (!line) return [...counts, made('p', { class: 'soft' }, note || 'Click the same three places in two files, in the same order. Untick a file to see the other alone.')];
    return [...counts, made('p', {}, 'Paste this into a terminal, in the folder of this page’s files:'), made('pre', { id: 'link-line', tabindex: '0' }, line)];
  };
  return linking;
};
