// My experiment: releases of a dropped table over the basins, and how likely each end is for a hand that does not
// release exactly.

import { element } from "./element.js";
import { asScene, unlabelled } from "./frames.js";
import { drawPoints } from "./plane.js";
import { agrees, releasesOf } from "./table.js";

const GRID = 24; // samples along each axis of a spread
const [AGREES, DIFFERS, UNKNOWN] = ["#1b9e77", "#d1322c", "#9aa4ae"];

export class Experiment {
  /** @param {import("./state.js").State} state
   * @param {import("./basins.js").Basins} basins
   * @param {(words: string) => void} say */
  constructor(state, basins, say) {
    this.state = state;
    this.basins = basins;
    this.say = say;
    this.releases = [];
    element("releases-gone").onclick = () => this.take([]);
    state.listen((keys) => {
      if ((keys.has("pendulum") || keys.has("other") || keys.has("pane")) && this.releases.length) this.compareSoon();
    });
  }

  async read(file) {
    try {
      this.take(releasesOf(await file.text(), this.state.pivotFrequency));
    } catch (error) {
      this.say(`${file.name}: ${error.message}`);
    }
  }

  take(releases) {
    this.releases = releases;
    element("releases-gone").hidden = releases.length === 0;
    if (releases.length) this.compare();
    else this.show();
  }

  compareSoon() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.compare(), 400);
  }

  /** Asks for the end of every release. */
  async compare() {
    const mine = (this.comparing = {});
    const pane = this.basins.active;
    const pendulum = asScene(pane.pendulum);
    for (const release of this.releases) release.name = null;
    try {
      for (const [i, release] of this.releases.entries()) {
        const [found] = await pane.engine.answer({ request: "where", theta: release.theta, velocity: release.velocity,
          pendulum });
        if (mine !== this.comparing) return;
        release.name = found.attractor < 0 ? "not settled" : found.name;
        if (i % 20 === 0) this.show();
      }
      this.show();
    } catch (error) {
      this.say(error.message);
    }
  }

  /** Points on the basins, and the share of agreement for each recorded end. */
  show() {
    const groups = new Map();
    for (const { end, name } of this.releases.filter((release) => release.name)) {
      const group = groups.get(end) ?? groups.set(end, [0, 0]).get(end);
      group[0] += agrees(end, name);
      group[1]++;
    }
    const words = ([end, [right, all]]) => `${end}: ${right} of ${all} agree (${((100 * right) / all).toFixed(0)} %)`;
    element("agreement").textContent = [...groups].map(words).join("\n");
    for (const pane of this.basins.panes) {
      pane.plain.releases = pane === this.basins.active ? this.releases : [];
      pane.draw();
    }
  }
}

/** Releases, coloured by agreement. */
export function drawReleases(surface, plane, releases) {
  for (const { theta, velocity, end, name } of releases)
    drawPoints(surface, plane, [[theta, velocity]], !name ? UNKNOWN : agrees(end, name) ? AGREES : DIFFERS, 4.5);
}

/** [[name, share], ...] of the ends inside of an ellipse about a place of a pane, the likeliest first; half axes in
 * shares of its window. */
export function likelyEnds(pane, [across, up], [wide, high]) {
  const counts = new Map();
  let all = 0;
  for (let i = 0; i < GRID; i++)
    for (let j = 0; j < GRID; j++) {
      const [x, y] = [i, j].map((n) => (2 * n + 1) / GRID - 1);
      const found = Math.hypot(x, y) < 1 && pane.cellAt(across + x * wide, up + y * high);
      if (!found) continue;
      const label = found.frame.labels[found.cell];
      const name = label === 255 ? unlabelled(found.frame) : found.frame.catalogue.attractors[label].name;
      counts.set(name, (counts.get(name) ?? 0) + 1);
      all++;
    }
  return [...counts].map(([name, count]) => [name, count / all]).sort((one, other) => other[1] - one[1]);
}
