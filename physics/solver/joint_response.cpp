// What contacts see of the joints behind a body, by the factor of the joints.
#include <algorithm>

#include "physics/solver/articulation.h"
#include "physics/solver/joint_lanes.h"

namespace physics {

void JointResponse::clear() {
  slots_.clear();
  touched_.clear();
  starts_.clear();
  entries_.clear();
}

// What its joints are eliminated into, and those into: of each column the first row below.
int JointResponse::touch(int body, int slot, const JointTopology& topology) {
  if (slots_.empty()) {
    at_.assign(topology.bodyCount, -1);
    pulls_.assign(topology.shapes.size(), Vec3::Zero());
    starts_.push_back(0);
  }
  at_[body] = static_cast<int>(slots_.size());
  slots_.push_back(slot);
  touched_.push_back({body, {}});
  isMet_.assign(topology.tailStart, 0);
  for (int i = 0; i < topology.tailStart; ++i) {
    const JointShape& shape = topology.shapes[i];
    for (int b = 0; b < shape.bodyCount; ++b) {
      if (shape.moves[b] && shape.body[b] == body) isMet_[i] = 1;
    }
    if (!isMet_[i]) continue;
    entries_.push_back({i, Row::Zero(), Row::Zero()});
    const JointColumn& column = topology.columns[i];
    const int parent = column.count > 0 ? topology.below[column.start].to : topology.tailStart;
    if (parent < topology.tailStart) isMet_[parent] = 1;
  }
  starts_.push_back(static_cast<int>(entries_.size()));
  return at_[body];
}

void JointResponse::give(int place, const Six& impulse) {
  touched_[place].given += impulse;
  for (const Entry& entry : entriesOf(entries_, place))
    pulls_[entry.row].noalias() += entry.over * impulse;
}

JointResponse::Six JointResponse::takeGiven(int place) {
  const Six given = touched_[place].given;
  touched_[place].given.setZero();
  return given;
}

void JointResponse::forgetPulls() { std::fill(pulls_.begin(), pulls_.end(), Vec3::Zero()); }

JointResponse::Six JointResponse::movedBy(int place) const {
  const Body& body = touched_[place];
  Six by = body.alone * body.given;
  for (const Entry& entry : entriesOf(entries_, place)) {
    by.noalias() -= entry.of.transpose() * pulls_[entry.row];
  }
  return by;
}

JointResponse::SixBySix JointResponse::between(int place, int other) const {
  SixBySix r = place == other ? touched_[place].alone : SixBySix::Zero().eval();
  const auto a = entriesOf(entries_, place), b = entriesOf(entries_, other);
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
    if (i->row == j->row) r.noalias() -= i->of.transpose() * j->over;
    const int reached = std::min(i->row, j->row);
    if (i->row == reached) ++i;
    if (j->row == reached) ++j;
  }
  return r;
}

// M_b^-1 and J M_b^-1 in the units of its lane, of rows that are free.
template <int W>
void JointPack<W>::pushAlone(int l, JointResponse::Body& touched,
                             std::span<JointResponse::Entry> entries) {
  const int body = touched.body;
  const LaneInverse inverse = inverseOf(touched.mass);
  const double mass = bodies_[body].inverseMass.v[l];
  touched.alone.setZero();
  for (int c = 0; c < 3; ++c) {
    const Vec3 torque = torqueOf(touched.mass, Vec3::Unit(c).eval());
    touched.alone(c, c) = mass;
    touched.alone.col(3 + c).tail<3>() = turnOf(inverse, turnBy(bodies_[body], l, torque));
  }
  for (JointResponse::Entry& entry : entries) {
    entry.of.setZero();
    const JointShape& shape = topology_->shapes[entry.row];
    const JointLanes<W>& row = rows_[entry.row];
    if (!used_[entry.row] || !(row.free.v[l] > 0)) continue;
    for (int b = 0; b < shape.bodyCount; ++b) {
      if (!shape.moves[b] || shape.body[b] != body) continue;
      for (int r = 0; r < shape.rows; ++r) {
        auto of = entry.of.row(r);
        if (shape.isGap) of[r] += b == 0 ? mass : -mass;
        if (shape.hasLinear) {
          of.template head<3>() += mass * read(row.linear[b] + 3 * r, l).transpose();
        }
        if (shape.hasAngular) {
          const Vec3 turn = read(factors_[entry.row].response[b] + 3 * r, l);
          of.template tail<3>() += turnOf(inverse, turn).transpose();
        }
      }
    }
  }
}

namespace {

// to -= scaled of, in lane l
template <int R, int C, int W, class Row>
void takeAway(const Num<W>* scaled, int l, const Row& of, Row& to) {
  for (int r = 0; r < R; ++r) {
    auto row = to.row(r).eval();
    for (int c = 0; c < C; ++c) row -= scaled[c * R + r].v[l] * of.row(c);
    to.row(r) = row;
  }
}

}  // namespace

// L^-1 of that, and D^-1.
template <int W>
void JointPack<W>::eliminate(int l, std::span<JointResponse::Entry> entries) {
  for (std::size_t k = 0; k < entries.size(); ++k) {
    entryOf_[entries[k].row] = static_cast<int>(k);
  }
  for (JointResponse::Entry& entry : entries) {
    const int i = entry.row, size = topology_->shapes[i].size;
    const auto* inverse = factors_[i].inverse;
    entry.over.setZero();
    if (!used_[i]) continue;
    for (int r = 0; r < size; ++r) {
      for (int c = 0; c < size; ++c) {
        const int low = std::min(r, c), high = std::max(r, c);
        entry.over.row(r) += inverse[high * (high + 1) / 2 + low].v[l] * entry.of.row(c);
      }
    }
    const JointColumn& column = topology_->columns[i];
    for (int u = 0; u < usedCounts_[i]; ++u) {
      const JointBelow& below = topology_->below[column.start + usedBelow_[column.start + u]];
      if (below.to >= topology_->tailStart) continue;
      auto& to = entries[entryOf_[below.to]].of;
      const auto* scaled = &scaled_[below.at];
      if (topology_->shapes[below.to].size == 1) {
        size == 1 ? takeAway<1, 1>(scaled, l, entry.of, to)
                  : takeAway<1, 3>(scaled, l, entry.of, to);
      } else {
        size == 1 ? takeAway<3, 1>(scaled, l, entry.of, to)
                  : takeAway<3, 3>(scaled, l, entry.of, to);
      }
    }
  }
}

template <int W>
void JointPack<W>::respond() {
  entryOf_.resize(rows_.size());
  for (int l = 0; l < lanes_; ++l) {
    JointResponse& response = of_[l]->response_;
    for (int place = 0; place < static_cast<int>(response.size()); ++place) {
      const auto entries = response.entriesOf(response.entries_, place);
      pushAlone(l, response.touched_[place], entries);
      eliminate(l, entries);
      response.touched_[place].own = response.between(place, place);
    }
  }
}

template void JointPack<1>::respond();
template void JointPack<4>::respond();
template void JointPack<8>::respond();

}  // namespace physics
