// GLSL of the scene: bodies, ground, shadows. Only +, *, /, sqrt and min/max reach a colour, so
// that every CPU gives the same bytes.
#include "render/shaders.h"

namespace render {

#define FRAME_BLOCK                                                         \
  "layout(std140) uniform Frame {\n"                                        \
  "  mat4 toClip, toShadow;\n"                                              \
  "  vec4 eye, towardLight, ground, groundFade, groundColor, background;\n" \
  "  vec4 shadow, shadowOfGround, pixels, keyColor;\n"                      \
  "  mat4 toLights[4];\n"                                                   \
  "  vec4 towardSky[3];\n"                                                  \
  "} frame;\n"

// Of the frame, as fragments read it. llvmpipe fetches a uniform once for each of eight pixels,
// and what is flat once for all.
#define HANDED                                                        \
  "HANDED vec4 eye, towardLight, ground, shadow, pixels, keyColor;\n" \
  "HANDED mat4x3 toShadow;\n"                                         \
  "#ifdef EXPOSED\n"                                                  \
  "HANDED mat4x3 toLights[4];\n"                                      \
  "HANDED vec3 towardSky[3];\n"                                       \
  "#endif\n"
#define READ_HANDED "#define HANDED flat in\n" HANDED
#define HAND_ON                                                              \
  "#define HANDED flat out\n" HANDED                                         \
  "void handOn() {\n"                                                        \
  "  eye = frame.eye;\n"                                                     \
  "  towardLight = frame.towardLight;\n"                                     \
  "  ground = frame.ground;\n"                                               \
  "  shadow = frame.shadow;\n"                                               \
  "  pixels = frame.pixels;\n"                                               \
  "  keyColor = frame.keyColor;\n"                                           \
  "  toShadow = mat4x3(frame.toShadow);\n"                                   \
  "#ifdef EXPOSED\n"                                                         \
  "  for (int i = 0; i < 4; ++i) toLights[i] = mat4x3(frame.toLights[i]);\n" \
  "  for (int i = 0; i < 3; ++i) towardSky[i] = frame.towardSky[i].xyz;\n"   \
  "#endif\n"                                                                 \
  "}\n"

// Of an exposure: the key light and three points of the sky have a tile each of one map of depths.
// What lies beyond a tile is lit. A caster takes less of the sky the farther it is: single far ones
// would be seen as shadows with edges.
#define EXPOSED                                                               \
  "#ifdef EXPOSED\n"                                                          \
  "uniform sampler2D lights;\n"                                               \
  "float behind(int light, vec3 at) {  // the caster, in depths of the map\n" \
  "  vec3 p = toLights[light] * vec4(at, 1.0);\n"                             \
  "  vec2 middle = abs(p.xy - 0.5);\n"                                        \
  "  if (max(middle.x, middle.y) > 0.499) return 0.0;\n"                      \
  "  vec2 tile = 0.5 * vec2(light & 1, light >> 1);\n"                        \
  "  float depth = textureLod(lights, 0.5 * p.xy + tile, 0.0).r;\n"           \
  "  return max(min(p.z, 1.0) - depth, 0.0);\n"                               \
  "}\n"                                                                       \
  "float reached(vec3 at) { return behind(0, at) > 0.0 ? 0.0 : 1.0; }\n"      \
  "// Of what all the sky would give to a face with this normal.\n"           \
  "float skyOn(vec3 n, vec3 at) {\n"                                          \
  "  float sum = 0.0;\n"                                                      \
  "  for (int i = 0; i < 3; ++i) {\n"                                         \
  "    float share = max(dot(n, towardSky[i]), 0.0);\n"                       \
  "    float far = 7.0 * behind(i + 1, at);\n"                                \
  "    sum += far > 0.0 ? share * far * far / (1.0 + far * far) : share;\n"   \
  "  }\n"                                                                     \
  "  return 2.0 / 3.0 * sum;\n"                                               \
  "}\n"                                                                       \
  "#endif\n"

// Of an instance, as its vertex shaders read it.
#define INSTANCE                                                                            \
  "layout(location = 3) in vec4 place;  // centre, half the distance of a capsule's ends\n" \
  "layout(location = 4) in vec4 turn;   // quaternion\n"                                    \
  "layout(location = 5) in vec4 scale;  // w: marked\n"                                     \
  "layout(location = 6) in vec4 tint;   // linear\n"                                        \
  "vec3 turned(vec3 p) { return p + 2.0 * cross(turn.xyz, cross(turn.xyz, p) + turn.w * p); }\n"

// Where a point of the world goes, in the picture or, of a caster, in the shadow map; what is below
// the ground goes nowhere.
#define PROJECTED                                                                   \
  "out float gl_ClipDistance[1];\n"                                                 \
  "void project(vec3 world) {\n"                                                    \
  "  gl_ClipDistance[0] = frame.ground.y > 0.0 ? world.y - frame.ground.x : 1.0;\n" \
  "#ifdef CASTER\n"                                                                 \
  "  vec3 inShadow = (frame.toShadow * vec4(world, 1.0)).xyz;\n"                    \
  "  gl_Position = vec4(2.0 * inShadow - 1.0, 1.0);\n"                              \
  "#else\n"                                                                         \
  "  gl_Position = frame.toClip * vec4(world, 1.0);\n"                              \
  "#endif\n"                                                                        \
  "}\n"

const char* const kBodyVertex = FRAME_BLOCK HAND_ON INSTANCE PROJECTED R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 edge;
#ifndef CASTER
out vec3 vWorld, vNormal, vBody, vInShadow;
out vec2 vEdge;
flat out vec4 vTint;
flat out float vMarked;
#endif
void main() {
  vec3 body = position * scale.xyz;
  vec3 world = place.xyz + turned(body);
  project(world);
#ifndef CASTER
  handOn();
  vWorld = world;
  vNormal = turned(normalize(normal / max(abs(scale.xyz), vec3(1e-15))));
  vInShadow = (frame.toShadow * vec4(world + vNormal * frame.shadow.y, 1.0)).xyz;
  vBody = body;
  vEdge = edge;
  vTint = tint;
  vMarked = scale.w;
#endif
}
)";

// Of a ball, an ellipsoid or a capsule no more than the half is drawn that faces the viewer, or the
// light, in as many facets as its outline needs. In here one radius is the unit: a body is a ball,
// or two with a tube between them, and its outline is a circle at each end.
const char* const kFacingVertex = FRAME_BLOCK HAND_ON INSTANCE PROJECTED R"(
layout(location = 0) in vec4 position;  // end, along the meridian: cosine and sine; outwards
layout(location = 1) in vec3 meridian;  // shares of the tube's end, the middle, the outline
#ifndef CASTER
out vec3 vBody;
flat out vec4 vEye, vTurn, vCenter, vHalf, vTint;
#endif
vec3 turnedBack(vec3 p) { return p + 2.0 * cross(turn.xyz, cross(turn.xyz, p) - turn.w * p); }
void main() {
  vec3 radii = max(0.5 * abs(scale.xyz), vec3(1e-15));
  float reach = place.w / radii.y;
  vec3 end = vec3(0.0, position.x * reach, 0.0);
#ifdef CASTER
  vec3 toward = normalize(turnedBack(-vec3(frame.toShadow[0].z, frame.toShadow[1].z, frame.toShadow[2].z)) / radii);
  float near = 0.0;  // of a radius, from the centre to the plane of the outline
#else
  vec3 viewer = turnedBack(frame.eye.xyz - place.xyz) / radii;
  vec3 toward = viewer - end;
  float near = min(1.0 / length(toward), 0.99);
  toward = normalize(toward);
#endif
  // A ball has its axis across the view, and the same however it is turned.
  vec3 up = turnedBack(vec3(0.0, 1.0, 0.0)), right = turnedBack(vec3(1.0, 0.0, 0.0));
  vec3 axis = reach > 0.0 ? vec3(0.0, 1.0, 0.0)
                          : normalize(cross(toward, abs(dot(toward, up)) < 0.7 ? up : right));
  float along = dot(toward, axis);
  vec3 off = toward - along * axis;
  float across = length(off);
  vec3 front = across > 1e-6 ? off / across : vec3(1.0, 0.0, 0.0);
  vec3 pole = cross(front, axis), side = position.x * (across * axis - along * front);
  float ahead = clamp(position.x * along, -1.0, 1.0);
  vec3 middle = sqrt(0.5 + 0.5 * ahead) * toward + sqrt(0.5 - 0.5 * ahead) * side;
  vec3 on = normalize(meridian.x * front + meridian.y * middle + meridian.z * side);
  on = position.y * on + position.z * pole;
  // What lies on or behind the outline is moved out to the rays that touch it.
  float height = dot(on, toward);
  float rim = sqrt((1.0 - near * near) * max(1.0 - height * height, 0.0)) + height * near;
  on *= height < near + 1e-3 ? position.w / rim : 1.0;
  vec3 body = on + end;
  vec3 world = place.xyz + turned(body * radii);
  project(world);
#ifndef CASTER
  handOn();
  vBody = body;
  vEye = vec4(viewer, reach);
  vTurn = turn;
  vCenter = vec4(place.xyz, scale.w);
  vHalf = vec4(radii, 0.0);
  vTint = tint;
#endif
}
)";

const char* const kSurfaceVertex = FRAME_BLOCK HAND_ON PROJECTED R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 cell;  // lines run through its whole numbers
#ifndef CASTER
out vec3 vWorld, vNormal, vCell;
#endif
void main() {
  project(position);
#ifndef CASTER
  handOn();
  vWorld = position;
  vNormal = normal;
  vCell = cell;
#endif
}
)";

const char* const kCasterFragment = "void main() {}\n";

// Key light with soft shadow, sky and floor as ambient, a little gloss, dark edges.
const char* const kBodyFragment = READ_HANDED EXPOSED R"(
#ifndef EXPOSED
uniform sampler2DShadow shadowMap;
#endif
#ifdef SURFACE
uniform vec4 tints[2];  // front and back, linear
in vec3 vWorld, vNormal, vCell;
#elif defined FACING
in vec3 vBody;
flat in vec4 vEye, vTurn, vCenter, vHalf, vTint;
#else
in vec3 vWorld, vNormal, vBody, vInShadow;
in vec2 vEdge;
flat in vec4 vTint;
flat in float vMarked;
#endif
out vec4 color;

#ifndef EXPOSED
// Taps on a square. Two opposite corners that agree speak for all; and the loops' lengths are data:
// a software rasteriser leaves them as soon as no pixel of a group needs more.
float lit(float facing, vec3 inShadow) {
  float side = shadow.w, sum = 0.0;
  vec2 middle = abs(inShadow.xy - 0.5);  // beyond the map it is not known: lit
  int count = facing > 0.0 && max(middle.x, middle.y) < 0.5 ? int(side * side) : 0;
  float depth = min(inShadow.z, 1.0), reach = 0.5 * (side - 1.0);
  int corners = min(count, 2);
  for (int i = 0; i < corners; ++i) {
    vec2 tap = vec2((i == 0 ? -reach : reach) * shadow.z);
    sum += textureLod(shadowMap, vec3(inShadow.xy + tap, depth), 0.0);
  }
  if (abs(sum - 1.0) == 1.0) count = corners;
  for (int i = 1; i < count - 1; ++i) {
    float row = floor((float(i) + 0.5) / side);
    vec2 tap = (vec2(float(i) - row * side, row) - reach) * shadow.z;
    sum += textureLod(shadowMap, vec3(inShadow.xy + tap, depth), 0.0);
  }
  return count > 0 ? sum / float(count) : 1.0;
}
#endif

#ifdef SURFACE
float lineDarkness() {
  vec3 perPixel = max(fwidth(vCell), vec3(1e-6));
  vec3 away = abs(fract(vCell + 0.5) - 0.5) / perPixel;
  vec3 line = clamp(vec3(0.5 * pixels.z + 0.5) - away, 0.0, 1.0);
  line *= clamp(1.6 - 5.0 * perPixel, 0.0, 1.0);  // gone before they run together
  return max(max(line.x, line.y), line.z);
}
#else
#ifndef FACING
float edgeDarkness() {
  vec2 width = max(fwidth(vEdge), vec2(1e-6));
  vec2 away = max(vec2(1.0) - abs(vEdge), vec2(0.0)) / width;
  vec2 line = clamp(vec2(pixels.z + 0.5) - away, 0.0, 1.0);
  line *= clamp(1.5 - 6.0 * width, 0.0, 1.0);
  return max(line.x, line.y);
}
#endif

float mark(vec3 body) {
  vec3 side = clamp(body / max(fwidth(body), vec3(1e-9)), -1.0, 1.0);
  return 0.5 + 0.5 * side.x * side.y * side.z;
}
#endif

#ifdef FACING
vec3 turned(vec3 p) { return p + 2.0 * cross(vTurn.xyz, cross(vTurn.xyz, p) + vTurn.w * p); }

// Where the ray through a point of a facet meets the round body, in radii.
vec3 hitBy(vec3 ray) {
  float reach = vEye.w;
  vec3 off = vBody - vec3(0.0, clamp(vBody.y, -reach, reach), 0.0);
  vec3 across = abs(vBody.y) < reach ? vec3(ray.x, 0.0, ray.z) : ray;
  float a = max(dot(across, across), 1e-6), b = dot(off, across), c = dot(off, off) - 1.0;
  return vBody - (b + sqrt(max(b * b - a * c, 0.0))) / a * ray;
}
#endif

vec3 encoded(vec3 linear) {  // sRGB by three square roots, within 0.003
  vec3 a = sqrt(linear), b = sqrt(a), c = sqrt(b);
  return clamp(0.585122381 * a + 0.783140355 * b - 0.368262736 * c, 0.0, 1.0);
}

void main() {
#ifdef FACING
  vec3 hit = hitBy(normalize(vBody - vEye.xyz));
  vec3 vWorld = vCenter.xyz + turned(hit * vHalf.xyz);
  vec3 vNormal = turned((hit - vec3(0.0, clamp(hit.y, -vEye.w, vEye.w), 0.0)) / vHalf.xyz);
#endif
  vec3 n = normalize(vNormal), toEye = normalize(eye.xyz - vWorld);
#ifdef SURFACE
  vec4 tint = tints[gl_FrontFacing ? 0 : 1];
  n = gl_FrontFacing ? n : -n;
  vec3 inShadow = toShadow * vec4(vWorld + n * shadow.y, 1.0);
  vec3 albedo = tint.rgb * (1.0 - 0.45 * lineDarkness());
  float dark = 0.0;
#elif defined FACING
  vec4 tint = vTint;
  vec3 inShadow = toShadow * vec4(vWorld + n * shadow.y, 1.0);
  vec3 albedo = tint.rgb * (1.0 - 0.45 * vCenter.w * mark(hit));
  float dark = 0.0;
#else
  vec4 tint = vTint;
  if (dot(n, toEye) < 0.0 && !gl_FrontFacing) n = -n;
  vec3 inShadow = vInShadow;
  vec3 albedo = tint.rgb * (1.0 - 0.45 * vMarked * mark(vBody));
  float dark = edgeDarkness();
#endif
  float facing = dot(n, towardLight.xyz);
  float key = max(facing, 0.0);
#ifdef EXPOSED
  vec3 outside = vWorld + n * shadow.y;
  if (shadow.x > 0.0 && facing > 0.0) key *= reached(outside);
#else
  key *= shadow.x > 0.0 ? lit(facing, inShadow) : 1.0;
#endif
  float height = max(vWorld.y - ground.x, 0.0) / (0.12 * pixels.w);
  float contact = ground.y > 0.0 ? (0.5 - 0.5 * n.y) / (1.0 + height * height) : 0.0;
  float aside = n.x * towardLight.z - n.z * towardLight.x;  // faces that share the key light differ
  float sky = 0.46 + 0.13 * n.y + 0.20 * aside + 0.06 * max(dot(n, toEye), 0.0);
  float open = 1.0 - 0.55 * contact;
#ifdef EXPOSED
  // The floor's share of what is around, and the sky's; light that comes back from all sides.
  if (shadow.x > 0.0) open = mix(0.22, 1.0, (0.5 - 0.5 * n.y) * open + skyOn(n, outside));
#endif
  vec3 ambient = vec3(0.97, 0.99, 1.03) * sky * open;
  float gloss = max(dot(n, normalize(toEye + towardLight.xyz)), 0.0);
  gloss *= gloss; gloss *= gloss; gloss *= gloss; gloss *= gloss; gloss *= gloss;
  vec3 light = albedo * (ambient + keyColor.rgb * key) + 0.07 * gloss * key;
  light *= 1.0 - 0.5 * dark;
  color = vec4(encoded(light) * tint.a, tint.a);
}
)";

const char* const kFloorVertex = FRAME_BLOCK HAND_ON R"(
out vec2 vAt;
out vec2 vInShadow;
flat out vec4 groundFade, groundColor, background, shadowOfGround;
void main() {
  handOn();
  groundFade = frame.groundFade;
  groundColor = frame.groundColor;
  background = frame.background;
  shadowOfGround = frame.shadowOfGround;
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vAt = corner * frame.groundFade.w;
  vec3 world = vec3(frame.groundFade.x + vAt.x, frame.ground.x, frame.groundFade.y + vAt.y);
  vInShadow = (frame.toShadow * vec4(world, 1.0)).xy;
  gl_Position = frame.toClip * vec4(world, 1.0);
}
)";

// Colours here are mixed as they are encoded: the ground is a drawing, not a lit body.
const char* const kFloorFragment = READ_HANDED EXPOSED R"(
#ifndef EXPOSED
uniform sampler2D sharpMask, wideMask;
#endif
in vec2 vAt;
in vec2 vInShadow;
flat in vec4 groundFade, groundColor, background, shadowOfGround;
out vec4 color;

// Coverage by lines through the whole numbers, `wide` half widths in pixels.
float lines(vec2 cell, float wide) {
  vec2 perPixel = max(fwidth(cell), vec2(1e-6));
  vec2 away = abs(fract(cell + 0.5) - 0.5) / perPixel;
  vec2 line = clamp(wide + 0.5 - away, 0.0, 1.0) * clamp(1.4 - 8.0 * perPixel, 0.0, 1.0);
  return max(line.x, line.y);
}

void main() {
  float away = sqrt(dot(vAt, vAt));
  float gone = clamp((away - groundFade.z) / (groundFade.w - groundFade.z), 0.0, 1.0);
  gone = gone * gone * (3.0 - 2.0 * gone);
  vec2 cell = (vAt + groundFade.xy) / ground.z;
  vec3 paint = groundColor.rgb;
  paint *= 1.0 - 0.07 * lines(cell, ground.w);
  paint *= 1.0 - 0.12 * lines(cell / 5.0, 1.3 * ground.w);
#ifdef EXPOSED
  vec3 at = vec3(groundFade.x + vAt.x, ground.x, groundFade.y + vAt.y);
  float dark = 0.36 * (1.0 - reached(at)) + 0.5 * (1.0 - skyOn(vec3(0.0, 1.0, 0.0), at));
#else
  vec2 wide = textureLod(wideMask, vInShadow, 0.0).rg;
  float sharp = textureLod(sharpMask, vInShadow, 0.0).r;
  float far = clamp(shadowOfGround.w * wide.g / max(wide.r, 0.004), 0.0, 1.0);
  float dark = 0.36 * mix(sharp, wide.r, far) + 0.16 * wide.r * (1.0 - far);
#endif
  vec2 middle = abs(vInShadow - 0.5);  // blurred, a shadow reaches the border again
  dark *= clamp((0.5 - max(middle.x, middle.y)) * 40.0, 0.0, 1.0);
  paint *= 1.0 - shadow.x * dark * vec3(1.0, 0.98, 0.95);
  // Over nothing the ground is only what it darkens.
  float darkened = 1.0 - paint.g / max(groundColor.g, 0.001);
  color = background.a < 1.0 ? vec4(vec3(0.0), darkened * (1.0 - gone))
                             : vec4(mix(paint, background.rgb, gone), 1.0);
}
)";

const char* const kViewportVertex = R"(
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(4.0 * corner - 1.0, 0.0, 1.0);
}
)";

// r: share of the texel in shadow, g: that times the distance of caster and ground along the light.
const char* const kMaskFragment = FRAME_BLOCK R"(
uniform sampler2D source;
out vec4 color;
void main() {
  ivec2 at = 2 * ivec2(gl_FragCoord.xy);
  vec2 uv = gl_FragCoord.xy / vec2(textureSize(source, 0) / 2);
  float ground = dot(frame.shadowOfGround.xyz, vec3(uv, 1.0));
  vec2 sum = vec2(0.0);
  for (int i = 0; i < 4; ++i) {
    float depth = texelFetch(source, at + ivec2(i & 1, i >> 1), 0).r;
    sum += depth < 1.0 ? vec2(1.0, clamp(ground - depth, 0.0, 1.0)) : vec2(0.0);
  }
  vec2 middle = abs(uv - 0.5);  // nothing may stick to the border, it is what lies beyond
  float inside = clamp((0.5 - max(middle.x, middle.y)) * 40.0 - 0.2, 0.0, 1.0);
  color = vec4(0.25 * inside * sum, 0.0, 1.0);
}
)";

const char* const kSharpFragment = R"(
uniform sampler2D source;
out vec4 color;
void main() {
  vec2 texel = 1.0 / vec2(textureSize(source, 0)), at = gl_FragCoord.xy * texel;
  vec2 sum = vec2(0.0);
  for (int i = 0; i < 4; ++i)
    sum += textureLod(source, at + (vec2(i & 1, i >> 1) * 1.6 - 0.8) * texel, 0.0).rg;
  color = vec4(0.25 * sum, 0.0, 1.0);
}
)";

const char* const kWideFragment = R"(
uniform sampler2D source;
out vec4 color;
void main() {
  vec2 texel = 1.0 / vec2(textureSize(source, 0)), at = 4.0 * gl_FragCoord.xy * texel;
  vec2 sum = vec2(0.0);
  for (int i = 0; i < 4; ++i)
    sum += textureLod(source, at + (vec2(i & 1, i >> 1) * 2.0 - 1.0) * texel, 0.0).rg;
  color = vec4(0.25 * sum, 0.0, 1.0);
}
)";

// Nine taps, sigma of two texels.
const char* const kBlurFragment = R"(
uniform sampler2D source;
uniform vec2 direction;
out vec4 color;
void main() {
  const float weight[5] = float[](0.2041636, 0.1801738, 0.1238315, 0.0662822, 0.0276306);
  vec2 texel = 1.0 / vec2(textureSize(source, 0)), at = gl_FragCoord.xy * texel;
  vec2 sum = weight[0] * textureLod(source, at, 0.0).rg;
  for (int i = 1; i < 5; ++i) {
    vec2 step = float(i) * direction * texel;
    sum += weight[i] * textureLod(source, at + step, 0.0).rg;
    sum += weight[i] * textureLod(source, at - step, 0.0).rg;
  }
  color = vec4(sum, 0.0, 1.0);
}
)";

const char* const kResolveFragment = R"(
uniform sampler2DMS source;
out vec4 color;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  color = 0.25 * (texelFetch(source, at, 0) + texelFetch(source, at, 1) +
                  texelFetch(source, at, 2) + texelFetch(source, at, 3));
}
)";

}  // namespace render
