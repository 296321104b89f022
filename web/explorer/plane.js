// The plane of starts on a canvas: where a start lies, and what lies at a place; axes, points and lines on it.

import { Decimal } from "./decimal.js";
import { degrees, ticksOf } from "./ticks.js";
import { TURN } from "./window.js";

const MOST_TICKS = 8; // of an axis on which a place is read

export const MARGIN = { left: 84, right: 16, top: 10, bottom: 52 };

export class Plane {
  /** `letters`: how much larger they are than usual, and with them the room for numbers such as −0.025. */
  constructor(window, width, height, letters = 1) {
    this.window = window;
    const left = Math.round(MARGIN.left * letters);
    this.box = [left, MARGIN.top, Math.max(8, width - left - MARGIN.right),
      Math.max(8, height - MARGIN.top - MARGIN.bottom)];
  }

  /** Shares (0 to 1 inside of the window) of a place on the canvas. */
  sharesOf(x, y) {
    const [left, top, width, height] = this.box;
    return [(x - left) / width, 1 - (y - top) / height];
  }

  placeOf(across, up) {
    const [left, top, width, height] = this.box;
    return [left + across * width, top + (1 - up) * height];
  }

  holds(x, y) {
    const [across, up] = this.sharesOf(x, y);
    return across >= 0 && across <= 1 && up >= 0 && up <= 1;
  }

  /** Every image theta + 2 pi n of a start that lies in the window, as [x, y]; theta and velocity are doubles. */
  images(theta, velocity) {
    const { theta: angles, velocity: speeds } = this.window;
    const up = speeds.shareOf(Decimal.from(velocity));
    const first = angles.shareOf(Decimal.from(theta));
    const period = TURN / angles.width;
    const found = [];
    if (up < 0 || up > 1) return found;
    for (let n = Math.ceil(-first / period); first + n * period <= 1; n++) found.push(
      this.placeOf(first + n * period, up));
    return found;
  }
}

/** Those of a first look: degrees, and turns in a shake. */
export const PLAIN = { theta: { words: "angle (degrees)", factor: degrees },
  velocity: { words: "push (turns in one shake)" } };

/** Factors and names of the units in which axes are marked. `pivotFrequency`: rad/s, or null where the scene does not
 * say. */
export function axesOf(units, pivotFrequency) {
  const plain = { words: "angle θ from down (rad)", inPi: true };
  const speed = { words: "velocity dθ/d(ωt)" };
  if (units === "degrees") return { theta: { words: "angle θ from down (degrees)", factor: degrees }, velocity: speed };
  if (units !== "si" || !pivotFrequency) return { theta: plain, velocity: speed };
  return { theta: plain, velocity: { words: "velocity (rad/s)", factor: () => Decimal.from(pivotFrequency) } };
}

export function drawAxes(surface, plane, axes) {
  const [left, top, width, height] = plane.box;
  const { ink } = surface.theme;
  const bottom = top + height;
  const frame = [
    [left, top],
    [left + width, top],
    [left + width, bottom],
    [left, bottom],
    [left, top],
  ];
  surface.line(frame, ink, 1);
  const along = ticksOf(plane.window.theta, Math.max(2, width / 75), axes.theta);
  const up = ticksOf(plane.window.velocity, Math.max(2, height / 60), axes.velocity);
  for (const { share, words } of along.ticks) {
    const x = left + share * width;
    surface.line(
      [
        [x, bottom],
        [x, bottom + 5],
      ],
      ink,
      1,
    );
    surface.text(words, x, bottom + 20, "center");
  }
  for (const { share, words } of up.ticks) {
    const y = bottom - share * height;
    surface.line(
      [
        [left - 5, y],
        [left, y],
      ],
      ink,
      1,
    );
    surface.text(words, left - 8, y + 4, "right");
  }
  const label = (axis, origin) => (origin ? `${axis.words} = ${origin}` : axis.words);
  surface.text(label(axes.theta, along.origin), left + width / 2, bottom + 42, "center");
  surface.text(label(axes.velocity, up.origin), 16, top + height / 2, "center", { turned: true });
}

/** Fine lines through a place (shares of the window), and its values on both axes.
 * @param {any} surface @param {Plane} plane @param {any} axes @param {number[]} place */
export function drawPlace(surface, plane, axes, [across, up]) {
  const [left, top, width, height] = plane.box;
  const [x, y] = plane.placeOf(across, up);
  for (const line of [[[left, y], [left + width, y]], [[x, top], [x, top + height]]]) {
    surface.line(line, "#00000040", 2.4);
    surface.line(line, "#ffffffc0", 1);
  }
  const [angle, speed] = ["theta", "velocity"].map((name) => ticksOf(plane.window[name], MOST_TICKS, axes[name]));
  tag(surface, angle.wordsAt(across), x, top + height + 20, "center", [left, left + width]);
  tag(surface, speed.wordsAt(up), left - 8, y + 4, "right", [0, left]);
}

/** Words on their own ground, which keeps between two edges where it is centred. */
function tag(surface, words, x, y, align, [low, high]) {
  const letters = surface.letters ?? 1;
  const wide = surface.width(words) + 8;
  const middle = align === "center" ? Math.max(low + wide / 2 - 20, Math.min(high - wide / 2 + 12, x))
    : x + 4 - wide / 2;
  surface.rectangle(middle - wide / 2, y - 12 * letters, wide, 16 * letters, surface.theme.ink);
  surface.text(words, middle, y, "center", { colour: surface.theme.paper });
}

/** Points of starts given as [[theta, velocity], ...]. */
export function drawPoints(surface, plane, points, fill, radius, stroke = "#ffffff") {
  for (const [theta, velocity] of points) for (const [x, y] of plane.images(theta, velocity)) surface.circle(x, y,
    radius, fill, stroke);
}

/** A line through starts whose angles go on beyond a turn (not wrapped); every image of it that is seen. */
export function drawLine(surface, plane, points, colour, width) {
  if (points.length < 2) return;
  const { theta, velocity } = plane.window;
  const period = TURN / theta.width;
  const low = theta.low.toNumber();
  const slow = velocity.low.toNumber();
  const shares = points.map(([angle, speed]) => [(angle - low) / theta.width, (speed - slow) / velocity.width]);
  const across = shares.map(([share]) => share);
  const first = Math.ceil(-Math.max(...across) / period);
  const last = Math.min(first + 64, Math.floor((1 - Math.min(...across)) / period));
  surface.clipped(plane.box, () => {
    for (let n = first; n <= last; n++)
      surface.line(
        shares.map(([x, y]) => plane.placeOf(x + n * period, y)),
        colour,
        width,
      );
  });
}
