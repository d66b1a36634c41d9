// Soft things against rigid shapes: bounds first, then the narrow phase of a sphere or a capsule.
#include "physics/collision/soft_collider.h"

#include <algorithm>
#include <cmath>

#include "physics/base/rotation.h"
#include "physics/collision/mesh_contacts.h"
#include "physics/collision/narrow.h"

namespace physics {

using namespace collision;

namespace {

Bounds around(const Bounds& a, const Bounds& b) {
  return {a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)};
}

// The element as a solid, and its frame at the start.
struct Placed {
  Solid solid;
  Pose pose;
};

Placed place(const SoftElement& element, std::span<const Pose> start) {
  Placed placed;
  const Vec3 &from = start[element.from].x, &to = start[element.to].x;
  placed.solid.rounding = placed.solid.radius = element.radius;
  placed.pose.x = 0.5 * (from + to);
  const Vec3 along = to - from;
  const double length = along.norm();
  const bool line = length > 1e-12;  // 1e4 roundings at 1 m: it has a direction
  placed.solid.kind = line ? SolidKind::capsule : SolidKind::sphere;
  placed.solid.halfLength = 0.5 * length;
  placed.solid.coreRadius = placed.solid.half.y() = 0.5 * length;
  placed.solid.size = placed.solid.coreRadius + element.radius;
  placed.solid.thickness = 2 * element.radius;
  if (line) placed.pose.q = turnBetween(Vec3::UnitY(), along);
  return placed;
}

}  // namespace

void SoftCollider::addBody(BodyId body, const Shape& shape) {
  if (std::holds_alternative<PointShape>(shape)) return;
  rigidOf_.resize(std::max<std::size_t>(rigidOf_.size(), body + 1), -1);
  rigidOf_[body] = static_cast<int>(rigids_.size());
  const auto* compound = std::get_if<Compound>(&shape);
  if (compound == nullptr) return addRigid(body, shape);
  for (const Part& part : compound->parts->list) {
    addRigid(body, part.shape);
    rigids_.back().isPart = true;
    rigids_.back().inBody = part.pose;
  }
}

void SoftCollider::addRigid(BodyId body, const Shape& shape) {
  Rigid rigid;
  rigid.body = body;
  rigid.solid = makeSolid(shape);
  rigids_.push_back(std::move(rigid));
}

void SoftCollider::ignore(BodyId point, BodyId body) {
  const std::array<BodyId, 2> pair{point, body};
  ignored_.insert(std::lower_bound(ignored_.begin(), ignored_.end(), pair), pair);
}

bool SoftCollider::isIgnored(const SoftElement& element, BodyId body) const {
  const auto has = [&](BodyId point) {
    return std::binary_search(ignored_.begin(), ignored_.end(), std::array{point, body});
  };
  return !ignored_.empty() && (has(element.from) || has(element.to));
}

void SoftCollider::takeMotion(std::span<const Pose> start, std::span<const Pose> end,
                              double margin) {
  for (Rigid& rigid : rigids_) {
    const Pose from = rigid.at(start[rigid.body]), to = rigid.at(end[rigid.body]);
    rigid.rotation = from.q.toRotationMatrix();
    rigid.move = to.x - from.x;
    rigid.turn = 0;
    if (rigid.solid.kind == SolidKind::plane) continue;
    rigid.turn = 2 * (to.q.coeffs() - from.q.coeffs()).norm() * rigid.solid.size;
    rigid.path = around(boundsAt(rigid.solid, from.x, rigid.rotation),
                        boundsAt(rigid.solid, to.x, to.q.toRotationMatrix()));
    rigid.path.low.array() -= margin;
    rigid.path.high.array() += margin;
  }
}

bool SoftCollider::mayTouch(const SoftElement& element, const Rigid& rigid,
                            std::span<const Pose> start, std::span<const Pose> end,
                            double margin) const {
  if (isIgnored(element, rigid.body)) return false;
  const Vec3 &a = start[element.from].x, &b = end[element.from].x;
  const Vec3 &c = start[element.to].x, &d = end[element.to].x;
  if (rigid.solid.kind == SolidKind::plane) {
    const Vec3 n = rigid.rotation * rigid.solid.normal;
    const double low = std::min({n.dot(a), n.dot(b), n.dot(c), n.dot(d)});
    return low - n.dot(start[rigid.body].x) - rigid.solid.offset < element.radius + margin;
  }
  const Vec3 low = a.cwiseMin(b).cwiseMin(c).cwiseMin(d).array() - element.radius;
  const Vec3 high = a.cwiseMax(b).cwiseMax(c).cwiseMax(d).array() + element.radius;
  return (low.array() <= rigid.path.high.array()).all() &&
         (high.array() >= rigid.path.low.array()).all();
}

void SoftCollider::look(int index, const Rigid& rigid, std::span<const Pose> start,
                        std::span<const Pose> end, double margin) {
  const SoftElement& element = elements_[index];
  const Placed placed = place(element, start);
  const double approach =
      std::max((end[element.from].x - start[element.from].x - rigid.move).norm(),
               (end[element.to].x - start[element.to].x - rigid.move).norm());
  const double reach = margin + approach + rigid.turn;
  const Relative pose = relativePose(placed.pose, rigid.at(start[rigid.body]));
  Manifold manifold;
  if (rigid.solid.kind == SolidKind::triangles) {
    std::vector<Manifold> more;
    int calls = 0;
    bool met = false;
    MeshLook mesh;
    mesh.pose = pose;
    mesh.near = mesh.reach = reach;
    touchMesh(placed.solid, rigid.solid, mesh, manifold, more, calls, met);
    take(index, placed.solid, rigid, pose, manifold, false);
    for (const Manifold& other : more) take(index, placed.solid, rigid, pose, other, false);
    return;
  }
  const bool swap = placed.solid.kind > rigid.solid.kind;  // a capsule against a sphere
  if (swap) {
    touch(rigid.solid, placed.solid, inverse(pose), reach, reach, 0, manifold);
  } else {
    touch(placed.solid, rigid.solid, pose, reach, reach, 0, manifold);
  }
  take(index, placed.solid, rigid, pose, manifold, swap);
}

void SoftCollider::take(int index, const Solid& solid, const Rigid& rigid, const Relative& pose,
                        const Manifold& manifold, bool swap) {
  const SoftElement& element = elements_[index];
  for (int k = 0; k < manifold.count; ++k) {
    const ContactPoint& p = manifold.points[k];
    const Vec3 n = swap ? Vec3(-(pose.R * manifold.normal)) : manifold.normal;  // rigid frame
    const Vec3& onElement = swap ? p.coreB : p.coreA;                           // its own frame
    const Vec3 onRigid = swap ? Vec3(p.coreA + p.radiusA * n) : Vec3(p.coreB + p.radiusB * n);
    const double length = 2 * solid.halfLength;
    const double along =
        element.isPoint() || length == 0 ? 0 : std::clamp(onElement.y() / length + 0.5, 0.0, 1.0);
    const double gap = n.dot(pose.R * onElement + pose.t - onRigid) - element.radius;
    SoftTouch& touch = touches_.emplace_back(SoftTouch{index, rigid.body, along, onRigid, n, gap});
    if (!rigid.isPart) continue;
    touch.onBody = rigid.inBody.x + rigid.inBody.q * onRigid;
    touch.normal = rigid.inBody.q * n;
  }
}

std::span<const SoftTouch> SoftCollider::find(std::span<const Pose> start,
                                              std::span<const Pose> end, double margin,
                                              std::span<const char> leftOut) {
  takeMotion(start, end, margin);
  touches_.clear();
  touches_.reserve(elements_.size());
  for (int k = 0; k < static_cast<int>(elements_.size()); ++k) {
    const bool out = !leftOut.empty() && leftOut[elements_[k].from] && leftOut[elements_[k].to];
    for (const Rigid& rigid : rigids_) {
      if (out && leftOut[rigid.body]) continue;
      if (mayTouch(elements_[k], rigid, start, end, margin)) look(k, rigid, start, end, margin);
    }
  }
  return touches_;
}

std::span<const SoftTouch> SoftCollider::find(std::span<const SoftPair> pairs,
                                              std::span<const Pose> start,
                                              std::span<const Pose> end, double margin) {
  takeMotion(start, end, margin);
  touches_.clear();
  for (const SoftPair& pair : pairs) {
    for (std::size_t i = rigidOf_[pair.body]; i < rigids_.size() && rigids_[i].body == pair.body;
         ++i) {
      if (!mayTouch(elements_[pair.element], rigids_[i], start, end, margin)) continue;
      look(pair.element, rigids_[i], start, end, margin);
    }
  }
  return touches_;
}

std::size_t SoftCollider::bytes() const {
  return elements_.capacity() * sizeof(SoftElement) + rigids_.capacity() * sizeof(Rigid) +
         ignored_.capacity() * sizeof(ignored_[0]) + touches_.capacity() * sizeof(SoftTouch);
}

}  // namespace physics
