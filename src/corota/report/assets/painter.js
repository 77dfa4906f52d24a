// Filled triangles with colors, and their edges: by WebGL, or on a plain canvas where there is none.

import { color, share } from "./colors.js";

const VERTEX = `#version 300 es
in vec2 position; in float value; uniform vec4 view; out float v;
void main() { gl_Position = vec4(position * view.xy + view.zw, 0.0, 1.0); v = value; }`;
const FRAGMENT = `#version 300 es
precision highp float;
in float v; uniform sampler2D map; uniform vec2 range; uniform float bands; uniform vec4 ink;
out vec4 result;
void main() {
  if (ink.a > 0.0) { result = vec4(ink.rgb * ink.a, ink.a); return; }
  float t = clamp((v - range.x) / (range.y - range.x), 0.0, 1.0);
  if (bands > 0.0) t = (min(floor(t * bands), bands - 1.0) + 0.5) / bands;
  result = vec4(texture(map, vec2((t * 255.0 + 0.5) / 256.0, 0.5)).rgb, 1.0);
}`;

class GlPainter {
  constructor(canvas, gl) {
    this.canvas = canvas;
    this.gl = gl;
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.bindAttribLocation(program, 0, "position");
    gl.bindAttribLocation(program, 1, "value");
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    gl.useProgram(program);
    this.place = Object.fromEntries(
      ["view", "range", "bands", "ink"].map((name) => [name, gl.getUniformLocation(program, name)]),
    );
    this.buffers = [gl.createBuffer(), gl.createBuffer()];
    this.triangles = gl.createBuffer();
    this.edges = gl.createBuffer();
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  topology({ triangles, edges }) {
    const { gl } = this;
    for (const [buffer, data] of [[this.triangles, triangles], [this.edges, edges]]) {
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, data, gl.STATIC_DRAW);
    }
    this.counts = [triangles.length, edges.length];
  }

  data(positions, values) {
    const { gl } = this;
    [[positions, 2], [values, 1]].forEach(([array, width], number) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[number]);
      gl.bufferData(gl.ARRAY_BUFFER, array, gl.DYNAMIC_DRAW);
      gl.enableVertexAttribArray(number);
      gl.vertexAttribPointer(number, width, gl.FLOAT, false, 0, 0);
    });
  }

  colors(table) {
    const { gl } = this;
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, table);
  }

  paint({ camera, range, bands, mesh, meshInk }) {
    const { gl, canvas } = this;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    const { width, height, scale, x, y } = camera;
    const [sx, sy] = [(2 * scale) / width, (2 * scale) / height];
    gl.uniform4f(this.place.view, sx, sy, -x * sx, -y * sy);
    gl.uniform2f(this.place.range, range[0], range[1] > range[0] ? range[1] : range[0] + 1);
    gl.uniform1f(this.place.bands, bands);
    gl.uniform4f(this.place.ink, 0, 0, 0, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.triangles);
    gl.drawElements(gl.TRIANGLES, this.counts[0], gl.UNSIGNED_INT, 0);
    if (!mesh) return;
    gl.uniform4f(this.place.ink, ...meshInk);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.edges);
    gl.drawElements(gl.LINES, this.counts[1], gl.UNSIGNED_INT, 0);
  }
}

/** Colors of the plain canvas, and triangles that it fills at once. */
const PLAIN_BANDS = 48;
const AT_ONCE = 300;

class PlainPainter {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
  }

  topology({ triangles, edges }) {
    Object.assign(this, { triangles, edges });
  }

  data(positions, values) {
    Object.assign(this, { positions, values });
  }

  colors(table) {
    this.table = table;
  }

  paint({ camera, range, bands, mesh, meshInk }) {
    const { context, canvas, positions: p, values: v, triangles: t, edges } = this;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, canvas.width, canvas.height);
    const ratio = canvas.width / camera.width;
    const x = (i) => ratio * camera.toX(p[2 * i]);
    const y = (i) => ratio * camera.toY(p[2 * i + 1]);
    // Triangles of a color go by paths of some hundred: one each takes long, and so does one path.
    const count = bands || PLAIN_BANDS;
    const paths = Array.from({ length: count }, () => ({ path: new Path2D(), held: 0 }));
    const flush = (i) => {
      context.fillStyle = color(this.table, (i + 0.5) / count);
      context.fill(paths[i].path);
      paths[i] = { path: new Path2D(), held: 0 };
    };
    for (let i = 0; i < t.length; i += 3) {
      const [a, b, c] = [t[i], t[i + 1], t[i + 2]];
      const place = Math.floor(share((v[a] + v[b] + v[c]) / 3, range) * count);
      const number = Math.min(place, count - 1);
      const { path } = paths[number];
      path.moveTo(x(a), y(a));
      path.lineTo(x(b), y(b));
      path.lineTo(x(c), y(c));
      path.closePath();
      if (++paths[number].held === AT_ONCE) flush(number);
    }
    for (let i = 0; i < count; i++) if (paths[i].held) flush(i);
    if (!mesh) return;
    const [r, g, b, alpha] = meshInk;
    context.strokeStyle = `rgba(${255 * r},${255 * g},${255 * b},${alpha})`;
    context.beginPath();
    for (let i = 0; i < edges.length; i += 2) {
      context.moveTo(x(edges[i]), y(edges[i]));
      context.lineTo(x(edges[i + 1]), y(edges[i + 1]));
    }
    context.stroke();
  }
}

export function makePainter(canvas) {
  const gl = canvas.getContext("webgl2", { antialias: true, premultipliedAlpha: true });
  return gl ? new GlPainter(canvas, gl) : new PlainPainter(canvas);
}
