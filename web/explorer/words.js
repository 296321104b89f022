// What the page says of motions, in the words of a school book.

import { sharesOf } from "./frames.js";

/** Kinds of motion, as lists of them are ordered, each explained in a line. */
export const EXPLAINED = {
  down: "hangs",
  inverted: "stands upside down",
  "down nodding": "swings about down",
  flutter: "swings from side to side, upside down",
  "inverted nodding": "swings slowly, upside down",
  "rotation +": "turns round, to the left",
  "rotation -": "turns round, to the right",
  "running +": "turns to the left, out of step with the shaking",
  "running -": "turns to the right, out of step with the shaking",
  other: "swings about a place between down and inverted",
  chaotic: "moves for ever, and never repeats itself",
  "not settled": "has not come to an end yet",
};
export const ORDER = Object.keys(EXPLAINED);
const FIRST = ["inverted", "flutter"]; // ends that a window is named by, the first that it has
const WHOLE = {
  inverted: (share) => `can stand: ${share} of all starts`,
  flutter: (share) => `can flutter: ${share} of all starts`,
  none: () => "cannot stand: it falls, or turns",
};
const PART = {
  inverted: (share) => `${share} of the starts shown end inverted`,
  flutter: (share) => `${share} of the starts shown end in flutter`,
  none: () => "None of the starts shown ends inverted",
};

/** The kind of a motion of that name. */
export function kindOf(name) {
  const kind = name.replace(/\d+-nodding/, "nodding").replace(/^(rotation|running) ([+-]).*/, "$1 $2");
  return kind in EXPLAINED ? kind : "other";
}

/** Rows of a list, those of one kind as one, which has the name of the kind and the colour of the commonest of them. */
export function byKind(rows) {
  const kinds = new Map();
  for (const row of rows) {
    const { kind } = row;
    const known = kinds.get(kind);
    const shares = known ? row.shares.map((share, i) => (share === null ? null : known.shares[i] + share)) : row.shares;
    const own = row.shares[0] ?? 0;
    const { colour, most } = known && known.most >= own ? known : { colour: row.colour, most: own };
    const names = row.id < 0 ? {} : { name: kind, key: kind };
    kinds.set(kind, { ...row, ...names, shares, colour, most });
  }
  return [...kinds.values()];
}

/** The end that a frame of basins is named by: {kind, share}; kind "none" where it has neither of FIRST. */
export function verdictOf(frame) {
  const share = (kind) => sharesOf(frame).reduce((sum, row) => sum + (row.kind === kind ? row.share : 0), 0);
  const kind = FIRST.find((one) => share(one) > 0) ?? "none";
  return { kind, share: kind === "none" ? 0 : share(kind) };
}

/** A verdict as a sentence: `whole`: of the first window; `isNew`: the pendulum before had another one. */
export function sentenceOf({ kind, share }, words, whole, isNew) {
  return whole ? `${isNew ? "Now it" : "It"} ${WHOLE[kind](words(share))}.` : `${PART[kind](words(share))}.`;
}
