// The painter of browsers without WebGL: each frame becomes a picture of its own, which is drawn where it lies.

import { HATCHING } from "./frames.js";
import { heightsOf, lightOf } from "./heights.js";
import { imagesOf } from "./placement.js";

const UNDRAWN = -1;

export class Painter2d {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.kind = "2d";
    this.largest = 8192;
  }

  draw(frames, window, shading) {
    const { context, canvas } = this;
    context.clearRect(0, 0, canvas.width, canvas.height);
    for (const frame of frames) {
      const picture = this.pictureOf(frame, shading);
      const across = canvas.width, up = canvas.height;
      for (const [left, bottom, width, height] of imagesOf(frame, window)) {
        context.imageSmoothingEnabled = frame.columns > 1.4 * across * width;
        context.drawImage(picture, left * across, (1 - bottom - height) * up, width * across, height * up);
      }
    }
  }

  pictureOf(frame, shading) {
    frame.texture ??= { shading: UNDRAWN, canvas: document.createElement("canvas") };
    const { texture, palette } = frame;
    if (texture.shading !== shading || texture.palette !== palette) this.paint(frame, shading);
    Object.assign(texture, { shading, palette });
    return frame.texture.canvas;
  }

  /** One pixel a cell, the highest velocity on top; doubtful cells in the colours of both candidates, in turn. */
  paint(frame, shading) {
    const { rows, columns, cells, palette } = frame;
    const { canvas } = frame.texture;
    Object.assign(canvas, { width: columns, height: rows });
    const context = canvas.getContext("2d");
    const image = context.createImageData(columns, rows);
    const [low, high] = heightsOf(frame, shading);
    for (let row = 0; row < rows; row++)
      for (let column = 0; column < columns; column++) {
        const cell = 4 * (row * columns + column);
        const pixel = 4 * ((rows - 1 - row) * columns + column);
        const second = cells[cell + 2] === 255 && (row + column) % 2 === 1;
        const label = 4 * (second ? cells[cell + 3] : cells[cell]);
        const dark = frame.hatched && label === 4 * 255 && Math.floor((row + column) / 4) % 2 === 1;
        const late = Math.max(0, Math.min(1, (cells[cell + 1] / 255 - low) / (high - low)));
        const light = lightOf(shading, late) ** 0.5 * (dark ? 1 - HATCHING : 1);
        for (let part = 0; part < 3; part++) image.data[pixel + part] = palette[label + part] * light;
        image.data[pixel + 3] = 255;
      }
    context.putImageData(image, 0, 0);
  }

  forget(frame) {
    frame.texture = null;
  }
}
