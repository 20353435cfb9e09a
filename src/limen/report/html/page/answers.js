// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// A click on an answer writes the line that takes it.

document.addEventListener('click', (event) => {
  let line = event.target.dataset?.line;
  if (!line) return;
  const paste = element('paste');
  paste.hidden = false;
  if (location.protocol === 'file:') {  // its folder is the project's
    const folder = decodeURIComponent(location.pathname).replace(/\/[^/]*$/, '') || '/';
    line = line.replace(' DIR ', () => ` '${folder.replaceAll("'", "'\\''")}' `);
  } else if (origin === 'null') {  // in the sandbox of limen serve
    paste.textContent = t`Answer on the page from which you opened this report.`;
    return;
  }
  paste.querySelector('code').textContent = line;
  navigator.clipboard?.writeText(line).catch(() => {});
});
