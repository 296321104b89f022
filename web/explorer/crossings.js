// What happens to the motions where a way over the map crosses curves, in words.

const NAMED = 3; // motions of a sentence that names several

/** A sentence on the way from one place of an atlas to another: on the curve that it crosses; where there are several,
 * on what lives at its ends. "" where nothing happens. */
export function happening(atlas, from, to) {
  const crossings = atlas.crossed(from, to);
  if (!crossings.length) return "";
  const [first, ...others] = crossings;
  if (others.length) return compared(atlas, from, to);
  return capital(sentence(atlas, first, changed(atlas, ...beside(first, from, to, 1.5 / atlas.cells))));
}

/** What a place has that another has not, and the other way round. */
function compared(atlas, from, to) {
  const isKnown = (place) => Boolean(atlas.lists[atlas.listAt(place)]);
  if (!isKnown(from) || !isKnown(to)) return "What has changed is not known: a curve of the map is missing";
  const { born, gone } = changed(atlas, from, to);
  const parts = [["New here", born], ["Gone", gone]].filter(([, motions]) => motions.length);
  return parts.map(([word, motions]) => `${word}: ${listed(motions)}`).join(". ");
}

function listed(motions) {
  const words = motions.toSorted((one, other) => one.period - other.period).map(({ name }) => name);
  return words.slice(0, NAMED).join(", ") + (words.length > NAMED ? ` and ${words.length - NAMED} more` : "");
}

/** Places before and behind a crossing of a way, so far from it. */
function beside({ at }, from, to, reach) {
  const way = [to[0] - from[0], to[1] - from[1]];
  const share = reach / Math.hypot(...way);
  return [at - share, at + share].map((part) => way.map((step, i) => Math.max(0, Math.min(1, from[i] + part * step))));
}

/** Motions that a place has more, and less, than another. */
function changed(atlas, from, to) {
  const [before, after] = [from, to]
    .map((place) => new Map(atlas.motionsAt(place).map((motion) => [motion.name, motion])));
  const more = (one, other) => [...one.values()].filter(({ name, count }) => count > (other.get(name)?.count ?? 0));
  return { born: more(after, before), gone: more(before, after) };
}

const family = (name) => /rotation|^inverted|^flutter|^down/.exec(name)?.[0].replace("flutter", "inverted") ?? null;

/** Whether a motion is what branches off on a curve: another curve may lie near. */
function isChild({ kind, period, name }, motion) {
  const [own, other] = [family(name), family(motion.name)];
  const fits = own === other || ((own === null || other === null) && own !== "rotation" && other !== "rotation");
  return motion.name !== name && fits && motion.period === (kind === "symmetry_breaking" ? 1 : 2) * period;
}

function sentence(atlas, { curve, point, into }, { born, gone }) {
  const { name, kind } = curve;
  const child = (into ? gone : born).find((motion) => isChild(curve, motion))?.name;
  const attracts = atlas.supercritical[point] === 1;
  if (kind === "fold") return into ? `${name} is born: a stable and an unstable motion part (fold)`
    : `${name} ends: it meets an unstable motion (fold)`;
  if (kind === "rest_leans") {
    if (into) return `${name} becomes stable`;
    return `${name} is no longer stable: the pendulum leans to a side${child ? ` (${child})` : ""}`;
  }
  const way = kind === "symmetry_breaking" ? "by losing symmetry" : "by period doubling";
  if (into) return attracts ? `${name} is stable again${child ? `; ${child} ends in it` : ""}`
    : `${name} becomes stable`;
  if (!attracts) return `${name} loses its stability ${way}: nothing near it takes over`;
  return child ? `${child} is born: ${name} loses its stability ${way}` : `${name} loses its stability ${way}`;
}

const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);
