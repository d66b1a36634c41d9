// The sparse system of all joints.
#include "physics/sweep/joint_system.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <map>

namespace physics {

// Blocks (k, l), k >= l, of the lower triangle, with the place of every column in the value array.
struct JointSystem::Impl {
  struct Block {
    int k = 0, l = 0;
    std::array<int, JointRows::kMostRows>
        columnStart{};  // of row k.first (k.first + column if k == l)
  };
  std::size_t joints = 0;
  std::vector<Block> blocks;
  std::vector<bool> moves;
  Eigen::SparseMatrix<double> matrix;  // lower triangle, compressed columns
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> factor;
  Eigen::VectorXd right, solution;
};

JointSystem::JointSystem() = default;
JointSystem::~JointSystem() = default;
JointSystem::JointSystem(JointSystem&&) noexcept = default;
JointSystem& JointSystem::operator=(JointSystem&&) noexcept = default;

namespace {

// Pairs of joints that share a moving body, every joint with itself included; sorted by column then
// row.
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

}  // namespace

bool JointSystem::isLaidOutFor(std::size_t joints) const {
  return impl_ && impl_->joints == joints;
}

void JointSystem::layOut(std::span<const JointRows> joints, const Bodies& bodies) {
  impl_ = std::make_unique<Impl>();
  Impl& s = *impl_;
  s.joints = joints.size();
  for (const InverseMass& inverse : bodies.inverse) s.moves.push_back(inverse.m > 0);
  const auto pairs = meetings(joints, s.moves);
  const int size = joints.empty() ? 0 : joints.back().first + joints.back().rows;
  std::vector<Eigen::Triplet<double>> places;
  for (const auto& [l, k] : pairs) {
    for (int c = 0; c < joints[l].rows; ++c) {
      for (int r = k == l ? c : 0; r < joints[k].rows; ++r) {
        places.emplace_back(joints[k].first + r, joints[l].first + c, 1.0);
      }
    }
  }
  s.matrix.resize(size, size);
  s.matrix.setFromTriplets(places.begin(), places.end());
  s.matrix.makeCompressed();
  for (const auto& [l, k] : pairs) {
    Impl::Block block{k, l, {}};
    for (int c = 0; c < joints[l].rows; ++c) {
      const int column = joints[l].first + c, row = joints[k].first + (k == l ? c : 0);
      const int* begin = s.matrix.innerIndexPtr() + s.matrix.outerIndexPtr()[column];
      const int* end = s.matrix.innerIndexPtr() + s.matrix.outerIndexPtr()[column + 1];
      block.columnStart[c] =
          static_cast<int>(std::lower_bound(begin, end, row) - s.matrix.innerIndexPtr());
    }
    s.blocks.push_back(block);
  }
  s.factor.analyzePattern(s.matrix);
  s.right.resize(size);
}

bool JointSystem::factorize(std::span<const JointRows> joints) {
  Impl& s = *impl_;
  double* values = s.matrix.valuePtr();
  for (const Impl::Block& block : s.blocks) {
    const JointRows &k = joints[block.k], &l = joints[block.l];
    const Mat3 a = couple(k, l, s.moves);
    for (int c = 0; c < l.rows; ++c) {
      const int top = block.k == block.l ? c : 0;
      double* column = values + block.columnStart[c] - top;
      for (int r = top; r < k.rows; ++r) column[r] = a(r, c);
      if (block.k == block.l) column[c] += k.alpha;
    }
  }
  s.factor.factorize(s.matrix);
  return s.factor.info() == Eigen::Success;
}

void JointSystem::solve(std::span<const JointRows> joints, std::span<Vec3> change) {
  Impl& s = *impl_;
  for (const JointRows& joint : joints) {
    s.right.segment(joint.first, joint.rows) = joint.right.head(joint.rows);
  }
  s.solution = s.factor.solve(s.right);
  for (std::size_t k = 0; k < joints.size(); ++k) {
    change[k].setZero();
    change[k].head(joints[k].rows) = s.solution.segment(joints[k].first, joints[k].rows);
  }
}

}  // namespace physics
