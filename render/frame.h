// What every pass needs to know of one picture: matrices, light, sizes. Plain numbers, no OpenGL.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "render/exposure.h"
#include "render/picture.h"
#include "render/renderer.h"

namespace render {

// What a quality stands for.
struct Detail {
  int samples = 4;        // of multisampling; 1: none
  int shadowSize = 1024;  // texels of the shadow map across the sphere in focus
  int shadowTaps = 2;     // per side of the square of taps on a body
  int exposures = 0;      // whose mean the picture is; 0: it is drawn once
};
Detail detailOf(Quality quality);

// The block `Frame` of the shaders, std140: matrices and vectors of four only.
struct FrameBlock {
  Eigen::Matrix4f toClip;    // world -> clip space
  Eigen::Matrix4f toShadow;  // world -> shadow map, [0,1] in each direction
  Eigen::Vector4f eye;
  Eigen::Vector4f towardLight;
  Eigen::Vector4f ground;      // height, 1 when drawn, spacing of the fine lines, line width in px
  Eigen::Vector4f groundFade;  // centre x and z, distances where it begins to fade and is gone
  Eigen::Vector4f groundColor;
  Eigen::Vector4f background;
  Eigen::Vector4f shadow;  // 1 when on, offset along the normal [m], step of taps, taps per side
  Eigen::Vector4f shadowOfGround;  // depth of the ground in the map: x u + y v + z; w: softening
  Eigen::Vector4f
      pixels;  // width, height of the scene in pixels, edge width in px, radius in focus
  Eigen::Vector4f keyColor;  // linear
  // Of an exposure: world -> tile of the light maps, of the key light and of points of the sky.
  std::array<Eigen::Matrix4f, 1 + kSkies> toLights;
  std::array<Eigen::Vector4f, kSkies> towardSky;
};

struct Ball {
  Vec3f center = Vec3f::Zero();
  float radius = 0;
};

struct Frame {
  FrameBlock block;
  int width = 0, height = 0;
  Eigen::Vector3f eye, right, up, ahead;  // orthonormal; `ahead` looks at the target
  float nearest = 0;                      // distance of the near plane
  float pixelsPerMetre = 0;               // of something one metre away
  float texelsPerMetre = 0;               // of shadow maps
  float scale = 1;                        // scene pixels per pixel of a picture of 720 lines
  bool groundDrawn = false;
  std::vector<Ball> balls;  // around all instances, in their order, and surfaces

  float depthOf(const Vec3f& point) const { return ahead.dot(point - eye); }
};

// Throws std::invalid_argument when the picture has a number that is not finite, an instance
// without its mesh, a surface whose lists do not fit, or a camera that looks nowhere.
Frame frameOf(const Picture& picture, const RendererOptions& options, const Detail& detail);

// The frame of one exposure of that picture.
Frame exposed(Frame frame, const Picture& picture, const Detail& detail, const Exposure& exposure);

// A ball around an instance: radius about its position.
float radiusOf(const Instance& instance);

}  // namespace render
