// The page itself: what is asked of the server, and what the controls do.

const token = new URLSearchParams(location.search).get("token");
const element = (id) => document.getElementById(id);
const map = element("map");
const page = { window: null, home: null, past: [], pendulum: {}, values: {}, overlays: {}, view: null, image: null, motion: null, shown: 0, order: 0, timer: 0 };

async function ask(name, request) {
  const answer = await fetch(`/${name}`, { method: "POST", headers: { "X-Kapitza-Token": token }, body: JSON.stringify(request) });
  const body = await answer.json();
  if (answer.status === 409) return null; // a newer request has ended this one
  if (!answer.ok) throw new Error(body.error);
  return body;
}

function say(state, words) {
  document.body.dataset.state = state;
  element("status").textContent = words;
}

function request(scale = 1) {
  const [, , width, height] = new Plane(page.window, map.clientWidth, map.clientHeight).box;
  const fit = Math.min(1, 1000 / width, 800 / height) * scale;
  return { window: page.window, width: Math.max(8, Math.round(width * fit)), height: Math.max(8, Math.round(height * fit)),
    method: element("method").value, pendulum: page.pendulum };
}

// What a view is computed by, one after the other: a quick look, the method chosen; before exact labels those by integration.
function steps() {
  const chosen = element("method").value, fine = chosen === "exact" ? "direct" : chosen;
  const list = [{ words: "a quick look ...", scale: 0.25, coarse: true, method: fine }, { words: "computing the labels ...", scale: 1, coarse: false, method: fine }];
  if (chosen === "exact") list.push({ words: "deciding every label ...", scale: 1, coarse: false, method: "exact" });
  return list;
}

// Each step in turn; a later call ends this one.
async function compute() {
  const order = ++page.order, list = steps();
  try {
    for (const step of list) {
      say("computing", step.words);
      const view = await ask("view", { ...request(step.scale), coarse: step.coarse, method: step.method });
      if (!view || order !== page.order) return;
      page.view = view;
      page.image = labelImage(view);
      writeLegend();
      draw();
      if (step === list.at(-1)) say("done", viewWords(view));
    }
  } catch (error) {
    if (order === page.order) say("error", error.message);
  }
}

function viewWords(view) {
  const open = view.undecided === null ? "" : view.undecided === 0 ? ", every label decided" : `, ${view.undecided} undecided`;
  return `${view.width} × ${view.height} starts, method ${view.method}${open}`;
}

function computeSoon() {
  draw();
  page.order++;
  say("moving", "");
  clearTimeout(page.timer);
  page.timer = setTimeout(compute, 180);
}

function layers() {
  const chosen = [...document.querySelectorAll("#overlays input:checked")].map((box) => box.value);
  const moved = Object.keys(page.pendulum).length > 0;
  const motion = page.motion && { theta: page.motion.strobe_theta.slice(0, page.shown + 1), velocity: page.motion.strobe_velocity.slice(0, page.shown + 1) };
  return { view: page.view, image: page.image, attractors: chosen.includes("attractors"), motion,
    overlays: moved ? [] : chosen.filter((name) => name in page.overlays).map((name) => page.overlays[name]) };
}

function draw() {
  const ratio = devicePixelRatio || 1, width = map.clientWidth, height = map.clientHeight;
  if (map.width !== Math.round(width * ratio) || map.height !== Math.round(height * ratio)) {
    map.width = Math.round(width * ratio);
    map.height = Math.round(height * ratio);
  }
  const context = map.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  page.plane = drawMap(new CanvasSurface(context), page.window, width, height, layers());
  const [low, high, slow, fast] = page.window, depth = (page.home[1] - page.home[0]) / (high - low);
  const digits = Math.min(17, 5 + Math.ceil(Math.log10(Math.max(depth, 1)))), text = (value) => String(Number(value.toPrecision(digits))).replace("-", "−");
  element("where").textContent = `Depth ${Number(depth.toPrecision(3))}×. θ ${text(low)} to ${text(high)}, velocity ${text(slow)} to ${text(fast)}`;
  Object.assign(element("where").dataset, { depth, window: JSON.stringify(page.window) });
}

// The windows stay what they can be: at most the whole circle.
function moveTo(window, remembered = page.window) {
  const [low, high, slow, fast] = window, middle = (low + high) / 2, half = Math.min(high - low, TURN) / 2;
  if (!(high > low && fast > slow)) return;
  if (remembered) page.past.push(remembered);
  page.window = high - low > TURN ? [middle - half, middle + half, slow, fast] : [low, high, slow, fast];
  if (page.window[1] - page.window[0] > TURN) page.window[1] = page.window[0] + TURN;
  computeSoon();
}

function zoom(factor, theta, velocity) {
  const [low, high, slow, fast] = page.window;
  moveTo([theta - (theta - low) * factor, theta + (high - theta) * factor, velocity - (velocity - slow) * factor, velocity + (fast - velocity) * factor]);
}

function zoomMiddle(factor) {
  const [low, high, slow, fast] = page.window;
  zoom(factor, (low + high) / 2, (slow + fast) / 2);
}

async function play(theta, velocity) {
  const order = ++page.order;
  clearTimeout(page.timer);
  say("computing", "following the start ...");
  try {
    const answer = await ask("start", { ...request(), theta, velocity });
    if (!answer || order !== page.order) return;
    writeEnding(answer.ending);
    page.motion = answer.motion;
    player.play(answer.motion);
    const complete = page.view && JSON.stringify(page.view.window) === JSON.stringify(page.window) && page.view.width === request().width;
    if (complete) say("done", viewWords(page.view));
    else compute();
  } catch (error) {
    if (order === page.order) say("error", error.message);
  }
}

function writeEnding(ending) {
  const start = `From θ = ${ending.theta.toPrecision(8)}, velocity ${ending.velocity.toPrecision(8)}\n`;
  element("ending").textContent = start + (ending.attractor < 0 ? "not settled" :
    `ends on ${ending.name}, settled after ${ending.settling_time} drive period${ending.settling_time === 1 ? "" : "s"}\n` +
    (ending.decided ? `decided in ${ending.precision === "pairs" ? "pairs of doubles" : `${ending.precision} precision`}`
      : `not decided: ${ending.name} or ${ending.other_name ?? "another"}`));
  element("ending").dataset.ending = JSON.stringify(ending);
}

function shareWords(share) {
  const percent = 100 * share;
  return percent >= 1 || percent === 0 ? `${percent.toFixed(1)} %` : percent >= 0.01 ? `${percent.toFixed(2)} %` : "< 0.01 %";
}

function writeLegend() {
  const rows = page.view.attractors.filter((row) => row.share > 0).sort((a, b) => b.share - a.share);
  if (page.view.unsettled > 0) rows.push({ id: -1, name: "not settled", colour: page.view.unsettled_colour, share: page.view.unsettled });
  element("legend").tBodies[0].replaceChildren(...rows.map((row) => {
    const line = document.createElement("tr"), patch = document.createElement("span");
    patch.className = "patch";
    patch.style.background = row.colour;
    Object.assign(line.dataset, { id: row.id, name: row.name, share: row.share });
    line.insertCell().append(patch);
    line.insertCell().textContent = row.name.replace(" -", " −");
    line.insertCell().textContent = shareWords(row.share);
    return line;
  }));
}
