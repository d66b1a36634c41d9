// Plays the run: time goes on, is dragged, or stands; a frame is drawn when anything changed.
// What stands behind the page's # begins so: #t=1.5&play=0&speed=0.25&show=contacts,names

const kTrailSeconds = 1.5;
const kViews = [['labels', 'labels'], ['masses', 'centres of mass'], ['names', 'names'], ['trails', 'trails'], ['wire', 'edges only'],
                ['clear', 'see through'], ['shadows', 'shadows']];

class Player {
  constructor(take) {
    this.take = take;
    this.frame = 0;
    this.isPlaying = true;
    this.shown = new Set(take.shown);
    this.picked = -1;
    this.canvas = element('view');
    this.scene = new Scene(this.canvas, take);
    this.view = new View(this.canvas, take, () => { this.isStale = true; });
    this.told = new Told(take, (frame) => this.goTo(frame));
    this.words = new Words(take);
    this.moving = take.parts.map((_, p) => p).filter(
        (p) => take.parts[p].name && [0, 1, 2, 3, 4, 5].some((k) => take.poses.step[p * kPart + k] > 0));
    this.readAddress();
    this.addChoices();
    this.listen();
  }

  readAddress() {
    const asked = new URLSearchParams(location.hash.slice(1));
    const number = (word, other) => asked.has(word) && +asked.get(word) >= 0 ? +asked.get(word) : other;
    this.frame = Math.min(number('t', 0) * this.take.fps, this.take.frames - 1);
    this.isPlaying = asked.get('play') !== '0' && this.take.frames > 1;
    this.chooseSpeed(number('speed', this.take.speed));
    if (asked.has('show')) this.shown = new Set(asked.get('show').split(','));
  }

  chooseSpeed(speed) {
    const list = element('speed'), all = [...list.options];
    let chosen = all.find((option) => +option.value === speed);
    if (!chosen) {
      chosen = new Option(`${short(speed)}×`, speed);
      list.add(chosen, all.find((option) => +option.value > speed));
    }
    chosen.selected = true;
  }

  addChoices() {
    const layers = this.take.layers.map(({name}) => [name, name]);
    for (const [word, text] of [...layers, ...kViews]) {
      if (word === 'labels' && this.take.labels.length === 0) continue;
      const label = say(element('show'), 'label', ''), box = document.createElement('input');
      box.type = 'checkbox';
      box.checked = this.shown.has(word);
      box.addEventListener('change', () => {
        this.shown[box.checked ? 'add' : 'delete'](word);
        this.isStale = true;
      });
      label.append(box, ' ' + text);
    }
    for (const name of this.take.missing) {
      say(element('show'), 'small', `${name}: too many to take along`);
    }
  }

  listen() {
    const slider = element('frame');
    slider.max = this.take.frames - 1;
    slider.addEventListener('input', () => this.goTo(+slider.value));
    element('play').addEventListener('click', () => this.play(!this.isPlaying));
    element('reset').addEventListener('click', () => this.view.reset());
    window.addEventListener('resize', () => { this.isStale = true; });
    window.addEventListener('keydown', (event) => this.key(event));
    let down = [0, 0];
    this.canvas.addEventListener('pointerdown', (event) => { down = [event.clientX, event.clientY]; });
    this.canvas.addEventListener('click', (event) => {
      if (Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 4) this.pick(event);
    });
    this.canvas.addEventListener('dblclick', (event) => {
      this.pick(event);
      if (this.picked >= 0) this.view.lookAt(this.placeOf(this.picked, this.frame));
    });
  }

  key(event) {
    if (event.target.tagName === 'SELECT' || event.ctrlKey || event.metaKey || event.altKey) return;
    const steps = {ArrowLeft: -1, ArrowRight: 1, PageUp: -10, PageDown: 10}[event.key];
    if (event.key === ' ') this.play(!this.isPlaying);
    else if (event.key === 'r' || event.key === 'R') this.view.reset();
    else if (event.key === 'Home') this.goTo(0);
    else if (event.key === 'End') this.goTo(this.take.frames - 1);
    else if (steps) this.goTo(Math.round(this.frame) + steps);
    else return;
    event.preventDefault();
  }

  play(isPlaying) {
    if (isPlaying && this.frame >= this.take.frames - 1) this.frame = 0;
    this.isPlaying = isPlaying;
    this.isStale = true;
  }

  goTo(frame) {
    this.frame = Math.max(0, Math.min(this.take.frames - 1, frame));
    this.isPlaying = false;
    this.isStale = true;
  }

  pick(event) {
    const scale = window.devicePixelRatio, {width, height} = this.canvas;
    this.picked = this.scene.partAt(Math.floor(event.offsetX * scale), Math.floor(event.offsetY * scale),
                                    this.view.camera(width, height));
    this.isStale = true;
  }

  placeOf(part, frame) {
    return Array.from(this.take.poses.at(frame).subarray(part * kPart, part * kPart + 3));
  }

  // Called for every picture of the screen, with the seconds since the last.
  advance(seconds) {
    const end = this.take.frames - 1;
    if (this.isPlaying) {
      this.frame += seconds * this.take.fps * +element('speed').value;
      if (this.frame > end && element('loop').checked) this.frame = 0;
      if (this.frame >= end && !element('loop').checked) {
        this.frame = end;
        this.isPlaying = false;
      }
      this.isStale = true;
    }
    if (this.isStale) this.draw();
  }

  draw() {
    this.isStale = false;
    const {canvas, take} = this, scale = window.devicePixelRatio;
    const width = Math.round(canvas.clientWidth * scale), height = Math.round(canvas.clientHeight * scale);
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    this.view.follow(this.frame);
    const camera = this.view.camera(width, height);
    this.addStrokes(camera, height);
    const look = {wire: this.shown.has('wire'), clear: this.shown.has('clear'),
                  shadows: this.shown.has('shadows')};
    this.scene.draw(this.frame, camera, look);
    this.words.clear();
    if (this.shown.has('labels')) this.words.drawLabels(this.frame, camera);
    if (this.shown.has('names')) this.words.drawNames(this.frame, camera);
    this.told.show(this.frame);
    this.tellPicked();
    element('frame').value = this.frame;
    element('play').textContent = this.isPlaying ? 'Stop' : 'Play';
    const told = document.body.dataset;
    told.drawn = +(told.drawn ?? 0) + 1;
    told.frame = this.frame;
  }

  addStrokes(camera, height) {
    const strokes = this.scene.strokes, scale = height / 720, whole = Math.floor(this.frame);
    strokes.clear();
    if (this.shown.has('trails')) for (const part of this.moving) this.addTrail(part);
    else if (this.picked >= 0) this.addTrail(this.picked);
    if (this.shown.has('masses')) {
      for (const part of this.moving) {
        const at = this.placeOf(part, this.frame);
        strokes.add(at, at, [0.08, 0.08, 0.08, 1], 6 * scale);
      }
    }
    for (const layer of this.take.layers) {
      if (!this.shown.has(layer.name)) continue;
      layer.forEach(whole, (from, to, look) => {
        const pen = look.arrow ? 'addArrow' : 'add';
        strokes[pen](from, to, look.color, look.width * scale, camera, height);
      });
    }
  }

  addTrail(part) {
    const {poses, fps, parts} = this.take, now = Math.floor(this.frame);
    const first = Math.max(0, now - Math.round(kTrailSeconds * fps));
    const place = (f) => [0, 1, 2].map((k) => poses.one(part * kPart + k, f));
    let from = place(first);
    for (let f = first + 1; f <= now; ++f) {
      const to = place(f), share = (f - first) / Math.max(1, now - first);
      const color = [...parts[part].color].map((c) => 0.75 * c);
      this.scene.strokes.add(from, to, [color[0], color[1], color[2], share], 2);
      from = to;
    }
  }

  tellPicked() {
    const part = this.take.parts[this.picked];
    if (!part) {
      element('picked').textContent = '';
      return;
    }
    const f = Math.min(Math.floor(this.frame), Math.max(0, this.take.frames - 2));
    const now = this.placeOf(this.picked, f), next = this.placeOf(this.picked, f + 1);
    const speed = norm(subtract(next, now)) * this.take.fps;
    element('picked').textContent = `${part.name || 'a rod'}: at ${now.map(short).join(', ')} m, ` +
                                    `${short(speed)} m/s`;
  }
}

async function main() {
  const player = new Player(await openTake());
  window.player = player;
  let before = performance.now();
  const next = (now) => {
    player.advance(Math.min(0.25, Math.max(0, now - before) / 1000));
    before = now;
    requestAnimationFrame(next);
  };
  player.draw();
  document.body.dataset.state = 'ready';
  requestAnimationFrame(next);
}

main().catch((error) => {
  document.body.dataset.state = 'failed';
  element('failure').textContent = 'This run cannot be shown: ' + error.message;
  element('failure').hidden = false;
  console.error(error);
});
