// Facts about one node, or about the fleet: [term, text, "wide" where it fills a line].

import { NOTHING, number, percent, position, words } from './format.js';

function causes(counts) {
  const some = Object.entries(counts ?? {}).filter(([, count]) => count > 0);
  return some.length ? some.map(([cause, count]) => `${words(cause)} ${number(count)}`).join(' · ') : 'none';
}

const MOST_LINKS = 8;

/** The strongest links of a node: whom to, how strong, at what rate. */
function linksOf(node, snapshot) {
  const names = new Map(snapshot.nodes.map((other) => [other.node, other.name]));
  const own = snapshot.links.filter(([a, b]) => a === node.node || b === node.node);
  const shown = own.slice(0, MOST_LINKS).map(([a, b, dbm, , , mbps]) =>
    `${names.get(a === node.node ? b : a)} ${number(dbm, 1)} dBm ${number(mbps, mbps % 1 ? 1 : 0)} Mb/s`);
  const more = own.length - shown.length;
  return shown.length ? shown.join(' · ') + (more > 0 ? ` · ${more} more` : '') : 'none';
}

export function factsOf(node, snapshot) {
  const { telemetry, truth, radio } = node;
  const off = telemetry && truth ? Math.hypot(...truth.p_m.map((c, i) => c - telemetry.p_m[i])) : null;
  const facts = [['Truth, ENU m', position(truth?.p_m)]];
  if (node.vehicle) {
    facts.push(
      ['Telemetry, ENU m', position(telemetry?.p_m)],
      ['Apart', off === null ? NOTHING : `${number(off, 2)} m`],
      ['Loss, latest 64', telemetry ? `${percent(telemetry.recent_loss)} %` : NOTHING],
    );
  }
  return [
    ...facts,
    ['Hears', `${node.hears} nodes`],
    ['Address', node.address || NOTHING],
    ['Offered', number(radio?.offered)],
    ['Retries', number(radio?.retries)],
    ['Acknowledged', number(radio?.acknowledged)],
    ['Links: level of the weaker way, rate of the slower', linksOf(node, snapshot), 'wide'],
    ['Given up, by cause', causes(radio?.dropped), 'wide'],
    ['Receptions lost, by cause', causes(radio?.lost), 'wide'],
  ];
}

/** Sums of objects of numbers, key by key. */
function total(objects) {
  const sums = {};
  for (const object of objects) {
    for (const [key, value] of Object.entries(object)) sums[key] = (sums[key] ?? 0) + value;
  }
  return sums;
}

export function factsOfAll(snapshot) {
  const radios = snapshot.nodes.map((node) => node.radio).filter((radio) => radio);
  const { dropped, lost, ...flat } = {
    ...total(radios.map(({ dropped: ignored, lost: also, ...numbers }) => numbers)),
    dropped: total(radios.map((radio) => radio.dropped)),
    lost: total(radios.map((radio) => radio.lost)),
  };
  const { telemetry } = snapshot.run;
  return [
    ['Frames offered', number(flat.offered)],
    ['Sent, with retries', number(flat.transmissions)],
    ['Received', number(flat.received)],
    ['Telemetry received', number(telemetry.received)],
    ['Telemetry rejected', number(telemetry.rejected)],
    ['Retries', number(flat.retries)],
    ['Given up, by cause', causes(dropped), 'wide'],
    ['Receptions lost, by cause', causes(lost), 'wide'],
  ];
}

export function showFacts(section, title, facts) {
  const heading = document.createElement('h2');
  heading.textContent = title;
  const list = document.createElement('dl');
  for (const [term, text, width] of facts) {
    const pair = document.createElement('div');
    if (width) pair.className = width;
    const dt = document.createElement('dt');
    const dd = document.createElement('dd');
    dt.textContent = term;
    dd.textContent = text;
    pair.append(dt, dd);
    list.append(pair);
  }
  section.hidden = false;
  section.replaceChildren(heading, list);
}
