// Shades by the time after which ends are certain.

/** By the word of the state: how much darker late ends are drawn (`depth`, 0 to 1), and whether early and late are those of the frame itself: the
 * times of a picture differ by few periods, which would be one shade of the whole scale. */
const SHADINGS = { relief: { depth: 0.36, own: true }, settling: { depth: 0.8, own: false } };
const FLAT = { depth: 0, own: false };
export const shadingOf = (shade) => SHADINGS[shade] ?? FLAT;
const [EARLY, LATE] = [0.02, 0.9]; // shares of a frame's cells that are as light, or darker than all but these

/** Times, of 0 to 1 as `cells` has them, from which on cells get darker, and at which they are darkest. */
export function heightsOf(frame, { own }) {
  if (!own) return [0, 1];
  return (frame.heights ??= spreadOf(frame.cells));
}

/** Gives a frame the times of a coarser frame of its window, between whose cells they are interpolated. */
export function raise(frame, coarse) {
  const { rows, columns, cells } = frame;
  const between = (i, count, all) => {
    const at = Math.max(0, Math.min(all - 1, ((i + 0.5) * all) / count - 0.5));
    const first = Math.min(Math.floor(at), all - 2);
    return [first, at - first];
  };
  const time = (row, column) => coarse.cells[4 * (row * coarse.columns + column) + 1];
  const across = Array.from({ length: columns }, (_, i) => between(i, columns, coarse.columns));
  for (let row = 0; row < rows; row++) {
    const [below, up] = between(row, rows, coarse.rows);
    for (let column = 0; column < columns; column++) {
      const [left, right] = across[column];
      const low = time(below, left) * (1 - right) + time(below, left + 1) * right;
      const high = time(below + 1, left) * (1 - right) + time(below + 1, left + 1) * right;
      cells[4 * (row * columns + column) + 1] = low * (1 - up) + high * up;
    }
  }
  frame.heights = null;
}

function spreadOf(cells) {
  const counts = new Uint32Array(256);
  let all = 0;
  for (let i = 0; i < cells.length; i += 4)
    if (cells[i] !== 255) {
      counts[cells[i + 1]]++;
      all++;
    }
  const at = (share) => {
    let level = 0;
    for (let sum = counts[0]; sum <= share * all && level < 255;) sum += counts[++level];
    return level / 255;
  };
  const [low, high] = [at(EARLY), at(LATE)];
  return [low, Math.max(high, low + 0.1)];
}
