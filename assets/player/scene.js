// A frame of the run on the canvas: shadows, then bodies, cloths and ground, then what is on top.

const kShadowSize = 2048;

class Scene {
  constructor(canvas, take) {
    const gl = canvas.getContext('webgl2', {antialias: true, alpha: false, preserveDrawingBuffer: true});
    if (!gl) throw new Error('this browser has no WebGL 2');
    this.gl = gl;
    this.canvas = canvas;
    this.take = take;
    this.bodies = new Bodies(gl, take);
    this.surfaces = new Surfaces(gl, take);
    this.floor = new Program(gl, kFloorVertex, kFloorFragment);
    this.nothing = gl.createVertexArray();
    this.strokes = new Strokes(gl);
    gl.enable(gl.DEPTH_TEST);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    this.makeShadow();
  }

  makeShadow() {
    const gl = this.gl, texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, kShadowSize, kShadowSize);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    this.shadow = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadow);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, texture, 0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    this.shadowMap = texture;
  }

  // Orthographic, along the light, around the sphere in focus.
  toShadow(center) {
    const {radius} = this.take.focus, along = unit(this.take.light);
    const side = unit(cross(along, Math.abs(along[1]) > 0.9999 ? [1, 0, 0] : [0, 1, 0]));
    const rows = [side, cross(side, along), along], m = new Float32Array(16);
    rows.forEach((row, r) => {
      for (let c = 0; c < 3; ++c) m[4 * c + r] = row[c] / (2.1 * radius);
      m[12 + r] = 0.5 - dot(row, center) / (2.1 * radius);
    });
    m[15] = 1;
    return m;
  }

  values(camera, look) {
    const {ground, light, shadows} = this.take, height = this.canvas.height;
    const {focus, eye} = camera, {radius} = this.take.focus;
    const begin = 1.5 * radius + 0.5 * Math.hypot(focus[0] - eye[0], focus[2] - eye[2]);
    return {
      toClip: camera.toClip, toShadow: this.toShadow(focus), eye,
      towardLight: unit(light).map((x) => -x), groundHeight: ground.height,
      edgeWidth: Math.max(0.9 * height / 720, 0.6), radius,
      shadowOn: shadows && look.shadows ? 1 : 0, shadowStep: 1.1 / kShadowSize,
      shadowOffset: 2.5 * 2.1 * radius / kShadowSize, shadowMap: 0,
      opacity: look.clear ? 0.3 : 1, spacing: ground.spacing, paint: ground.color.slice(0, 3),
      paper: [1, 1, 1], fade: [focus[0], focus[2], begin, 3.2 * begin],
    };
  }

  drawShadow(values) {
    const gl = this.gl;
    gl.bindTexture(gl.TEXTURE_2D, null);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadow);
    gl.viewport(0, 0, kShadowSize, kShadowSize);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    if (values.shadowOn) {
      gl.enable(gl.POLYGON_OFFSET_FILL);
      gl.polygonOffset(1.5, 2);
      this.bodies.draw('caster', values);
      this.surfaces.draw('caster', values);
      gl.disable(gl.POLYGON_OFFSET_FILL);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.bindTexture(gl.TEXTURE_2D, this.shadowMap);
  }

  // look: clear, wire, shadows; `strokes` are there.
  draw(frame, camera, look) {
    const gl = this.gl, {width, height} = this.canvas;
    this.bodies.arrange(this.take.poses.at(frame), camera, look.clear);
    this.surfaces.arrange(this.take.positions.at(frame), camera);
    const values = this.values(camera, look);
    this.drawShadow(values);
    gl.viewport(0, 0, width, height);
    gl.clearColor(1, 1, 1, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (look.wire) {
      this.bodies.draw('wire', values);
      this.surfaces.draw('wire', values);
    } else {
      this.drawBodies(values, look);
    }
    this.strokes.draw(camera, width, height);
  }

  drawBodies(values, look) {
    const gl = this.gl;
    this.bodies.draw('color', values, true);
    if (!look.clear) this.surfaces.draw('color', values, true);
    this.drawFloor(values);
    gl.enable(gl.BLEND);
    gl.enable(gl.CULL_FACE);
    gl.depthMask(!look.clear);
    for (const hidden of [gl.FRONT, gl.BACK]) {
      gl.cullFace(hidden);
      this.surfaces.draw('color', values, look.clear ? undefined : false);
      if (!look.clear || hidden === gl.BACK) this.bodies.draw('color', values, false);
    }
    gl.depthMask(true);
    gl.disable(gl.CULL_FACE);
    gl.disable(gl.BLEND);
  }

  drawFloor(values) {
    const gl = this.gl, ground = this.take.ground;
    if (!ground.visible || values.eye[1] <= ground.height) return;
    this.floor.use(values);
    gl.bindVertexArray(this.nothing);
    gl.enable(gl.POLYGON_OFFSET_FILL);  // what lies on it is in front of it
    gl.polygonOffset(1, 1);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.disable(gl.POLYGON_OFFSET_FILL);
  }

  // The part at a place of the canvas, from its upper left; -1: none.
  partAt(x, y, camera) {
    const gl = this.gl, {width, height} = this.canvas, made = [];
    const store = (format) => {
      made.push(gl.createRenderbuffer());
      gl.bindRenderbuffer(gl.RENDERBUFFER, made.at(-1));
      gl.renderbufferStorage(gl.RENDERBUFFER, format, width, height);
      return made.at(-1);
    };
    const target = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.RENDERBUFFER, store(gl.RGBA8));
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER,
                               store(gl.DEPTH_COMPONENT24));
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.bodies.draw('number', {toClip: camera.toClip});
    const pixel = new Uint8Array(4);
    gl.readPixels(x, height - 1 - y, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.deleteFramebuffer(target);
    for (const buffer of made) gl.deleteRenderbuffer(buffer);
    return pixel[0] + 256 * pixel[1] + 65536 * pixel[2] - 1;
  }
}
