// Reads the run that stands in this page, as app/take/numbers.h lays it out.

class Reader {
  constructor(bytes) {
    this.buffer = bytes.buffer;
    this.at = 0;
  }

  // Every array begins at a whole four.
  array(Type, count) {
    const found = new Type(this.buffer, this.at, count);
    this.at += Math.ceil(found.byteLength / 4) * 4;
    return found;
  }

  floats(count) { return this.array(Float32Array, count); }
  whole(count) { return this.array(Uint32Array, count); }

  // 16 bits each: all low bytes, then all high ones; unfolded, still differences.
  differences(count) {
    const bytes = this.array(Uint8Array, 2 * count);
    const numbers = new Uint16Array(count);
    for (let i = 0; i < count; ++i) {
      const folded = bytes[i] | bytes[count + i] << 8;
      numbers[i] = folded & 1 ? ~(folded >> 1) : folded >> 1;
    }
    return numbers;
  }
}

// Columns of numbers over the frames; only those that change have a number in each.
class Tracks {
  constructor(reader, columns, frames) {
    this.frames = frames;
    this.least = reader.floats(columns);
    this.step = reader.floats(columns);
    this.moving = [];
    this.slots = new Int32Array(columns).fill(-1);  // of each column among those that change
    for (let c = 0; c < columns; ++c) {
      if (this.step[c] > 0) this.slots[c] = this.moving.push(c) - 1;
    }
    const many = this.moving.length, differences = reader.differences(many * frames);
    this.values = new Uint16Array(many * frames);
    for (let m = 0; m < many; ++m) {
      for (let f = 0, value = 0; f < frames; ++f) {
        value = value + differences[m * frames + f] & 65535;
        this.values[f * many + m] = value;
      }
    }
    this.now = new Float32Array(this.least);
  }

  // The row between frames; the same array every time.
  at(frame) {
    const first = Math.min(Math.floor(frame), this.frames - 1);
    const second = Math.min(first + 1, this.frames - 1), share = frame - first;
    const many = this.moving.length, a = first * many, b = second * many;
    for (let m = 0; m < many; ++m) {
      const c = this.moving[m], v = this.values;
      this.now[c] = this.least[c] + this.step[c] * (v[a + m] + (v[b + m] - v[a + m]) * share);
    }
    return this.now;
  }

  one(column, frame) {
    const m = this.slots[column];
    const steps = m < 0 ? 0 : this.values[frame * this.moving.length + m];
    return this.least[column] + this.step[column] * steps;
  }
}

// Strokes of an overlay, of which every frame has as many as it has.
class Layer {
  constructor(reader, head, frames) {
    this.name = head.name;
    this.looks = head.styles;
    const counts = reader.whole(frames);
    this.first = [0];
    for (const count of counts) this.first.push(this.first.at(-1) + count);
    this.styles = reader.array(Uint8Array, head.strokes);
    this.scale = reader.floats(6);
    this.columns = [];
    for (let k = 0; k < 6; ++k) {
      this.columns.push(this.summed(reader.differences(head.strokes)));
    }
  }

  // Each is a difference from the stroke with its number in the frame before, or the last that had one.
  summed(numbers) {
    const before = [];
    for (let f = 0; f + 1 < this.first.length; ++f) {
      for (let i = this.first[f], k = 0; i < this.first[f + 1]; ++i, ++k) {
        numbers[i] += before[k] ?? 0;
        before[k] = numbers[i];
      }
    }
    return numbers;
  }

  forEach(frame, visit) {
    const s = this.scale, from = [0, 0, 0], to = [0, 0, 0];
    for (let i = this.first[frame]; i < this.first[frame + 1]; ++i) {
      for (let k = 0; k < 3; ++k) {
        const steps = this.columns[k][i];
        from[k] = s[2 * k] + s[2 * k + 1] * steps;
        to[k] = s[2 * k] + s[2 * k + 1] * (steps + this.columns[k + 3][i] & 65535);
      }
      visit(from, to, this.looks[this.styles[i]]);
    }
  }
}

async function inflated(text) {
  if (typeof DecompressionStream === 'undefined') {
    throw new Error('this browser is too old: it has no DecompressionStream ' +
                    '(Chrome 103, Firefox 113 and Safari 16.4 have it)');
  }
  const letters = atob(text), bytes = new Uint8Array(letters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = letters.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

const kPart = 8, kPartLook = 9, kVertex = 9, kCamera = 10, kLabel = 4;

function readParts(reader, take) {
  const rows = reader.floats(take.names.length * kPartLook);
  take.parts = take.names.map((name, p) => {
    const row = rows.subarray(p * kPartLook, (p + 1) * kPartLook);
    return {name, geometry: row[0], capsule: row[1] > 0, x: row[2], z: row[3],
            color: row.subarray(4, 8), marked: row[8]};
  });
  for (const geometry of take.geometries) {
    geometry.vertices = reader.floats(geometry.vertices * kVertex);
    geometry.indices = reader.whole(geometry.indices);
  }
}

async function openTake() {
  const take = JSON.parse(document.getElementById('take').textContent);
  const reader = new Reader(await inflated(document.getElementById('numbers').textContent.trim()));
  readParts(reader, take);
  take.poses = new Tracks(reader, take.parts.length * kPart, take.frames);
  let columns = 0;
  for (const surface of take.surfaces) {
    surface.first = columns;
    columns += 3 * surface.positions;
    surface.indices = reader.whole(surface.indices);
    surface.cells = reader.floats(surface.grid ? 2 * surface.positions : 0);
  }
  take.positions = new Tracks(reader, columns, take.frames);
  take.cameras = new Tracks(reader, kCamera, take.frames);
  take.labelPlaces = new Tracks(reader, take.labels.length * kLabel, take.frames);
  take.measured = new Tracks(reader, take.metrics.length, take.frames);
  take.layers = take.layers.map((head) => new Layer(reader, head, take.frames));
  return take;
}
