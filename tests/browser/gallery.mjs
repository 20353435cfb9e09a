// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// Pictures of the views that limen writes: node gallery.mjs VIEW.html PICTURE.jpg SETTINGS, where SETTINGS is JSON.
//   size      [width, height] of the picture
//   section   [low, high] in metres over the lowest of what is shown: what is higher is cut off
//   colour    side, own or height
//   points    their size
//   turn, shift  [right, up]: steps of the arrow keys, without Shift and with it
//   zoom      steps of the key +
// With "page": [width, height] it is the top of any page that limen writes, as it is.
import playwright from 'playwright-core';
import { openBrowser, openReport } from './browser.mjs';

const [file, picture, settings] = process.argv.slice(2);
const { page: top, size = [1100, 600], section, colour, points, turn = [0, 0], shift = [0, 0], zoom = 0 } = JSON.parse(settings);
const browser = await openBrowser(playwright);
if (top) {
  const { page } = await openReport(browser.context, file, { viewport: { width: top[0], height: top[1] }, ready: false });
  await page.waitForTimeout(3000);
  await page.screenshot({ path: picture, type: 'jpeg', quality: 65 });
  await browser.close();
  process.exit();
}
const { page } = await openReport(browser.context, file, { viewport: { width: 1500, height: 1000 } });
const slide = (id, share) => page.locator(`#${id}`).evaluate((input, at) => {
  input.value = +input.min + at * (input.max - input.min);
  input.dispatchEvent(new Event('input', { bubbles: true }));
}, share);
const set = (box, on) => box.evaluate((input, wanted) => { if (input.checked !== wanted) input.click(); }, on);
if (colour) await set(page.locator(`input[name="colouring"][value="${colour}"]`), true);
await set(page.locator('#links-shown'), false);
if (section) {
  await set(page.locator('#cut'), true);
  const [low, high] = section;
  await slide('cut-thickness', Math.log((high - low) / 0.02) / Math.log(2500));
  const place = (share) => slide('cut-place', share).then(() => page.locator('#cut-place-text').innerText()).then(parseFloat);
  const [bottom, top] = [await place(0), await place(1)];
  await place(((low + high) / 2 - bottom) / (top - bottom));
}
if (points) await slide('size', (points - 1) / 5);
await page.addStyleTag({ content: `
  .stage { position: fixed !important; inset: 0 auto auto 0; width: ${size[0]}px !important; height: ${size[1]}px !important; z-index: 9; background: #fff; }
  .stage .bar, .stage .legend, .stage .scale { display: none; }` });
await page.waitForTimeout(300);
await page.keyboard.press('0');
const canvas = page.locator('#canvas');
await canvas.focus();
const press = async (keys, steps) => { for (let k = 0; k < Math.abs(steps); ++k) await page.keyboard.press(keys[steps > 0 ? 0 : 1]); };
await press(['ArrowRight', 'ArrowLeft'], turn[0]);
await press(['ArrowUp', 'ArrowDown'], turn[1]);
await press(['Shift+ArrowRight', 'Shift+ArrowLeft'], shift[0]);
await press(['Shift+ArrowUp', 'Shift+ArrowDown'], shift[1]);
await press(['+', '-'], zoom);
await page.waitForTimeout(500);
await canvas.evaluate((node) => node.blur());
await page.waitForTimeout(200);
await canvas.screenshot({ path: picture, type: 'jpeg', quality: 65 });
await browser.close();
