// Where it is looked at from: the scene's own camera, until a hand turns it.

const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const addScaled = (a, b, s) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) =>
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = (a) => Math.hypot(a[0], a[1], a[2]);
const unit = (a) => { const n = norm(a); return n > 0 ? a.map((x) => x / n) : [0, 1, 0]; };

// Unit vectors to the right and up as seen, along `ahead`; looking straight down, north is up.
function axesOf(ahead) {
  const up = Math.abs(ahead[1]) > 0.99999 ? [0, 0, -1] : [0, 1, 0];
  const right = unit(cross(ahead, up));
  return {right, up: cross(right, ahead)};
}

// Column by column, as WebGL takes it.
function clipMatrix(eye, ahead, slope, aspect, near, far) {
  const {right, up} = axesOf(ahead);
  const rows = [right.map((x) => x / (slope * aspect)), up.map((x) => x / slope),
                ahead.map((x) => x * (far + near) / (far - near)), ahead];
  const m = new Float32Array(16);
  rows.forEach((row, r) => {
    for (let c = 0; c < 3; ++c) m[4 * c + r] = row[c];
    m[12 + r] = -dot(row, eye);
  });
  m[14] -= 2 * far * near / (far - near);
  return m;
}

class View {
  constructor(canvas, take, changed) {
    this.canvas = canvas;
    this.take = take;
    this.changed = changed;
    this.isFree = false;
    this.eye = [0, 0, 1];
    this.target = [0, 0, 0];
    this.fov = 35;
    this.focus = take.focus.center;
    this.followed = this.followedAt(0);
    this.pointers = new Map();
    this.listen();
  }

  // The middle of what the scene's camera follows.
  followedAt(frame) { return Array.from(this.take.cameras.at(frame).subarray(7, 10)); }

  // The scene's camera at a frame; where a hand has taken it, it goes along with what is followed.
  follow(frame) {
    const now = this.followedAt(frame), moved = subtract(now, this.followed);
    this.followed = now;
    this.focus = addScaled(this.focus, moved, 1);
    if (this.isFree) {
      this.target = addScaled(this.target, moved, 1);
      this.eye = addScaled(this.eye, moved, 1);
    } else {
      const row = this.take.cameras.at(frame);
      this.eye = Array.from(row.subarray(0, 3));
      this.target = Array.from(row.subarray(3, 6));
      this.fov = row[6];
    }
  }

  // As drawn on a canvas of this size; what fits a wide picture fits a narrow one too.
  camera(width, height) {
    const aspect = width / height, wide = 16 / 9;
    const slope = Math.tan(this.fov * Math.PI / 360) * Math.max(1, wide / aspect);
    const ahead = unit(subtract(this.target, this.eye));
    const depth = dot(ahead, subtract(this.focus, this.eye));
    const far = Math.max(depth + 30 * this.take.focus.radius, norm(subtract(this.target, this.eye)) * 3);
    const near = Math.max(0.02 * norm(subtract(this.target, this.eye)), far * 5e-5);
    const fov = Math.atan(slope) * 360 / Math.PI;
    return {eye: this.eye, ahead, fov, focus: this.focus, toClip: clipMatrix(this.eye, ahead, slope, aspect, near, far)};
  }

  reset() {
    this.isFree = false;
    this.changed();
  }

  takeOver() {
    this.isFree = true;
    this.changed();
  }

  turn(dx, dy) {
    const away = subtract(this.eye, this.target), distance = norm(away);
    const yaw = Math.atan2(away[0], away[2]) - dx;
    const limit = 0.4999 * Math.PI;
    const pitch = Math.asin(Math.max(-1, Math.min(1, away[1] / distance))) + dy;
    const bounded = Math.max(-limit, Math.min(limit, pitch));
    const flat = distance * Math.cos(bounded);
    this.eye = addScaled(
        this.target, [flat * Math.sin(yaw), distance * Math.sin(bounded), flat * Math.cos(yaw)], 1);
    this.takeOver();
  }

  // Pixels; what is at the target stays under the hand.
  shift(dx, dy) {
    const ahead = subtract(this.target, this.eye), {right, up} = axesOf(unit(ahead));
    const perPixel =
        2 * Math.tan(this.fov * Math.PI / 360) * norm(ahead) / this.canvas.clientHeight;
    const step = addScaled(right.map((x) => -x * dx * perPixel), up, dy * perPixel);
    this.eye = addScaled(this.eye, step, 1);
    this.target = addScaled(this.target, step, 1);
    this.takeOver();
  }

  approach(factor) {
    const away = subtract(this.eye, this.target), radius = this.take.focus.radius;
    const distance = Math.max(1e-3 * radius, Math.min(60 * radius, norm(away) * factor));
    this.eye = addScaled(this.target, unit(away), distance);
    this.takeOver();
  }

  lookAt(point) {
    const step = subtract(point, this.target);
    this.eye = addScaled(this.eye, step, 1);
    this.target = point;
    this.takeOver();
  }

  listen() {
    const canvas = this.canvas;
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    });
    for (const gone of ['pointerup', 'pointercancel']) {
      canvas.addEventListener(gone, (event) => this.pointers.delete(event.pointerId));
    }
    canvas.addEventListener('pointermove', (event) => this.move(event));
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      const lines = event.deltaMode === 1 ? 30 : 1;
      this.approach(Math.exp(0.0012 * lines * event.deltaY));
    }, {passive: false});
  }

  move(event) {
    const was = this.pointers.get(event.pointerId);
    if (!was) return;
    const dx = event.clientX - was.x, dy = event.clientY - was.y;
    if (this.pointers.size === 2) {
      const other = [...this.pointers].find(([id]) => id !== event.pointerId)[1];
      const before = Math.hypot(was.x - other.x, was.y - other.y);
      const after = Math.hypot(event.clientX - other.x, event.clientY - other.y);
      if (after > 0) this.approach(before / after);
      this.shift(dx / 2, dy / 2);
    } else if (event.buttons & 6 || event.shiftKey) {
      this.shift(dx, dy);
    } else if (dx !== 0 || dy !== 0) {
      this.turn(0.008 * dx, 0.008 * dy);
    }
    was.x = event.clientX;
    was.y = event.clientY;
  }
}
