// The factor of an island's rows at both ends of a step.
#include "physics/accurate/cross_system.h"

#include "physics/base/inverse.h"

namespace physics {

CrossSystem::CrossSystem(std::shared_ptr<const JointTopology> topology)
    : topology_(std::move(topology)),
      diagonal_(topology_->shapes.size()),
      lower_(topology_->meetings.size()),
      upper_(topology_->meetings.size()) {}

void CrossSystem::build(std::span<const IslandRow> ends, std::span<const IslandRow> starts,
                        std::span<const BodyInverse> bodies) {
  const JointTopology& t = *topology_;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const JointShape& shape = t.shapes[i];
    diagonal_[i].setIdentity();
    if (!starts[i].solved) continue;
    Mat3 a = starts[i].alpha;
    double size = a.trace();
    for (int b = 0; b < shape.bodyCount; ++b) {
      if (!shape.moves[b]) continue;
      a += couple(ends[i], b, starts[i], b, bodies[shape.body[b]]);
      size += couple(starts[i], b, starts[i], b, bodies[shape.body[b]]).trace();
    }
    for (int r = 0; r < shape.rows; ++r) a(r, r) += size > 0 ? kRepeated * size / shape.rows : 1;
    diagonal_[i].topLeftCorner(shape.rows, shape.rows) = a.topLeftCorner(shape.rows, shape.rows);
  }
  for (std::size_t i = 0; i < t.columns.size(); ++i) {
    for (int n = 0; n < t.columns[i].count; ++n) {
      const JointBelow& below = t.below[t.columns[i].start + n];
      lower_[below.block].setZero();
      upper_[below.block].setZero();
      if (!starts[i].solved || !starts[below.to].solved) continue;
      const JointMeeting& meeting = t.meetings[below.block];
      for (int m = 0; m < meeting.count; ++m) {
        const int p = meeting.later[m], q = meeting.earlier[m];
        const BodyInverse& body = bodies[t.shapes[i].body[q]];
        lower_[below.block] += couple(ends[below.to], p, starts[i], q, body);
        upper_[below.block] += couple(ends[i], q, starts[below.to], p, body);
      }
    }
  }
}

void CrossSystem::eliminate(int i) {
  const JointColumn& column = topology_->columns[i];
  const JointBelow* below = topology_->below.data() + column.start;
  diagonal_[i] = inverseOrNan(diagonal_[i]);
  for (int q = 0; q < column.count; ++q) lower_[below[q].block] *= diagonal_[i];
  for (int q = 0; q < column.count; ++q) {
    const int* target = topology_->updates.data() + column.updates + q * (q + 1) / 2;
    const Mat3 &lower = lower_[below[q].block], &upper = upper_[below[q].block];
    for (int p = 0; p < q; ++p) {
      lower_[target[p]] -= lower * upper_[below[p].block];
      upper_[target[p]] -= lower_[below[p].block] * upper;
    }
    diagonal_[below[q].to] -= lower * upper;
  }
}

void CrossSystem::factorize(std::span<const IslandRow> ends, std::span<const IslandRow> starts,
                            std::span<const BodyInverse> bodies) {
  build(ends, starts, bodies);
  for (std::size_t i = 0; i < topology_->columns.size(); ++i) eliminate(static_cast<int>(i));
}

void CrossSystem::solve(std::span<Vec3> right) const {
  const JointTopology& t = *topology_;
  for (std::size_t i = 0; i < t.columns.size(); ++i) {
    for (int n = 0; n < t.columns[i].count; ++n) {
      const JointBelow& below = t.below[t.columns[i].start + n];
      right[below.to] -= lower_[below.block] * right[i];
    }
  }
  for (std::size_t i = t.columns.size(); i-- > 0;) {
    Vec3 y = right[i];
    for (int n = 0; n < t.columns[i].count; ++n) {
      const JointBelow& below = t.below[t.columns[i].start + n];
      y -= upper_[below.block] * right[below.to];
    }
    right[i] = diagonal_[i] * y;
  }
}

}  // namespace physics
