// Bodies side by side: as one by itself, and the same bytes whatever registers.
#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include "physics/base/rotation.h"
#include "physics/motion/free_motion.h"
#include "physics/small_steps/body_block.h"

namespace physics::testing {
namespace {

using Lanes = BodyBlock::Lanes;

constexpr double kH = 1.0 / 240;

Vec3 at(const Lanes (&of)[3], int l) { return {of[0].v[l], of[1].v[l], of[2].v[l]}; }
void put(Lanes (&to)[3], int l, const Vec3& v) {
  for (int k = 0; k < 3; ++k) to[k].v[l] = v[k];
}
Quat turnAt(const BodyBlock& b, int l) {
  return {b.q[0].v[l], b.q[1].v[l], b.q[2].v[l], b.q[3].v[l]};
}

Mat3 worldOf(const Quat& q, const Vec3& principal) {
  const Mat3 r = q.toRotationMatrix();
  return r * principal.asDiagonal() * r.transpose();
}

// Of lanes two in three turn with their inertia, one is a cube; the third is given its way, and the
// last spins far in a substep.
BodyBlock anyBlock(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto vector = [&] { return Vec3(any(random), any(random), any(random)); };
  BodyBlock b = {};
  for (int l = 0; l < BodyBlock::kLanes; ++l) {
    b.moves.v[l] = b.isTurned.v[l] = l != 2;
    b.turns.v[l] = l != 2 && l % 3 != 1;
    b.h.v[l] = kH;
    b.rate.v[l] = 1 / kH;
    const Vec3 inertia = b.turns.v[l] > 0 ? Vec3(1, 2, 2.5) : Vec3(2, 2, 2);
    put(b.inertia, l, inertia);
    put(b.inverseInertia, l, l == 2 ? Vec3(0, 0, 0) : inertia.cwiseInverse());
    const Quat q = exponential(2 * vector());
    b.q[0].v[l] = q.w();
    for (int k = 0; k < 3; ++k) b.q[k + 1].v[l] = q.vec()[k];
    const Mat3 world = worldOf(q, at(b.inverseInertia, l));
    const double entries[6] = {world(0, 0), world(1, 1), world(2, 2),
                               world(0, 1), world(0, 2), world(1, 2)};
    for (int k = 0; k < 6; ++k) b.inverse[k].v[l] = entries[k];
    for (int k : {0, 3, 5}) b.root[k].v[l] = b.inverseRoot[k].v[l] = 1;
    put(b.u, l, vector());
    put(b.w, l, (l == 7 ? 100 : 3) * vector());
  }
  return b;
}

// A substep in which contacts push and turn each body by the same.
void step(const BodyKernels& kernels, std::vector<BodyBlock>& blocks) {
  const auto forEachLane = [&](auto&& f) {
    for (BodyBlock& b : blocks) {
      for (int l = 0; l < BodyBlock::kLanes; ++l) f(b, l);
    }
  };
  const auto know = [](BodyBlock& b, int l) {
    put(b.knownU, l, at(b.nowU, l));
    put(b.knownTurn, l, at(b.nowTurn, l));
  };
  const auto push = [&](BodyBlock& b, int l) {
    know(b, l);
    put(b.nowU, l, at(b.nowU, l) + 1e-3 * Vec3(1, 2, 3));
    put(b.nowTurn, l, at(b.nowTurn, l) + 1e-3 * Vec3(3, -1, 2));
  };
  for (BodyBlock& b : blocks) kernels.predict(b);
  for (BodyBlock& b : blocks) kernels.give(b);
  forEachLane(push);
  forEachLane([](BodyBlock& b, int l) { put(b.sinceRows, l, at(b.nowTurn, l)); });
  for (BodyBlock& b : blocks) kernels.displace(b);
  forEachLane(know);
  for (BodyBlock& b : blocks) kernels.end(b);
}

TEST(BodyKernels, GiveTheSameBytesInAllRegisters) {
  std::vector<const BodyKernels*> others;
  if (__builtin_cpu_supports("avx2")) others.push_back(&kBodyKernelsAvx2);
  if (__builtin_cpu_supports("avx512f")) others.push_back(&kBodyKernelsAvx512);
  std::vector<BodyBlock> expected;
  for (unsigned seed = 0; seed < 20; ++seed) expected.push_back(anyBlock(seed));
  const std::vector<BodyBlock> start = expected;
  step(kBodyKernelsSse2, expected);
  for (const BodyKernels* kernels : others) {
    std::vector<BodyBlock> blocks = start;
    step(*kernels, blocks);
    EXPECT_EQ(std::memcmp(blocks.data(), expected.data(), blocks.size() * sizeof(BodyBlock)), 0);
  }
}

// The root is one: turns of lanes are turns.
TEST(BodyKernels, StepABodyAsItsEquationsDo) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::vector<BodyBlock> blocks(1, anyBlock(seed));
    const BodyBlock start = blocks[0];
    step(bodyKernels(), blocks);
    for (int l = 0; l < BodyBlock::kLanes; ++l) {
      const bool moves = start.moves.v[l] > 0, turns = start.turns.v[l] > 0;
      const Quat q = turnAt(start, l);
      const Mat3 inertia = worldOf(q, at(start.inertia, l)),
                 inverse = worldOf(q, at(start.inverseInertia, l));
      const Vec3 v = at(start.u, l), w = at(start.w, l);
      Vec3 mean = w;
      if (turns && l == 7) {
        mean = q * freeTurn(at(start.inertia, l), q.conjugate() * w, kH).mean;
      } else if (turns) {
        mean = w - 0.5 * kH * (inverse * w.cross(inertia * w));
      }
      const Vec3 push = moves ? Vec3(1e-3, 2e-3, 3e-3) : Vec3(0, 0, 0),
                 turn = moves ? Vec3(3e-3, -1e-3, 2e-3) : Vec3(0, 0, 0);
      const Vec3 u = kH * v + push, theta = kH * mean + turn;
      const Quat end = exponential(theta) * q;
      const BodyBlock& b = blocks[0];
      EXPECT_LT((turnAt(b, l).coeffs() - end.coeffs()).norm(), 2e-15) << l;
      if (!moves) continue;
      const Vec3 spin =
          turns ? worldOf(end, at(start.inverseInertia, l)) * (inertia * (kH * w + turn)) : theta;
      EXPECT_LT((at(b.u, l) - u / kH).norm(), 1e-13);
      EXPECT_LT((at(b.theta, l) - spin / kH).norm(), 1e-12) << l;
    }
  }
}

}  // namespace
}  // namespace physics::testing
