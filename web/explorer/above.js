// What lies over the basins of a pane: boundaries, points, the motion, marks, axes, and the place of the pointer.

import { drawReleases } from "./experiment.js";
import { imagesOf } from "./placement.js";
import { axesOf, drawAxes, drawLine, drawPlace, drawPoints, PLAIN } from "./plane.js";

/** On any surface; `plain`: of a pane, `top`: its last frame or null. */
export function drawOverBasins(surface, plane, plain, state, top) {
  const { motion, bob, marks, cursor, pointed, overlays, skeleton, releases, spread, veil } = plain;
  const isPlain = state.level === "look";
  const letters = surface.letters ?? 1;
  const axes = isPlain ? PLAIN : axesOf(state.units, state.pivotFrequency);
  surface.clipped(plane.box, () => {
    const [x, y, wide, high] = plane.box;
    for (const [left, bottom, width, height] of veil ? imagesOf(veil.frame, plane.window) : [])
      surface.image(veil.canvas, [x + left * wide, y + (1 - bottom - height) * high, width * wide, height * high]);
    for (const { lines = [], points = [] } of [...overlays, ...(skeleton ?? [])]) {
      for (const line of lines) drawLine(surface, plane, line, "#000000", 1);
      drawPoints(surface, plane, points, "#ffffff", 3.6, "#000000");
    }
    if (state.points === "on" && top && !isPlain)
      for (const { strobe } of top.catalogue.attractors)
        drawPoints(surface, plane, strobe, "#1c2127", (strobe.length > 2 ? 3.2 : 4.6) * letters);
    drawReleases(surface, plane, releases);
    if (motion) motion.drawOver(surface, plane, !isPlain, bob);
    if (spread) surface.line(ellipse(plane, ...spread), "#ffffff", 2);
    drawMarks(surface, plane, marks);
  });
  drawAxes(surface, plane, axes);
  if (pointed) drawPlace(surface, plane, axes, pointed);
  if (cursor) {
    drawPlace(surface, plane, axes, cursor);
    surface.circle(...plane.placeOf(...cursor), 5, "transparent", "#1c2127");
  }
}

/** Starts of a dive, [theta, velocity] as Decimals, with a line between them. */
function drawMarks(surface, plane, marks) {
  const { theta, velocity } = plane.window;
  const places = marks.map(([angle, speed]) => plane.placeOf(theta.shareOf(angle), velocity.shareOf(speed)));
  if (places.length > 1) surface.line(places, "#b3261e", 2);
  for (const place of places) surface.circle(...place, 5, "#ffffff", "#b3261e");
}

/** Places of an ellipse about a place, both in shares of the window. */
function ellipse(plane, [across, up], [wide, high]) {
  const angles = Array.from({ length: 49 }, (_, i) => (Math.PI * i) / 24);
  return angles.map((angle) => plane.placeOf(across + wide * Math.cos(angle), up + high * Math.sin(angle)));
}
