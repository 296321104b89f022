// Wheel, trackpad, mouse and fingers on a canvas, as zooms, moves and clicks.

// Natural logarithm of the zoom per pixel scrolled: a notch of 100 px zooms 1.25 times, 4 px hardly
const WHEEL = 0.0022;
const PINCH = 0.012; // of the trackpad's pinch, which browsers send as a wheel with the control key, in smaller numbers
const LINE = 33; // px of a line, where a wheel counts lines
const PAGE = 400;
const SLOP = 4; // px that a click may move

/** How much a wheel event zooms: by the distance scrolled, never by the number of events. */
export function zoomOfWheel({ deltaY, deltaMode, ctrlKey }) {
  const pixels = deltaY * [1, LINE, PAGE][deltaMode];
  return Math.exp(pixels * (ctrlKey ? PINCH : WHEEL));
}

/** What hands do on `canvas`. `target`: holds(x, y); zoom(factor, x, y), where it has that; move(dx, dy, x, y),
 * click(x, y), hover(x, y) or hover(null) in px; grip() and release() at the beginning and the end of a drag. */
export function listen(canvas, target) {
  const fingers = new Map();
  let dragged = false;
  const placeOf = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };

  canvas.addEventListener(
    "wheel",
    (event) => {
      const [x, y] = placeOf(event);
      if (!target.zoom || !target.holds(x, y)) return;
      event.preventDefault();
      target.zoom(zoomOfWheel(event), x, y);
    },
    { passive: false },
  );

  canvas.addEventListener("pointerdown", (event) => {
    const [x, y] = placeOf(event);
    if (event.button !== 0 || !target.holds(x, y)) return;
    canvas.setPointerCapture(event.pointerId);
    canvas.focus({ preventScroll: true });
    if (fingers.size === 0) dragged = false;
    fingers.set(event.pointerId, { x, y, from: [x, y] });
    target.grip();
  });

  canvas.addEventListener("pointermove", (event) => {
    const [x, y] = placeOf(event);
    const finger = fingers.get(event.pointerId);
    if (!finger) return target.hover(target.holds(x, y) ? [x, y] : null);
    const before = { ...finger };
    if (!dragged && Math.hypot(x - finger.from[0], y - finger.from[1]) < SLOP) return;
    dragged = true;
    Object.assign(finger, { x, y });
    if (fingers.size === 1) target.move(x - before.x, y - before.y, x, y);
    else if (target.zoom) pinch(target, [...fingers].filter(([id]) => id !== event.pointerId)[0][1], before, finger);
  });

  const lift = (event) => {
    const finger = fingers.get(event.pointerId);
    if (!fingers.delete(event.pointerId) || fingers.size > 0) return;
    target.release();
    if (!dragged && event.type === "pointerup") target.click(finger.x, finger.y);
  };
  canvas.addEventListener("pointerup", lift);
  canvas.addEventListener("pointercancel", lift);
  canvas.addEventListener("pointerleave", () => target.hover(null));
}

/** Two fingers: the one moves while the other rests; what lies under both stays under both. */
function pinch(target, other, before, now) {
  const distance = (finger) => Math.max(10, Math.hypot(finger.x - other.x, finger.y - other.y));
  target.move((now.x - before.x) / 2, (now.y - before.y) / 2);
  target.zoom(distance(before) / distance(now), (now.x + other.x) / 2, (now.y + other.y) / 2);
}
