// The header: scenario, time, lateness, connection; and the cards above the table.

import { duration, microseconds, number } from './format.js';
import { isLost } from './model.js';

const element = (id) => document.getElementById(id);

function write(id, text) {
  const target = element(id);
  if (target.textContent !== text) target.textContent = text;
}

/** A hint while the run lasts; the verdict is in the run's fidelity.json. */
function latenessLevel(lateness) {
  if (!lateness || lateness.releases === 0) return ['none', 'no frames yet'];
  if (lateness.p99 > 5000 || lateness.max > 50000) return ['bad', 'late'];
  if (lateness.p99 > 1000 || lateness.max > 10000) return ['fair', 'strained'];
  return ['good', 'on time'];
}

function showLateness(lateness) {
  const [level, word] = latenessLevel(lateness);
  element('lateness').dataset.level = level;
  write('lateness-word', word);
  const known = level === 'none' ? null : lateness;
  write('lateness-p50', microseconds(known?.p50));
  write('lateness-p99', microseconds(known?.p99));
  write('lateness-max', microseconds(known?.max));
}

function showCards(snapshot) {
  const vehicles = snapshot.nodes.filter((node) => node.vehicle);
  const heard = vehicles.filter((node) => !isLost(node)).length;
  write('card-heard', `${heard} / ${vehicles.length}`);
  element('card-heard').dataset.level = heard < vehicles.length ? 'fair' : '';
  write('card-links', number(snapshot.links.length + snapshot.links_left_out));
  const failed = vehicles.filter((node) => node.telemetry?.state === 'failsafe').length;
  element('failsafe').hidden = failed === 0;
  write('card-failsafe', number(failed));
  const { world, radio } = snapshot.run;
  write('card-overruns', number(world?.overruns));
  element('card-overruns').dataset.level = world?.overruns > 0 ? 'fair' : '';
  const ages = [world?.heartbeat_age_s, radio?.heartbeat_age_s];
  const ended = snapshot.run.state === 'ended';
  const late = !ended && ages.some((age) => age === undefined || age > 1);
  const oldest = Math.max(...ages.map((age) => age ?? Infinity));
  write('card-heartbeats', late ? `${number(oldest, 1)} s` : ended ? 'stopped' : 'ok');
  element('card-heartbeats').dataset.level = late ? 'bad' : '';
  element('card-heartbeats').title = `world ${number(ages[0], 2)} s ago, radio ${number(ages[1], 2)} s ago`;
}

export function showRun(snapshot) {
  const { run } = snapshot;
  write('scenario', run.scenario || 'cuscus');
  write('run-id', `run ${run.id}`);
  const title = `${run.scenario || 'run'} · cuscus`;
  if (document.title !== title) document.title = title;
  const at = Math.max(0, run.sim_time_s);
  write('sim-time', duration(run.duration_s > 0 ? Math.min(at, run.duration_s) : at));
  write('duration', run.duration_s > 0 ? `of ${duration(run.duration_s)}` : '');
  const share = run.duration_s > 0 ? Math.min(1, at / run.duration_s) : 0;
  element('progress').hidden = run.duration_s <= 0;
  element('progress').setAttribute('aria-valuenow', String(Math.round(100 * share)));
  element('progress-bar').style.width = `${(100 * share).toFixed(2)}%`;
  showLateness(run.radio?.lateness_us);
  showCards(snapshot);
}

/**
 * @param state "live", "connecting" or "ended"
 * @param silence_s how long an open connection has said nothing; undefined when it is not open
 */
export function showConnection(state, everLive, silence_s) {
  document.body.dataset.connection = state;
  const lost = state === 'connecting' && everLive;
  write('connection', { live: 'live', ended: 'run ended', connecting: lost ? 'reconnecting…' : 'connecting…' }[state]);
  const banner = element('banner');
  banner.hidden = state === 'live' || !everLive;
  const news = silence_s === undefined ? 'No connection to the ground station.'
    : `No news from the ground station for ${Math.floor(silence_s)} s.`;
  write('banner', state === 'ended' ? 'The run has ended. This is its last picture.'
    : `${news} This is the last picture.`);
}
