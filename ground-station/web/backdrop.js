// What lies under the fleet: grid, axes, mission circle; and over it: scale bar, north arrow.

const GRID_PX = 70;  // about this far apart

/** 1, 2 or 5 times a power of ten, near `length`. */
export function roundLength(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  const digit = length / power;
  if (digit < 1.5) return power;
  if (digit < 3.5) return 2 * power;
  if (digit < 7.5) return 5 * power;
  return 10 * power;
}

function metres(length) {
  return length >= 1000 ? `${length / 1000} km` : `${Number(length.toPrecision(3))} m`;
}

export function drawGrid(context, viewport, palette) {
  const step = roundLength(GRID_PX / viewport.scale);
  const [west, north] = viewport.toWorld(0, 0);
  const [east, south] = viewport.toWorld(viewport.width, viewport.height);
  context.lineWidth = 1;
  context.font = `11px ${palette.font}`;
  context.fillStyle = palette.muted;
  const line = (index, x0, y0, x1, y1) => {
    context.strokeStyle = index % 5 === 0 ? palette['grid-strong'] : palette.grid;
    context.beginPath();
    context.moveTo(x0, y0);
    context.lineTo(x1, y1);
    context.stroke();
  };
  for (let i = Math.ceil(west / step); i * step <= east; ++i) {
    const x = Math.round(viewport.toScreen([i * step, 0])[0]) + 0.5;
    line(i, x, 0, x, viewport.height);
  }
  for (let i = Math.ceil(south / step); i * step <= north; ++i) {
    const y = Math.round(viewport.toScreen([0, i * step])[1]) + 0.5;
    line(i, 0, y, viewport.width, y);
  }
}

export function drawCircle(context, viewport, palette, circle) {
  if (!circle) return;
  const [x, y] = viewport.toScreen(circle.centre_m);
  context.strokeStyle = palette.guide;
  context.lineWidth = 1.25;
  context.setLineDash([5, 6]);
  context.beginPath();
  context.arc(x, y, circle.radius_m * viewport.scale, 0, 2 * Math.PI);
  context.stroke();
  context.setLineDash([]);
  context.beginPath();
  context.moveTo(x - 5, y);
  context.lineTo(x + 5, y);
  context.moveTo(x, y - 5);
  context.lineTo(x, y + 5);
  context.stroke();
}

export function drawScaleBar(context, viewport, palette) {
  const length = roundLength(130 / viewport.scale);
  const width = length * viewport.scale;
  const x1 = viewport.width - 24;
  const x0 = x1 - width;
  const y = viewport.height - 24;
  context.strokeStyle = palette.text;
  context.lineWidth = 1.5;
  context.beginPath();
  context.moveTo(x0, y - 5);
  context.lineTo(x0, y);
  context.lineTo(x1, y);
  context.lineTo(x1, y - 5);
  context.stroke();
  context.fillStyle = palette.text;
  context.font = `600 12px ${palette.font}`;
  context.textAlign = 'center';
  context.textBaseline = 'bottom';
  context.fillText(metres(length), (x0 + x1) / 2, y - 5);
}

export function drawNorth(context, viewport, palette) {
  const x = viewport.width - 34;
  const y = 40;
  context.fillStyle = palette.text;
  context.beginPath();
  context.moveTo(x, y - 18);
  context.lineTo(x + 7, y + 6);
  context.lineTo(x, y + 1);
  context.closePath();
  context.fill();
  context.strokeStyle = palette.text;
  context.lineWidth = 1.25;
  context.lineJoin = 'round';
  context.beginPath();
  context.moveTo(x, y - 18);
  context.lineTo(x - 7, y + 6);
  context.lineTo(x, y + 1);
  context.stroke();
  context.font = `650 12px ${palette.font}`;
  context.textAlign = 'center';
  context.textBaseline = 'top';
  context.fillText('N', x, y + 9);
}
