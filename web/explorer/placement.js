// Where frames lie in the window that is shown.

import { TURN } from "./window.js";

/** Where a frame lies in a window: shares of it, and the period in angle in units of the frame. */
export function placementOf(frame, window) {
  const place = window.placeOf(frame.window);
  const period = TURN / frame.window.theta.width;
  const [rows, columns] = frame.full; // the last cells of a coarse level reach beyond the window
  const wide = (frame.columns * frame.level) / columns;
  const high = (frame.rows * frame.level) / rows;
  const bounded = Math.abs(period - 1) < 1e-9 ? 1 : Math.min(period, 1e30);
  return { place: [place.left, place.bottom, place.width * wide, place.height * high], period: bounded / wide };
}

/** Places, [left, bottom, width, height] as shares of a window, of every image of a frame in it. */
export function imagesOf(frame, window) {
  const { place, period } = placementOf(frame, window);
  const [left, bottom, width, height] = place;
  const step = period * width;
  const found = [];
  for (let n = Math.ceil((-left - width) / step); left + n * step < 1; n++) found.push(
    [left + n * step, bottom, width, height]);
  return found;
}

/** Those of the frames, the last on top, that are seen in a window: what lies under one that fills it is not. */
export function seen(frames, window) {
  const fills = (frame) => {
    const { place, period } = placementOf(frame, window);
    const [left, bottom, width, height] = place;
    const slack = 1e-9;
    return (period <= 1 || (left <= slack && left + width >= 1 - slack)) && bottom <= slack
      && bottom + height >= 1 - slack;
  };
  return frames.slice(Math.max(0, frames.findLastIndex(fills)));
}
