// node check_page.mjs --url http://127.0.0.1:8080 --drones 10 --screenshot out.png
//     [--dark] [--width 1440] [--height 900] [--trail-s 5]
// Checks the page of a run that is under way, then takes a picture of it, `trail-s` seconds later.

import assert from 'node:assert/strict';
import { parseArgs } from 'node:util';
import { skipIfMissing, withPage } from './chromium.mjs';
import { awaitSnapshot, checkLivePage } from './page_checks.mjs';

const { values } = parseArgs({
  options: {
    url: { type: 'string' },
    drones: { type: 'string' },
    screenshot: { type: 'string' },
    dark: { type: 'boolean', default: false },
    'trail-s': { type: 'string', default: '0' },
    width: { type: 'string', default: '1440' },
    height: { type: 'string', default: '900' },
  },
});
if (!values.url || !values.drones) {
  console.error('usage: check_page.mjs --url URL --drones N [--screenshot FILE] [--dark] [--trail-s S]');
  process.exit(2);
}
await skipIfMissing();

const look = {
  url: values.url,
  colorScheme: values.dark ? 'dark' : 'light',
  width: Number(values.width),
  height: Number(values.height),
};
await withPage(look, async (page, complaints) => {
  const seen = await checkLivePage(page, Number(values.drones));
  if (Number(values['trail-s']) > 0) {
    const { run } = await awaitSnapshot(page, () => true);
    await awaitSnapshot(page, (later) => later.run.sim_time_s >= run.sim_time_s + Number(values['trail-s']));
  }
  if (values.screenshot) await page.screenshot({ path: values.screenshot });
  assert.deepEqual(complaints, []);
  console.log(JSON.stringify({ scenario: seen.scenario, simTime: seen.simTime, drones: seen.drones, links: seen.links }));
});
