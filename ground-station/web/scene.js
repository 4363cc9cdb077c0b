// The fleet in plan: links, trails, drones, the ground station, names.

import { levelColour, stateColour, strength } from './colours.js';
import { drawCircle, drawGrid, drawNorth, drawScaleBar } from './backdrop.js';
import { TRAIL_S } from './model.js';
import { number } from './format.js';

const TRAIL_BANDS = 8;  // pieces of a trail, each fainter than the next
const ARM_PX = 7.5;
const ROTOR_PX = 4.6;
const PICK_PX = 18;
const CROWD = 24;       // from this many nodes on, drones are drawn smaller
const MANY_LINKS = 80;  // from this many on, links are fainter

/** [west, south, east, north] of everything that should be in view, and `margin_m` around it. */
export function boundsOf(placed, circle, margin_m) {
  const points = placed.filter((item) => item.pose).map((item) => item.pose.p);
  if (circle) {
    const { centre_m: c, radius_m: r } = circle;
    points.push([c[0] - r, c[1] - r], [c[0] + r, c[1] + r]);
  }
  if (points.length === 0) return null;
  const xs = points.map((p) => p[0]);
  const ys = points.map((p) => p[1]);
  return [Math.min(...xs) - margin_m, Math.min(...ys) - margin_m, Math.max(...xs) + margin_m, Math.max(...ys) + margin_m];
}

/** The node drawn nearest to a point of the canvas, or null. */
export function pick(viewport, placed, x, y) {
  let best = null;
  let least = PICK_PX;
  for (const item of placed) {
    if (!item.pose) continue;
    const [px, py] = viewport.toScreen(item.pose.p);
    const distance = Math.hypot(px - x, py - y);
    if (distance < least) [best, least] = [item.node.node, distance];
  }
  return best;
}

function drawLinks(context, viewport, palette, links, byNode, selected) {
  let drawn = 0;
  const faint = Math.min(1, Math.max(0.25, Math.sqrt(MANY_LINKS / links.length)));
  context.lineCap = 'round';
  for (const link of links) {
    const a = byNode.get(link.a)?.pose;
    const b = byNode.get(link.b)?.pose;
    if (!a || !b) continue;
    const concerned = selected === null || link.a === selected || link.b === selected;
    const fresh = 1 - 0.5 * Math.min(1, link.age);
    const bold = selected === null ? faint : 1;
    const alpha = (concerned ? (0.3 + 0.45 * strength(link.dbm)) * bold : 0.07 * faint) * fresh;
    context.strokeStyle = levelColour(palette, link.dbm, alpha);
    context.lineWidth = 1 + 1.2 * strength(link.dbm) + (concerned && selected !== null ? 0.8 : 0);
    context.setLineDash(link.oneWay ? [3, 6] : []);
    context.beginPath();
    context.moveTo(...viewport.toScreen(a.p));
    context.lineTo(...viewport.toScreen(b.p));
    context.stroke();
    ++drawn;
  }
  context.setLineDash([]);
  return drawn;
}

function drawTrail(context, viewport, item, colour, t) {
  const samples = item.trail.between(t - TRAIL_S, t);
  if (!item.pose || samples.length === 0) return;
  const points = [...samples.map((s) => [s.t, s.p]), [t, item.pose.p]];
  context.strokeStyle = colour;
  context.lineWidth = 2;
  context.lineCap = 'butt';
  context.lineJoin = 'round';
  let from = 0;
  for (let band = 1; band <= TRAIL_BANDS; ++band) {
    const until = t - TRAIL_S * (1 - band / TRAIL_BANDS);
    let to = from;
    while (to < points.length - 1 && points[to][0] < until) ++to;
    if (to === from) continue;
    context.globalAlpha = 0.05 + 0.45 * (band / TRAIL_BANDS) ** 2;
    context.beginPath();
    context.moveTo(...viewport.toScreen(points[from][1]));
    for (let i = from + 1; i <= to; ++i) context.lineTo(...viewport.toScreen(points[i][1]));
    context.stroke();
    from = to;
  }
  context.globalAlpha = 1;
}

/** What tells a drone in failsafe without colour: a cross in a ring. */
function drawCross(context, palette) {
  const radius = 19;
  const reach = radius * Math.SQRT1_2;
  context.strokeStyle = palette.bad;
  context.lineWidth = 2.5;
  context.beginPath();
  context.arc(0, 0, radius, 0, 2 * Math.PI);
  for (const side of [1, -1]) {
    context.moveTo(-reach, -side * reach);
    context.lineTo(reach, side * reach);
  }
  context.stroke();
}

function drawDrone(context, palette, x, y, yaw, colour, { lost, failed, selected, size }) {
  context.save();
  context.translate(x, y);
  context.scale(size, size);
  if (selected) {
    context.strokeStyle = palette.accent;
    context.lineWidth = 1.5;
    context.beginPath();
    context.arc(0, 0, 24, 0, 2 * Math.PI);
    context.stroke();
  }
  if (failed) drawCross(context, palette);
  context.rotate(-yaw);  // counter-clockwise from east; the canvas's y points down
  context.globalAlpha = lost ? 0.45 : 1;
  context.strokeStyle = colour;
  context.lineWidth = 1.8;
  context.lineCap = 'round';
  context.beginPath();
  for (const [sx, sy] of [[1, 1], [1, -1]]) {
    context.moveTo(-sx * ARM_PX, -sy * ARM_PX);
    context.lineTo(sx * ARM_PX, sy * ARM_PX);
  }
  context.stroke();
  for (const [sx, sy] of [[1, 1], [1, -1], [-1, 1], [-1, -1]]) {
    context.beginPath();
    context.arc(sx * ARM_PX, sy * ARM_PX, ROTOR_PX, 0, 2 * Math.PI);
    context.fillStyle = sx > 0 ? colour : palette.plan;  // the front rotors are solid
    context.fill();
    context.stroke();
  }
  context.fillStyle = colour;
  context.beginPath();
  context.moveTo(22, 0);  // the nose
  context.lineTo(14.5, 4.5);
  context.lineTo(14.5, -4.5);
  context.closePath();
  context.fill();
  context.beginPath();
  context.arc(0, 0, 3.4, 0, 2 * Math.PI);
  context.fill();
  context.restore();
}

function drawStation(context, palette, x, y) {
  context.fillStyle = palette.text;
  context.strokeStyle = palette.plan;
  context.lineWidth = 2;
  context.beginPath();
  context.moveTo(x, y - 10);
  context.lineTo(x + 9, y + 7);
  context.lineTo(x - 9, y + 7);
  context.closePath();
  context.stroke();
  context.fill();
  context.strokeStyle = palette.text;
  context.lineWidth = 1.5;
  for (const radius of [6, 10]) {
    context.beginPath();
    context.arc(x, y - 10, radius, -0.75 * Math.PI, -0.25 * Math.PI);
    context.stroke();
  }
}

function drawGhost(context, viewport, palette, item) {
  if (!item.pose || !item.other) return;
  const [x, y] = viewport.toScreen(item.other.p);
  context.strokeStyle = palette.muted;
  context.lineWidth = 1.25;
  context.setLineDash([2, 3]);
  context.beginPath();
  context.moveTo(...viewport.toScreen(item.pose.p));
  context.lineTo(x, y);
  context.stroke();
  context.beginPath();
  context.arc(x, y, 6, 0, 2 * Math.PI);
  context.stroke();
  context.setLineDash([]);
}

const isFailed = (node) => node.vehicle && node.telemetry?.state === 'failsafe';

/** Whether a label beside (x, y) would cover no other in `taken`, which it then joins. */
function isFree(taken, x, y, right, below) {
  const box = right ? [x + 28, x + 84, y - 14, y + below] : [x - 84, x - 28, y - 14, y + below];
  const free = taken.every(([x0, x1, y0, y1]) => box[1] < x0 || box[0] > x1 || box[3] < y0 || box[2] > y1);
  if (free) taken.push(box);
  return free;
}

/** Name and altitude beside a node, on the side that looks away from the fleet's middle. */
function drawLabel(context, palette, x, y, middle, item) {
  const right = x >= middle[0] - 1;
  const tx = x + (right ? 28 : -28);
  context.textAlign = right ? 'left' : 'right';
  context.textBaseline = 'middle';
  context.lineJoin = 'round';
  context.strokeStyle = palette.plan;
  const write = (text, dy, font, colour) => {
    context.font = font;
    context.lineWidth = 4;
    context.strokeText(text, tx, y + dy);
    context.fillStyle = colour;
    context.fillText(text, tx, y + dy);
  };
  if (!item.node.vehicle) {
    write(item.node.name, 0, `600 12px ${palette.font}`, palette.text);
    return;
  }
  write(item.node.name, -7, `600 12px ${palette.font}`, palette.text);
  write(`${number(item.pose.p[2], 1)} m`, 7, `11.5px ${palette.font}`, palette.muted);
  if (isFailed(item.node)) write('failsafe', 21, `600 11.5px ${palette.font}`, palette.bad);
}

/**
 * Draws one frame. `placed` is FleetModel.poses(), `t` the sim time shown.
 * @return what was drawn: {drones, links} counted, and places: [[node, x, y]] on the canvas
 */
export function drawScene(context, viewport, palette, { placed, links, circle, city, ratio, t, options, selected }) {
  context.fillStyle = palette.plan;
  context.fillRect(0, 0, viewport.width, viewport.height);
  if (!viewport.centre) return { drones: 0, links: 0, places: [] };
  const byNode = new Map(placed.map((item) => [item.node.node, item]));
  const seen = placed.filter((item) => item.pose);
  const colourOf = (item) => stateColour(palette, item.node.telemetry?.state);

  drawGrid(context, viewport, palette);
  if (city && options.city) city.draw(context, viewport, palette, ratio);
  drawCircle(context, viewport, palette, circle);
  const linksDrawn = options.links ? drawLinks(context, viewport, palette, links, byNode, selected) : 0;
  if (options.trails) for (const item of seen) if (item.node.vehicle) drawTrail(context, viewport, item, colourOf(item), t);
  const chosen = byNode.get(selected);
  if (chosen?.node.vehicle) drawGhost(context, viewport, palette, chosen);
  let middle = [0, 0];
  for (const item of seen) {
    const at = viewport.toScreen(item.pose.p);
    middle = [middle[0] + at[0] / seen.length, middle[1] + at[1] / seen.length];
  }
  if (circle) middle = viewport.toScreen(circle.centre_m);
  let drones = 0;
  const size = seen.length > CROWD ? 0.7 : 1;
  const taken = [];
  const places = [];
  for (const item of seen) {
    const [x, y] = viewport.toScreen(item.pose.p);
    places.push([item.node.node, Math.round(10 * x) / 10, Math.round(10 * y) / 10]);
    if (item.node.vehicle) {
      drawDrone(context, palette, x, y, item.pose.yaw, colourOf(item),
        { lost: item.lost, failed: isFailed(item.node), selected: item.node.node === selected, size });
      ++drones;
    } else {
      drawStation(context, palette, x, y);
    }
  }
  if (options.labels) {
    const first = (item) => Number(item.node.node === selected || !item.node.vehicle || isFailed(item.node));
    for (const item of [...seen].sort((a, b) => first(b) - first(a))) {
      const [x, y] = viewport.toScreen(item.pose.p);
      const below = isFailed(item.node) ? 28 : 14;
      if (isFree(taken, x, y, x >= middle[0] - 1, below)) drawLabel(context, palette, x, y, middle, item);
    }
  }
  drawScaleBar(context, viewport, palette);
  drawNorth(context, viewport, palette);
  return { drones, links: linksDrawn, places };
}
