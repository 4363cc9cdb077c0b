// The page's palette: custom properties of style.css, read for drawing on canvas.

/** Received levels between which the link colours run [dBm]. */
export const WEAKEST_DBM = -95;
export const STRONGEST_DBM = -45;
const LEVELS = 5;

function parseHex(text) {
  const value = parseInt(text.trim().slice(1), 16);
  return [(value >> 16) & 255, (value >> 8) & 255, value & 255];
}

/** Reads the palette as it is now: call again when the colour scheme changes. */
export function readPalette() {
  const style = getComputedStyle(document.documentElement);
  const colour = (name) => style.getPropertyValue(`--${name}`).trim();
  const names = ['plan', 'panel', 'grid', 'grid-strong', 'guide', 'text', 'muted', 'accent', 'fair', 'bad', 'idle',
    'street', 'wood', 'tree', 'roof-low', 'roof-high', 'roof-edge'];
  const palette = Object.fromEntries(names.map((name) => [name, colour(name)]));
  palette.font = getComputedStyle(document.body).fontFamily;
  palette.levels = [];
  for (let i = 0; i < LEVELS; ++i) palette.levels.push(parseHex(colour(`level-${i}`)));
  return palette;
}

/** 0 at WEAKEST_DBM and below, 1 at STRONGEST_DBM and above. */
export function strength(dbm) {
  return Math.min(1, Math.max(0, (dbm - WEAKEST_DBM) / (STRONGEST_DBM - WEAKEST_DBM)));
}

export function levelColour(palette, dbm, alpha = 1) {
  const at = strength(dbm) * (LEVELS - 1);
  const low = Math.min(LEVELS - 2, Math.floor(at));
  const mix = palette.levels[low].map((c, i) => Math.round(c + (palette.levels[low + 1][i] - c) * (at - low)));
  return `rgb(${mix.join(' ')} / ${alpha})`;
}

export function stateColour(palette, state) {
  if (state === 'flying') return palette.accent;
  if (state === 'taking-off' || state === 'landing') return palette.fair;
  if (state === 'failsafe') return palette.bad;
  return palette.idle;
}

/** Paints the legend's bar and writes its ticks. */
export function drawLegend(palette, canvas, ticks) {
  const context = canvas.getContext('2d');
  const gradient = context.createLinearGradient(0, 0, canvas.width, 0);
  for (let i = 0; i < LEVELS; ++i) gradient.addColorStop(i / (LEVELS - 1), `rgb(${palette.levels[i].join(' ')})`);
  context.fillStyle = gradient;
  context.fillRect(0, 0, canvas.width, canvas.height);
  const steps = [0, 1, 2, 3, 4, 5];
  ticks.replaceChildren(...steps.map((i) => {
    const tick = document.createElement('span');
    tick.textContent = `−${Math.abs(WEAKEST_DBM + (i * (STRONGEST_DBM - WEAKEST_DBM)) / 5)}`;
    return tick;
  }));
}
