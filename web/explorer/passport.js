// The passport of the motion that is pinned in the list: lines of words, each from what is known at the time.

import { smallestPush } from "./boundary.js";
import { element } from "./element.js";
import { shareWords } from "./legend.js";
import { signed } from "./ticks.js";
import { EXPLAINED } from "./words.js";

const HIGHEST = 3; // drive frequencies of the spectrum,
const STRONGEST = 3; // and lines of it that are named
const KEPT = 64; // smallest pushes
const FAINT = 1e-6; // amplitude below which a line is rounding

const timeOf = (periods, units) => units.time(Number(periods.toPrecision(3)));
const returnTime = ({ period, multiplier }, units) =>
  period > 0 && multiplier > 0 && multiplier < 1 ? `return time ${timeOf(-period / Math.log(multiplier), units)}` : "";

/** The measures of a basin in one line, for the pointer: a row of `sharesOf`, and the words of its smallest push as far
 * as they are known; `units`: of the page. */
export function measureWords(row, push, units) {
  const settling = row.settling > 0 ? `settles in ${timeOf(row.settling, units)} (mean)` : "";
  const share = row.share === null ? "" : `${shareWords(row.share)} of this window`;
  return [share, settling, returnTime(row, units), push].filter(Boolean).join(", ");
}

/** What is known of an attractor itself, in words; `share`: of its basin. Measures of other kinds join here as further
 * lines. */
export function passportWords(row, share, units) {
  const { name, period, winding, symmetric, multiplier, strobe, mean_velocity } = row;
  const closes = period > 0 ? `closes after ${units.time(period)}` : winding === 0 ? "chaotic"
    : `never closes, mean velocity ${units.velocity(mean_velocity.toPrecision(5))}`;
  const turns = winding === 0 || period === 0 ? ""
    : `, ${Math.abs(winding)} turn${Math.abs(winding) === 1 ? "" : "s"} in them`;
  const image = symmetric ? "its own mirror image" : "has a mirror image";
  const back = returnTime(row, units) && `, ${returnTime(row, units)}`;
  const part = share === null ? "" : ` ${shareWords(share)} of this window;`;
  const head = `${name}:${part} ${EXPLAINED[row.kind]}\n${closes}${turns}; ${image}`;
  if (period === 0) return head;
  const [theta, velocity] = strobe[0].map((value) => value.toPrecision(5));
  const point = `strobe point θ ${units.angle(theta)}, velocity ${units.velocity(velocity)}`;
  return `${head}\nlargest multiplier ${multiplier.toPrecision(4)}${back}; ${point}`;
}

/** The strongest lines of a motion's spectrum, in words. */
export function spectrumWords(motion, units) {
  const lines = motion.spectrum(HIGHEST).filter(([frequency, amplitude]) => frequency > 0 && amplitude > FAINT);
  const strongest = lines.sort(([, one], [, other]) => other - one).slice(0, STRONGEST);
  if (!strongest.length) return "spectrum: no lines, as nothing moves";
  const rounded = strongest.map(([frequency, amplitude]) => [frequency, amplitude.toPrecision(2)]);
  return `spectrum: ${units.frequencies(rounded)}`;
}

export class Passport {
  /** @param {import("./state.js").State} state
   * @param {import("./basins.js").Basins} basins */
  constructor(state, basins) {
    this.state = state;
    this.basins = basins;
    this.pushes = new Map(); // words of smallest pushes, by motion and pendulum
  }

  /** Shows the row that is pinned, of the rows of the list. */
  write(rows) {
    const row = rows.find(({ key }) => key === this.state.pinned);
    element("passport").hidden = !row;
    delete document.body.dataset.passport;
    if (!row) return;
    const { motion, active } = this.basins;
    this.measure(active, row);
    const [theta, velocity] = row.strobe[0] ?? [];
    const own = motion && Number(motion.ending.theta) === theta && Number(motion.ending.velocity) === velocity;
    if (own) document.body.dataset.passport = "own"; // it says more than the words on the end of the motion
    const { units } = this.basins;
    const share = row.shares.find((known) => known !== null) ?? null;
    const lines = [passportWords(row, share, units), own ? spectrumWords(motion, units) : "", this.pushOf(active, row)];
    element("passport").textContent = signed(lines.filter(Boolean).join("\n"));
  }

  /** The words of the smallest push out of a basin; empty where nobody has looked for it. */
  pushOf(pane, row) {
    return this.pushes.get(nameOf(pane, row)) ?? "";
  }

  /** Looks for the smallest push, once for a motion of a pendulum. */
  async measure(pane, row) {
    const of = nameOf(pane, row);
    if (this.pushes.has(of)) return;
    if (this.pushes.size >= KEPT) this.pushes.clear();
    this.pushes.set(of, "smallest push …");
    try {
      const push = await smallestPush(pane, row);
      const speed = push && this.basins.units.velocity(Math.abs(push).toPrecision(3));
      this.pushes.set(of, push ? `smallest push seen, at the strobe: ${push > 0 ? "+" : "-"}${speed}`
        : "smallest push: beyond this window");
    } catch (error) {
      this.pushes.set(of, `smallest push: ${error.message}`);
    }
    this.basins.write();
  }
}

const nameOf = (pane, { key }) => `${key} ${JSON.stringify(pane.pendulum)}`;
