// GLSL of the bodies, cloths, shadows and ground: the look of the films.

const kHead = `#version 300 es
precision highp float;
precision highp sampler2DShadow;
uniform mat4 toClip, toShadow;
uniform vec3 eye, towardLight;
uniform float groundHeight, edgeWidth, radius, shadowOn, shadowStep, shadowOffset, opacity;
`;

const kBodyVertex = kHead + `
layout(location = 0) in vec4 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 edge;
layout(location = 3) in vec4 place;  // centre, half the distance of a capsule's ends
layout(location = 4) in vec4 turn;   // quaternion
layout(location = 5) in vec4 scale;  // w: marked
layout(location = 6) in vec4 tint;   // linear
layout(location = 7) in float number;
out vec3 vWorld, vNormal, vBody;
out vec2 vEdge;
flat out vec4 vTint;
flat out float vMarked, vNumber;
vec3 turned(vec3 p) { return p + 2.0 * cross(turn.xyz, cross(turn.xyz, p) + turn.w * p); }
void main() {
  vBody = position.xyz * scale.xyz + vec3(0.0, position.w * place.w, 0.0);
  vWorld = place.xyz + turned(vBody);
  vNormal = turned(normalize(normal / max(abs(scale.xyz), vec3(1e-15))));
  vEdge = edge;
  vTint = tint;
  vMarked = scale.w;
  vNumber = number;
#ifdef CASTER
  gl_Position = vec4(2.0 * (toShadow * vec4(vWorld, 1.0)).xyz - 1.0, 1.0);
#else
  gl_Position = toClip * vec4(vWorld, 1.0);
#endif
}`;

const kSurfaceVertex = kHead + `
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 cell;  // lines run through its whole numbers
out vec3 vWorld, vNormal, vCell;
void main() {
  vWorld = position;
  vNormal = normal;
  vCell = cell;
#ifdef CASTER
  gl_Position = vec4(2.0 * (toShadow * vec4(position, 1.0)).xyz - 1.0, 1.0);
#else
  gl_Position = toClip * vec4(position, 1.0);
#endif
}`;

const kNothing = kHead + 'void main() {}';

// Which part is under the mouse.
const kNumberFragment = kHead + `
flat in float vNumber;
out vec4 color;
void main() {
  float high = floor(vNumber / 65536.0), rest = vNumber - 65536.0 * high;
  color = vec4(mod(rest, 256.0), floor(rest / 256.0), high, 255.0) / 255.0;
}`;

const kWireFragment = kHead + `
uniform vec4 plain;
#ifndef SURFACE
flat in vec4 vTint;
#endif
out vec4 color;
void main() {
#ifdef SURFACE
  color = plain;
#else
  color = vec4(sqrt(vTint.rgb) * 0.8, 1.0);
#endif
}`;

const kLit = `
uniform sampler2DShadow shadowMap;
float lit(vec3 at) {
  vec2 middle = abs(at.xy - 0.5);
  if (shadowOn == 0.0 || max(middle.x, middle.y) > 0.5) return 1.0;
  float sum = 0.0;
  for (int i = 0; i < 16; ++i) {
    vec2 tap = (vec2(i & 3, i >> 2) - 1.5) * shadowStep;
    sum += textureLod(shadowMap, vec3(at.xy + tap, min(at.z, 1.0)), 0.0);
  }
  return sum / 16.0;
}
`;

// Key light with soft shadow, sky and floor as ambient, a little gloss, dark edges.
const kBodyFragment = kHead + kLit + `
#ifdef SURFACE
uniform vec4 tints[2];  // front and back, linear
in vec3 vWorld, vNormal, vCell;
#else
in vec3 vWorld, vNormal, vBody;
in vec2 vEdge;
flat in vec4 vTint;
flat in float vMarked;
#endif
out vec4 color;
#ifdef SURFACE
float lineDarkness() {
  vec3 perPixel = max(fwidth(vCell), vec3(1e-6));
  vec3 away = abs(fract(vCell + 0.5) - 0.5) / perPixel;
  vec3 line = clamp(vec3(0.5 * edgeWidth + 0.5) - away, 0.0, 1.0);
  line *= clamp(1.6 - 5.0 * perPixel, 0.0, 1.0);  // gone before they run together
  return max(max(line.x, line.y), line.z);
}
#else
float edgeDarkness() {
  vec2 width = max(fwidth(vEdge), vec2(1e-6));
  vec2 away = max(vec2(1.0) - abs(vEdge), vec2(0.0)) / width;
  vec2 line = clamp(vec2(edgeWidth + 0.5) - away, 0.0, 1.0);
  line *= clamp(1.5 - 6.0 * width, 0.0, 1.0);
  return max(line.x, line.y);
}
float mark() {  // shows how a sphere or cylinder turns
  vec3 side = clamp(vBody / max(fwidth(vBody), vec3(1e-9)), -1.0, 1.0);
  return 0.5 + 0.5 * side.x * side.y * side.z;
}
#endif
vec3 encoded(vec3 linear) {  // sRGB by three square roots, within 0.003
  vec3 a = sqrt(linear), b = sqrt(a), c = sqrt(b);
  return clamp(0.585122381 * a + 0.783140355 * b - 0.368262736 * c, 0.0, 1.0);
}
void main() {
  vec3 n = normalize(vNormal), toEye = normalize(eye - vWorld);
#ifdef SURFACE
  vec4 tint = tints[gl_FrontFacing ? 0 : 1];
  n = gl_FrontFacing ? n : -n;
  vec3 albedo = tint.rgb * (1.0 - 0.45 * lineDarkness());
  float dark = 0.0;
#else
  vec4 tint = vTint;
  if (dot(n, toEye) < 0.0 && !gl_FrontFacing) n = -n;
  vec3 albedo = tint.rgb * (1.0 - 0.45 * vMarked * mark());
  float dark = edgeDarkness();
#endif
  vec3 inShadow = (toShadow * vec4(vWorld + n * shadowOffset, 1.0)).xyz;
  float facing = dot(n, towardLight);
  float key = facing > 0.0 ? facing * lit(inShadow) : 0.0;
  float height = max(vWorld.y - groundHeight, 0.0) / (0.12 * radius);
  float contact = (0.5 - 0.5 * n.y) / (1.0 + height * height);
  float aside = n.x * towardLight.z - n.z * towardLight.x;
  float sky = 0.46 + 0.13 * n.y + 0.20 * aside + 0.06 * max(dot(n, toEye), 0.0);
  vec3 ambient = vec3(0.97, 0.99, 1.03) * sky * (1.0 - 0.55 * contact);
  float gloss = pow(max(dot(n, normalize(toEye + towardLight)), 0.0), 32.0);
  vec3 light = albedo * (ambient + vec3(0.61, 0.60, 0.58) * key) + 0.07 * gloss * key;
  light *= 1.0 - 0.5 * dark;
  float a = tint.a * opacity;
  color = vec4(encoded(light) * a, a);
}`;

const kFloorVertex = kHead + `
uniform vec4 fade;  // centre x and z, distances where it begins to fade and is gone
out vec2 vAt;
out vec3 vInShadow;
void main() {
  vAt = (vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0) * fade.w;
  vec4 world = vec4(fade.x + vAt.x, groundHeight, fade.y + vAt.y, 1.0);
  vInShadow = (toShadow * world).xyz;
  gl_Position = toClip * world;
}`;

const kFloorFragment = kHead + kLit + `
uniform vec4 fade;
uniform vec3 paint, paper;
uniform float spacing;
in vec2 vAt;
in vec3 vInShadow;
out vec4 color;
float lines(vec2 cell, float wide) {
  vec2 perPixel = max(fwidth(cell), vec2(1e-6));
  vec2 away = abs(fract(cell + 0.5) - 0.5) / perPixel;
  vec2 line = clamp(wide + 0.5 - away, 0.0, 1.0) * clamp(1.4 - 8.0 * perPixel, 0.0, 1.0);
  return max(line.x, line.y);
}
void main() {
  float gone = smoothstep(fade.z, fade.w, length(vAt));
  vec2 cell = (vAt + fade.xy) / spacing;
  vec3 here = paint;
  here *= 1.0 - 0.07 * lines(cell, 0.6 * edgeWidth);
  here *= 1.0 - 0.12 * lines(cell / 5.0, 0.8 * edgeWidth);
  here *= 1.0 - 0.42 * (1.0 - lit(vInShadow - vec3(0.0, 0.0, 1e-4))) * vec3(1.0, 0.98, 0.95);
  color = vec4(mix(here, paper, gone), 1.0);
}`;

// A bar with round ends from place to place, as wide everywhere.
const kStrokeVertex = `#version 300 es
precision highp float;
uniform mat4 toClip;
uniform vec2 size;
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in vec4 tint;
layout(location = 3) in float width;
out vec3 vShape;  // along, across, length in pixels
flat out vec4 vTint;
flat out float vRadius;
void main() {
  vec4 a = toClip * vec4(from, 1.0), b = toClip * vec4(to, 1.0);
  float near = 1e-3 * max(max(a.w, b.w), 1e-6);  // what is behind the eye is cut off
  if (a.w < near) a = mix(b, a, (b.w - near) / (b.w - a.w));
  if (b.w < near) b = mix(a, b, (a.w - near) / (a.w - b.w));
  vec2 p = a.xy / a.w * 0.5 * size, q = b.xy / b.w * 0.5 * size, d = q - p;
  float len = length(d), reach = 0.5 * width + 1.0;
  vec2 t = len > 1e-4 ? d / len : vec2(1.0, 0.0), n = vec2(-t.y, t.x);
  float end = float(gl_VertexID & 1), side = float(gl_VertexID >> 1) * 2.0 - 1.0;
  vec2 at = mix(p - reach * t, q + reach * t, end) + side * reach * n;
  vShape = vec3(mix(-reach, len + reach, end), side * reach, len);
  vTint = tint;
  vRadius = 0.5 * width;
  bool behind = (toClip * vec4(from, 1.0)).w < near && (toClip * vec4(to, 1.0)).w < near;
  gl_Position = behind ? vec4(2.0, 2.0, 2.0, 1.0) : vec4(at / (0.5 * size), 0.0, 1.0);
}`;

const kStrokeFragment = `#version 300 es
precision highp float;
in vec3 vShape;
flat in vec4 vTint;
flat in float vRadius;
out vec4 color;
void main() {
  float past = max(max(-vShape.x, vShape.x - vShape.z), 0.0);
  float a = vTint.a * clamp(vRadius + 0.5 - length(vec2(past, vShape.y)), 0.0, 1.0);
  color = vec4(vTint.rgb * a, a);
}`;
