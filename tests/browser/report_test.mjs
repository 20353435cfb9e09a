// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// The report page in a browser:  node --test report_test.mjs, with LIMEN_PROGRAM naming the program.
// LIMEN_SCREENSHOTS names a folder where pictures of the page are left.
import assert from 'node:assert/strict';
import { copyFileSync, mkdirSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { accessibilityFaults, findChromium, limen, openBrowser, openReport, pixels, settled } from './browser.mjs';

const program = process.env.LIMEN_PROGRAM;
process.env.LIMEN_CHROMIUM ??= findChromium();
const playwright = await import('playwright-core');
const folder = mkdtempSync(join(tmpdir(), 'limen-report-'));
const shots = process.env.LIMEN_SCREENSHOTS;
const report = (name) => join(folder, name, 'report.html');
let browser;

before(async () => {
  const museum = join(folder, 'museum');
  limen(program, 'simulate', 'museum', '-o', museum, '--points-indoor', '100000', '--points-outdoor', '400000');
  limen(program, 'register', join(museum, 'indoor_00.ply'), join(museum, 'outdoor.ply'), '-o', join(folder, 'registered'), '--pdf');
  const long = join(museum, 'station_of_the_second_floor_of_the_north_wing_beside_the_great_stairs.ply');
  copyFileSync(join(museum, 'indoor_00.ply'), long);
  limen(program, 'register', long, join(museum, 'outdoor.ply'), '-o', join(folder, 'handed_on'), '--language', 'de',
    '--title', 'Registration of the north wing, second floor, of the former municipal museum of natural history, stations of October',
    '--project', '2026-117 Museum refurbishment, lot 3', '--operator', 'Office of surveyors and partners', '--date', '22 November 2026');
  const office = join(folder, 'office');
  limen(program, 'simulate', 'office', '-o', office, '--room', 'repeated', '--points-indoor', '60000');
  limen(program, 'register', join(office, 'scan_01.ply'), join(office, 'model.ifc'), '-o', join(folder, 'in_model'));
  limen(program, 'register', join(office, 'scan_01.ply'), join(museum, 'outdoor.ply'), '-o', join(folder, 'no_match'));
  browser = await openBrowser(playwright);
  if (shots) mkdirSync(shots, { recursive: true });
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

describe('a registered pair', () => {
  let page; let record;
  before(async () => ({ page, record } = await openReport(browser.context, report('registered'))));

  test('tells the verdict first and shows something', async () => {
    assert.match(await page.locator('h1').innerText(), /^Registered: the two scans fit in one way only$/);
    assert.match(await page.locator('.verdict').innerText(), /\(95 %\): [\d.]+ mm at the centre, [\d.]+ [cm]*m at the far end/);
    const seen = await pixels(page);
    assert.ok(seen.drawn > 0.03, `only ${seen.drawn} of the canvas is drawn`);
    assert.ok(seen.orange > 0.02 && seen.orange < 0.98, `${seen.orange} orange: both sides must be there`);
  });

  test('toggles before and after, by mouse and by key', async () => {
    const first = await pixels(page);
    const before_ = await settled(page, () => page.click('#before'));
    assert.equal(await page.getAttribute('#before', 'aria-pressed'), 'true');
    assert.notEqual(before_.sum, first.sum);
    const again = await settled(page, () => page.keyboard.press('b'));
    assert.equal(await page.getAttribute('#after', 'aria-pressed'), 'true');
    assert.equal(again.sum, first.sum);
  });

  test('steps through the alternatives, each with its numbers and matrix', async () => {
    const best = await page.locator('#matrix').innerText();
    const numbers = await page.locator('#numbers').innerText();
    assert.equal(best.trim(), readFileSync(join(folder, 'registered', 'transform.txt'), 'utf8').trim());
    assert.match(await page.locator('#matrix-pose').innerText(), /^The best pose, as in transform\.txt/);
    const first = await pixels(page);
    const other = await settled(page, () => page.keyboard.press('n'));
    assert.match(await page.locator('#pose').innerText(), /Alternative 1/);
    assert.notEqual(await page.locator('#matrix').innerText(), best);
    assert.match(await page.locator('#matrix-pose').innerText(), /^Alternative 1, not the pose of transform\.txt/);
    assert.notEqual(await page.locator('#numbers').innerText(), numbers);
    assert.notEqual(other.sum, first.sum);
    await settled(page, () => page.click('#alternatives button[data-pose="2"]'));
    assert.match(await page.locator('#pose').innerText(), /Alternative 2/);
    await settled(page, () => page.keyboard.press('p'));
    await settled(page, () => page.keyboard.press('p'));
    assert.match(await page.locator('#pose').innerText(), /Best/);
  });

  test('views and sections by key', async () => {
    for (const [key, name] of [['1', 'top'], ['2', 'front'], ['3', 'side']]) {
      await settled(page, () => page.keyboard.press(key));
      assert.equal(await page.getAttribute(`[data-view="${name}"]`, 'aria-pressed'), 'true');
      assert.ok(await page.isChecked('#cut'));
      assert.match(await page.locator('#scale-text').innerText(), /^[125]0* c?m$/);
    }
    const cut = await pixels(page);
    const moved = await settled(page, () => page.keyboard.press(']'));
    assert.notEqual(moved.sum, cut.sum);
    const thick = await settled(page, () => page.fill('#cut-thickness', '90'));
    assert.ok(thick.drawn > moved.drawn);
    await settled(page, () => page.keyboard.press('4'));
    assert.ok(!(await page.isChecked('#cut')));
  });

  test('turns, shifts and zooms by key', async () => {
    await page.focus('#canvas');
    let last = (await settled(page, () => page.keyboard.press('4'))).sum;
    for (const key of ['ArrowLeft', 'ArrowUp', 'Shift+ArrowRight', '+', '-']) {
      const { sum } = await settled(page, () => page.keyboard.press(key));
      assert.notEqual(sum, last, key);
      last = sum;
    }
    await settled(page, () => page.keyboard.press('4'));
  });

  test('tells what was clicked', async () => {
    const { width, height } = await page.locator('#canvas').boundingBox();
    for (const side of ['source', 'target']) {
      const other = side === 'source' ? 'target' : 'source';
      await settled(page, () => page.uncheck(`[data-layer="${other}-cloud"]`));
      let words = '';
      for (let k = 0; k < 60 && !/Plane/.test(words); ++k) {
        const position = { x: width * (0.3 + 0.4 * ((k * 0.618) % 1)), y: height * (0.3 + 0.4 * (k / 60)) };
        await page.locator('#canvas').click({ position });
        words = await page.locator('#picked').innerText();
      }
      assert.match(words, side === 'source' ? /Source\s+indoor_00\.ply/ : /Target\s+outdoor\.ply/);
      // The target lies on a national grid; millimetres are shown.
      assert.match(words, /10\d{5}\.\d{3}\s+68\d{5}\.\d{3}\s+\d+\.\d{3}/);
      assert.match(words, /Plane\s+\d+, [\d.]+ m²/);
      await settled(page, () => page.check(`[data-layer="${other}-cloud"]`));
    }
    assert.ok(await page.isVisible('#pin'));
    await page.focus('#canvas');
    await settled(page, () => page.keyboard.press('Enter'));
  });

  test('residual colours have a legend', async () => {
    const plain = await pixels(page);
    const coloured = await settled(page, () => page.check('input[value="residual"]'));
    assert.notEqual(coloured.sum, plain.sum);
    assert.match(await page.locator('#legend').innerText(), /Residual 0\s*\d+ mm and more/);
    await settled(page, () => page.check('input[value="side"]'));
  });

  test('every control can be reached with the tab key and shows it', async () => {
    await page.evaluate(() => { document.activeElement?.blur(); scrollTo(0, 0); });
    const reached = new Set();
    for (let k = 0; k < 100; ++k) {
      await page.keyboard.press('Tab');
      const at = await page.evaluate(() => {
        const node = document.activeElement;
        const shown = getComputedStyle(node).outlineStyle !== 'none';
        return { name: node.id || node.dataset.view || node.dataset.layer || node.value || node.className, shown };
      });
      if (at.name) assert.ok(at.shown, `no focus to be seen on ${at.name}`);
      reached.add(at.name);
    }
    for (const name of ['canvas', 'before', 'after', 'previous', 'next', 'top', 'front', 'side', 'free', 'source-cloud',
      'target-openings', 'cut', 'cut-axis', 'cut-place', 'cut-thickness', 'size', 'matrix', 'copy']) {
      assert.ok(reached.has(name), `${name} was not reached`);
    }
    const nameless = await page.evaluate(() => [...document.querySelectorAll('button, input, select, canvas')]
      .filter((node) => !node.ariaLabel && !node.labels?.length && !node.textContent.trim()).map((node) => node.outerHTML));
    assert.deepEqual(nameless, []);
  });

  test('copies the matrix', async () => {
    await page.click('#copy');
    await page.waitForFunction(() => document.getElementById('copied').textContent !== '');
  });

  test('asks nothing of the network and complains of nothing', async () => {
    assert.deepEqual(record.problems, []);
    assert.deepEqual(record.requests.filter((url) => !/^(file|data):/.test(url)), []);
    assert.equal(record.requests.filter((url) => url.startsWith('file:')).length, 1);
    const blocked = await page.evaluate(() => fetch('https://example.org/').then(() => false, () => true));
    assert.ok(blocked, 'the page must not be able to reach out');
  });

  test('was printed on one A4 page by the program', () => {
    const text = readFileSync(join(folder, 'registered', 'report.pdf')).toString('latin1');
    assert.equal(text.match(/\/Type\s*\/Page\b(?!s)/g)?.length, 1);
    const [, width, height] = /\/MediaBox\s*\[\s*0 0 ([\d.]+) ([\d.]+)/.exec(text).map(Number);
    assert.ok(Math.abs(width - 595) < 2 && Math.abs(height - 842) < 2, `${width} x ${height} is not A4`);
  });

  test('is at most 10 MB and prints on one A4 page', async () => {
    assert.ok(statSync(report('registered')).size <= 10e6);
    for (const name of ['registered', 'in_model', 'no_match', 'handed_on']) {
      const { page: printed } = await openReport(browser.context, report(name));
      const pdf = await printed.pdf({ preferCSSPageSize: true });
      if (shots) writeFileSync(join(shots, `${name}.pdf`), pdf);
      const text = pdf.toString('latin1');
      assert.equal(text.match(/\/Type\s*\/Page\b(?!s)/g)?.length, 1, `${name}: more than one page`);
      const [, width, height] = /\/MediaBox\s*\[\s*0 0 ([\d.]+) ([\d.]+)/.exec(text).map(Number);
      assert.ok(Math.abs(width - 595) < 2 && Math.abs(height - 842) < 2, `${width} x ${height} is not A4`);
      await printed.close();
    }
  });
});

describe('a report to hand on', () => {
  test('has its head, is in the language asked for, and has no folder in a file name', async () => {
    const { page, record } = await openReport(browser.context, report('handed_on'));
    assert.match(await page.locator('.cover-title').innerText(), /north wing/);
    assert.match(await page.locator('.cover').innerText(), /Projekt\s+2026-117[\s\S]*Bearbeiter/);
    assert.match(await page.locator('.verdict').innerText(), /Dies ist die richtige Lage mit einer Wahrscheinlichkeit von/);
    assert.ok((await page.locator('.path').allInnerTexts()).every((name) => !name.includes('/')));
    assert.equal(await page.title(), await page.locator('.cover-title').innerText());
    assert.deepEqual(record.problems, []);
    await page.close();
  });

  test('has no text of the English page, nor has what a click and a key bring', async () => {
    const table = readFileSync(new URL('../../src/limen/report/html/page/de.tsv', import.meta.url), 'utf8').split('\n')
      .map((line) => line.split('\t'));
    const alike = new Set(table.filter(([english, german]) => english === german).map(([english]) => english));
    const said = async (name) => {
      const { page } = await openReport(browser.context, report(name));
      const words = new Set();
      const listen = async () => {
        for (const text of await page.evaluate(() => {
          const texts = [...document.querySelectorAll('[aria-label]')].map((node) => node.ariaLabel);
          const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
          while (walker.nextNode()) {
            if (!walker.currentNode.parentElement.closest('script, style, [translate="no"]')) texts.push(walker.currentNode.data);
          }
          return texts.map((text) => text.trim()).filter((text) => /\p{L}{3}/u.test(text));
        })) words.add(text);
      };
      await listen();
      for (const key of ['n', 'c', 'c', 'p', 'b']) {
        await settled(page, () => page.keyboard.press(key));
        await listen();
      }
      await settled(page, () => page.keyboard.press('b'));
      await page.focus('#canvas');
      await settled(page, () => page.keyboard.press('Enter'));
      await page.click('#copy');
      await page.waitForFunction(() => document.getElementById('copied').textContent !== '');
      await listen();
      await page.close();
      return words;
    };
    const english = await said('registered');
    const both = [...await said('handed_on')].filter((text) => english.has(text) && !alike.has(text));
    assert.ok(english.size > 100, `only ${english.size} texts`);
    assert.deepEqual(both.filter((text) => !/\.ply$/.test(text)), []);
  });

  test('the freedoms and numbers are those of the pose that is shown', async () => {
    const { page } = await openReport(browser.context, report('in_model'));
    const sigmaText = () => page.locator('#sigma').innerText();
    const first = await sigmaText();
    await settled(page, () => page.keyboard.press('n'));
    assert.notEqual(await sigmaText(), first);
    await settled(page, () => page.keyboard.press('p'));
    assert.equal(await sigmaText(), first);
    await page.close();
  });
});

describe('other outcomes', () => {
  test('a room that the model repeats: every place can be looked at', async () => {
    const { page, record } = await openReport(browser.context, report('in_model'));
    assert.match(await page.locator('h1').innerText(), /^Not decided: \d+ places fit about equally well$/);
    const first = await pixels(page);
    const other = await settled(page, () => page.click('#next'));
    assert.notEqual(other.sum, first.sum);
    assert.deepEqual(record.problems, []);
    await page.close();
  });

  test('no match: both stand side by side, nothing to toggle', async () => {
    const { page, record } = await openReport(browser.context, report('no_match'));
    assert.match(await page.locator('h1').innerText(), /^No match:/);
    assert.ok(!(await page.isVisible('#toggle')));
    assert.ok(!(await page.isVisible('#poses')));
    // A room beside a street is small.
    const seen = await pixels(page);
    assert.ok(seen.orange > 0.002 && seen.orange < 0.998);
    assert.deepEqual(record.problems, []);
    await page.close();
  });

  test('without WebGL2 it says so and still tells everything else', async () => {
    const plain = await openBrowser(playwright, { webgl: false });
    const { page, record } = await openReport(plain.context, report('registered'), { ready: false });
    await page.waitForSelector('#fallback:not([hidden])');
    assert.match(await page.locator('#fallback').innerText(), /no WebGL2/);
    assert.equal(await page.locator('.sections svg').count(), 3);
    assert.ok(await page.locator('#sigma tbody tr').count() === 6);
    assert.deepEqual(record.problems.filter((text) => !/webgl/i.test(text)), []);
    await plain.close();
  });
});

describe('on every screen', () => {
  for (const [width, height, scheme] of [[1280, 900, 'light'], [1280, 900, 'dark'], [390, 844, 'light']]) {
    test(`${width} px, ${scheme}: nothing sticks out, and everybody can use it`, async () => {
      for (const name of ['registered', 'in_model', 'no_match']) {
        const { page } = await openReport(browser.context, report(name), { viewport: { width, height }, scheme });
        assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), name);
        const sizes = await page.evaluate(() => ['#canvas', 'h1'].map((one) => document.querySelector(one).getBoundingClientRect().width));
        assert.ok(sizes.every((size) => size > 0 && size <= width));
        assert.deepEqual(await accessibilityFaults(page), [], name);
        if (shots) await page.screenshot({ path: join(shots, `${name}-${width}-${scheme}.png`), fullPage: width < 600 });
        await page.close();
      }
    });
  }
});
