// A picture as plain data: what the renderer draws, with no idea of what it means.
// World units are metres, y up; colours are sRGB in [0,1].
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace render {

using Vec3f = Eigen::Vector3f;
using Color = Eigen::Vector4f;  // r g b a, sRGB, straight alpha

struct Mesh {  // triangles; flat or smooth as its normals say
  std::vector<Vec3f> positions, normals;
  std::vector<std::uint32_t> indices;
};

// Unit primitives, scaled by Instance::size: box (full extents), sphere (diameter per axis),
// cylinder (x,z diameter, y length), capsule (size.x = diameter, size.y = distance between the cap
// centres; axis y).
enum class Primitive { kBox, kSphere, kCapsule, kCylinder, kMesh };

struct Instance {
  Primitive primitive = Primitive::kBox;
  std::shared_ptr<const Mesh> mesh;  // for kMesh, drawn with `size` as scale
  Vec3f size = Vec3f::Ones();
  Vec3f position = Vec3f::Zero();
  Eigen::Quaternionf orientation = Eigen::Quaternionf::Identity();
  Color color{0.6f, 0.6f, 0.6f, 1.0f};
  bool marked = false;  // a quiet pattern that shows how a sphere or cylinder turns
};

// A sheet of triangles in world coordinates, for what changes its form from frame to frame: a
// cloth, the skin of a soft body. Drawn from both sides, with smooth normals made from the
// triangles.
struct Surface {
  std::vector<Vec3f> positions;
  std::vector<std::uint32_t> indices;  // triangles, counterclockwise from the front
  std::vector<Eigen::Vector2f> grid;   // by position: fine lines run through the whole numbers
  bool edges = false;  // without a grid: fine lines along all edges, and creases stay sharp
  float offset = 0;    // m, drawn this far out along the normals
  Color color{0.6f, 0.6f, 0.6f, 1.0f}, backColor{0.6f, 0.6f, 0.6f, 1.0f};
};

struct Camera {
  Vec3f eye{4, 3, 6}, target{0, 1, 0}, up{0, 1, 0};
  float fieldOfViewDegrees = 35;  // vertical
};

struct Ground {  // a plane with a grid that gives scale
  bool visible = true;
  float height = 0;
  float spacing = 1;  // m between fine lines; every fifth is stronger
  Color color{0.93f, 0.93f, 0.92f, 1};
};

struct Light {
  Vec3f direction{-0.45f, -1.0f, -0.35f};  // the way light travels
  bool shadows = true;
  Vec3f color = Vec3f::Ones();  // linear, times a white that is a little warm
  float softness = 0.05f;       // tangent of half the angle that the light is seen under
};

// Overlay geometry in the world, drawn with constant width in pixels (at 720 lines; scales with the
// size).
struct Line {
  Vec3f from = Vec3f::Zero(), to = Vec3f::Zero();
  Color color{0, 0, 0, 1};
  float width = 2;
  bool arrow = false;
  bool onTop = true;  // seen through bodies
};
struct Dot {
  Vec3f at = Vec3f::Zero();
  Color color{0, 0, 0, 1};
  float diameter = 7;
};
struct Label {  // text, with the marks of marked_text.h, at a place of the world; offset in pixels
  Vec3f at = Vec3f::Zero();
  std::string text;
  Eigen::Vector2f offset{8, -8};
  Color color{0.1f, 0.1f, 0.1f, 1};
  float size = 18;  // pixels at 720 lines
  float anchor =
      0;  // which part of the text is at the place: 0 its start, 1/2 its middle, 1 its end
};

struct Plot {  // a running plot of the HUD
  std::string title, unit;
  struct Curve {
    std::string name;
    std::vector<float> values;
    Color color{0, 0, 0, 1};
  };
  std::vector<Curve> curves;  // one value per frame from 0 to now
  int length = 0;             // frames the axis spans; 0: as many as there are
  bool logarithmic = false;
};

struct Bar {  // of the HUD: how much of a whole holds, and where it is now
  std::string name, value;
  float end = 1, now = 0;  // shares of the whole
};

struct Hud {
  bool visible = false;
  std::string title;
  std::vector<std::array<std::string, 2>> rows;  // name, value
  std::vector<Bar> bars;
  std::vector<Plot> plots;
};

struct Picture {
  Camera camera;
  Light light;
  Ground ground;
  std::vector<Instance> instances;
  std::vector<Surface> surfaces;
  std::vector<Line> lines;
  std::vector<Dot> dots;
  std::vector<Label> labels;
  Hud hud;
  std::string caption;           // one line at the lower left, empty: none
  Color background{1, 1, 1, 1};  // alpha 0: transparent, and the ground is only its shadows
  Vec3f focusCenter{0, 1, 0};    // the sphere that shadows must cover
  float focusRadius = 5;
};

}  // namespace render
