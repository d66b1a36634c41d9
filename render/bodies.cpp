// Instanced drawing of boxes, spheres, capsules, cylinders and meshes.
#include "render/bodies.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "render/shaders.h"

namespace render {
namespace {

// Segments around a round body, by level of detail, in fours. A silhouette of n segments is off by
// 2.5 r / n^2 pixels. Small triangles cost most of a picture: a level more is a few kilobytes.
constexpr std::array kSegments = {8, 12, 16, 20, 24, 28, 32, 40, 48, 64, 96, 128};
constexpr std::size_t kLevels = kSegments.size();
constexpr std::size_t kFirstMesh = 1 + 3 * kLevels;

// The radius that a level serves, in pixels. Its outline is off by a tenth of one; of small bodies,
// whose triangles would cost more than what they show, by a fifth.
float reachOf(std::size_t level) {
  constexpr int kSmall = 16;  // segments: a radius of 20 pixels
  const auto square = static_cast<float>(kSegments[level] * kSegments[level]);
  return square / (kSegments[level] <= kSmall ? 12.5f : 25);
}

std::size_t levelFor(float radiusInPixels) {
  std::size_t level = 0;
  while (level + 1 < kLevels && radiusInPixels > reachOf(level)) ++level;
  return level;
}

// What reaches farther, as a wall or a floor, mostly lies behind the rest: it is drawn last, and
// where it is hidden it need not be shaded.
constexpr float kLargeShare = 0.1f;  // of the picture's height

// The radius of what is round of it.
float roundingOf(const Instance& instance) {
  const Vec3f size = instance.size.cwiseAbs();
  return (instance.primitive == Primitive::kSphere ? size.maxCoeff()
                                                   : std::max(size.x(), size.z())) /
         2;
}

}  // namespace

Bodies::Bodies(const std::string& defines) {
  colorProgram_ = makeProgram(kBodyVertex, kBodyFragment, defines);
  casterProgram_ = makeProgram(kBodyVertex, kCasterFragment, "#define CASTER\n");
  facingColorProgram_ = makeProgram(kFacingVertex, kBodyFragment, "#define FACING\n" + defines);
  facingCasterProgram_ = makeProgram(kFacingVertex, kCasterFragment, "#define CASTER\n");
  instanceBuffer_ = makeBuffer();
  casterBuffer_ = makeBuffer();
  shapes_.push_back(upload(unitBox(), true));
  for (const auto make : {facingBall, facingCapsule, unitCylinder}) {
    for (const int segments : kSegments) {
      shapes_.push_back(upload(make(segments), true));
      shapes_.back().facing = make != unitCylinder;
    }
  }
}

Bodies::Shape Bodies::upload(const Geometry& geometry, bool closed) {
  Shape shape{makeVertexArray(),
              makeBuffer(),
              makeBuffer(),
              static_cast<GLsizei>(geometry.indices.size()),
              closed,
              false,
              ++uploads_};
  glBindVertexArray(shape.array);
  fillBuffer(GL_ARRAY_BUFFER, shape.vertices, geometry.vertices, GL_STATIC_DRAW);
  fillBuffer(GL_ELEMENT_ARRAY_BUFFER, shape.indices, geometry.indices, GL_STATIC_DRAW);
  setAttribute(0, 4, sizeof(Vertex), offsetof(Vertex, position));
  setAttribute(1, 3, sizeof(Vertex), offsetof(Vertex, normal));
  setAttribute(2, 2, sizeof(Vertex), offsetof(Vertex, edge));
  for (GLuint index = 3; index < 7; ++index) glVertexAttribDivisor(index, 1);
  return shape;
}

std::size_t Bodies::shapeOf(const Instance& instance, float pixels) {
  switch (instance.primitive) {
    case Primitive::kSphere:
      return 1 + levelFor(pixels);
    case Primitive::kCapsule:
      return 1 + kLevels + levelFor(pixels);
    case Primitive::kCylinder:
      return 1 + 2 * kLevels + levelFor(pixels);
    case Primitive::kMesh:
      return shapeOfMesh(instance.mesh);
    case Primitive::kBox:
      break;
  }
  return 0;
}

std::size_t Bodies::shapeOfMesh(const std::shared_ptr<const Mesh>& mesh) {
  Kept& kept = meshes_[mesh.get()];
  if (!kept.mesh) {
    const Shape shape = upload(geometryOf(*mesh), false);
    if (freeShapes_.empty()) {
      kept.shape = shapes_.size();
      shapes_.push_back(shape);
    } else {
      kept.shape = freeShapes_.back();
      freeShapes_.pop_back();
      shapes_[kept.shape] = shape;
    }
    kept.mesh = mesh;
  }
  kept.used = true;
  return kept.shape;
}

void Bodies::dropUnusedMeshes() {
  for (auto at = meshes_.begin(); at != meshes_.end();) {
    Kept& kept = at->second;
    if (kept.mesh && kept.used) {
      kept.used = false;
      ++at;
      continue;
    }
    if (kept.mesh) {
      const Shape& shape = shapes_[kept.shape];
      glDeleteVertexArrays(1, &shape.array);
      glDeleteBuffers(1, &shape.vertices);
      glDeleteBuffers(1, &shape.indices);
      freeShapes_.push_back(kept.shape);
    }
    at = meshes_.erase(at);
  }
}

void Bodies::sortInstances(const Picture& picture, const Frame& frame) {
  sorted_.clear();
  for (std::size_t i = 0; i < picture.instances.size(); ++i) {
    const Instance& instance = picture.instances[i];
    const float alpha = instance.color.w();
    if (alpha <= 0) continue;
    const float depth = frame.depthOf(instance.position);
    const float perMetre = frame.pixelsPerMetre / std::max(depth, frame.nearest);
    const bool large =
        perMetre * frame.balls[i].radius > kLargeShare * static_cast<float>(frame.height);
    sorted_.push_back(
        {shapeOf(instance, perMetre * roundingOf(instance)), i, depth, alpha >= 1, large});
  }
  const auto key = [](const Sorted& s) {
    return s.opaque ? std::tuple(s.large ? 1 : 0, s.shape, s.depth, s.instance)
                    : std::tuple(2, std::size_t{0}, -s.depth, s.instance);
  };
  std::sort(sorted_.begin(), sorted_.end(),
            [key](const Sorted& a, const Sorted& b) { return key(a) < key(b); });
}

Bodies::InstanceData Bodies::dataOf(const Instance& instance) {
  const bool capsule = instance.primitive == Primitive::kCapsule;
  const Vec3f& p = instance.position;
  const Eigen::Vector4f turn = instance.orientation.normalized().coeffs();
  const Vec3f scale = capsule ? Vec3f::Constant(instance.size.x()) : instance.size;
  const Color c = linearColor(instance.color);
  return {{p.x(), p.y(), p.z(), capsule ? instance.size.y() / 2 : 0.0f},
          {turn.x(), turn.y(), turn.z(), turn.w()},
          {scale.x(), scale.y(), scale.z(), instance.marked ? 1.0f : 0.0f},
          {c.x(), c.y(), c.z(), c.w()}};
}

void Bodies::fillBatches(const Picture& picture) {
  data_.clear();
  batches_.clear();
  for (const Sorted& s : sorted_) {
    data_.push_back(dataOf(picture.instances[s.instance]));
    const bool same =
        !batches_.empty() && batches_.back().shape == s.shape && batches_.back().opaque == s.opaque;
    if (!same) batches_.push_back({s.shape, data_.size() - 1, 0, s.opaque});
    ++batches_.back().count;
  }
}

// Half as fine as the pictures: shadows are filtered over two texels.
void Bodies::findCasters(const Picture& picture, const Frame& frame) {
  casters_.clear();
  if (!picture.light.shadows) return;
  for (const Instance& instance : picture.instances) {
    if (instance.color.w() < 0.5f) continue;
    const InstanceData data = dataOf(instance);
    const std::size_t shape = shapeOf(instance, 0.5f * frame.texelsPerMetre * roundingOf(instance));
    casters_.push_back({shape, shapes_[shape].upload, data.place, data.turn, data.scale});
  }
}

void Bodies::arrange(const Picture& picture, const Frame& frame) {
  sortInstances(picture, frame);
  findCasters(picture, frame);
  dropUnusedMeshes();
  fillBatches(picture);
  fillBuffer(GL_ARRAY_BUFFER, instanceBuffer_, data_, GL_STREAM_DRAW);
}

void Bodies::drawBatch(const Batch& batch, GLuint instances) const {
  const Shape& shape = shapes_[batch.shape];
  glBindVertexArray(shape.array);
  glBindBuffer(GL_ARRAY_BUFFER, instances);
  const std::size_t start = batch.first * sizeof(InstanceData);
  for (GLuint i = 0; i < 4; ++i) setAttribute(3 + i, 4, sizeof(InstanceData), start + 16 * i);
  glDrawElementsInstanced(GL_TRIANGLES, shape.count, GL_UNSIGNED_INT, nullptr, batch.count);
}

void Bodies::drawCasters(std::span<const std::size_t> which) {
  if (which.empty()) return;
  std::vector<std::size_t> byShape(which.begin(), which.end());
  std::stable_sort(byShape.begin(), byShape.end(), [this](std::size_t a, std::size_t b) {
    return casters_[a].shape < casters_[b].shape;
  });
  std::vector<InstanceData> data;
  std::vector<Batch> batches;
  for (const std::size_t i : byShape) {
    const Caster& caster = casters_[i];
    data.push_back({caster.place, caster.turn, caster.scale, {}});
    if (batches.empty() || batches.back().shape != caster.shape)
      batches.push_back({caster.shape, data.size() - 1, 0, true});
    ++batches.back().count;
  }
  fillBuffer(GL_ARRAY_BUFFER, casterBuffer_, data, GL_STREAM_DRAW);
  for (const Batch& batch : batches) {
    glUseProgram(shapes_[batch.shape].facing ? facingCasterProgram_ : casterProgram_);
    cullBack(batch);
    drawBatch(batch, casterBuffer_);
  }
  glDisable(GL_CULL_FACE);
}

void Bodies::cullBack(const Batch& batch) const {
  if (shapes_[batch.shape].closed)
    glEnable(GL_CULL_FACE);
  else
    glDisable(GL_CULL_FACE);
}

void Bodies::draw() const {
  for (const Batch& batch : batches_) {
    glUseProgram(shapes_[batch.shape].facing ? facingColorProgram_ : colorProgram_);
    cullBack(batch);
    if (batch.opaque)
      glDisable(GL_BLEND);
    else
      glEnable(GL_BLEND);
    drawBatch(batch, instanceBuffer_);
  }
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
}

}  // namespace render
