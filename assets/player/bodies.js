// Programs of the graphics card, and the bodies: one draw for all that have a geometry in common.

class Program {
  constructor(gl, vertex, fragment, defines = '') {
    this.gl = gl;
    this.program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text.replace('es\n', 'es\n' + defines));
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) {
        throw new Error(gl.getShaderInfoLog(shader));
      }
      gl.attachShader(this.program, shader);
    }
    gl.linkProgram(this.program);
    if (!gl.getProgramParameter(this.program, gl.LINK_STATUS)) {
      throw new Error(gl.getProgramInfoLog(this.program));
    }
    this.places = new Map();
    const many = gl.getProgramParameter(this.program, gl.ACTIVE_UNIFORMS);
    for (let i = 0; i < many; ++i) {
      const {name, type} = gl.getActiveUniform(this.program, i);
      this.places.set(name.replace('[0]', ''), {at: gl.getUniformLocation(this.program, name), type});
    }
  }

  // Whatever of these the shaders ask for.
  use(values) {
    const gl = this.gl;
    gl.useProgram(this.program);
    for (const [name, {at, type}] of this.places) {
      const value = values[name];
      if (value === undefined) continue;
      if (type === gl.FLOAT) gl.uniform1f(at, value);
      else if (type === gl.FLOAT_VEC2) gl.uniform2fv(at, value);
      else if (type === gl.FLOAT_VEC3) gl.uniform3fv(at, value);
      else if (type === gl.FLOAT_VEC4) gl.uniform4fv(at, value);
      else if (type === gl.FLOAT_MAT4) gl.uniformMatrix4fv(at, false, value);
      else gl.uniform1i(at, value);
    }
  }
}

const linear = (c) => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
const linearColor = (c) => [linear(c[0]), linear(c[1]), linear(c[2]), c[3]];

// The edges of triangles, but for those within a flat face; `at` gives a corner's place.
function edgesOf(indices, at) {
  const edges = new Map(), keys = new Map();
  const key = (i) => at(i).map((x) => x.toFixed(5)).join();
  const numberOf = (i) => {
    const text = key(i);
    if (!keys.has(text)) keys.set(text, keys.size);
    return keys.get(text);
  };
  for (let t = 0; t < indices.length; t += 3) {
    const corners = [indices[t], indices[t + 1], indices[t + 2]], places = corners.map(at);
    const normal = cross(subtract(places[1], places[0]), subtract(places[2], places[0]));
    if (norm(normal) === 0) continue;
    for (let k = 0; k < 3; ++k) {
      const a = corners[k], b = corners[(k + 1) % 3], n = [numberOf(a), numberOf(b)];
      const name = n[0] < n[1] ? n.join() : n[1] + ',' + n[0];
      const other = edges.get(name);
      if (!other) edges.set(name, {a, b, normal: unit(normal), flat: false});
      else other.flat = dot(other.normal, unit(normal)) > 0.9999;
    }
  }
  return Uint32Array.from([...edges.values()].filter((e) => !e.flat).flatMap((e) => [e.a, e.b]));
}

const kInstance = 17;  // place, turn, scale, tint, number

class Bodies {
  constructor(gl, take) {
    this.gl = gl;
    this.take = take;
    this.color = new Program(gl, kBodyVertex, kBodyFragment);
    this.caster = new Program(gl, kBodyVertex, kNothing, '#define CASTER\n');
    this.wire = new Program(gl, kBodyVertex, kWireFragment);
    this.number = new Program(gl, kBodyVertex, kNumberFragment);
    this.shapes = take.geometries.map((geometry) => this.upload(geometry));
    this.tints = take.parts.map((part) => linearColor(part.color));
    this.instances = gl.createBuffer();
    this.numbers = new Float32Array(take.parts.length * kInstance);
    this.solid = this.sorted(take.parts.map((_, p) => p).filter((p) => this.tints[p][3] >= 1));
    this.clear = take.parts.map((_, p) => p).filter((p) => this.tints[p][3] < 1);
  }

  sorted(parts) {
    const geometry = (p) => this.take.parts[p].geometry;
    return parts.sort((a, b) => geometry(a) - geometry(b) || a - b);
  }

  upload(geometry) {
    const gl = this.gl, v = geometry.vertices, array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, v, gl.STATIC_DRAW);
    [4, 3, 2].reduce((at, size, place) => {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, 4 * kVertex, 4 * at);
      return at + size;
    }, 0);
    const corner = (i) => [v[i * kVertex], v[i * kVertex + 1] + v[i * kVertex + 3], v[i * kVertex + 2]];
    const indices = gl.createBuffer(), edges = gl.createBuffer(), lines = edgesOf(geometry.indices, corner);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, edges);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, lines, gl.STATIC_DRAW);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, geometry.indices, gl.STATIC_DRAW);
    return {array, indices, edges, count: geometry.indices.length, lines: lines.length};
  }

  // The instances at a frame: solid ones by geometry, then clear ones from the back.
  arrange(row, camera, allClear) {
    const depth = (p) => dot(camera.ahead, row.subarray(p * kPart, p * kPart + 3));
    const solid = allClear ? [] : this.solid;
    const clear = allClear ? [...this.solid, ...this.clear] : [...this.clear];
    clear.sort((a, b) => depth(b) - depth(a));
    this.batches = [];
    let count = 0;
    for (const [parts, isSolid] of [[solid, true], [clear, false]]) {
      for (const p of parts) {
        if (row[p * kPart + 7] === 0) continue;
        this.write(p, row, count);
        const last = this.batches.at(-1), geometry = this.take.parts[p].geometry;
        if (last && last.geometry === geometry && last.isSolid === isSolid) ++last.count;
        else this.batches.push({geometry, isSolid, first: count, count: 1});
        ++count;
      }
    }
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.instances);
    gl.bufferData(gl.ARRAY_BUFFER, this.numbers.subarray(0, count * kInstance), gl.STREAM_DRAW);
  }

  write(p, row, count) {
    const part = this.take.parts[p], n = this.numbers, at = count * kInstance, from = p * kPart;
    const length = row[from + 7];
    n[at] = row[from];
    n[at + 1] = row[from + 1];
    n[at + 2] = row[from + 2];
    n[at + 3] = part.capsule ? length / 2 : 0;
    const size = Math.hypot(row[from + 3], row[from + 4], row[from + 5], row[from + 6]);
    for (let k = 0; k < 4; ++k) n[at + 4 + k] = row[from + 3 + k] / size;
    n[at + 8] = part.x;
    n[at + 9] = part.capsule ? part.x : length;
    n[at + 10] = part.capsule ? part.x : part.z;
    n[at + 11] = part.marked;
    n.set(this.tints[p], at + 12);
    n[at + 16] = p + 1;
  }

  // kind: 'color', 'caster', 'wire' or 'number'
  draw(kind, values, isSolid) {
    const gl = this.gl, isWire = kind === 'wire';
    this[kind].use(values);
    for (const batch of this.batches) {
      if (isSolid !== undefined && batch.isSolid !== isSolid) continue;
      const shape = this.shapes[batch.geometry];
      gl.bindVertexArray(shape.array);
      gl.bindBuffer(gl.ARRAY_BUFFER, this.instances);
      [4, 4, 4, 4, 1].reduce((at, size, i) => {
        gl.enableVertexAttribArray(3 + i);
        gl.vertexAttribPointer(3 + i, size, gl.FLOAT, false, 4 * kInstance,
                               4 * (batch.first * kInstance + at));
        gl.vertexAttribDivisor(3 + i, 1);
        return at + size;
      }, 0);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, isWire ? shape.edges : shape.indices);
      gl.drawElementsInstanced(isWire ? gl.LINES : gl.TRIANGLES, isWire ? shape.lines : shape.count,
                               gl.UNSIGNED_INT, 0, batch.count);
    }
  }
}
