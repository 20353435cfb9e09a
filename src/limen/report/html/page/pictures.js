// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// Pictures that were taken at stations: a button at each place opens them.

const openPicture = (name, src) => {
  const dialog = made('dialog', { class: 'picture', 'aria-label': `Picture of ${name}`, onclose: () => dialog.remove(), onkeydown: (event) => event.stopPropagation() },
    made('div', { class: 'head' }, made('strong', {}, name), made('button', { type: 'button', onclick: () => dialog.close() }, 'Close')),
    made('div', { class: 'pan', tabindex: '0', role: 'region', 'aria-label': `Picture of ${name}, which can be moved` }, made('img', { src, alt: `What was seen round ${name}` })));
  document.body.append(dialog);
  dialog.showModal();
};

/** Buttons with the sides and places that they belong to. */
const makePictures = (scene) => scene.sides.flatMap((side) => (side.pictures ?? []).map(({ at, src }) => {
  const node = made('button', { type: 'button', class: 'spot sight', hidden: true, 'aria-label': `Picture of ${side.name}`, title: side.name, onclick: () => openPicture(side.name, src) }, '◉');
  element('stage').append(node);
  return { node, side, at: turn(scene.viewFromFrame, at) };
}));
