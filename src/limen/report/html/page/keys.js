// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// The keyboard.

const kArrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** Moves the section by a fiftieth of what it can. */
const moveSection = ({ state: { cut }, cutRange, changed }, way) => {
  const [low, high] = cutRange(cut.axis);
  cut.place[cut.axis] = clamp(cut.place[cut.axis] + way * 0.02 * (high - low), low, high);
  cut.on = true;
  changed();
};

/** The next of the colourings that are offered. */
const nextColouring = ({ state, colourings }) => {
  const next = colourings[(colourings.indexOf(state.colouring) + 1) % colourings.length];
  document.querySelector(`input[name="colouring"][value="${next}"]`).click();
};

/**
 * Single letters work wherever the reader is but in a field; arrows only on the picture itself. `letters` come
 * beside those that every view has.
 */
const listenKeys = (canvas, letters, actions) => {
  const zoom = (factor) => actions.setCamera(zoomed(actions.camera(), factor));
  const all = {
    ...letters, c: () => nextColouring(actions), '+': () => zoom(0.85), '=': () => zoom(0.85), '-': () => zoom(1 / 0.85),
    '[': () => moveSection(actions, -1), ']': () => moveSection(actions, 1),
    1: () => actions.chooseView('top'), 2: () => actions.chooseView('front'),
    3: () => actions.chooseView('side'), 4: () => actions.chooseView('free'), 0: () => actions.fit(),
  };
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const field = event.target.closest?.('select, textarea');
    const letter = all[event.key.toLowerCase()];
    if (letter && !field) { letter(); event.preventDefault(); return; }
    if (event.target !== canvas) return;
    if (event.key === 'Enter') actions.middle();
    const arrow = kArrows[event.key];
    if (!arrow) return;
    event.preventDefault();
    const shift = event.shiftKey || actions.camera().parallel;
    actions.setCamera(shift ? panned(actions.camera(), -0.05 * arrow[0], -0.05 * arrow[1]) : rotated(actions.camera(), 0.08 * arrow[0], 0.08 * arrow[1]));
  });
};
