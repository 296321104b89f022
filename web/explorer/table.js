// A table of releases, as people record them: CSV with a head.

const ANGLES = { theta: 1, angle: 1, theta_rad: 1, angle_rad: 1, theta_deg: Math.PI / 180, angle_deg: Math.PI / 180 };
const SPEEDS = ["velocity", "velocity_rad_per_drive_radian"];
const SI_SPEEDS = ["velocity_rad_per_s", "omega", "velocity_si"];
const ENDS = ["end", "ended", "attractor", "name", "outcome"];
const WORDS = { upright: "inverted", up: "inverted", standing: "inverted", hanging: "down", rotating: "rotation",
  rotates: "rotation" };
const MOST = 5000; // releases

/** [{theta, velocity, end}]: angles in rad from down, velocities in rad per drive radian. `pivotFrequency`: rad/s, or
 * null. Throws words. */
export function releasesOf(text, pivotFrequency) {
  const lines = text.split(/\r?\n/).filter((line) => line.trim() && !line.startsWith("#"));
  const separator = (lines[0] ?? "").includes(";") ? ";" : ",";
  const [head, ...rows] = lines.map((line) => line.split(separator).map((cell) => cell.trim().replace(/^"|"$/g, "")));
  const columnOf = (names) => (head ?? []).findIndex((name) => names.includes(name.toLowerCase()));
  const [angle, speed, fast, end] = [Object.keys(ANGLES), SPEEDS, SI_SPEEDS, ENDS].map(columnOf);
  if (angle < 0 || end < 0)
    throw new Error("a table of releases needs a head with theta (or theta_deg), end, " +
      "and velocity (or velocity_rad_per_s) where it is not 0");
  if (fast >= 0 && !pivotFrequency) throw new Error(
    "velocities in rad/s need a scene that gives the frequency of the pivot");
  if (rows.length > MOST) throw new Error(`the table has ${rows.length} releases; at most ${MOST} are compared`);
  return rows.map((row, i) => {
    const number = (column) => (row[column]?.trim() ? Number(row[column]) : NaN);
    const theta = number(angle) * ANGLES[head[angle].toLowerCase()];
    const velocity = fast >= 0 ? number(fast) / pivotFrequency : speed >= 0 ? number(speed) : 0;
    if (!Number.isFinite(theta) || !Number.isFinite(velocity)) throw new Error(
      `release ${i + 1}: ${row.join(separator)}: is not a number`);
    return { theta, velocity, end: row[end] ?? "" };
  });
}

/** Whether a recorded end is that of the model: the same name, a kind of it, or everyday words for it. */
export function agrees(recorded, name) {
  const said = recorded.toLowerCase().trim();
  const meant = WORDS[said] ?? said;
  const own = name.toLowerCase();
  return own === meant || own.startsWith(`${meant} `) || (meant === "flutter" && own.includes("flutter"));
}
