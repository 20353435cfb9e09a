// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// A browser of this machine and the pages of one run of limen.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const kFlags = ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync'];
const kWebgl = ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];

/** The first Chromium found, or null. LIMEN_CHROMIUM names another. */
export const findChromium = () => [process.env.LIMEN_CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-headless-shell',
  '/usr/lib/chromium/headless_shell', '/usr/bin/google-chrome'].find((path) => path && existsSync(path)) ?? null;

/** A browser with an empty profile; close() removes it. `webgl`: false leaves WebGL out. */
export const openBrowser = async (playwright, { webgl = true } = {}) => {
  const profile = mkdtempSync(join(tmpdir(), 'limen-browser-'));
  const context = await playwright.chromium.launchPersistentContext(profile, {
    executablePath: findChromium(), headless: true,
    args: [...kFlags, ...(webgl ? kWebgl : ['--disable-3d-apis', '--disable-webgl2'])],
    ignoreDefaultArgs: webgl ? [] : ['--enable-unsafe-swiftshader'],
    viewport: { width: 1280, height: 900 }, reducedMotion: 'reduce',
  });
  return { context, close: async () => { await context.close(); rmSync(profile, { recursive: true, force: true }); } };
};

/** A page of a report with everything it says and asks for: `record.problems` must stay empty. */
export const openReport = async (context, file, { ready = true, viewport, scheme = 'light' } = {}) => {
  const page = await context.newPage();
  if (viewport) await page.setViewportSize(viewport);
  await page.emulateMedia({ colorScheme: scheme, reducedMotion: 'reduce' });
  const record = { problems: [], requests: [] };
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type()) && !/GPU stall|performance/i.test(message.text())) record.problems.push(message.text());
  });
  page.on('pageerror', (error) => record.problems.push(String(error.stack ?? error)));
  page.on('request', (request) => record.requests.push(request.url()));
  await page.goto(pathToFileURL(file).href);
  if (ready) await page.waitForSelector('html[data-ready]', { timeout: 60000 });
  if (ready) await page.waitForFunction(() => +document.getElementById('canvas').dataset.frames > 0);
  return { page, record };
};

/** Runs limen; any of its answers is fine, only bad input and faults are not. */
export const limen = (program, ...words) => {
  try {
    execFileSync(program, [...words, '--quiet'], { stdio: ['ignore', 'ignore', 'inherit'] });
  } catch (error) {
    if (![3, 4].includes(error.status)) throw error;
  }
};

/** Shares of pixels of the canvas that are not empty, and of those nearer to orange than to blue. */
export const pixels = (page) => page.evaluate(() => {
  const canvas = document.getElementById('canvas');
  const copy = Object.assign(document.createElement('canvas'), { width: canvas.width, height: canvas.height });
  const context = copy.getContext('2d');
  context.drawImage(canvas, 0, 0);
  const { data } = context.getImageData(0, 0, copy.width, copy.height);
  let drawn = 0; let orange = 0; let sum = 0;
  for (let k = 0; k < data.length; k += 4) {
    if (data[k + 3] < 16) continue;
    drawn += 1;
    orange += data[k] > data[k + 2] + 30 ? 1 : 0;
    sum = (sum * 31 + data[k] + 7 * data[k + 1] + 13 * data[k + 2]) % 1000000007;
  }
  return { drawn: drawn / (data.length / 4), orange: orange / Math.max(1, drawn), sum };
});

/** After what an action asked for was drawn. */
export const settled = async (page, action) => {
  const frames = () => page.evaluate(() => +document.getElementById('canvas').dataset.frames);
  const earlier = await frames();
  await action();
  await page.waitForFunction((n) => +document.getElementById('canvas').dataset.frames > n, earlier, { timeout: 30000 });
  await page.waitForFunction(() => document.getElementById('canvas').dataset.moving === 'false');
  return pixels(page);
};

/** What axe-core holds against the page, in words; the rules of WCAG 2.1, levels A and AA, and good practice. */
export const accessibilityFaults = async (page) => {
  // Evaluated, not added as an element: the page allows no other scripts than its own.
  await page.evaluate(readFileSync(new URL('node_modules/axe-core/axe.min.js', import.meta.url), 'utf8'));
  // What is well is not handed over: that would take longer than the rules.
  return page.evaluate(async () => {
    const { violations } = await axe.run(document, { resultTypes: ['violations'], selectors: false });
    return violations.flatMap(({ id, nodes }) => nodes.map(({ html, failureSummary }) => `${id}: ${html.slice(0, 160)} ${failureSummary}`));
  });
};
