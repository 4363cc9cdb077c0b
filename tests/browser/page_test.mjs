// node page_test.mjs <page_harness> <cuscus-gcs> <folder for screenshots>

import assert from 'node:assert/strict';
import { mkdir } from 'node:fs/promises';
import { request } from 'node:http';
import { join } from 'node:path';
import { skipIfMissing, withPage } from './chromium.mjs';
import { startHarness } from './harness.mjs';
import { checkLivePage, read } from './page_checks.mjs';

const DRONES = 10;
const [harness, gcs, folder] = process.argv.slice(2);
await skipIfMissing();
await mkdir(folder, { recursive: true });

/** One HTTP request, headers as given; resolves to {status, headers, body}. */
function ask(url, path, { method = 'GET', headers = {} } = {}) {
  return new Promise((resolve, reject) => {
    const { hostname, port, host } = new URL(url);
    const asked = request({ hostname, port, path, method, headers: { Host: host, ...headers } }, (response) => {
      let body = '';
      response.setEncoding('utf8');
      response.on('data', (chunk) => { body += chunk; });
      response.on('end', () => resolve({ status: response.statusCode, headers: response.headers, body }));
    });
    asked.on('upgrade', (response, socket) => {
      socket.destroy();
      resolve({ status: response.statusCode, headers: response.headers, body: '' });
    });
    asked.on('error', reject);
    asked.end();
  });
}

const upgrade = (origin) => ({
  Connection: 'Upgrade',
  Upgrade: 'websocket',
  'Sec-WebSocket-Version': '13',
  'Sec-WebSocket-Key': 'dGhlIHNhbXBsZSBub25jZQ==',
  ...(origin ? { Origin: origin } : {}),
});

async function checkGuards(url) {
  const { port } = new URL(url);
  const status = async (...request) => (await ask(url, ...request)).status;
  assert.equal(await status('/', { headers: { Host: 'evil.example' } }), 421);
  assert.equal(await status('/', { headers: { Host: `evil.example:${port}` } }), 421);
  assert.equal(await status('/', { headers: { Host: `localhost:${port}` } }), 200);
  assert.equal(await status('/ws', { headers: { ...upgrade('http://evil.example') } }), 403);
  assert.equal(await status('/ws', { headers: { ...upgrade('null') } }), 403);
  assert.equal(await status('/ws', { headers: { ...upgrade(url) } }), 101);
  assert.equal(await status('/ws'), 426);
  assert.equal(await status('/', { method: 'POST' }), 405);
  assert.equal(await status('/../../etc/passwd'), 404);
  assert.equal(await status('/%2e%2e/main.js'), 404);
  assert.equal(await status('/none'), 404);
  const page = await ask(url, '/', { method: 'HEAD' });
  assert.equal(page.status, 200);
  assert.equal(page.body, '');
  assert.match(page.headers['content-security-policy'], /default-src 'self'/);
  assert.equal(page.headers['x-content-type-options'], 'nosniff');
}

async function checkSnapshot(url) {
  const { status, headers, body } = await ask(url, '/api/snapshot');
  assert.equal(status, 200);
  assert.equal(headers['content-type'], 'application/json');
  assert.ok(!body.includes('<'), 'names are escaped');
  const snapshot = JSON.parse(body);
  assert.equal(snapshot.nodes.filter((node) => node.vehicle).length, DRONES);
  assert.equal(snapshot.run.scenario, `Circle of ${DRONES} <quadrotors>`);
  assert.ok(snapshot.run.telemetry.rejected > 0, 'garbage is counted');
  assert.ok(snapshot.links.length > 0);
  assert.ok(snapshot.links.every(([a, b]) => a < b), 'a link is a pair');
  const station = snapshot.nodes.find((node) => !node.vehicle);
  const toStation = snapshot.links.filter(([, b]) => b === station.node);
  assert.equal(station.hears, toStation.length);
  assert.ok(station.hears > 0);
  assert.ok(toStation.every(([, , , , oneWay]) => !oneWay), 'a station that is silent is not out of earshot');
  assert.ok(snapshot.links.every(([, , , , , mbps]) => mbps === 6), 'the rate of the latest frame');
  const levels = snapshot.links.map(([, , dbm]) => dbm);
  assert.deepEqual(levels, [...levels].sort((a, b) => b - a), 'strongest first');
}

/** Zoom, layers, sources and selection, by mouse and by keys. */
async function checkControls(page) {
  await page.click('#show-telemetry');
  await page.locator('#show-telemetry[aria-pressed="true"]').waitFor();
  await page.waitForFunction((count) => Number(document.getElementById('plan').dataset.drones) === count, DRONES);
  await page.keyboard.press('t');
  await page.locator('#show-truth[aria-pressed="true"]').waitFor();
  await page.keyboard.press('l');
  await page.waitForFunction(() => document.getElementById('plan').dataset.links === '0');
  await page.keyboard.press('l');
  await page.waitForFunction(() => Number(document.getElementById('plan').dataset.links) > 0);
  await page.click('#fleet tbody tr:nth-child(4) button');
  await page.locator('#details h2', { hasText: 'uav3' }).waitFor();
  await page.locator('#details dd', { hasText: / dBm 6 Mb\/s/ }).waitFor();
}

/** The ground station stands still with the connection open: the page must not call that live. */
async function checkSilence(page) {
  run.pause();
  try {
    await page.locator('#banner', { hasText: /No news from the ground station for \d+ s/ }).waitFor();
    assert.equal((await read(page)).connection, 'connecting');
  } finally {
    run.resume();
  }
  await page.locator('body[data-connection="live"]').waitFor();
  await page.locator('#banner').waitFor({ state: 'hidden' });
}

/** A table that saw one run shows the names of the next, on the same port and of the same size. */
async function checkNextRun(page) {
  const names = await page.evaluate(async () => {
    const { FleetTable } = await import('/table.js');
    const snapshot = await (await fetch('/api/snapshot')).json();
    const table = document.getElementById('fleet').cloneNode(true);
    const fleet = new FleetTable(table, document.createElement('section'), () => {});
    const shown = () => [...table.tBodies[0].rows].map((row) => row.cells[0].textContent);
    fleet.show(snapshot, 'truth');
    const before = shown();
    for (const node of snapshot.nodes) node.name = `next-${node.name}`;
    fleet.show(snapshot, 'truth');
    return { before, after: shown() };
  });
  assert.deepEqual(names.after, names.before.map((name) => `next-${name}`));
}

/** Seconds of silence after which a UAV counts as lost follow its telemetry period. */
async function checkLostAfter(page) {
  const seconds = await page.evaluate(async () => {
    const { lostAfter } = await import('/model.js');
    return [0, 0.2, 5].map((period) => lostAfter({ telemetry_period_s: period }));
  });
  assert.deepEqual(seconds, [1, 1, 15]);
}

async function checkFailsafe(page) {
  await page.waitForFunction(() => document.getElementById('card-failsafe').textContent === '1');
  assert.ok(await page.locator('#failsafe').isVisible());
  assert.equal(await page.locator('.state[data-state="failsafe"]').count(), 1);
}

const run = await startHarness(harness, gcs, '--failed', '7');
try {
  await withPage({ url: run.url, width: 390, height: 844 }, async (page, complaints) => {
    await checkLivePage(page, DRONES);
    await page.screenshot({ path: join(folder, 'page-narrow.png') });
    assert.deepEqual(complaints, []);
  });
  for (const colorScheme of ['light', 'dark']) {
    await withPage({ url: run.url, colorScheme }, async (page, complaints) => {
      const seen = await checkLivePage(page, DRONES);
      assert.equal(seen.scenario, `Circle of ${DRONES} <quadrotors>`);
      assert.equal(seen.lateness, 'good');
      if (colorScheme === 'light') {
        await checkSnapshot(run.url);
        await checkGuards(run.url);
        await checkSilence(page);
      } else {
        await checkControls(page);
        await checkNextRun(page);
        await checkLostAfter(page);
        await checkFailsafe(page);
      }
      await page.screenshot({ path: join(folder, `page-${colorScheme}.png`) });
      assert.deepEqual(complaints, []);

      if (colorScheme === 'dark') {
        const report = await run.stop();
        assert.equal(report.exit_code, 0);
        assert.ok(report.stop_ms < 1000, `stopped in ${report.stop_ms} ms with a client connected`);
        assert.ok(report.telemetry_received > 0 && report.telemetry_rejected > 0);
        await page.locator('body[data-connection="ended"]').waitFor();
        await page.locator('#banner', { hasText: 'The run has ended' }).waitFor();
        const last = await read(page);
        assert.equal(last.rows.length, DRONES);
        assert.equal(last.drones, DRONES);
        await page.screenshot({ path: join(folder, 'page-ended.png') });
      }
    });
  }
  console.log('the page holds');
} finally {
  run.abandon();
}
