// Mouse, keys, sliders and buttons; then the first view.

const player = new Player(element("pendulum"), (period) => { page.shown = period; draw(); });

function placeOf(event) {
  const box = map.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}

map.addEventListener("wheel", (event) => {
  const [x, y] = placeOf(event);
  event.preventDefault();
  if (page.plane.holds(x, y)) zoom(event.deltaY < 0 ? 1 / 1.6 : 1.6, page.plane.theta(x), page.plane.velocity(y));
}, { passive: false });

let grip = null; // where the mouse went down, and the window then

map.addEventListener("pointerdown", (event) => {
  const [x, y] = placeOf(event);
  if (event.button !== 0 || !page.plane.holds(x, y)) return;
  grip = { x, y, window: page.window, plane: page.plane, moved: false };
  map.setPointerCapture(event.pointerId);
});

map.addEventListener("pointermove", (event) => {
  const [x, y] = placeOf(event);
  if (!grip || (!grip.moved && Math.hypot(x - grip.x, y - grip.y) < 4)) return;
  grip.moved = true;
  const aside = grip.plane.theta(grip.x) - grip.plane.theta(x), up = grip.plane.velocity(grip.y) - grip.plane.velocity(y);
  const [low, high, slow, fast] = grip.window;
  page.window = [low + aside, high + aside, slow + up, fast + up];
  draw();
});

map.addEventListener("pointerup", () => {
  if (!grip) return;
  const { x, y, moved, window, plane } = grip;
  grip = null;
  if (moved) moveTo(page.window, window);
  else play(plane.theta(x), plane.velocity(y));
});

map.addEventListener("keydown", (event) => {
  const [low, high, slow, fast] = page.window, aside = (high - low) / 8, up = (fast - slow) / 8;
  const moves = { ArrowLeft: [-aside, 0], ArrowRight: [aside, 0], ArrowUp: [0, up], ArrowDown: [0, -up] };
  if (event.key === "+" || event.key === "=") zoomMiddle(1 / 1.6);
  else if (event.key === "-") zoomMiddle(1.6);
  else if (event.key in moves) {
    const [x, y] = moves[event.key];
    moveTo([low + x, high + x, slow + y, fast + y]);
  } else return;
  event.preventDefault();
});

element("zoom-in").onclick = () => zoomMiddle(0.5);
element("zoom-out").onclick = () => zoomMiddle(2);
element("home").onclick = () => moveTo(page.home);
element("back").onclick = () => { if (page.past.length) moveTo(page.past.pop(), null); };
element("method").onchange = computeSoon;
addEventListener("resize", computeSoon);

// A slider from a quarter of the scene's value to four times it, in equal ratios (from -1 to 1 where it is zero), and its number.
function addSlider(name, value) {
  const holder = document.createElement("div"), label = document.createElement("label"), range = document.createElement("input"), number = document.createElement("input");
  holder.className = "slider";
  label.textContent = name.replace(/_/g, " ");
  label.htmlFor = number.id = `value-${name}`;
  Object.assign(range, { type: "range", min: -1, max: 1, step: 0.005, value: 0, id: `slider-${name}` });
  range.setAttribute("aria-label", label.textContent);
  Object.assign(number, { type: "text", inputMode: "decimal", value: String(value) });
  const set = (next) => {
    if (next === value) delete page.pendulum[name];
    else page.pendulum[name] = next;
    page.motion = player.motion = null;
    computeSoon();
  };
  range.oninput = () => {
    const at = Number(range.value), next = value === 0 ? at : value * 4 ** at;
    number.value = at === 0 ? String(value) : next.toPrecision(5);
    set(Number(number.value));
  };
  number.onchange = () => {
    if (number.value.trim() !== "" && Number.isFinite(Number(number.value))) set(Number(number.value));
    else say("error", `${label.textContent}: ${number.value} is not a number`);
  };
  holder.append(label, range, number);
  element("sliders").append(holder);
}

function addOverlay(name, words) {
  const label = document.createElement("label"), box = document.createElement("input");
  Object.assign(box, { type: "checkbox", checked: true, value: name, onchange: draw });
  label.append(box, ` ${words}`);
  element("overlays").append(label);
}

function save(name, content, kind) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type: kind }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// The map with its title above and its legend beside.
function drawPicture(surface, width, height) {
  drawMap(surface, page.window, width, height, layers());
  const rows = [...element("legend").rows];
  rows.forEach((row, i) => {
    surface.rectangle(width + 8, 12 + 20 * i, 13, 13, INK);
    surface.rectangle(width + 9, 13 + 20 * i, 11, 11, row.querySelector(".patch").style.background);
    surface.text(row.dataset.name.replace(" -", " −"), width + 28, 23 + 20 * i, "left");
    surface.text(row.cells[2].textContent, width + 240, 23 + 20 * i, "right");
  });
}

element("save-scene").onclick = async () => {
  try {
    save("view.yaml", (await ask("scene", request())).text, "application/yaml");
  } catch (error) {
    say("error", error.message);
  }
};

element("save-png").onclick = () => {
  const canvas = document.createElement("canvas"), width = map.clientWidth, height = map.clientHeight;
  Object.assign(canvas, { width: 2 * (width + 250), height: 2 * height });
  const context = canvas.getContext("2d");
  context.fillStyle = "#ffffff";
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.scale(2, 2);
  drawPicture(new CanvasSurface(context), width, height);
  canvas.toBlob((blob) => save("view.png", blob));
};

element("save-svg").onclick = () => {
  const surface = new SvgSurface(map.clientWidth + 250, map.clientHeight);
  drawPicture(surface, map.clientWidth, map.clientHeight);
  save("view.svg", surface.toString(), "image/svg+xml");
};

async function begin() {
  const first = await ask("state", {});
  document.title = element("title").textContent = first.title;
  page.home = first.window;
  page.window = first.window;
  page.overlays = first.overlays;
  for (const method of first.methods) element("method").append(new Option(method, method));
  if (first.methods.includes("direct")) element("method").value = "direct";
  addOverlay("attractors", "strobe points of attractors");
  for (const name of Object.keys(first.overlays)) addOverlay(name, name);
  for (const [name, value] of Object.entries(first.sliders)) addSlider(name, value);
  draw();
  compute();
}

begin().catch((error) => say("error", error.message));
