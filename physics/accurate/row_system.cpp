// The factor of an island's rows.
#include "physics/accurate/row_system.h"

#include <algorithm>

#include "physics/base/inverse.h"
#include "physics/base/rotation.h"

namespace physics {
namespace {

Mat3 linearOf(const IslandRow& row, int b) {
  return row.form == IslandRow::Form::kGap ? Mat3((b == 0 ? 1 : -1) * Mat3::Identity())
                                           : row.linear[b];
}

Mat3 angularOf(const IslandRow& row, int b) {
  return row.form == IslandRow::Form::kGap ? skew(b == 0 ? -row.arm[b] : row.arm[b])
                                           : row.angular[b];
}

// -[a]x M [b]x, column by column.
Mat3 turnBetweenArms(const Vec3& a, const Mat3& m, const Vec3& b) {
  Mat3 to;
  to.col(0) = (b.z() * m.col(1) - b.y() * m.col(2)).cross(a);
  to.col(1) = (b.x() * m.col(2) - b.z() * m.col(0)).cross(a);
  to.col(2) = (b.y() * m.col(0) - b.x() * m.col(1)).cross(a);
  return to;
}

}  // namespace

Mat3 couple(const IslandRow& k, int p, const IslandRow& i, int q, const BodyInverse& body) {
  using Form = IslandRow::Form;
  Mat3 sum;
  if (k.form == Form::kSingle && i.form == Form::kSingle) {
    sum.setZero();
    sum(0, 0) = body.mass * k.linear[p].row(0).dot(i.linear[q].row(0));
    if (body.turns) {
      const Vec3 turn = i.angular[q].row(0).transpose();
      sum(0, 0) += k.angular[p].row(0).dot(body.inertia * turn);
    }
    return sum;
  }
  if (k.form == Form::kGap && i.form == Form::kGap) {
    if (body.turns) {
      sum = turnBetweenArms(k.arm[p], body.inertia, i.arm[q]);
    } else {
      sum.setZero();
    }
    sum.diagonal().array() += body.mass;
    return p == q ? sum : -sum;
  }
  sum = body.mass * (linearOf(k, p) * linearOf(i, q).transpose());
  if (body.turns) sum += angularOf(k, p) * (body.inertia * angularOf(i, q).transpose());
  return sum;
}

RowSystem::RowSystem(std::shared_ptr<const JointTopology> topology)
    : topology_(std::move(topology)),
      diagonal_(topology_->shapes.size()),
      entries_(topology_->meetings.size()),
      scaled_(topology_->meetings.size()),
      isSingle_(std::all_of(topology_->shapes.begin(), topology_->shapes.end(),
                            [](const JointShape& shape) { return shape.rows == 1; })) {}

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

// Of rows of up to N numbers, by columns of no more than K.
template <int N, int K>
void RowSystem::eliminate(int i) {
  const JointColumn& column = topology_->columns[i];
  const JointBelow* below = topology_->below.data() + column.start;
  Eigen::Matrix<double, K, K> inverse;
  if constexpr (K == 1) {
    inverse(0, 0) = 1 / diagonal_[i](0, 0);
  } else {
    inverse = inverseOrNan(diagonal_[i]);
  }
  diagonal_[i].template topLeftCorner<K, K>() = inverse;
  for (int q = 0; q < column.count; ++q) {
    const int block = below[q].block;
    Eigen::Matrix<double, N, K> scaled = entries_[block].template topLeftCorner<N, K>() * inverse;
    if constexpr (K < N) scaled_[block].setZero();
    scaled_[block].template topLeftCorner<N, K>() = scaled;
    const int* target = topology_->updates.data() + column.updates + q * (q + 1) / 2;
    for (int p = 0; p < q; ++p) {
      entries_[target[p]].template topLeftCorner<N, N>() -=
          scaled * entries_[below[p].block].template topLeftCorner<N, K>().transpose();
    }
    diagonal_[below[q].to].template topLeftCorner<N, N>() -=
        scaled * entries_[block].template topLeftCorner<N, K>().transpose();
  }
}

void RowSystem::factorize(std::span<const IslandRow> rows, std::span<const BodyInverse> bodies) {
  build(rows, bodies);
  for (std::size_t column = 0; column < topology_->columns.size(); ++column) {
    const int i = static_cast<int>(column);
    if (isSingle_) {
      eliminate<1, 1>(i);
    } else if (topology_->shapes[column].rows == 1) {
      eliminate<3, 1>(i);
    } else {
      eliminate<3, 3>(i);
    }
  }
}

template <int N>
void RowSystem::solveBlocks(std::span<Vec3> right) const {
  const JointTopology& t = *topology_;
  for (std::size_t i = 0; i < t.columns.size(); ++i) {
    for (int n = 0; n < t.columns[i].count; ++n) {
      const JointBelow& below = t.below[t.columns[i].start + n];
      right[below.to].head<N>() -= scaled_[below.block].topLeftCorner<N, N>() * right[i].head<N>();
    }
  }
  for (std::size_t i = t.columns.size(); i-- > 0;) {
    Eigen::Matrix<double, N, 1> y = diagonal_[i].topLeftCorner<N, N>() * right[i].head<N>();
    for (int n = 0; n < t.columns[i].count; ++n) {
      const JointBelow& below = t.below[t.columns[i].start + n];
      y -= scaled_[below.block].topLeftCorner<N, N>().transpose() * right[below.to].head<N>();
    }
    right[i].head<N>() = y;
  }
}

void RowSystem::solve(std::span<Vec3> right) const {
  isSingle_ ? solveBlocks<1>(right) : solveBlocks<3>(right);
}

}  // namespace physics
