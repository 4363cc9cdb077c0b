// Wires the page together: snapshots into the model, the model onto canvas and table.

import { loadCity } from './city.js';
import { connect } from './connection.js';
import { FleetModel } from './model.js';
import { FleetTable } from './table.js';
import { Viewport, listen } from './viewport.js';
import { boundsOf, drawScene, pick } from './scene.js';
import { drawLegend, readPalette } from './colours.js';
import { showConnection, showRun } from './header.js';
import { number } from './format.js';

const element = (id) => document.getElementById(id);
const seconds = () => performance.now() / 1000;

const CITY_MARGIN_M = 30;  // of the streets around the fleet

const canvas = element('plan');
const context = canvas.getContext('2d', { alpha: false });
const model = new FleetModel();
const viewport = new Viewport();
const options = { source: 'truth', links: true, trails: true, labels: true, city: true };
let palette = readPalette();
let selected = null;
let placed = [];
let links = [];
let city = null;
let cityOfRun = null;
let everLive = false;
let lastFrame = seconds();
let requested = false;

function requestFrame() {
  if (requested) return;
  requested = true;
  requestAnimationFrame(frame);
}

function frame() {
  requested = false;
  const now = seconds();
  const t = model.shownTime(now);
  placed = model.poses(options.source, t);
  const circle = model.snapshot?.circle;
  const moving = viewport.follow(boundsOf(placed, circle, city ? CITY_MARGIN_M : 0), Math.min(0.1, now - lastFrame));
  lastFrame = now;
  const drawn = drawScene(context, viewport, palette,
    { placed, links, circle, city, ratio: window.devicePixelRatio || 1, t, options, selected });
  canvas.dataset.drones = drawn.drones;
  canvas.dataset.links = drawn.links;
  canvas.dataset.places = JSON.stringify(drawn.places);
  // A picture that stands still is drawn again only when something asks for it.
  if (moving || document.body.dataset.connection === 'live') requestFrame();
}

function select(node) {
  selected = node;
  table.select(node);
  if (model.snapshot) table.show(model.snapshot, options.source);
  requestFrame();
}

const table = new FleetTable(element('fleet'), element('details'), select);

function setSource(source) {
  options.source = source;
  element('show-truth').setAttribute('aria-pressed', String(source === 'truth'));
  element('show-telemetry').setAttribute('aria-pressed', String(source === 'telemetry'));
  if (model.snapshot) table.show(model.snapshot, source);
  requestFrame();
}

function toggle(name) {
  options[name] = !options[name];
  element(`show-${name}`).setAttribute('aria-pressed', String(options[name]));
  requestFrame();
}

const actions = {
  'show-truth': () => setSource('truth'),
  'show-telemetry': () => setSource('telemetry'),
  'show-links': () => toggle('links'),
  'show-trails': () => toggle('trails'),
  'show-labels': () => toggle('labels'),
  'show-city': () => toggle('city'),
  'zoom-in': () => viewport.zoom(1.4),
  'zoom-out': () => viewport.zoom(1 / 1.4),
  'zoom-fit': () => viewport.fit(),
};
for (const [id, action] of Object.entries(actions)) {
  element(id).addEventListener('click', () => {
    action();
    requestFrame();
  });
}

const keys = {
  t: () => setSource(options.source === 'truth' ? 'telemetry' : 'truth'),
  l: () => toggle('links'),
  r: () => toggle('trails'),
  n: () => toggle('labels'),
  c: () => toggle('city'),
  '+': actions['zoom-in'],
  '=': actions['zoom-in'],
  '-': actions['zoom-out'],
  0: actions['zoom-fit'],
  Escape: () => select(null),
};
document.addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
  keys[event.key]();
  requestFrame();
});

new ResizeObserver(() => {
  const { clientWidth: width, clientHeight: height } = canvas;
  const ratio = window.devicePixelRatio || 1;
  canvas.width = Math.max(1, Math.round(width * ratio));
  canvas.height = Math.max(1, Math.round(height * ratio));
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  viewport.resize(width, height);
  requestFrame();
}).observe(canvas);

function showColours() {
  palette = readPalette();
  drawLegend(palette, element('legend'), element('legend-ticks'));
  requestFrame();
}
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', showColours);
showColours();

listen(canvas, viewport, requestFrame, (x, y) => select(pick(viewport, placed, x, y)));

/** Of each run anew: the next one on this port may fly elsewhere. */
async function showCity(run) {
  if (run === cityOfRun) return;
  cityOfRun = run;
  const loaded = await loadCity().catch(() => undefined);
  if (cityOfRun !== run) return;  // meanwhile another run has come
  if (loaded === undefined) {     // the ground station has gone: asked again when it is back
    cityOfRun = null;
    return;
  }
  city = loaded;
  canvas.dataset.buildings = city?.buildings ?? 0;
  for (const id of ['show-city', 'roofs']) element(id).hidden = !city;
  element('attribution').hidden = !city?.attribution;
  element('attribution').textContent = city?.attribution ? `Map data ${city.attribution}` : '';
  if (city) [element('roofs-low').textContent, element('roofs-high').textContent] = city.heights.map((m) => number(m, 0));
  requestFrame();
}

function showState(state, silence_s) {
  showConnection(model.ended ? 'ended' : state, everLive, silence_s);
  requestFrame();
}

connect((snapshot) => {
  everLive = true;
  model.apply(snapshot, seconds());
  links = model.links();
  showRun(snapshot);
  showCity(snapshot.run.id);
  table.show(snapshot, options.source);
  showState('live');
}, (state, silence_s) => {
  if (state !== 'live') showState(state, silence_s);
});
