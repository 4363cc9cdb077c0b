// node city_page_test.mjs <page_harness> <cuscus-gcs> <folder for screenshots>
//
// The city under the fleet: to scale, in place, with its courtyards, and whose data it is.

import assert from 'node:assert/strict';
import { mkdir } from 'node:fs/promises';
import { join } from 'node:path';
import { skipIfMissing, withPage } from './chromium.mjs';
import { startHarness } from './harness.mjs';

const [harness, gcs, folder] = process.argv.slice(2);
await skipIfMissing();
await mkdir(folder, { recursive: true });

/** Waits until the plan has been drawn with its city. */
async function awaitCity(page, buildings) {
  await page.waitForFunction((count) => document.getElementById('plan').dataset.buildings === String(count), buildings);
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}

/**
 * Paints the city alone as the page does, at 10 px per metre about (26 m, 26 m), the middle of the
 * first block, and reads the colours at places in metres.
 */
function coloursAt(page, places) {
  return page.evaluate(async (asked) => {
    const { loadCity } = await import('/city.js');
    const { Viewport } = await import('/viewport.js');
    const { readPalette } = await import('/colours.js');
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [400, 300];
    const viewport = new Viewport();
    viewport.resize(400, 300);
    viewport.centre = [26, 26];
    viewport.scale = 10;
    const context = canvas.getContext('2d', { willReadFrequently: true });
    const city = await loadCity();
    city.draw(context, viewport, readPalette(), 1);
    return asked.map((place) => {
      const [x, y] = viewport.toScreen(place);
      return [...context.getImageData(Math.floor(x), Math.floor(y), 1, 1).data].join(',');
    });
  }, places);
}

async function checkPlan(page) {
  const nothing = '0,0,0,0';
  const [roof, corner, courtyard, west, south, street, next] = await coloursAt(page,
    [[22, 22], [31.8, 31.8], [26, 26], [19.8, 26], [26, 19.8], [34, 22], [38, 22]]);
  assert.notEqual(roof, nothing);
  assert.equal(corner, roof, 'the block reaches to its corner');
  for (const [name, colour] of Object.entries({ courtyard, west, south, street })) {
    assert.equal(colour, nothing, `nothing is built: ${name}`);
  }
  assert.notEqual(next, nothing);
  assert.notEqual(next, roof, 'what is higher has another shade');
}

/** The page's own plan has pixels of the roofs, and has none when the city is switched off. */
async function checkSwitch(page) {
  const roofs = () => page.evaluate(async () => {
    const { readPalette } = await import('/colours.js');
    const palette = readPalette();
    const wanted = [1, 3, 5].map((at) => parseInt(palette['roof-low'].slice(at, at + 2), 16));
    const plan = document.getElementById('plan');
    const copy = Object.assign(document.createElement('canvas'), { width: plan.width, height: plan.height });
    const context = copy.getContext('2d', { willReadFrequently: true });
    context.drawImage(plan, 0, 0);
    const { data } = context.getImageData(0, 0, copy.width, copy.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) count += wanted.every((c, k) => data[i + k] === c) ? 1 : 0;
    return count;
  });
  assert.ok(await roofs() > 1000);
  await page.locator('#show-city').click();
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  assert.equal(await roofs(), 0);
  await page.keyboard.press('c');
}

async function withCity(blocks, attribution, body) {
  const run = await startHarness(harness, gcs, '--blocks', String(blocks), ...(attribution ? ['--attribution', attribution] : []));
  try {
    await withPage({ url: run.url }, async (page, complaints) => {
      await page.locator('body[data-connection="live"]').waitFor();
      await awaitCity(page, blocks);
      await body(page);
      assert.deepEqual(complaints, []);
    });
  } finally {
    run.abandon();
  }
}

await withCity(4, '© Nobody <contributors>', async (page) => {
  await checkPlan(page);
  await checkSwitch(page);
  assert.equal(await page.locator('#attribution').textContent(), 'Map data © Nobody <contributors>');
  await page.screenshot({ path: join(folder, 'city.png') });
});
await withCity(8000, '', async (page) => {
  assert.ok(await page.locator('#attribution').isHidden());
  const before = await page.evaluate(() => document.getElementById('sim-time').textContent);
  // The page goes on: neither the many buildings nor a view that moves stops its clock.
  for (let i = 0; i < 6; ++i) await page.locator('#zoom-in').click();
  for (let i = 0; i < 13; ++i) await page.locator('#zoom-out').click();
  await page.waitForFunction((text) => document.getElementById('sim-time').textContent !== text, before);
  await page.screenshot({ path: join(folder, 'city-large.png') });
});
const open = await startHarness(harness, gcs);
try {
  await withPage({ url: open.url }, async (page) => {
    await page.locator('body[data-connection="live"]').waitFor();
    await awaitCity(page, 0);
    assert.ok(await page.locator('#show-city').isHidden());
    assert.ok(await page.locator('#roofs').isHidden());
  });
} finally {
  open.abandon();
}
console.log('the city is where it is');
