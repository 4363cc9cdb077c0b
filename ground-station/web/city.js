// What stands and grows around the fleet, in plan: streets, woods, trees, and roofs by height.

const SHADES = 6;  // of roofs
const LOWEST = 0.02;  // part of the roofs that may be lower than the first shade, and higher than the last
const EDGE_PX = 0.75;
const EDGES_FROM = 0.4;  // px per metre: smaller, and edges would hide the roofs

const parseHex = (text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16));

/** Of the colours "#rrggbb" `low` and `high`, what lies between them at 0 ... 1. */
export function mix(low, high, at) {
  const from = parseHex(low);
  const to = parseHex(high);
  return `rgb(${from.map((c, i) => Math.round(c + (to[i] - c) * at)).join(' ')})`;
}

/** Heights [m] between which the shades run: those of most roofs. */
export function heightRange(tops) {
  if (tops.length === 0) return [0, 1];
  const sorted = Float64Array.from(tops).sort();
  const at = (part) => sorted[Math.round(part * (sorted.length - 1))];
  return [at(LOWEST), Math.max(at(1 - LOWEST), at(LOWEST) + 1)];
}

/** 0 ... SHADES - 1. */
export function shadeOf(top, [low, high]) {
  return Math.min(SHADES - 1, Math.max(0, Math.floor(((top - low) / (high - low)) * SHADES)));
}

function addRing(path, ring) {
  ring.forEach(([x, y], i) => (i === 0 ? path.moveTo(x, y) : path.lineTo(x, y)));
  path.closePath();
}

function addFootprint(path, { outer, courtyards }) {
  addRing(path, outer);
  for (const courtyard of courtyards) addRing(path, courtyard);
}

/** Streets of one width in one path, so that where they cross they are one surface. */
function streetPaths(streets) {
  const paths = new Map();
  for (const { width_m: width, axis_m: axis } of streets) {
    if (!paths.has(width)) paths.set(width, new Path2D());
    axis.forEach(([x, y], i) => (i === 0 ? paths.get(width).moveTo(x, y) : paths.get(width).lineTo(x, y)));
  }
  return paths;
}

function crowns(trees) {
  const path = new Path2D();
  for (const { foot_m: [x, y], crown_radius_m: radius } of trees) {
    path.moveTo(x + radius, y);
    path.arc(x, y, radius, 0, 2 * Math.PI);
  }
  return path;
}

function footprints(prisms) {
  const path = new Path2D();
  for (const prism of prisms) addFootprint(path, prism);
  return path;
}

/** The city in plan, painted anew only when the view has changed. */
export class CityPlan {
  /** `city` is what /api/city says. */
  constructor(city) {
    const prisms = city.buildings.flatMap((building) => building.prisms);
    this.attribution = city.attribution;
    this.buildings = city.buildings.length;
    this.heights = heightRange(prisms.map((prism) => prism.top_m));
    this.streets = streetPaths(city.streets);
    this.woods = footprints(city.woods);
    this.trees = crowns(city.trees);
    // The low first: what is higher lies over it.
    this.roofs = Array.from({ length: SHADES }, (_, shade) => footprints(prisms
      .filter((prism) => shadeOf(prism.top_m, this.heights) === shade)
      .sort((a, b) => a.top_m - b.top_m)));
    this.picture = document.createElement('canvas');
    this.painted = '';
  }

  /** Draws the city under a plan whose canvas has `ratio` pixels per CSS pixel. */
  draw(context, viewport, palette, ratio) {
    const { width, height, centre, scale } = viewport;
    const wanted = [width, height, ratio, ...centre, scale, palette.plan].join(' ');
    if (wanted !== this.painted) {
      this.picture.width = Math.round(width * ratio);
      this.picture.height = Math.round(height * ratio);
      this.paint(this.picture.getContext('2d'), viewport, palette, ratio);
      this.painted = wanted;
    }
    context.drawImage(this.picture, 0, 0, width, height);
  }

  paint(context, viewport, palette, ratio) {
    const { width, height, centre, scale } = viewport;
    const k = scale * ratio;
    // Metres, north up.
    context.setTransform(k, 0, 0, -k, (width / 2) * ratio - centre[0] * k, (height / 2) * ratio + centre[1] * k);
    context.lineCap = 'round';
    context.lineJoin = 'round';
    context.strokeStyle = palette.street;
    for (const [street_m, path] of this.streets) {
      context.lineWidth = Math.max(street_m, 1 / scale);
      context.stroke(path);
    }
    context.fillStyle = palette.wood;
    context.fill(this.woods);
    context.strokeStyle = palette['roof-edge'];
    context.lineWidth = EDGE_PX / scale;
    this.roofs.forEach((path, shade) => {
      context.fillStyle = mix(palette['roof-low'], palette['roof-high'], shade / (SHADES - 1));
      context.fill(path);
      if (scale >= EDGES_FROM) context.stroke(path);
    });
    context.fillStyle = palette.tree;
    context.fill(this.trees);
  }
}

/** Asks the ground station what stands around the fleet: a CityPlan, or null. */
export async function loadCity() {
  const answer = await fetch('/api/city');
  const city = answer.ok ? await answer.json() : null;
  return city ? new CityPlan(city) : null;
}
