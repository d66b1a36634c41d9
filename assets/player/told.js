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

// The bodies' names beside their centres, nearest first, none over another.
class Names {
  constructor(take) {
    this.take = take;
    this.canvas = element('names');
  }

  draw(row, camera, isShown) {
    const {canvas} = this, scale = window.devicePixelRatio, pen = canvas.getContext('2d');
    const width = canvas.width = canvas.clientWidth * scale;
    const height = canvas.height = canvas.clientHeight * scale;
    if (!isShown) return;
    pen.font = `${12 * scale}px system-ui, sans-serif`;
    pen.textBaseline = 'middle';
    pen.lineWidth = 3 * scale;
    pen.strokeStyle = 'rgba(255, 255, 255, .85)';
    const taken = [];
    for (const {name, x, y} of this.places(row, camera, width, height)) {
      const box = [x, y - 8 * scale, x + pen.measureText(name).width + 4 * scale, y + 8 * scale];
      if (taken.some((b) => b[0] < box[2] && box[0] < b[2] && b[1] < box[3] && box[1] < b[3])) continue;
      taken.push(box);
      pen.strokeText(name, x, y);
      pen.fillText(name, x, y);
      if (taken.length === 300) return;
    }
  }

  places(row, camera, width, height) {
    const m = camera.toClip, found = [];
    this.take.parts.forEach((part, p) => {
      const at = p * kPart;
      if (!part.name || row[at + 7] === 0) return;
      const c = [0, 1, 3].map((r) => m[r] * row[at] + m[4 + r] * row[at + 1] + m[8 + r] * row[at + 2] +
                                     m[12 + r]);
      if (c[2] <= 0 || Math.abs(c[0]) > c[2] || Math.abs(c[1]) > c[2]) return;
      found.push({name: part.name, depth: c[2], x: (0.5 + 0.5 * c[0] / c[2]) * width,
                  y: (0.5 - 0.5 * c[1] / c[2]) * height});
    });
    return found.sort((a, b) => a.depth - b.depth);
  }
}
