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
template <int N>
void solveWhatADenseOneDoes() {
  using Block = Eigen::Matrix<double, N, N>;
  using Vector = Eigen::Matrix<double, N, 1>;
  using Factor = BlockFactor<N>;
  constexpr int kCount = 8;
  std::vector<std::array<int, 2>> entries;
  for (int k = 0; k < kCount; ++k) entries.push_back({k, k});
  for (int k = 1; k < kCount; ++k) entries.push_back({k, k - 1});
  for (const auto& chord : {std::array{kCount - 1, 0}, {5, 2}, {6, 1}}) entries.push_back(chord);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> spread(-1, 1);
  const auto any = [&] { return Vector::NullaryExpr([&] { return spread(random); }).eval(); };
  std::vector<Block> own(kCount, Block::Identity()), between;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(N * kCount, N * kCount);
  for (std::size_t k = kCount; k < entries.size(); ++k) {
    const Vector d = any().normalized(), e = any().normalized();
    const auto [i, j] = entries[k];
    own[i] += 1e7 * d * d.transpose();
    own[j] += 1e7 * e * e.transpose();
    between.push_back(-1e7 * d * e.transpose());
    dense.block<N, N>(N * i, N * j) = between.back();
    dense.block<N, N>(N * j, N * i) = between.back().transpose();
  }
  for (int k = 0; k < kCount; ++k) dense.block<N, N>(N * k, N * k) = own[k];
  Factor factor;
  factor.layOut(entries);
  factor.begin();
  for (const Block& block : own) factor.give(block);
  for (const Block& block : between) factor.give(block);
  factor.factorize();
  std::vector<Vector> x(kCount);
  Eigen::VectorXd right(N * kCount);
  for (int k = 0; k < kCount; ++k) right.segment<N>(N * k) = x[k] = any();
  const Eigen::VectorXd wanted = dense.llt().solve(right);
  factor.solve(std::span(x));
  double off = 0;
  for (int k = 0; k < kCount; ++k) off = std::max(off, (x[k] - wanted.segment<N>(N * k)).norm());
  EXPECT_LT(off, 1e-7 * wanted.norm());
  std::vector<typename Factor::Sides> sides(kCount);
  for (int k = 0; k < kCount; ++k) {
    for (int side = 0; side < Factor::kSides; ++side) {
      sides[k].col(side) = (side - 3) * right.segment<N>(N * k);
    }
  }
  factor.solve(std::span(sides));
  for (int k = 0; k < kCount; ++k) {
    for (int side = 0; side < Factor::kSides; ++side) {
      const Vector many = (side - 3) * x[k];
      EXPECT_LT((sides[k].col(side) - many).norm(), 1e-9 * wanted.norm()) << k << ", " << side;
    }
  }
  EXPECT_GT(wanted.norm(), 0.1);
}

TEST(BlockFactor, SolvesWhatADenseOneDoes) {
  solveWhatADenseOneDoes<3>();
  solveWhatADenseOneDoes<6>();
}

template <int N>
void compareWideProducts(SubtractProducts<N> sse2, SubtractProducts<N> avx2) {
  using Padded = PaddedBlock<N>;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> spread(-1, 1);
  const auto any = [&] {
    Padded block;
    for (int k = 0; k < N * N; ++k) matrixOf(block)(k / N, k % N) = spread(random);
    return block;
  };
  constexpr double kRounding = 1e-15 * (N * N / 9);  // of N^2 numbers, each a sum of N products
  constexpr int kCount = 5;
  const std::array<int, kCount> at = {4, 0, 3, 1, 2};
  std::array<Padded, kCount> lower, row;
  for (int k = 0; k < kCount; ++k) lower[k] = any(), row[k] = any();
  std::array<Padded, kCount> wide = row, narrow = row;
  const Padded block = any();
  avx2(wide.data(), lower.data(), at.data(), kCount, block);
  sse2(narrow.data(), lower.data(), at.data(), kCount, block);
  EXPECT_EQ(0, std::memcmp(wide.data(), narrow.data(), sizeof wide));
  for (int k = 0; k < kCount; ++k) {
    const Eigen::Matrix<double, N, N> wanted =
        matrixOf(row[at[k]]) - matrixOf(lower[k]) * matrixOf(block);
    EXPECT_LT((matrixOf(wide[at[k]]) - wanted).norm(), kRounding) << k;
  }
}

TEST(BlockFactor, WideProductsAreTheSameBytes) {
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "no AVX2";
  compareWideProducts<3>(kBlockKernelsSse2.three, kBlockKernelsAvx2.three);
  compareWideProducts<6>(kBlockKernelsSse2.six, kBlockKernelsAvx2.six);
}

}  // namespace
}  // namespace physics::testing
