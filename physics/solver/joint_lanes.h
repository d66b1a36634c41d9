// What enters and leaves the lanes of joint_block.h, and what a row with bounds does in one of
// them.
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "physics/bodies/body.h"
#include "physics/solver/articulation.h"
#include "physics/solver/joint_row.h"

namespace physics {

template <int W>
Vec3 read(const Num<W>* from, int l) {
  return {from[0].v[l], from[1].v[l], from[2].v[l]};
}

template <int W>
void write(Num<W>* to, int l, const Vec3& v) {
  for (int k = 0; k < 3; ++k) to[k].v[l] = v[k];
}

template <int W>
Quat readTurn(const Num<W>* from, int l) {
  return Quat(from[0].v[l], from[1].v[l], from[2].v[l], from[3].v[l]);
}

template <int W>
void writeTurn(Num<W>* to, int l, const Quat& q) {
  to[0].v[l] = q.w();
  write(to + 1, l, q.vec());
}

// xx yy zz xy xz yz
template <int W>
void writeSymmetric(Num<W>* to, int l, const Mat3& m) {
  const double entries[6] = {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)};
  for (int k = 0; k < 6; ++k) to[k].v[l] = entries[k];
}

template <int W>
Mat3 readSymmetric(const Num<W>* from, int l) {
  const auto entry = [&](int k) { return from[k].v[l]; };
  Mat3 m;
  m << entry(0), entry(3), entry(4), entry(3), entry(1), entry(5), entry(4), entry(5), entry(2);
  return m;
}

template <int W>
void writeRows(Num<W>* to, int l, const Mat3& m, int rows) {
  for (int r = 0; r < rows; ++r) {
    for (int k = 0; k < 3; ++k) to[3 * r + k].v[l] = m(r, k);
  }
}

template <int W>
Mat3 readRows(const Num<W>* from, int l, int rows) {
  Mat3 m = Mat3::Zero();
  for (int r = 0; r < rows; ++r) m.row(r) = read(from + 3 * r, l);
  return m;
}

// `ids`: the body of each lane, body after body.
template <int W>
void gatherMotion(std::span<const BodyId> ids, std::span<const Displacement> moved,
                  std::span<JointBody<W>> bodies) {
  for (std::size_t i = 0; i < ids.size(); ++i) {
    write(bodies[i / W].u, i % W, moved[ids[i]].u);
    write(bodies[i / W].theta, i % W, moved[ids[i]].theta);
  }
}

template <int W>
void gatherMasses(std::span<const BodyId> ids, std::span<const JointMass> masses,
                  std::span<JointBody<W>> bodies) {
  for (std::size_t i = 0; i < ids.size(); ++i) {
    bodies[i / W].inverseMass.v[i % W] = masses[ids[i]].inverse;
    writeSymmetric(bodies[i / W].inertia, i % W, masses[ids[i]].inertia);
  }
}

template <int W>
void gatherPoses(std::span<const BodyId> ids, std::span<const Pose> pose,
                 std::span<JointBody<W>> bodies) {
  for (std::size_t i = 0; i < ids.size(); ++i) {
    write(bodies[i / W].x, i % W, pose[ids[i]].x);
    writeTurn(bodies[i / W].q, i % W, pose[ids[i]].q);
  }
}

template <int W>
void scatterMotion(std::span<const BodyId> ids, int lanes, std::span<const char> moves,
                   std::span<const JointBody<W>> bodies, std::span<Displacement> moved) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (int l = 0; moves[i] && l < lanes; ++l) {
      moved[ids[i * W + l]] = {read(bodies[i].u, l), read(bodies[i].theta, l)};
    }
  }
}

template <int W>
void scatterPoses(std::span<const BodyId> ids, int lanes, std::span<const JointBody<W>> bodies,
                  std::span<Pose> pose) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (int l = 0; l < lanes; ++l) {
      pose[ids[i * W + l]] = {read(bodies[i].x, l), readTurn(bodies[i].q, l)};
    }
  }
}

template <int W>
void takeGradients(const JointShape& shape, int l, const JointRow& from, JointLanes<W>& row) {
  for (int b = 0; b < shape.bodyCount; ++b) {
    if (shape.hasLinear) writeRows(row.linear[b], l, from.linear[b], shape.rows);
    if (shape.hasAngular) writeRows(row.angular[b], l, from.angular[b], shape.rows);
    if (shape.pulls) write(row.arm[b], l, from.arm[b]);
  }
}

template <int W>
void takeError(int l, const JointRow& from, JointLanes<W>& row) {
  write(row.c, l, from.c);
  row.low.v[l] = from.low;
  row.high.v[l] = from.high;
  row.longest.v[l] = from.longest;
  for (int r = 0, k = 0; r < 3; ++r) {
    for (int c = 0; c <= r; ++c) row.alpha[k++].v[l] = from.alpha(r, c);
  }
}

template <int W>
bool isBounded(const JointLanes<W>& row, int l) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return row.low.v[l] > -kInfinity || row.high.v[l] < kInfinity || row.longest.v[l] < kInfinity;
}

template <int W>
bool hasAlpha(const JointLanes<W>& row, int l) {
  return std::any_of(std::begin(row.alpha), std::end(row.alpha),
                     [l](const Num<W>& entry) { return entry.v[l] != 0; });
}

template <int W>
Vec3 clamped(const JointShape& shape, const JointLanes<W>& row, int l, const Vec3& total) {
  Vec3 inside = total;
  for (int r = 0; r < shape.rows; ++r) {
    inside[r] = std::clamp(total[r], row.low.v[l], row.high.v[l]);
  }
  const double length = inside.norm();
  if (length > row.longest.v[l]) inside *= row.longest.v[l] / length;  // (132)
  return inside;
}

// I^-1 torque
template <int W>
Vec3 turnBy(const JointBody<W>& body, int l, const Vec3& torque) {
  const auto inertia = [&](int k) { return body.inertia[k].v[l]; };
  const Vec3 x(inertia(0), inertia(3), inertia(4)), y(inertia(3), inertia(1), inertia(5)),
      z(inertia(4), inertia(5), inertia(2));
  return {x.dot(torque), y.dot(torque), z.dot(torque)};
}

// u += M^-1 J^T change, of one lane.
template <int W>
void give(const JointShape& shape, const JointLanes<W>& row, int l, const Vec3& change,
          std::span<JointBody<W>> bodies) {
  for (int b = 0; b < shape.bodyCount; ++b) {
    if (!shape.moves[b]) continue;
    JointBody<W>& body = bodies[shape.body[b]];
    Vec3 push = Vec3::Zero(), turn = Vec3::Zero();
    for (int r = 0; r < shape.rows; ++r) {
      if (shape.hasLinear) push += change[r] * read(row.linear[b] + 3 * r, l);
      if (shape.hasAngular) turn += change[r] * read(row.angular[b] + 3 * r, l);
    }
    write(body.u, l, read(body.u, l) + body.inverseMass.v[l] * push);
    write(body.theta, l, read(body.theta, l) + turnBy(body, l, turn));
  }
}

}  // namespace physics
