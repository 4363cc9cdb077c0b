// Numbers as text.

const THIN_SPACE = '\u2009';
export const NOTHING = '–';

/** A number with fixed decimals and grouped thousands; a dash when there is none. */
export function number(value, decimals = 0) {
  if (value === null || value === undefined || !Number.isFinite(value)) return NOTHING;
  const text = Math.abs(value).toFixed(decimals);
  const [whole, part] = text.split('.');
  const grouped = whole.replace(/\B(?=(\d{3})+$)/g, THIN_SPACE);
  const sign = value < 0 && Number(text) !== 0 ? '−' : '';
  return sign + grouped + (part ? `.${part}` : '');
}

/** Seconds as "12.3 s" or "2:05". */
export function duration(seconds) {
  if (!Number.isFinite(seconds)) return NOTHING;
  if (seconds < 60) return `${seconds.toFixed(1)} s`;
  const whole = Math.floor(seconds);
  const pad = (n) => String(n).padStart(2, '0');
  const minutes = Math.floor(whole / 60) % 60;
  const hours = Math.floor(whole / 3600);
  const tail = `${pad(whole % 60)}`;
  return hours > 0 ? `${hours}:${pad(minutes)}:${tail}` : `${minutes}:${tail}`;
}

/** Microseconds in the unit that reads best. */
export function microseconds(us) {
  if (us === null || us === undefined) return NOTHING;
  return us < 1000 ? `${us.toFixed(us < 10 ? 1 : 0)} µs` : `${(us / 1000).toFixed(us < 10000 ? 2 : 1)} ms`;
}

export function percent(ratio) {
  return ratio === null || ratio === undefined ? NOTHING : number(100 * ratio, 1);
}

export function sum(counts) {
  return Object.values(counts).reduce((total, count) => total + count, 0);
}

/** "below_detection" as "below detection". */
export function words(key) {
  return key.replaceAll('_', ' ');
}

/** An ENU position [m]. */
export function position(p) {
  return p ? p.map((c) => number(c, 2)).join(', ') : NOTHING;
}
