// Dots, lines and arrows over the bodies, with a width in pixels.

const kStroke = 11;  // from, to, colour, width

class Strokes {
  constructor(gl) {
    this.gl = gl;
    this.program = new Program(gl, kStrokeVertex, kStrokeFragment);
    this.numbers = new Float32Array(kStroke * 1024);
    this.count = 0;
    this.array = gl.createVertexArray();
    this.buffer = gl.createBuffer();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    [3, 3, 4, 1].reduce((at, size, place) => {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, 4 * kStroke, 4 * at);
      gl.vertexAttribDivisor(place, 1);
      return at + size;
    }, 0);
  }

  clear() { this.count = 0; }

  add(from, to, color, width) {
    if ((this.count + 1) * kStroke > this.numbers.length) {
      const more = new Float32Array(2 * this.numbers.length);
      more.set(this.numbers);
      this.numbers = more;
    }
    const n = this.numbers, at = this.count++ * kStroke;
    for (let k = 0; k < 3; ++k) {
      n[at + k] = from[k];
      n[at + 3 + k] = to[k];
    }
    for (let k = 0; k < 4; ++k) n[at + 6 + k] = color[k];
    n[at + 10] = width;
  }

  // With a head as long as a few of its widths, in the plane that is seen flat.
  addArrow(from, to, color, width, camera, height) {
    this.add(from, to, color, width);
    const along = subtract(to, from), length = norm(along);
    const side = cross(along, subtract(camera.eye, to)), wide = norm(side);
    if (length === 0 || wide === 0) return;
    const slope = Math.tan(camera.fov * Math.PI / 360);
    const perPixel = 2 * slope * norm(subtract(camera.eye, to)) / height;
    const head = Math.min(4 * width * perPixel, 0.5 * length);
    for (const sign of [1, -1]) {
      const end = to.map((x, k) => x - head * (along[k] / length + sign * 0.45 * side[k] / wide));
      this.add(to, end, color, width);
    }
  }

  draw(camera, width, height) {
    const gl = this.gl;
    if (this.count === 0) return;
    this.program.use({toClip: camera.toClip, size: [width, height]});
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, this.numbers.subarray(0, this.count * kStroke), gl.STREAM_DRAW);
    gl.disable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.count);
    gl.disable(gl.BLEND);
    gl.enable(gl.DEPTH_TEST);
  }
}
