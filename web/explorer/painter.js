// Labels as a texture, colours as a palette: the basins are drawn, moved and scaled by the graphics card.

import { HATCHING } from "./frames.js";
import { DOUBLINGS, heightsOf, lightOf, shadeOfTurns } from "./heights.js";
import { Painter2d } from "./painter2d.js";
import { placementOf } from "./placement.js";

const VERTICES = `#version 300 es
in vec2 corner;
void main() { gl_Position = vec4(corner, 0.0, 1.0); }`;

// A pixel is the mean, in light (about the square of a colour's number), of the cells that it covers. In `cells`:
// label, time until the end is certain, doubt, the other candidate. Cells without a label (255) are hatched where they
// may still get one.
const FRAGMENTS = `#version 300 es
precision highp float;
precision highp int;
uniform sampler2D cells;
uniform sampler2D palette;
uniform vec2 canvas;
uniform vec4 place;
uniform float period;
uniform float shading;
uniform float lightest;
uniform vec2 heights;
uniform float hatching;
out vec4 colour;

vec3 lightOf(ivec2 cell, bool second) {
  vec4 found = texelFetch(cells, cell, 0);
  float label = found.b == 1.0 && second ? found.a : found.r;
  vec3 colour = texelFetch(palette, ivec2(int(label * 255.0 + 0.5), 0), 0).rgb;
  bool dark = mod(floor((gl_FragCoord.x - gl_FragCoord.y) / 4.0), 2.0) == 1.0;
  if (label == 1.0 && dark) colour *= 1.0 - hatching;
  return colour * colour * lightest * (1.0 - shading * clamp((found.g - heights.x) / (heights.y - heights.x), 0.0,
    1.0));
}

void main() {
  vec2 at = (gl_FragCoord.xy / canvas - place.xy) / place.zw;
  at.x -= period * floor(at.x / period);
  if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, vec2(1.0)))) discard;
  ivec2 size = textureSize(cells, 0);
  ivec2 count = clamp(ivec2(vec2(size) / (canvas * place.zw) + 0.5), 1, 4);
  ivec2 first = ivec2(at * vec2(size) - 0.5 * vec2(count - 1));
  bool second = mod(floor((gl_FragCoord.x + gl_FragCoord.y) / 2.0), 2.0) == 1.0;
  vec3 sum = vec3(0.0);
  for (int row = 0; row < count.y; row++)
    for (int column = 0; column < count.x; column++)
      sum += lightOf(clamp(first + ivec2(column, row), ivec2(0), size - 1), second);
  colour = vec4(sqrt(sum / float(count.x * count.y)), 1.0);
}`;

/** A frame of labels as the painters keep it: `cells` holds 4 bytes a cell, rows from the lowest velocity up; `planes`
 * as the program sent them; `palette`: 256 colours of 4 bytes, colour i of label i. */
export function frameOf(header, planes, window, palette) {
  const { rows, columns } = header;
  const cells = new Uint8Array(4 * rows * columns);
  const { labels, settling_time: times, doubt, other, turns } = planes;
  const shades = planes.smooth_time ?? times; // whole periods are terraces, which are gentle enough for a relief
  let doubtful = 0;
  for (let i = 0; i < labels.length; i++) {
    cells[4 * i] = labels[i];
    if (turns) cells[4 * i + 1] = 255 * shadeOfTurns(turns[i]);
    else if (shades) cells[4 * i + 1] = Math.min(255, (255 / DOUBLINGS) * Math.log2(1 + (shades[i] || 0)));
    if (doubt && doubt[i] === 1) cells[4 * i + 2] = 255;
    if (cells[4 * i + 2] === 255) doubtful++;
    if (other) cells[4 * i + 3] = other[i];
  }
  return {
    rows,
    columns,
    level: header.level,
    doubtful: doubt && doubtful,
    times: times ?? shades,
    smooth: planes.smooth_time ?? null,
    labels,
    cells,
    window,
    palette,
    hatched: header.quality === "moving",
    full: header.full,
    texture: null,
  };
}

/** A painter on that canvas: by WebGL where the browser has it. */
export function painterOn(canvas, plain = false) {
  const gl = plain ? null : canvas.getContext("webgl2", { antialias: false, preserveDrawingBuffer: false });
  return gl ? new PainterGl(canvas, gl) : new Painter2d(canvas);
}

class PainterGl {
  constructor(canvas, gl) {
    this.canvas = canvas;
    this.gl = gl;
    this.kind = "webgl";
    this.program = linked(gl);
    gl.useProgram(this.program);
    const corners = new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, corners, gl.STATIC_DRAW);
    const at = gl.getAttribLocation(this.program, "corner");
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, 2, gl.FLOAT, false, 0, 0);
    this.largest = gl.getParameter(gl.MAX_TEXTURE_SIZE);
    this.palette = texture(gl);
    gl.uniform1i(this.uniform("palette"), 1);
  }

  uniform(name) {
    return this.gl.getUniformLocation(this.program, name);
  }

  setPalette(bytes) {
    const { gl } = this;
    if (bytes === this.colours) return;
    this.colours = bytes;
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, this.palette);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
  }

  /** The frames, the last on top, in a window; `shading`: of shadingOf. */
  draw(frames, window, shading) {
    const { gl, canvas } = this;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.uniform2f(this.uniform("canvas"), canvas.width, canvas.height);
    gl.uniform1f(this.uniform("shading"), shading.depth);
    gl.uniform1f(this.uniform("lightest"), lightOf(shading, 0));
    for (const frame of frames) {
      const { place, period } = placementOf(frame, window);
      this.setPalette(frame.palette);
      gl.activeTexture(gl.TEXTURE0);
      gl.bindTexture(gl.TEXTURE_2D, (frame.texture ??= this.upload(frame)));
      gl.uniform4f(this.uniform("place"), ...place);
      gl.uniform1f(this.uniform("period"), period);
      gl.uniform2f(this.uniform("heights"), ...heightsOf(frame, shading));
      gl.uniform1f(this.uniform("hatching"), frame.hatched ? HATCHING : 0);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    }
  }

  upload(frame) {
    const { gl } = this;
    const made = texture(gl);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, frame.columns, frame.rows, 0, gl.RGBA, gl.UNSIGNED_BYTE, frame.cells);
    return made;
  }

  forget(frame) {
    if (frame.texture) this.gl.deleteTexture(frame.texture);
    frame.texture = null;
  }
}

function texture(gl) {
  const made = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, made);
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
  for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
  return made;
}

function linked(gl) {
  const program = gl.createProgram();
  for (const [kind, text] of [
    [gl.VERTEX_SHADER, VERTICES],
    [gl.FRAGMENT_SHADER, FRAGMENTS],
  ]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  return program;
}
