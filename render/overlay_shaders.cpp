// GLSL of what is drawn flat: strokes, text and plots. All colours leave premultiplied.
#include "render/shaders.h"

namespace render {

const char* const kStrokeVertex = R"(
layout(location = 0) in vec3 at;
layout(location = 1) in vec4 shape;
layout(location = 2) in vec2 radii;
layout(location = 3) in vec4 tint;
out vec4 vShape;
flat out vec2 vRadii;
flat out vec4 vTint;
void main() {
  gl_Position = vec4(at, 1.0);
  vShape = shape;
  vRadii = radii;
  vTint = tint;
}
)";

// A bar with round ends, or a trapezoid with straight ends, covered as far as its edge reaches
// into the pixel. Thinner than a pixel: as wide as one, and fainter.
const char* const kStrokeFragment = R"(
in vec4 vShape;
flat in vec2 vRadii;
flat in vec4 vTint;
out vec4 color;
void main() {
  float along = vShape.x, across = abs(vShape.y), len = vShape.z;
  float past = max(-along, along - len);
  float share = len > 0.0 ? clamp(along / len, 0.0, 1.0) : 0.0;
  float radius = mix(vRadii.x, vRadii.y, share);
  float cover;
  if (vShape.w > 0.5) {
    float away = past > 0.0 ? sqrt(past * past + across * across) : across;
    cover = clamp(max(radius, 0.5) + 0.5 - away, 0.0, 1.0) * min(2.0 * radius, 1.0);
  } else {
    cover = clamp(radius + 0.5 - across, 0.0, 1.0) * clamp(0.5 - past, 0.0, 1.0);
  }
  float a = vTint.a * cover;
  color = vec4(vTint.rgb * a, a);
}
)";

const char* const kCanvasVertex = R"(
uniform vec2 size;
layout(location = 0) in vec2 at;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 tint;
out vec2 vUv;
out vec4 vTint;
void main() {
  gl_Position = vec4(2.0 * at.x / size.x - 1.0, 1.0 - 2.0 * at.y / size.y, 0.0, 1.0);
  vUv = uv;
  vTint = tint;
}
)";

const char* const kCanvasFragment = R"(
uniform sampler2D source;
in vec2 vUv;
in vec4 vTint;
out vec4 color;
void main() {
  float a = vTint.a * textureLod(source, vUv, 0.0).r;
  color = vec4(vTint.rgb * a, a);
}
)";

}  // namespace render
