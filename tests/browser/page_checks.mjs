// What must hold of the operator's page in any running run.

import assert from 'node:assert/strict';

const rows = (page) => page.locator('#fleet tbody tr[data-vehicle="true"]');

/** What the page shows, as one would read it. */
export function read(page) {
  return page.evaluate(() => {
    const cells = (row) => [...row.cells].map((cell) => cell.textContent.trim());
    const canvas = document.getElementById('plan');
    return {
      connection: document.body.dataset.connection,
      scenario: document.getElementById('scenario').textContent,
      simTime: document.getElementById('sim-time').textContent,
      lateness: document.getElementById('lateness').dataset.level,
      drones: Number(canvas.dataset.drones ?? 0),
      links: Number(canvas.dataset.links ?? 0),
      rows: [...document.querySelectorAll('#fleet tbody tr[data-vehicle="true"]')].map(cells),
    };
  });
}

/** The page's own view of the run, fetched by the page. */
export function snapshotOf(page) {
  return page.evaluate(async () => (await fetch('/api/snapshot')).json());
}

/** Asks for snapshots, one per animation frame, until one satisfies `holds`, and returns it. */
export async function awaitSnapshot(page, holds) {
  for (;;) {
    const snapshot = await snapshotOf(page);
    if (holds(snapshot)) return snapshot;
    await page.evaluate(() => new Promise(requestAnimationFrame));
  }
}

/** How many different colours the plan has: an empty plan has few. */
export function coloursOfPlan(page) {
  return page.evaluate(() => {
    const canvas = document.getElementById('plan');
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    const colours = new Set();
    for (let i = 0; i < data.length; i += 4) colours.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
    return colours.size;
  });
}

/** Where the page has drawn the nodes: {node: [x, y]} in pixels of the plan, and the plan's size. */
export function drawnPlaces(page) {
  return page.evaluate(() => {
    const canvas = document.getElementById('plan');
    const places = Object.fromEntries(JSON.parse(canvas.dataset.places ?? '[]').map(([node, x, y]) => [node, [x, y]]));
    return { places, width: canvas.clientWidth, height: canvas.clientHeight };
  });
}

/**
 * Waits until every drone has been drawn elsewhere, on a plan that itself stood still meanwhile,
 * and checks that all lie inside of it.
 */
async function checkDrawnMotion(page) {
  const FAR_PX = 3;
  const { nodes } = await snapshotOf(page);
  const numbers = (vehicle) => nodes.filter((node) => node.vehicle === vehicle).map(({ node }) => node);
  let first = await drawnPlaces(page);
  for (;;) {
    const now = await drawnPlaces(page);
    const moved = (node) => Math.hypot(...now.places[node].map((c, i) => c - first.places[node][i]));
    if (numbers(false).some((node) => moved(node) > 0.5)) first = now;  // the view follows the fleet
    if (numbers(true).every((node) => moved(node) > FAR_PX)) {
      for (const [node, [x, y]] of Object.entries(now.places)) {
        assert.ok(x >= 0 && y >= 0 && x <= now.width && y <= now.height, `node ${node} is drawn at ${x}, ${y}`);
      }
      return;
    }
    await page.evaluate(() => new Promise(requestAnimationFrame));
  }
}

/** Checks that nothing sticks out to the side. */
export async function checkNoOverflow(page) {
  const [content, window] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
  assert.ok(content <= window, `the page is ${content} px wide in a window of ${window} px`);
}

/** Waits until the page shows `drones` UAVs that are heard, drawn, linked and moving. */
export async function checkLivePage(page, drones) {
  await page.locator('body[data-connection="live"]').waitFor();
  await page.waitForFunction((count) => {
    const canvas = document.getElementById('plan');
    const heard = [...document.querySelectorAll('#fleet tbody tr[data-vehicle="true"] .state')]
      .filter((state) => state.textContent !== 'not heard');
    return heard.length === count && Number(canvas.dataset.drones) === count && Number(canvas.dataset.links) > 0;
  }, drones);
  assert.equal(await rows(page).count(), drones);

  const before = await read(page);
  await page.waitForFunction((time) => document.getElementById('sim-time').textContent !== time, before.simTime);
  const positions = ({ nodes }) => nodes.filter((node) => node.vehicle).map((node) => node.truth.p_m.join());
  const first = positions(await snapshotOf(page));
  assert.equal(first.length, drones);
  await awaitSnapshot(page, (snapshot) => positions(snapshot).every((position, i) => position !== first[i]));
  await checkDrawnMotion(page);
  assert.ok(await coloursOfPlan(page) > 50, 'the plan is drawn');
  await checkNoOverflow(page);
  return read(page);
}
