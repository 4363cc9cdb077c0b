// Which part of the world the canvas shows, and how the operator moves it.

const SIDE_PX = 90;    // room for names
const ABOVE_PX = 84;   // room for the tools
const BELOW_PX = 112;  // room for the legend
const LARGEST_SCALE = 400;  // px per metre
const SMALLEST_SCALE = 0.002;
const FOLLOW_PER_S = 3;  // how quickly the view follows the fleet

export class Viewport {
  constructor() {
    this.width = 1;
    this.height = 1;
    this.centre = null;  // ENU [m]
    this.scale = 10;     // px per metre
    this.automatic = true;
  }

  resize(width, height) {
    this.width = Math.max(1, width);
    this.height = Math.max(1, height);
  }

  toScreen(p) {
    return [
      this.width / 2 + (p[0] - this.centre[0]) * this.scale,
      this.height / 2 - (p[1] - this.centre[1]) * this.scale,
    ];
  }

  toWorld(x, y) {
    return [
      this.centre[0] + (x - this.width / 2) / this.scale,
      this.centre[1] - (y - this.height / 2) / this.scale,
    ];
  }

  /**
   * Moves towards showing `bounds` [west, south, east, north], when nobody has moved the view.
   * @return whether it is still on its way
   */
  follow(bounds, elapsed_s) {
    if (!bounds || (!this.automatic && this.centre)) return false;
    const [west, south, east, north] = bounds;
    const side = Math.min(SIDE_PX, this.width / 5);
    const above = Math.min(ABOVE_PX, this.height / 5);
    const below = Math.min(BELOW_PX, this.height / 5);
    const scale = Math.min(
      (this.width - 2 * side) / Math.max(east - west, 4),
      (this.height - above - below) / Math.max(north - south, 4),
    );
    const target = [(west + east) / 2, (south + north) / 2 - (below - above) / 2 / scale];
    if (!this.centre) {
      this.centre = target;
      this.scale = scale;
      return false;
    }
    const k = 1 - Math.exp(-FOLLOW_PER_S * elapsed_s);
    this.centre = this.centre.map((c, i) => c + (target[i] - c) * k);
    this.scale *= (scale / this.scale) ** k;
    const off_px = Math.hypot(target[0] - this.centre[0], target[1] - this.centre[1]) * this.scale;
    return off_px > 0.5 || Math.abs(scale / this.scale - 1) > 0.001;
  }

  fit() {
    this.automatic = true;
  }

  pan(dx, dy) {
    if (!this.centre) return;
    this.automatic = false;
    this.centre = [this.centre[0] - dx / this.scale, this.centre[1] + dy / this.scale];
  }

  /** Zooms so that the point under (x, y) stays there. */
  zoom(factor, x = this.width / 2, y = this.height / 2) {
    if (!this.centre) return;
    this.automatic = false;
    const before = this.toWorld(x, y);
    this.scale = Math.min(LARGEST_SCALE, Math.max(SMALLEST_SCALE, this.scale * factor));
    const after = this.toWorld(x, y);
    this.centre = this.centre.map((c, i) => c + before[i] - after[i]);
  }
}

/** Lets mouse, touch and keys move `viewport`. `changed` is called after, `picked(x, y)` on a click. */
export function listen(canvas, viewport, changed, picked) {
  const CLICK_PX = 4;
  const pointers = new Map();
  let travelled = 0;
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
    travelled = pointers.size > 1 ? Infinity : 0;
  });
  canvas.addEventListener('pointermove', (event) => {
    const last = pointers.get(event.pointerId);
    if (!last) return;
    const [dx, dy] = [event.offsetX - last[0], event.offsetY - last[1]];
    if (pointers.size === 2) {
      const [other] = [...pointers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
      const distance = (at) => Math.max(1, Math.hypot(at[0] - other[0], at[1] - other[1]));
      viewport.zoom(distance([event.offsetX, event.offsetY]) / distance(last), other[0], other[1]);
    } else {
      travelled += Math.hypot(dx, dy);
      if (travelled > CLICK_PX) viewport.pan(dx, dy);
    }
    pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
    changed();
  });
  const release = (event) => {
    if (pointers.delete(event.pointerId) && event.type === 'pointerup' && travelled <= CLICK_PX) {
      picked(event.offsetX, event.offsetY);
    }
  };
  canvas.addEventListener('pointerup', release);
  canvas.addEventListener('pointercancel', release);
  canvas.addEventListener('dblclick', () => {
    viewport.fit();
    changed();
  });
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    viewport.zoom(Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.0015)), event.offsetX, event.offsetY);
    changed();
  }, { passive: false });
  const STEP_PX = 60;
  const keys = {
    ArrowLeft: () => viewport.pan(STEP_PX, 0),
    ArrowRight: () => viewport.pan(-STEP_PX, 0),
    ArrowUp: () => viewport.pan(0, STEP_PX),
    ArrowDown: () => viewport.pan(0, -STEP_PX),
  };
  canvas.addEventListener('keydown', (event) => {
    if (!keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
    changed();
  });
}
