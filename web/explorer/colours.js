// Colours of the attractors of a view, as figures have them (python/kapitza/style.py). Each attractor keeps its own
// while sliders move.

const UNSETTLED = "#ffffff";
const APART = 0.06; // colours nearer than this in OKLab cannot be told apart in a fine mixture
const TURNS = [0, 30, -30, 60, -60, 90, -90, 120, -120, 150, -150, 180]; // degrees of hue
const LIGHTER = [0, -0.12, 0.12, -0.24];
const TO_CONES = [
  [0.4122214708, 0.5363325363, 0.0514459929],
  [0.2119034982, 0.6806995451, 0.1073969566],
  [0.0883024619, 0.2817188376, 0.6299787005],
];
const TO_LAB = [
  [0.2104542553, 0.7936177850, -0.0040720468],
  [1.9779984951, -2.4285922050, 0.4505937099],
  [0.0259040371, 0.7827717662, -0.8086757660],
];

/** The rows of a catalogue, each with its `colour`. If `kept` ones would look like new ones, all are chosen anew. */
export function colouredRows(rows, kinds, kept = new Map()) {
  const found = coloursOf(rows, kinds);
  const names = rows.map(({ track, kind }) => `${track} ${kind}`);
  let chosen = names.map((name, i) => kept.get(name) ?? found[i]);
  if (new Set(chosen).size < new Set(found).size) chosen = found;
  names.forEach((name, i) => kept.set(name, chosen[i]));
  return rows.map((row, i) => ({ ...row, colour: chosen[i] }));
}

const isSecond = ({ id, mirror }) => mirror !== -1 && mirror < id;

function coloursOf(rows, kinds) {
  const rank = (row) => [row.period, Math.abs(row.winding), Number(isSecond(row)), row.id];
  const before = (one, other) => rank(one).map((value, i) => value - rank(other)[i]).find((step) => step) ?? 0;
  const chosen = rows.map((row) => ownColour(row, kinds));
  const taken = [labOf(UNSETTLED)];
  for (const { id } of [...rows].sort(before)) {
    const all = [chosen[id], ...variants(chosen[id])];
    const room = all.map((colour) => Math.min(...taken.map((place) => distance(place, labOf(colour)))));
    const first = room.findIndex((space) => space >= APART);
    chosen[id] = all[first < 0 ? room.indexOf(Math.max(...room)) : first];
    taken.push(labOf(chosen[id]));
  }
  return chosen;
}

function ownColour(row, kinds) {
  const { kind, period, winding } = row;
  const base = kinds[kind] ?? UNSETTLED;
  if (kind.startsWith("rotation")) {
    const speed = Math.abs(winding) / period;
    const repeats = divisor(Math.abs(winding), period);
    return shade(base, (speed <= 1 ? 0.5 * (1 - speed) : -0.5 * (1 - 1 / speed)) + 0.4 * (1 - 1 / repeats));
  }
  const nodding = kind.endsWith(" nodding") ? (period > 1 ? 0.55 * (1 - 2 / period) : 0.6) : 0;
  return shade(base, (isSecond(row) && winding === 0 ? -0.3 : 0) + nodding);
}

const divisor = (a, b) => (b ? divisor(b, a % b) : a);
const rgbOf = (colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16) / 255);
const halfEven = (x) => (x % 1 === 0.5 && Math.floor(x) % 2 === 0 ? Math.floor(x) : Math.round(x));
const hexOf = (rgb) => `#${rgb.map((part) => halfEven(255 * part).toString(16).padStart(2, "0")).join("")}`;
const times = (matrix, place) => matrix.map((row) => row.reduce((sum, part, i) => sum + part * place[i], 0));
const distance = (one, other) => Math.hypot(...one.map((part, i) => part - other[i]));

/** The colour moved towards white, or black where `lighter` < 0. */
function shade(colour, lighter) {
  const target = lighter > 0 ? 1 : 0;
  return hexOf(rgbOf(colour).map((part) => part + Math.abs(lighter) * (target - part)));
}

/** Lightness, and two numbers of hue, of B. Ottosson's OKLab (2020). */
function labOf(colour) {
  const linear = rgbOf(colour).map((part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4));
  return times(TO_LAB, times(TO_CONES, linear).map(Math.cbrt));
}

function fromLab(place) {
  const linear = times(inverse(TO_CONES), times(inverse(TO_LAB), place).map((cone) => cone ** 3));
  const clipped = linear.map((part) => Math.min(1, Math.max(0, part)));
  return hexOf(clipped.map((part) => (part <= 0.0031308 ? 12.92 * part : 1.055 * part ** (1 / 2.4) - 0.055)));
}

function inverse(m) {
  const at = (i, j) => m[i % 3][j % 3];
  const minor = (i, j) => at(i + 1, j + 1) * at(i + 2, j + 2) - at(i + 1, j + 2) * at(i + 2, j + 1);
  const whole = m[0].reduce((sum, part, j) => sum + part * minor(0, j), 0);
  return m.map((_, i) => m.map((__, j) => minor(j, i) / whole));
}

/** Other hues and lightnesses of a colour, the nearest hues first; never paler than is seen. */
function variants(colour) {
  const [lightness, a, b] = labOf(colour);
  const [chroma, hue] = [Math.max(Math.hypot(a, b), 0.09), Math.atan2(b, a)];
  return TURNS.flatMap((degrees) =>
    LIGHTER.map((lighter) => {
      const angle = hue + (degrees * Math.PI) / 180;
      const seen = Math.min(0.88, Math.max(0.3, lightness + lighter));
      return fromLab([seen, chroma * Math.cos(angle), chroma * Math.sin(angle)]);
    }),
  );
}
