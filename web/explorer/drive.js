// Drives beyond the sine: what the page offers of them where the scene does not name them.

/** Their values that change nothing. */
export const NEUTRAL = { tilt: "0", ellipse: "0", torque: "0", waveform: "sine" };
const FORMS = ["sine", "square", "triangle"]; // samples are a scene's own

export const isOfDrive = (name) => name in NEUTRAL;


/** Whether a value is as good as left out. */
export const isNeutral = (name, value) => NEUTRAL[name] === value || (isOfDrive(name) && Number(value) === 0);

/** The forms to choose from, for a scene's pendulum. */
export const formsOf = (pendulum) => [...FORMS, ...(pendulum.samples ? ["samples"] : [])];

/** Samples belong to their own form alone. */
export const isUnused = (name, pendulum) => name === "samples" && pendulum.waveform !== "samples";
