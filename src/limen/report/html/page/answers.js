// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// A click on an answer writes the line that takes it.

document.addEventListener('click', (event) => {
  let line = event.target.dataset?.line;
  if (!line) return;
  // The folder is that of this page.
  if (location.protocol === 'file:') {
    const folder = decodeURIComponent(location.pathname).replace(/\/[^/]*$/, '') || '/';
    line = line.replace(' DIR ', () => ` '${folder.replaceAll("'", "'\\''")}' `);
  }
  const paste = element('paste');
  paste.hidden = false;
  paste.querySelector('code').textContent = line;
  navigator.clipboard?.writeText(line).catch(() => {});
});
