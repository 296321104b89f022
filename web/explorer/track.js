// The track of a slider: what a start at rest near inverted does along its values.

import { kindOf } from "./backdrop.js";
import { asScene } from "./frames.js";
import { numberOf, placeOf, valueAt, withUnit } from "./values.js";

const CELLS = 400; // values of a track
const BESIDE = 1e-6; // part by which the second row of its chart differs: a chart has two rows at least
const LEAST = 0.025; // of a track, from which on a stretch has a word
const LETTER = 8.7; // px, about
const DIGITS = 2; // of the value from which on it holds: where a stretch begins depends a little on the start
const WORDS = { inverted: "stands", flutter: "flutters", "inverted nodding": "flutters", "rotation +": "turns" };
const COLOURS = { stands: "inverted", flutters: "flutter", turns: "rotation +", falls: "down" }; // kinds of motion

/** An axis of a chart, from one value of a scene to another. */
const axis = (parameter, low, high, count) => {
  const [min, max] = [low, high].map(({ number, unit }) => (unit ? withUnit(number, unit) : number));
  return { parameter, min, max, count };
};

/** Stretches of the slider of a key, {from, to, words, number}, places from 0 to 1; null where another request has
 * ended this one. Throws the program's words where it draws no chart of the pendulum. */
export async function stretchesOf(engine, name, pendulum, home) {
  const other = Object.keys(pendulum).find((key) => key !== name && numberOf(pendulum[key])?.number > 0);
  const [low, high] = [-1, 1].map((place) => numberOf(valueAt(place, home)));
  if (!other || !(low.number < high.number)) return [];
  const beside = numberOf(pendulum[other]);
  const y = axis(other, beside, { ...beside, number: beside.number * (1 + BESIDE) }, 2);
  const request = { request: "chart", pendulum: asScene(pendulum), x: axis(name, low, high, CELLS), y };
  const [header, bytes] = await engine.answer(request);
  if (header.answer !== "chart") return null;
  const found = [];
  for (let i = 0; i < CELLS; i++) {
    const words = WORDS[kindOf(bytes[i], bytes[2 * CELLS + i])] ?? "falls";
    const number = low.number + (i * (high.number - low.number)) / CELLS;
    if (found.at(-1)?.words !== words) found.push(
      { words, number, from: (1 + placeOf(withUnit(number, low.unit), home)) / 2 });
  }
  return found.map((one, i) => ({ ...one, to: found[i + 1]?.from ?? 1 }));
}

/** Colours a slider by its stretches, and writes their words under it: each where its stretch begins, or behind the
 * word before. */
export function drawTrack({ range, marks }, stretches) {
  const parts = stretches.map(({ words, from, to }) => `var(--${idOf(COLOURS[words])}) ${100 * from}% ${100 * to}%`);
  range.style.setProperty("--track", parts.length ? `linear-gradient(to right, ${parts.join(", ")})` : "none");
  marks.replaceChildren();
  let end = 0;
  for (const { words, number, from, to } of stretches) {
    const left = Math.max(from * marks.clientWidth, end);
    const wideOf = (text) => LETTER * (text.length + 1);
    const fits = (text) => left + wideOf(text) <= marks.clientWidth + LETTER;
    const text = [from > 0 ? `${words} ${Number(number.toPrecision(DIGITS))}` : words, words].find(fits);
    if (to - from < LEAST || left > to * marks.clientWidth || !text) continue;
    const mark = Object.assign(document.createElement("span"), { textContent: text });
    mark.style.left = `${left}px`;
    marks.append(mark);
    end = left + wideOf(text);
  }
}

/** The name of the colour of a kind, as style sheets have it. */
export const idOf = (kind) => kind.replace(" +", "-left").replace(" -", "-right").replaceAll(" ", "-");
