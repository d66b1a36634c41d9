// The factor of an island's rows.
#include "physics/accurate/row_system.h"

#include "physics/base/inverse.h"

namespace physics {
RowSystem::RowSystem(std::shared_ptr<const JointTopology> topology)
    : topology_(std::move(topology)),
      diagonal_(topology_->shapes.size()),
      entries_(topology_->meetings.size()),
      scaled_(topology_->meetings.size()) {}

void RowSystem::build(std::span<const IslandRow> rows, std::span<const BodyInverse> bodies) {
  const JointTopology& t = *topology_;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const JointShape& shape = t.shapes[i];
    Mat3& d = diagonal_[i];
    d.setIdentity();
    if (!rows[i].solved) continue;
    Mat3 a = rows[i].alpha;
    for (int b = 0; b < shape.bodyCount; ++b) {
      if (shape.moves[b]) a += couple(rows[i], b, rows[i], b, bodies[shape.body[b]]);
    }
    const double mean = a.trace() / shape.rows;
    for (int r = 0; r < shape.rows; ++r) a(r, r) += mean > 0 ? kRepeated * mean : 1;
    d.topLeftCorner(shape.rows, shape.rows) = a.topLeftCorner(shape.rows, shape.rows);
  }
  for (std::size_t i = 0; i < t.columns.size(); ++i) {
    for (int n = 0; n < t.columns[i].count; ++n) {
      const JointBelow& below = t.below[t.columns[i].start + n];
      Mat3& entry = entries_[below.block];
      entry.setZero();
      if (!rows[i].solved || !rows[below.to].solved) continue;
      const JointMeeting& meeting = t.meetings[below.block];
      for (int m = 0; m < meeting.count; ++m) {
        entry += couple(rows[below.to], meeting.later[m], rows[i], meeting.earlier[m],
                        bodies[t.shapes[i].body[meeting.earlier[m]]]);
      }
    }
  }
}

// A row of one number, whose blocks have no more than a column.
void RowSystem::eliminateSingle(int i) {
  const JointColumn& column = topology_->columns[i];
  const JointBelow* below = topology_->below.data() + column.start;
  diagonal_[i](0, 0) = 1 / diagonal_[i](0, 0);
  for (int q = 0; q < column.count; ++q) {
    const int block = below[q].block;
    scaled_[block].setZero();
    auto scaled = scaled_[block].col(0);
    scaled = entries_[block].col(0) * diagonal_[i](0, 0);
    const int* target = topology_->updates.data() + column.updates + q * (q + 1) / 2;
    for (int p = 0; p < q; ++p) {
      entries_[target[p]] -= scaled * entries_[below[p].block].col(0).transpose();
    }
    diagonal_[below[q].to] -= scaled * entries_[block].col(0).transpose();
  }
}

void RowSystem::eliminate(int i) {
  if (topology_->shapes[i].rows == 1) return eliminateSingle(i);
  const JointColumn& column = topology_->columns[i];
  const JointBelow* below = topology_->below.data() + column.start;
  diagonal_[i] = inverseOrNan(diagonal_[i]);
  for (int q = 0; q < column.count; ++q) {
    const int block = below[q].block;
    scaled_[block] = entries_[block] * diagonal_[i];
    const int* target = topology_->updates.data() + column.updates + q * (q + 1) / 2;
    for (int p = 0; p < q; ++p) {
      entries_[target[p]] -= scaled_[block] * entries_[below[p].block].transpose();
    }
    diagonal_[below[q].to] -= scaled_[block] * entries_[block].transpose();
  }
}

void RowSystem::factorize(std::span<const IslandRow> rows, std::span<const BodyInverse> bodies) {
  build(rows, bodies);
  for (std::size_t i = 0; i < topology_->columns.size(); ++i) eliminate(static_cast<int>(i));
}

void RowSystem::solve(std::span<Vec3> right) const {
  const JointTopology& t = *topology_;
  for (std::size_t i = 0; i < t.columns.size(); ++i) {
    for (int n = 0; n < t.columns[i].count; ++n) {
      const JointBelow& below = t.below[t.columns[i].start + n];
      right[below.to] -= scaled_[below.block] * right[i];
    }
  }
  for (std::size_t i = t.columns.size(); i-- > 0;) {
    Vec3 y = diagonal_[i] * right[i];
    for (int n = 0; n < t.columns[i].count; ++n) {
      const JointBelow& below = t.below[t.columns[i].start + n];
      y -= scaled_[below.block].transpose() * right[below.to];
    }
    right[i] = y;
  }
}

}  // namespace physics
