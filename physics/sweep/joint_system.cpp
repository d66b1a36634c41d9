// The sparse system of all joints.
#include "physics/sweep/joint_system.h"

#include <algorithm>
#include <map>

namespace physics {
namespace {

// Pairs of joints that share a moving body, every joint with itself included; by the earlier one.
std::vector<std::array<int, 2>> meetings(std::span<const JointRows> joints,
                                         const std::vector<bool>& moves) {
  std::map<BodyId, std::vector<int>> at;
  std::vector<std::array<int, 2>> pairs;
  for (int k = 0; k < static_cast<int>(joints.size()); ++k) {
    pairs.push_back({k, k});
    for (const BodyId body : joints[k].bodies) {
      if (!moves[body]) continue;
      for (const int l : at[body]) pairs.push_back({l, k});
      at[body].push_back(k);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

Mat3 couple(const JointRows& k, const JointRows& l, const std::vector<bool>& moves) {
  Mat3 sum = Mat3::Zero();
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      if (k.bodies[i] != l.bodies[j] || !moves[k.bodies[i]]) continue;
      sum.noalias() += k.linear[i].lazyProduct(l.responseLinear[j]);
      sum.noalias() += k.angular[i].lazyProduct(l.responseAngular[j]);
    }
  }
  return sum;
}

// f(row, column) of what two joints have below the diagonal and on it.
template <class F>
void forEachEntry(std::span<const JointRows> joints, const std::array<int, 2>& pair, F&& f) {
  const auto [k, l] = pair;
  for (int c = 0; c < joints[l].rows; ++c) {
    for (int r = k == l ? c : 0; r < joints[k].rows; ++r) f(r, c);
  }
}

}  // namespace

bool JointSystem::isLaidOutFor(std::size_t joints) const {
  return factor_.isLaidOut() && joints_ == joints;
}

void JointSystem::layOut(std::span<const JointRows> joints, const Bodies& bodies) {
  joints_ = joints.size();
  pairs_.clear();
  moves_.clear();
  for (const InverseMass& inverse : bodies.inverse) moves_.push_back(inverse.m > 0);
  std::vector<std::array<int, 2>> entries;
  for (const auto& [l, k] : meetings(joints, moves_)) {
    pairs_.push_back({k, l});
    forEachEntry(joints, {k, l}, [&, k = k, l = l](int r, int c) {
      entries.push_back({joints[k].first + r, joints[l].first + c});
    });
  }
  factor_.layOut(entries);
  right_.resize(factor_.size());
}

bool JointSystem::factorize(std::span<const JointRows> joints) {
  factor_.begin();
  for (const auto& pair : pairs_) {
    const JointRows &k = joints[pair[0]], &l = joints[pair[1]];
    Mat3 a = couple(k, l, moves_);
    if (pair[0] == pair[1]) a.diagonal().array() += k.alpha;
    forEachEntry(joints, pair, [&](int r, int c) { factor_.give(a(r, c)); });
  }
  return factor_.factorize();
}

void JointSystem::solve(std::span<const JointRows> joints, std::span<Vec3> change) {
  for (const JointRows& joint : joints) {
    right_.segment(joint.first, joint.rows) = joint.right.head(joint.rows);
  }
  factor_.solve(right_, solution_);
  for (std::size_t k = 0; k < joints.size(); ++k) {
    change[k].setZero();
    change[k].head(joints[k].rows) = solution_.segment(joints[k].first, joints[k].rows);
  }
}

}  // namespace physics
