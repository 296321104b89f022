// A view as one HTML file that needs no server: the picture, the list, and a recorded motion of each attractor.

import { asScene, sharesOf } from "./frames.js";
import { rowsOf, shareWords } from "./legend.js";
import { passportWords } from "./passport.js";
import { pictureCanvas, saveText } from "./save.js";
import { signed } from "./ticks.js";

const SAMPLES = 32; // of a recorded motion, a drive period
const [LEAST, MOST] = [6, 40]; // drive periods of it
const DIGITS = 5; // behind the point
const STYLE = `body{font:15px/1.5 system-ui,sans-serif;margin:2em auto;max-width:1300px;padding:0 1em;
  color-scheme:light dark}
main{display:flex;gap:2em;flex-wrap:wrap}img{max-width:100%;flex:1 1 560px;object-fit:contain}aside{flex:1 1 300px}
button{font:inherit;display:block;width:100%;text-align:left;border:0;background:none;color:inherit;padding:.3em;
  cursor:pointer}
button:disabled{cursor:default}#views button{display:inline;width:auto;opacity:.7}canvas{width:100%;height:300px}
.patch{display:inline-block;width:.8em;height:.8em;border:1px solid;margin-right:.6em}
#words{white-space:pre-line;font-size:13px}`;

export async function saveHtml(state, basins) {
  const rows = [];
  for (const row of rowsOf(basins.panes)) rows.push(await recorded(row, basins));
  const picture = pictureCanvas(state, basins).toDataURL("image/png");
  const data = JSON.stringify({ rows, pivotFrequency: state.pivotFrequency }).replace(/</g, "\\u003c");
  const title = state.shownTitle.replace(/&/g, "&amp;").replace(/</g, "&lt;");
  const values = Object.entries(asScene(basins.active.pendulum))
    .map(([name, value]) => `${name}: ${typeof value === "object" ? "…" : value}`);
  const text = `<!doctype html><html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>${title}</title><style>${STYLE}</style></head><body><h1>${title}</h1><p>${values.join(", ").replace(/</g,
  "&lt;")}</p>
<main><img alt="basins of attraction" src="${picture}"><aside><div id="views"></div>
<canvas id="pendulum" role="img" aria-label="the motion"></canvas>
<p id="words"></p><div id="list"></div></aside></main><script>${await bundled("viewer.js")}view(
  ${data});</script></body></html>
`;
  saveText("view.html", text, "text/html");
}

/** A row of the list with a motion of it, where its attractor is known. */
async function recorded(row, { panes, units }) {
  const known = { name: signed(row.name), colour: row.colour, share: row.shares.map(shareWords).join(" / "),
    motion: null, words: "" };
  const pane = panes.find(({ top }) => top && sharesOf(top).some(({ key, strobe }) => key === row.key
    && strobe?.length));
  if (!pane) return known;
  const [theta, velocity] = row.strobe[0];
  const periods = Math.max(LEAST, Math.min(MOST, 2 * (row.period || MOST)));
  const request = { request: "orbit", theta, velocity, periods, samples_per_period: SAMPLES,
    pendulum: asScene(pane.pendulum) };
  const [{ samples, samples_per_period, pivot }, bytes] = await pane.engine.answer(request);
  const numbers = [...new Float64Array(bytes.buffer)].map((number) => Number(number.toFixed(DIGITS)));
  const ending = { period: row.period, settling_time: 0, near_time: 0 };
  const words = signed(passportWords(row, row.shares.find((share) => share !== null), units));
  return { ...known, words, motion: { header: { samples, samples_per_period, pivot }, numbers, ending } };
}

/** A module of the page with those that it imports, as a script that stands alone; what it exports is known by name
 * behind it. */
async function bundled(name) {
  const parts = [];
  const known = new Set();
  const add = async (file) => {
    if (known.has(file)) return;
    known.add(file);
    const text = await (await fetch(file)).text();
    for (const [, other] of text.matchAll(/^import .* from "\.\/(.*)";$/gm)) await add(other);
    const exported = [...text.matchAll(/^export (?:const|class|(?:async )?function\*?) (\w+)/gm)]
      .map(([, word]) => word);
    const body = text
      .replace(/^import \{(.*)\} from "\.\/(.*)";$/gm,
        (_, words, other) => `const {${words.replace(/ as /g, ": ")}} = modules["${other}"];`)
      .replace(/^export /gm, "");
    parts.push(`modules["${file}"] = (() => {\n${body}\nreturn { ${exported.join(", ")} };\n})();`);
  };
  await add(name);
  return `const modules = {};\n${parts.join("\n")}\nconst { view } = modules["${name}"];\n`.replace(/<\/script/g,
    "<\\/script");
}
