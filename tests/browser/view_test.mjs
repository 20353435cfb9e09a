// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// What somebody does with the page of `limen view`, and whether everybody can use that of a project.
import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, rmSync, statSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { accessibilityFaults, limen, openBrowser, openReport, pixels, settled } from './browser.mjs';

const program = process.env.LIMEN_PROGRAM;
const playwright = await import('playwright-core');
const folder = mkdtempSync(join(tmpdir(), 'limen-view-'));
const shots = process.env.LIMEN_SCREENSHOTS;
const view = (name) => join(folder, `${name}.html`);
let browser;

before(async () => {
  const museum = join(folder, 'museum');
  limen(program, 'simulate', 'museum', '--as-drawn', '-o', museum, '--points-indoor', '60000', '--points-outdoor', '200000');
  limen(program, 'register', join(museum, 'indoor_00.ply'), join(museum, 'outdoor.ply'), '-o', join(folder, 'registered'));
  limen(program, 'view', join(folder, 'registered', 'result.json'), '-o', view('pair'), '--most-points', '120000');
  const office = join(folder, 'office');
  limen(program, 'simulate', 'office', '-o', office, '--points-indoor', '60000');
  limen(program, 'view', join(office, 'model.ifc'), '-o', view('model'), '--title', 'The model of the office');
  limen(program, 'simulate', 'room', '-o', join(folder, 'room'), '--points-indoor', '30000');
  limen(program, 'simulate', 'room', '-o', join(folder, 'e57'), '--points-indoor', '30000', '--as', 'e57');
  limen(program, 'view', join(folder, 'e57', 'indoor_00.e57'), '-o', view('station'));
  limen(program, 'project', join(folder, 'room', 'indoor_00.ply'), join(folder, 'room', 'indoor_01.ply'), '-o', join(folder, 'project'));
  browser = await openBrowser(playwright);
  if (shots) mkdirSync(shots, { recursive: true });
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

/** Clicks places of the canvas until something was found there; the words about it. */
const clickSomething = async (page, from = 0) => {
  const { width, height } = await page.locator('#canvas').boundingBox();
  const before_ = await page.locator('#picked').innerText();
  for (let k = from; k < from + 60; ++k) {
    await page.locator('#canvas').click({ position: { x: width * (0.3 + 0.4 * ((k * 0.618) % 1)), y: height * (0.35 + 0.3 * ((k * 0.383) % 1)) } });
    const words = await page.locator('#picked').innerText();
    if (words !== before_) return words;
  }
  return '';
};

describe('both sides of a result', () => {
  let page; let record;
  before(async () => ({ page, record } = await openReport(browser.context, view('pair'))));

  test('shows both and tells how many points', async () => {
    assert.equal(await page.title(), 'indoor_00.ply, outdoor.ply');
    const files = await page.locator('#sides').innerText();
    assert.match(files, /indoor_00\.ply\s+\d+\D\d+ of 60\D\d+ points/);
    assert.match(files, /outdoor\.ply\s+\d+\D\d+ of 200\D\d+ points/);
    const seen = await pixels(page);
    assert.ok(seen.drawn > 0.03, `only ${seen.drawn} of the canvas is drawn`);
    assert.ok(seen.orange > 0.02 && seen.orange < 0.98, `${seen.orange} orange: both sides must be there`);
    if (shots) await page.screenshot({ path: join(shots, 'view-pair.png') });
  });

  test('a file can be hidden', async () => {
    const both = await pixels(page);
    const one = await settled(page, () => page.uncheck('[data-side="1"]'));
    assert.ok(one.drawn < both.drawn);
    const again = await settled(page, () => page.check('[data-side="1"]'));
    assert.equal(again.sum, both.sum);
  });

  test('sections move by slider and key', async () => {
    await settled(page, () => page.keyboard.press('1'));
    assert.ok(await page.isChecked('#cut'));
    const cut = await pixels(page);
    const moved = await settled(page, () => page.keyboard.press(']'));
    assert.notEqual(moved.sum, cut.sum);
    const thick = await settled(page, () => page.fill('#cut-thickness', '90'));
    assert.ok(thick.drawn > moved.drawn);
    if (shots) await page.screenshot({ path: join(shots, 'view-plan.png') });
    await settled(page, () => page.keyboard.press('4'));
    assert.ok(!(await page.isChecked('#cut')));
  });

  test('colours by height with a legend', async () => {
    const plain = await pixels(page);
    const coloured = await settled(page, () => page.check('input[value="height"]'));
    assert.notEqual(coloured.sum, plain.sum);
    assert.match(await page.locator('#legend').innerText(), /[\d.]+ m\s*[\d.]+ m/);
    await settled(page, () => page.check('input[value="side"]'));
    assert.equal(await page.locator('#legend').innerText(), '');
  });

  test('a click tells where a point is, in world coordinates', async () => {
    const words = await clickSomething(page);
    assert.match(words, /At\s+10\d{5}\.\d{3}\s+68\d{5}\.\d{3}\s+-?\d+\.\d{3}/);
    assert.match(words, /File\s+(indoor_00|outdoor)\.ply/);
    await page.waitForSelector('#pin-0:not([hidden])');
  });

  test('three places in each file give the line that registers them', async () => {
    await page.click('#link');
    for (const other of [1, 0]) {
      await settled(page, () => page.uncheck(`[data-side="${other}"]`));
      for (let k = 0; k < 3; ++k) await clickSomething(page, 5 * k);
      await settled(page, () => page.check(`[data-side="${other}"]`));
    }
    const line = await page.locator('#link-line').innerText();
    const places = [...line.matchAll(/--start-points (\S+)=(\S+)/g)].map((match) => match.slice(1).map((place) => place.split(',').map(Number)));
    assert.match(line, /^limen register \S*indoor_00\.ply \S*outdoor\.ply -o linked /);
    assert.equal(places.length, 3);
    // The room is in its own frame, the street on the national grid.
    for (const [room, street] of places) {
      assert.ok(Math.hypot(...room) < 1000, `${room} is in the room's frame`);
      assert.ok(street[0] > 1e6 && street[1] > 6e6, `${street} is on the grid`);
    }
    await page.keyboard.press('l');
    assert.equal(await page.getAttribute('#link', 'aria-pressed'), 'false');
    assert.match(await page.locator('#picked').innerText(), /Click a point/);
  });

  test('two clicks measure', async () => {
    await page.keyboard.press('m');
    assert.equal(await page.getAttribute('#measure', 'aria-pressed'), 'true');
    assert.match(await page.locator('#picked').innerText(), /Click two points/);
    assert.match(await clickSomething(page), /Click the other end/);
    const words = await clickSomething(page, 7);
    const places = [...words.matchAll(/End \d\s+(\S+)\s+(\S+)\s+(\S+)/g)].map((match) => match.slice(1).map(Number));
    assert.equal(places.length, 2);
    const distance = Math.hypot(...places[0].map((c, k) => places[1][k] - c));
    const stated = +/Distance\s+([\d.]+) m/.exec(words)[1];
    assert.ok(stated > 0.05 && Math.abs(stated - distance) < 0.002, `${stated} stated, ${distance} between the ends`);
    await page.waitForSelector('#length:not([hidden])');  // it is put there with the next picture
    assert.equal(await page.locator('#length').innerText(), `${stated.toFixed(3)} m`);
    if (shots) await page.screenshot({ path: join(shots, 'view-measured.png') });
    await settled(page, () => page.click('#clear'));
    assert.ok(!(await page.isVisible('#pin-0')));
    assert.ok(!(await page.isVisible('#length')));
    await page.click('#measure');
  });

  test('every control can be reached with the tab key and shows it', async () => {
    await page.evaluate(() => { document.activeElement?.blur(); scrollTo(0, 0); });
    const reached = new Set();
    for (let k = 0; k < 40; ++k) {
      await page.keyboard.press('Tab');
      const at = await page.evaluate(() => {
        const node = document.activeElement;
        return { name: node.id || node.dataset.view || node.dataset.side || node.value, shown: getComputedStyle(node).outlineStyle !== 'none' };
      });
      if (at.name) assert.ok(at.shown, `no focus to be seen on ${at.name}`);
      reached.add(at.name);
    }
    for (const name of ['canvas', 'measure', 'clear', 'top', 'free', '0', '1', 'cut', 'cut-axis', 'cut-place', 'cut-thickness', 'size'])
      assert.ok(reached.has(name), `${name} was not reached`);
  });

  test('asks nothing of the network, complains of nothing, and is small', async () => {
    assert.deepEqual(record.problems, []);
    assert.deepEqual(record.requests.filter((url) => !/^(file|data):/.test(url)), []);
    assert.equal(record.requests.filter((url) => url.startsWith('file:')).length, 1);
    assert.ok(statSync(view('pair')).size < 2.5e6);
  });
});

describe('a station with a panorama', () => {
  test('a click on its place shows it', async () => {
    const { page, record } = await openReport(browser.context, view('station'));
    const button = page.locator('button.sight');
    assert.equal(await button.count(), 1);
    await button.click();
    const image = page.locator('dialog.picture img');
    await image.waitFor();
    assert.ok(await image.evaluate((node) => node.complete && node.naturalWidth === 2 * node.naturalHeight));
    assert.deepEqual(await accessibilityFaults(page), []);
    if (shots) await page.screenshot({ path: join(shots, 'view-panorama.png') });
    await page.keyboard.press('Escape');
    await image.waitFor({ state: 'detached' });
    await settled(page, () => page.uncheck('[data-side="0"]'));
    assert.ok(!(await button.isVisible()));
    assert.deepEqual(record.problems, []);
    await page.close();
  });
});

describe('a model', () => {
  test('its surfaces are shown and can be clicked', async () => {
    const { page, record } = await openReport(browser.context, view('model'));
    assert.equal(await page.locator('h1').innerText(), 'The model of the office');
    assert.ok((await pixels(page)).drawn > 0.05);
    assert.match(await clickSomething(page), /Surface\s+[\d.]+ m²/);
    if (shots) await page.screenshot({ path: join(shots, 'view-model.png') });
    assert.deepEqual(record.problems, []);
    await page.close();
  });
});

describe('the page of a project', () => {
  const report = () => join(folder, 'project', 'report.html');

  test('shows all scans, and one link alone before and after', async () => {
    const { page, record } = await openReport(browser.context, report());
    const all = await pixels(page);
    assert.ok(all.drawn > 0.03, `only ${all.drawn} of the canvas is drawn`);
    assert.equal(await page.locator('.spot:not([hidden])').count(), 2);
    assert.match(await page.locator('#sides').innerText(), /indoor_00\.ply\s+\w+; \d+ of \d{5} points/);
    const hidden = await settled(page, () => page.uncheck('#links-shown'));
    assert.notEqual(hidden.sum, all.sum);
    assert.equal(await page.locator('.spot:not([hidden])').count(), 0);
    await settled(page, () => page.check('#links-shown'));

    const after_ = await settled(page, () => page.click('[data-link="0"]'));
    assert.ok(after_.orange > 0.1 && after_.orange < 0.9, `${after_.orange} orange: both sides must be there`);
    const words = await page.locator('#pair-words').innerText();
    assert.match(words, /Source\s+indoor_0\d\.ply/);
    assert.match(words, /Planes that agree/);
    assert.equal(await page.locator('tr[aria-current="true"]').count(), 1);
    const before_ = await settled(page, () => page.click('#before'));
    assert.notEqual(before_.sum, after_.sum);
    const again = await settled(page, () => page.click('#after'));
    assert.equal(again.sum, after_.sum);
    await settled(page, () => page.click('#all-scans'));
    assert.equal(await page.inputValue('#pair'), '');
    assert.equal(await page.locator('.spot:not([hidden])').count(), 2);
    assert.match(await clickSomething(page), /At\s+-?[\d.]+ /);
    assert.deepEqual(record.problems, []);
    assert.deepEqual(record.requests.filter((url) => !url.startsWith('file:') && !url.startsWith('data:')), []);
    await page.close();
  });

  test('colours by state, and sections cut all scans', async () => {
    const { page } = await openReport(browser.context, report());
    const byFile = await pixels(page);
    assert.notEqual((await settled(page, () => page.check('input[value="state"]'))).sum, byFile.sum);
    const whole = await pixels(page);
    await settled(page, () => page.click('[data-view="top"]'));
    assert.ok(await page.isChecked('#cut'));
    assert.ok((await pixels(page)).drawn < whole.drawn);
    await page.close();
  });

  for (const [width, height, scheme] of [[1280, 900, 'light'], [1280, 900, 'dark'], [390, 844, 'light']]) {
    test(`everybody can use it, ${width} px, ${scheme}`, async () => {
      const { page, record } = await openReport(browser.context, report(), { viewport: { width, height }, scheme });
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
      assert.deepEqual(await accessibilityFaults(page), []);
      await settled(page, () => page.click('[data-link="0"]'));
      assert.deepEqual(await accessibilityFaults(page), []);
      assert.deepEqual(record.problems, []);
      if (shots) await page.screenshot({ path: join(shots, `project-${width}-${scheme}.png`), fullPage: true });
      await page.close();
    });
  }
});

describe('on every screen', () => {
  for (const [width, height, scheme] of [[1280, 900, 'light'], [1280, 900, 'dark'], [390, 844, 'light']]) {
    test(`${width} px, ${scheme}: nothing sticks out, and everybody can use it`, async () => {
      const { page } = await openReport(browser.context, view('pair'), { viewport: { width, height }, scheme });
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
      assert.deepEqual(await accessibilityFaults(page), []);
      if (shots) await page.screenshot({ path: join(shots, `view-${width}-${scheme}.png`), fullPage: width < 600 });
      await page.close();
    });
  }
});
