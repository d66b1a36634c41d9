// Joints in turns with contacts: what a turn leaves open, in any lane and in any registers.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cstring>
#include <random>
#include <vector>

#include "physics/base/types.h"
#include "physics/solver/turn_block.h"

namespace physics::testing {
namespace {

constexpr int kBodies = 3, kGaps = 2, kRows = 7, kFirstBlock = sizeof(TurnGap) / sizeof(Eight);
using Jacobian = Eigen::Matrix<double, kRows, 6 * kBodies>;
using Square = Eigen::Matrix<double, kRows, kRows>;
using Rows = Eigen::Matrix<double, kRows, 1>;
using Motion = Eigen::Matrix<double, 6 * kBodies, 1>;

Mat3 crossing(const Vec3& a) {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

// Three bodies in a row, joined by two gaps and, the first two, by a limit. A lane is a chain.
struct Chains {
  TurnBody bodies[kBodies];
  TurnMotion motions[kBodies];
  TurnRow rows[kGaps + 1] = {
      {{0, 1}, 0, 0, 2}, {{1, 2}, kFirstBlock + 12, 2, 1}, {{0, 1}, 0, 3, 0}};
  int below[3] = {3, 6, 6};
  std::vector<Eight> numbers = std::vector<Eight>(2 * kFirstBlock + 15);
  TurnLimit limit;
  Eight right[kRows], lambda[kRows], tail[1], factor[1], held[2];
  char gives[1] = {};
  bool isFactored = false;
  std::vector<LaneMotion> moves = std::vector<LaneMotion>(1 + 8 * kBodies);
  Jacobian j[8];
  Rows off[8];

  TurnGap& gap(int i) { return *reinterpret_cast<TurnGap*>(&numbers[rows[i].numbers]); }

  void fill(int l, unsigned seed, float high) {
    std::mt19937 random(seed);
    const auto next = [&] { return random() / 4294967296.0 - 0.5; };
    const auto any = [&] { return Vec3(next(), next(), next()); };
    j[l].setZero();
    for (int i = 0; i < kGaps; ++i) {
      for (int b = 0; b < 2; ++b) {
        const Vec3 arm = any();
        for (int k = 0; k < 3; ++k) gap(i).arm[b][k].v[l] = static_cast<float>(arm[k]);
        j[l].block<3, 3>(3 * i, 6 * (i + b)) = (b == 0 ? 1 : -1) * Mat3::Identity();
        j[l].block<3, 3>(3 * i, 6 * (i + b) + 3) = crossing(arm);
      }
      gap(i).free.v[l] = 1;
    }
    const Vec3 gradient = any();
    for (int k = 0; k < 3; ++k) limit.gradient[k].v[l] = static_cast<float>(gradient[k]);
    j[l].block<1, 3>(6, 3) = -gradient.transpose();
    j[l].block<1, 3>(6, 9) = gradient.transpose();
    limit.free.v[l] = 1;
    limit.low.v[l] = -1e9f;
    limit.high.v[l] = high;
    for (int k = 0; k < kRows; ++k) off[l][k] = 0.01 * next();
    for (int k = 0; k < 6; ++k) gap(k / 3).off[k % 3].v[l] = static_cast<float>(off[l][k]);
    limit.off.v[l] = static_cast<float>(off[l][6]);
    for (int b = 0; b < kBodies; ++b) {
      bodies[b].slot[l] = 1 + 8 * b + l;
      bodies[b].inverseMass.v[l] = 1;
      for (const int k : {0, 3, 5}) bodies[b].root[k].v[l] = 1;
      for (const int k : {0, 4, 8}) bodies[b].given[k].v[l] = 1;
      LaneMotion& motion = moves[bodies[b].slot[l]];
      for (int k = 0; k < 3; ++k) motion.u[k] = motion.turn[k] = static_cast<float>(0.01 * next());
    }
    eliminate(l);
  }

  // L and D^-1 of A = J J^T, all masses being one, by blocks.
  void eliminate(int l) {
    Square a = j[l] * j[l].transpose();
    const auto write = [l](const Eigen::MatrixXd& from, Eight* to) {
      for (int r = 0, k = 0; r < from.rows(); ++r) {
        for (int c = 0; c < from.cols(); ++c) to[k++].v[l] = static_cast<float>(from(r, c));
      }
    };
    for (int i = 0; i < kGaps; ++i) {
      const int first = 3 * i, rest = kRows - first - 3;
      const Mat3 inverse = a.block<3, 3>(first, first).inverse();
      const Eigen::MatrixXd scaled = a.block(first + 3, first, rest, 3) * inverse;
      a.bottomRightCorner(rest, rest) -= scaled * a.block(first, first + 3, 3, rest);
      for (int r = 0, k = 0; r < 3; ++r) {
        for (int c = 0; c <= r; ++c) gap(i).inverse[k++].v[l] = static_cast<float>(inverse(r, c));
      }
      write(scaled, &numbers[rows[i].numbers + kFirstBlock]);
    }
    tail[0].v[l] = static_cast<float>(a(6, 6));
  }

  void follow(const TurnKernels& kernels) {
    kernels.follow({bodies, motions, kBodies, rows, kGaps, 1, below, numbers.data(), &limit, right,
                    lambda, tail, factor, held, gives, &isFactored},
                   moves.data());
  }

  Rows openOf(int l) const {
    Motion motion;
    for (int b = 0; b < kBodies; ++b) {
      const LaneMotion& of = moves[bodies[b].slot[l]];
      for (int k = 0; k < 3; ++k) {
        motion[6 * b + k] = of.u[k];
        motion[6 * b + 3 + k] = of.turn[k];
      }
    }
    return j[l] * motion + off[l];
  }
};

TEST(TurnKernels, LeaveNothingOpenThatHolds) {
  Chains chains;
  for (int l = 0; l < 8; ++l) chains.fill(l, l, 1e9f);
  EXPECT_GT(chains.openOf(3).norm(), 1e-3);
  chains.follow(turnKernels());
  for (int l = 0; l < 8; ++l) {
    EXPECT_LT(chains.openOf(l).norm(), 1e-7) << l;  // of 1e-2, in single precision
    EXPECT_NE(chains.lambda[6].v[l], 0) << l;
  }
}

TEST(TurnKernels, HoldLimitsAtTheirBoundInLanesThatMeetIt) {
  Chains chains;
  for (int l = 0; l < 8; ++l) chains.fill(l, l, 1e9f);
  chains.follow(turnKernels());
  Chains bounded;
  for (int l = 0; l < 8; ++l) bounded.fill(l, l, 0);
  bounded.follow(turnKernels());
  int held = 0;
  for (int l = 0; l < 8; ++l) {
    const bool meets = chains.lambda[6].v[l] > 0;
    held += meets;
    EXPECT_EQ(bounded.lambda[6].v[l], meets ? 0 : chains.lambda[6].v[l]) << l;
    EXPECT_LT(bounded.openOf(l).head<6>().norm(), 1e-7) << l;
    EXPECT_LT(bounded.openOf(l)[6], 1e-7) << l;  // it opens the one way only
  }
  EXPECT_GT(held, 0);
  EXPECT_LT(held, 8);
}

TEST(TurnKernels, GiveTheSameBytesInAnyRegisters) {
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "no AVX2 here";
  Chains wide, halves;
  for (int l = 0; l < 8; ++l) {
    wide.fill(l, l, 0);
    halves.fill(l, l, 0);
  }
  wide.follow(kTurnKernelsAvx2);
  halves.follow(kTurnKernelsSse2);
  EXPECT_EQ(
      std::memcmp(wide.moves.data(), halves.moves.data(), wide.moves.size() * sizeof(LaneMotion)),
      0);
}

TEST(TurnKernels, GiveALaneTheBytesThatItHasAlone) {
  Chains eight;
  for (int l = 0; l < 8; ++l) eight.fill(l, l, 0);
  eight.follow(turnKernels());
  for (int l = 0; l < 8; ++l) {
    Chains one;
    one.fill(0, l, 0);
    one.follow(turnKernels());
    for (int b = 0; b < kBodies; ++b) {
      EXPECT_EQ(std::memcmp(one.moves[one.bodies[b].slot[0]].u, eight.moves[1 + 8 * b + l].u,
                            6 * sizeof(float)),
                0)
          << l;
    }
  }
}

}  // namespace
}  // namespace physics::testing
