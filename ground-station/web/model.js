// What the page knows of the run. No drawing, no DOM: any view, flat or solid, reads this.

export const TRAIL_S = 20;
/** Pictures are shown this much later than they were taken, so that there is a next one to move towards. */
const SHOWN_LATER_S = 0.15;
/** How long a pose is carried on along its velocity when no newer one comes. */
const CARRY_ON_S = 0.4;
const LATE_S = 1;

/** Seconds without telemetry after which a UAV is lost: three of its periods, a second at least. */
export function lostAfter(node) {
  return Math.max(1, 3 * node.telemetry_period_s);
}

export function isLost(node) {
  return !node.telemetry || node.telemetry.age_s > lostAfter(node);
}

function lerp(a, b, k) {
  return a + (b - a) * k;
}

function lerpAngle(a, b, k) {
  const turn = Math.atan2(Math.sin(b - a), Math.cos(b - a));
  return a + turn * k;
}

/** Poses of one node over the last seconds, by sim time. */
export class Track {
  constructor() {
    this.samples = [];
  }

  add(t, pose) {
    const last = this.samples.at(-1);
    if (last && t <= last.t) return;
    this.samples.push({ t, p: pose.p_m, v: pose.v_mps, yaw: pose.yaw_rad });
    let old = 0;
    while (this.samples[old].t < t - TRAIL_S - LATE_S) ++old;
    if (old > 0) this.samples.splice(0, old);
  }

  /** The pose at sim time `t`: between two samples, or carried on a little after the last. */
  at(t) {
    const { samples } = this;
    if (samples.length === 0) return null;
    let next = samples.length;
    while (next > 0 && samples[next - 1].t > t) --next;
    if (next === 0) return { p: samples[0].p, yaw: samples[0].yaw };
    const a = samples[next - 1];
    if (next === samples.length) {
      const ahead = Math.min(t - a.t, CARRY_ON_S);
      return { p: a.p.map((x, i) => x + a.v[i] * ahead), yaw: a.yaw };
    }
    const b = samples[next];
    const k = (t - a.t) / (b.t - a.t);
    return { p: a.p.map((x, i) => lerp(x, b.p[i], k)), yaw: lerpAngle(a.yaw, b.yaw, k) };
  }

  /** Positions between `from` and `to`, oldest first. */
  between(from, to) {
    return this.samples.filter((s) => s.t >= from && s.t <= to);
  }
}

export class FleetModel {
  constructor() {
    this.reset(null);
  }

  reset(runId) {
    this.runId = runId;
    this.snapshot = null;
    this.tracks = new Map();  // node -> {truth, telemetry}
    this.offset = null;       // sim time less local time [s]
    this.shown = -Infinity;
  }

  /** Takes in a snapshot that arrived at local time `now` [s]. */
  apply(snapshot, now) {
    if (snapshot.run.id !== this.runId) this.reset(snapshot.run.id);
    const t = snapshot.run.sim_time_s;
    if (this.snapshot && t < this.snapshot.run.sim_time_s) return;
    this.snapshot = snapshot;
    const offset = t - now;
    // Pictures can be late, never early: follow an early one at once, late ones slowly.
    if (this.offset === null || offset > this.offset || this.offset - offset > LATE_S) this.offset = offset;
    else this.offset = lerp(this.offset, offset, 0.02);
    for (const node of snapshot.nodes) {
      if (!this.tracks.has(node.node)) this.tracks.set(node.node, { truth: new Track(), telemetry: new Track() });
      const tracks = this.tracks.get(node.node);
      if (node.truth) tracks.truth.add(t, node.truth);
      if (node.telemetry) tracks.telemetry.add(node.telemetry.at_s, node.telemetry);
    }
  }

  get ended() {
    return this.snapshot?.run.state === 'ended';
  }

  /** The sim time to show at local time `now` [s]; never runs backwards, stands still at the end. */
  shownTime(now) {
    if (!this.snapshot) return 0;
    const latest = this.snapshot.run.sim_time_s;
    const due = this.ended ? latest : Math.min(now + this.offset - SHOWN_LATER_S, latest + CARRY_ON_S);
    this.shown = Math.max(this.shown, due);
    return this.shown;
  }

  /**
   * The nodes as of sim time `t`: [{node, pose, other, lost}], poses from `source` ("truth" or
   * "telemetry"), `other` from the other one. Fixed nodes send no telemetry: theirs is the truth.
   */
  poses(source, t) {
    if (!this.snapshot) return [];
    return this.snapshot.nodes.map((node) => {
      const tracks = this.tracks.get(node.node);
      const said = tracks.telemetry.at(t);
      const truth = tracks.truth.at(t);
      const wanted = source === 'truth' || !node.vehicle ? truth : said;
      return {
        node,
        pose: wanted,
        other: source === 'truth' ? said : truth,
        trail: source === 'truth' || !node.vehicle ? tracks.truth : tracks.telemetry,
        lost: node.vehicle && isLost(node),
      };
    });
  }

  /** The linked pairs: [{a, b, dbm (of the weaker way), age, oneWay, mbps (of the slower way)}]. */
  links() {
    return (this.snapshot?.links ?? []).map(([a, b, dbm, age, oneWay, mbps]) => ({ a, b, dbm, age, oneWay, mbps }));
  }
}
