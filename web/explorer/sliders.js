// A slider and a typed value for every number of the pendulum's mapping.

import { formsOf, isNeutral, isOfDrive } from "./drive.js";

const PARTS = /^\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*(.*?)\s*$/; // a number and its unit, if it has one
const REACH = 4; // a slider goes from the scene's value / 4 to its 4-fold, in equal ratios; from 0 to -1 and 1, finer near 0

/** Number and unit of a value as a scene has it ("0.3", "12 Hz"); null where it is none (words, lists). */
export function numberOf(value) {
  const match = typeof value === "string" ? PARTS.exec(value) : null;
  return match && Number.isFinite(Number(match[1])) ? { number: Number(match[1]), unit: match[2] } : null;
}

export function withUnit(number, unit) {
  return unit ? `${number} ${unit}` : String(number);
}

/** The value at a slider's place, -1 to 1, of a key that the scene gives as `home`. */
export function valueAt(place, home) {
  if (place === 0) return home;
  const { number, unit } = numberOf(home);
  const value = number === 0 ? place ** 3 : number * REACH ** place;
  return withUnit(Number(value.toPrecision(6)), unit);
}

/** The slider's place of a value. */
export function placeOf(value, home) {
  const { number } = numberOf(home);
  const at = numberOf(value)?.number ?? number;
  const place = number === 0 ? Math.cbrt(at) : at / number > 0 ? Math.log(at / number) / Math.log(REACH) : -1;
  return Math.max(-1, Math.min(1, place));
}

/** Fills `holder`; `change(name, text)` hears of each new value, `say(words)` of what is no number. */
export class Sliders {
  constructor(holder, scene, { change, say }) {
    this.scene = scene;
    this.rows = new Map();
    this.drive = newDrive(scene);
    for (const name of Object.keys(scene).filter((key) => numberOf(scene[key]))) {
      const row = newRow(name);
      row.range.oninput = () => change(name, valueAt(Number(row.range.value), scene[name]));
      row.number.onchange = () => {
        if (numberOf(row.number.value)) change(name, row.number.value.trim());
        else say(`${name}: ${row.number.value} is not a number`);
      };
      row.range.ondblclick = () => change(name, scene[name]);
      this.rows.set(name, row);
      (isOfDrive(name) ? this.drive : holder).append(row.element);
    }
    if ("waveform" in scene) this.addForms(change);
    if (this.drive.children.length > 1) holder.append(this.drive);
  }

  /** The list of wave forms. */
  addForms(change) {
    const { element, range, number } = newRow("waveform");
    this.forms = document.createElement("select");
    for (const form of formsOf(this.scene)) this.forms.append(new Option(form, form));
    this.forms.id = number.id;
    this.forms.onchange = () => change("waveform", this.forms.value);
    range.remove();
    number.replaceWith(this.forms);
    this.drive.append(element);
  }

  get names() {
    return [...this.rows.keys()];
  }

  /** Shows the values of a pendulum. */
  show(pendulum) {
    for (const [name, { range, number }] of this.rows) {
      range.value = placeOf(pendulum[name], this.scene[name]);
      if (document.activeElement !== number) number.value = pendulum[name];
      number.title = `the scene has ${this.scene[name]}`;
    }
    if (this.forms) this.forms.value = pendulum.waveform;
  }
}

/** The part for drives beyond the sine, which is open where the scene has one. */
function newDrive(scene) {
  const part = document.createElement("details");
  const summary = document.createElement("summary");
  summary.textContent = "Other drives";
  part.append(summary);
  part.open = Object.keys(scene).some((name) => isOfDrive(name) && !isNeutral(name, scene[name]));
  return part;
}

function newRow(name) {
  const element = document.createElement("div");
  const label = document.createElement("label");
  const range = document.createElement("input");
  const number = document.createElement("input");
  element.className = "slider";
  label.textContent = name.replace(/_/g, " ");
  label.htmlFor = number.id = `value-${name}`;
  Object.assign(range, { type: "range", min: -1, max: 1, step: 0.002, value: 0, id: `slider-${name}` });
  range.setAttribute("aria-label", label.textContent);
  Object.assign(number, { type: "text", inputMode: "decimal", autocomplete: "off" });
  element.append(label, range, number);
  return { element, range, number };
}
