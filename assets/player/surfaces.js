// Cloths and skins of soft bodies, whose normals are made from their triangles in every frame.

class Surface {
  constructor(gl, head) {
    this.gl = gl;
    this.head = head;
    this.isCreased = head.edges && !head.grid;  // every triangle has corners of its own
    const count = this.isCreased ? head.indices.length : head.positions;
    this.rows = new Float32Array(9 * count);
    this.areas = new Float32Array(head.indices.length);
    this.tints = new Float32Array([...linearColor(head.color), ...linearColor(head.back)]);
    this.isSolid = head.color[3] >= 1 && head.back[3] >= 1;
    if (this.isCreased) this.findNeighbours();
    this.array = gl.createVertexArray();
    this.buffer = gl.createBuffer();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    for (const place of [0, 1, 2]) {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 36, 12 * place);
    }
    this.indices = gl.createBuffer();
    this.edges = gl.createBuffer();
    const own = this.isCreased ? Uint32Array.from(head.indices, (_, i) => i) : head.indices;
    this.lines = this.isCreased ? Array.from(own).flatMap((i) => [i, i % 3 === 2 ? i - 2 : i + 1])
                                : this.gridLines();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.edges);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, Uint32Array.from(this.lines), gl.STATIC_DRAW);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.indices);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, own, gl.STATIC_DRAW);
  }

  gridLines() {
    const index = this.head.indices;
    return Array.from(index).flatMap((at, i) => [at, index[i % 3 === 2 ? i - 2 : i + 1]]);
  }

  findNeighbours() {
    const around = Array.from({length: this.head.positions}, () => []);
    this.head.indices.forEach((at, i) => around[at].push((i - i % 3) / 3));
    this.around = around;
  }

  // Of each triangle, along its normal and twice as long as its area.
  findAreas(place) {
    const index = this.head.indices;
    for (let i = 0; i < index.length; i += 3) {
      const a = place(index[i]), b = place(index[i + 1]), c = place(index[i + 2]);
      this.areas.set(cross(subtract(b, a), subtract(c, a)), i);
    }
  }

  // The sum over the triangles that face within 60 degrees of the corner's own.
  creasedNormal(corner) {
    const own = (corner - corner % 3) / 3, area = (t) => this.areas.subarray(3 * t, 3 * t + 3);
    let sum = [...area(own)];
    for (const other of this.around[this.head.indices[corner]]) {
      if (other !== own && dot(area(other), area(own)) > 0.5 * norm(area(other)) * norm(area(own))) {
        sum = addScaled(sum, area(other), 1);
      }
    }
    return unit(sum);
  }

  smoothNormals() {
    const normals = new Float32Array(3 * this.head.positions), index = this.head.indices;
    for (let i = 0; i < index.length; ++i) {
      const t = i - i % 3;
      for (let k = 0; k < 3; ++k) normals[3 * index[i] + k] += this.areas[t + k];
    }
    return (i) => unit(normals.subarray(3 * i, 3 * i + 3));
  }

  arrange(row, camera) {
    const gl = this.gl, head = this.head, first = head.first;
    const place = (i) => row.subarray(first + 3 * i, first + 3 * i + 3);
    this.findAreas(place);
    const smooth = this.smoothNormals();
    for (let i = 0; i < this.rows.length / 9; ++i) {
      const node = this.isCreased ? head.indices[i] : i, normal = smooth(node);
      const cell = this.isCreased ? [0, 1, 2].map((k) => k === i % 3 ? 1 : 0)
          : head.grid ? [head.cells[2 * i], head.cells[2 * i + 1], 0.5] : [0.5, 0.5, 0.5];
      this.rows.set(addScaled(place(node), normal, head.offset), 9 * i);
      this.rows.set(this.isCreased ? this.creasedNormal(i) : normal, 9 * i + 3);
      this.rows.set(cell, 9 * i + 6);
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, this.rows, gl.STREAM_DRAW);
    this.depth = dot(camera.ahead, place(0));
  }

  draw(isWire) {
    const gl = this.gl;
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, isWire ? this.edges : this.indices);
    if (isWire) gl.drawElements(gl.LINES, this.lines.length, gl.UNSIGNED_INT, 0);
    else gl.drawElements(gl.TRIANGLES, this.head.indices.length, gl.UNSIGNED_INT, 0);
  }
}

class Surfaces {
  constructor(gl, take) {
    this.gl = gl;
    this.all = take.surfaces.map((head) => new Surface(gl, head));
    const surface = '#define SURFACE\n';
    this.color = new Program(gl, kSurfaceVertex, kBodyFragment, surface);
    this.caster = new Program(gl, kSurfaceVertex, kNothing, '#define CASTER\n');
    this.wire = new Program(gl, kSurfaceVertex, kWireFragment, surface);
  }

  arrange(row, camera) {
    for (const surface of this.all) surface.arrange(row, camera);
    this.all.sort((a, b) => b.depth - a.depth);
  }

  draw(kind, values, isSolid) {
    for (const surface of this.all) {
      if (isSolid !== undefined && surface.isSolid !== isSolid) continue;
      const plain = surface.head.color;
      this[kind].use({...values, tints: surface.tints, plain});
      surface.draw(kind === 'wire');
    }
  }
}
