// What the page tells in words and curves beside the picture.

const element = (id) => document.getElementById(id);

function say(parent, tag, text) {
  const child = document.createElement(tag);
  child.textContent = text;
  parent.append(child);
  return child;
}

// Four digits, and never a power of ten where there is no need.
function short(number) {
  const size = Math.abs(number);
  return size === 0 || (size >= 1e-3 && size < 1e6) ? String(+number.toPrecision(4))
                                                   : number.toExponential(2);
}

const kEnergies = [['total', '#1c2024'], ['kinetic', '#d55e00'], ['potential', '#0072b2']];

class Told {
  constructor(take, goTo) {
    this.take = take;
    element('description').textContent = take.description;
    element('about').textContent = take.about;
    this.cells = new Map();
    const rows = [['total', 'energy', 'J'], ['contacts', 'contacts', ''], ['overlap', 'overlap', 'm']];
    for (const [metric, word, unit] of rows) {
      const column = take.metrics.indexOf(metric);
      if (column < 0) continue;
      const row = say(element('measured'), 'tr', '');
      say(row, 'td', word);
      this.cells.set(column, [say(row, 'td', ''), unit]);
    }
    this.canvas = element('energy');
    this.canvas.addEventListener('click', (event) => {
      goTo(event.offsetX / this.canvas.clientWidth * (take.frames - 1));
    });
  }

  show(frame) {
    const {take} = this, whole = Math.floor(frame);
    for (const [column, [cell, unit]] of this.cells) {
      const value = take.measured.one(column, whole);
      const text = take.metrics[column] === 'contacts' ? String(Math.round(value)) : short(value);
      cell.textContent = `${text} ${unit}`;
    }
    const last = (take.frames - 1) / take.fps;
    element('time').textContent = `${(frame / take.fps).toFixed(2)} of ${last.toFixed(2)} s`;
    this.drawEnergy(frame);
  }

  drawEnergy(frame) {
    const {canvas, take} = this, scale = window.devicePixelRatio;
    const width = canvas.width = canvas.clientWidth * scale;
    const height = canvas.height = canvas.clientHeight * scale;
    const pen = canvas.getContext('2d');
    this.curves ??= this.energies();
    if (!this.curves || width === 0) return;
    const {low, high, rows} = this.curves, last = Math.max(1, take.frames - 1);
    const above = 16 * scale;  // of the words
    const y = (value) => height - 2 - (height - 4 - above) * (value - low) / (high - low);
    pen.lineWidth = 1.5 * scale;
    for (const [values, color] of rows) {
      pen.strokeStyle = color;
      pen.beginPath();
      values.forEach((value, f) => pen.lineTo(f / last * width, y(value)));
      pen.stroke();
    }
    pen.strokeStyle = '#60676e';
    pen.lineWidth = scale;
    pen.strokeRect(frame / last * width, above, 0, height);
    pen.font = `${11 * scale}px system-ui, sans-serif`;
    let x = 2 * scale;
    for (const [name, color] of kEnergies) {
      pen.fillStyle = color;
      pen.fillText(name, x, 10 * scale);
      x += pen.measureText(name + '  ').width;
    }
  }

  energies() {
    const {take} = this;
    const rows = kEnergies.map(([name, color]) => {
      const column = take.metrics.indexOf(name);
      return [Array.from({length: take.frames}, (_, f) => take.measured.one(column, f)), color];
    });
    const all = rows.flatMap(([values]) => values);
    const low = all.reduce((a, b) => Math.min(a, b)), high = all.reduce((a, b) => Math.max(a, b));
    return high > low ? {low, high, rows} : null;
  }
}

// Where a place of the world is seen on a canvas; null: nowhere.
function seen(at, camera, {width, height}) {
  const m = camera.toClip;
  const [x, y, w] = [0, 1, 3].map((r) => m[r] * at[0] + m[4 + r] * at[1] + m[8 + r] * at[2] + m[12 + r]);
  if (w <= 0 || Math.abs(x) > w || Math.abs(y) > w) return null;
  return {depth: w, x: (0.5 + 0.5 * x / w) * width, y: (0.5 - 0.5 * y / w) * height};
}

// Over the picture: the scene's labels, and the bodies' names beside their centres.
class Words {
  constructor(take) {
    this.take = take;
    this.canvas = element('names');
    this.pen = this.canvas.getContext('2d');
  }

  clear() {
    const {canvas, pen} = this, scale = window.devicePixelRatio;
    canvas.width = canvas.clientWidth * scale;
    canvas.height = canvas.clientHeight * scale;
    pen.lineJoin = 'round';
    pen.strokeStyle = 'rgba(255, 255, 255, .85)';
    pen.fillStyle = '#1a1a1a';
  }

  write(words, x, y) {
    this.pen.strokeText(words, x, y);
    this.pen.fillText(words, x, y);
  }

  // As render/overlay.cpp and render/canvas.cpp set them.
  drawLabels(frame, camera) {
    const {take, canvas, pen} = this, scale = canvas.height / 720;
    const now = take.labelPlaces.at(frame);
    take.labels.forEach((label, i) => {
      const isShown = take.labelPlaces.one(i * kLabel + 3, Math.floor(frame)) > 0.5;
      const at = isShown && seen(now.subarray(i * kLabel, i * kLabel + 3), camera, canvas);
      if (!at) return;
      let x = at.x + scale * label.offset[0];
      const y = at.y + scale * label.offset[1], line = scale * label.size;
      for (const {words, level, slanted} of label.runs) {
        const size = 0.86 * line * (level === 0 ? 1 : 0.72);  // of a line of DejaVu Sans
        pen.font = `${slanted ? 'italic ' : ''}${size}px "DejaVu Sans", system-ui, sans-serif`;
        pen.lineWidth = 0.2 * size;
        pen.textBaseline = 'alphabetic';
        this.write(words, x, y - line * (level > 0 ? 0.3 : 0.16 * level));
        x += pen.measureText(words).width;
      }
    });
  }

  // The nearest first, none over another.
  drawNames(frame, camera) {
    const {pen} = this, scale = window.devicePixelRatio;
    pen.font = `${12 * scale}px system-ui, sans-serif`;
    pen.textBaseline = 'middle';
    pen.lineWidth = 3 * scale;
    const taken = [];
    for (const {name, x, y} of this.places(frame, camera)) {
      const box = [x, y - 8 * scale, x + pen.measureText(name).width + 4 * scale, y + 8 * scale];
      if (taken.some((b) => b[0] < box[2] && box[0] < b[2] && b[1] < box[3] && box[1] < b[3])) continue;
      taken.push(box);
      this.write(name, x, y);
      if (taken.length === 300) return;
    }
  }

  places(frame, camera) {
    const row = this.take.poses.at(frame), found = [];
    this.take.parts.forEach((part, p) => {
      const at = p * kPart;
      if (!part.name || row[at + 7] === 0) return;
      const place = seen(row.subarray(at, at + 3), camera, this.canvas);
      if (place) found.push({name: part.name, ...place});
    });
    return found.sort((a, b) => a.depth - b.depth);
  }
}
