// The factor of blocks beside a dense one.
#include "physics/solver/block_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cstring>
#include <random>

namespace physics::testing {
namespace {

// A ring of eight with two chords: some of L fills up. Pairs are held 1e7 times as stiffly as they
// are heavy, each along directions of its own: what stands between them is not symmetric.
TEST(BlockFactor, SolvesWhatADenseOneDoes) {
  constexpr int kCount = 8;
  std::vector<std::array<int, 2>> entries;
  for (int k = 0; k < kCount; ++k) entries.push_back({k, k});
  for (int k = 1; k < kCount; ++k) entries.push_back({k, k - 1});
  for (const auto& chord : {std::array{kCount - 1, 0}, {5, 2}, {6, 1}}) entries.push_back(chord);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> spread(-1, 1);
  const auto any = [&] { return Vec3(spread(random), spread(random), spread(random)); };
  std::vector<Mat3> own(kCount, Mat3::Identity()), between;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * kCount, 3 * kCount);
  for (std::size_t k = kCount; k < entries.size(); ++k) {
    const Vec3 d = any().normalized(), e = any().normalized();
    const auto [i, j] = entries[k];
    own[i] += 1e7 * d * d.transpose();
    own[j] += 1e7 * e * e.transpose();
    between.push_back(-1e7 * d * e.transpose());
    dense.block<3, 3>(3 * i, 3 * j) = between.back();
    dense.block<3, 3>(3 * j, 3 * i) = between.back().transpose();
  }
  for (int k = 0; k < kCount; ++k) dense.block<3, 3>(3 * k, 3 * k) = own[k];
  BlockFactor factor;
  factor.layOut(entries);
  factor.begin();
  for (const Mat3& block : own) factor.give(block);
  for (const Mat3& block : between) factor.give(block);
  factor.factorize();
  std::vector<Vec3> x(kCount);
  Eigen::VectorXd right(3 * kCount);
  for (int k = 0; k < kCount; ++k) right.segment<3>(3 * k) = x[k] = any();
  const Eigen::VectorXd wanted = dense.llt().solve(right);
  factor.solve(std::span(x));
  double off = 0;
  for (int k = 0; k < kCount; ++k) off = std::max(off, (x[k] - wanted.segment<3>(3 * k)).norm());
  EXPECT_LT(off, 1e-7 * wanted.norm());
  std::vector<BlockFactor::Sides> sides(kCount);
  for (int k = 0; k < kCount; ++k) {
    for (int side = 0; side < BlockFactor::kSides; ++side) {
      sides[k].col(side) = (side - 3) * right.segment<3>(3 * k);
    }
  }
  factor.solve(std::span(sides));
  for (int k = 0; k < kCount; ++k) {
    for (int side = 0; side < BlockFactor::kSides; ++side) {
      const Vec3 many = (side - 3) * x[k];
      EXPECT_LT((sides[k].col(side) - many).norm(), 1e-9 * wanted.norm()) << k << ", " << side;
    }
  }
  EXPECT_GT(wanted.norm(), 0.1);
}

TEST(BlockFactor, WideProductsAreTheSameBytes) {
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "no AVX2";
  std::mt19937 random(5);
  std::uniform_real_distribution<double> spread(-1, 1);
  const auto any = [&] {
    PaddedBlock block;
    for (int k = 0; k < 9; ++k) block.matrix()(k / 3, k % 3) = spread(random);
    return block;
  };
  constexpr int kCount = 5;
  const std::array<int, kCount> at = {4, 0, 3, 1, 2};
  std::array<PaddedBlock, kCount> lower, row;
  for (int k = 0; k < kCount; ++k) lower[k] = any(), row[k] = any();
  std::array<PaddedBlock, kCount> wide = row, narrow = row;
  const PaddedBlock block = any();
  kSubtractProductsAvx2(wide.data(), lower.data(), at.data(), kCount, block);
  kSubtractProductsSse2(narrow.data(), lower.data(), at.data(), kCount, block);
  EXPECT_EQ(0, std::memcmp(wide.data(), narrow.data(), sizeof wide));
  for (int k = 0; k < kCount; ++k) {
    const Mat3 wanted = row[at[k]].matrix() - lower[k].matrix() * block.matrix();
    EXPECT_LT((wide[at[k]].matrix() - wanted).norm(), 1e-15) << k;
  }
}

}  // namespace
}  // namespace physics::testing
