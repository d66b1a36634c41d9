// What contacts give bodies, in double precision, for islands that step by an accuracy. The lanes
// hold velocities in single precision: what slides loses of each change as much as it takes to
// round them, some 1e-5 of friction in a substep of 1 ms at 10 m/s, and bodies that push each other
// do not lose the same. What contacts carry is known to 1e-7 of itself.
#include "physics/small_steps/small_steps_impl.h"

namespace physics {
namespace {

constexpr int kLanes = ContactBlock::kLanes;

Vec3 at(const float (&rows)[3][kLanes], int l) { return {rows[0][l], rows[1][l], rows[2][l]}; }

}  // namespace

void ContactLoads::takeLane(const ContactBlock& block, int l) {
  for (int k = 0; k < block.points; ++k) point[k][l] = block.point[k].lambda[l];
  for (int t = 0; t < 2; ++t) tangent[t][l] = block.tangent[t].lambda[l];
  twist[l] = block.twist[l];
}

void ContactLoads::giveLane(ContactBlock& block, int l) const {
  for (int k = 0; k < block.points; ++k) block.point[k].lambda[l] = point[k][l];
  for (int t = 0; t < 2; ++t) block.tangent[t].lambda[l] = tangent[t][l];
  block.twist[l] = twist[l];
}

ContactLoads loadsOf(const ContactBlock& block) {
  ContactLoads loads;
  const auto copy = [](const float(&from)[kLanes], float(&to)[kLanes]) {
    std::copy_n(from, kLanes, to);
  };
  for (int k = 0; k < block.points; ++k) copy(block.point[k].lambda, loads.point[k]);
  for (int t = 0; t < 2; ++t) copy(block.tangent[t].lambda, loads.tangent[t]);
  copy(block.twist, loads.twist);
  return loads;
}

// Joints and points are told by the lanes.
bool SmallSteps::Impl::givesExactly(const Model& w, const Batch& batch) const {
  return stepsAccurately(w, batch) && !batch.blocks.empty() && !batch.isMixed();
}

// Nothing has been given yet.
void SmallSteps::Impl::startGiving(const Model& w, Batch& batch) {
  if (!givesExactly(w, batch)) return;
  batch.told.assign(batch.blocks.size(), ContactLoads{});
  batch.given.resize(batch.slots.size());
}

// Bodies know what contacts carry now.
void SmallSteps::Impl::noteGiven(const Model& w, Batch& batch) {
  if (!givesExactly(w, batch)) return;
  for (std::size_t k = 0; k < batch.blocks.size(); ++k) batch.told[k] = loadsOf(batch.blocks[k]);
}

// What lane l has carried since, to `given`: impulses, and turns in the units of the lanes.
void SmallSteps::Impl::giveLane(Batch& batch, const ContactBlock& block, const ContactLoads& told,
                                int l) {
  Vec3 turnA = Vec3::Zero(), turnB = Vec3::Zero(), push = Vec3::Zero();
  double normal = 0;
  for (int k = 0; k < block.points; ++k) {
    const ContactBlock::Point& p = block.point[k];
    const double more = double(p.lambda[l]) - told.point[k][l];
    normal += more;
    turnA += more * at(p.wA, l);
    turnB += more * at(p.wB, l);
  }
  for (int k = 0; k < 2; ++k) {
    const ContactBlock::Tangent& t = block.tangent[k];
    const double more = double(t.lambda[l]) - told.tangent[k][l];
    push += more * at(t.d, l);
    turnA += more * at(t.wA, l);
    turnB += more * at(t.wB, l);
  }
  const double twist = double(block.twist[l]) - told.twist[l];
  turnA += twist * at(block.twistA, l);
  turnB += twist * at(block.twistB, l);
  push += normal * at(block.n, l);
  Displacement &a = batch.given[block.bodyA[l]], &b = batch.given[block.bodyB[l]];
  a.u += push;
  a.theta += turnA;
  b.u -= push;
  b.theta -= turnB;
}

// True: `moved` has what contacts have given since bodies knew of it, and the lanes have `moved`.
bool SmallSteps::Impl::giveExactly(const Model& w, Batch& batch) {
  if (!givesExactly(w, batch)) return false;
  std::fill(batch.given.begin(), batch.given.end(), Displacement{});
  for (std::size_t k = 0; k < batch.blocks.size(); ++k) {
    for (int l = 0; l < kLanes; ++l) {
      if (batch.blocks[k].contact[l] >= 0) giveLane(batch, batch.blocks[k], batch.told[k], l);
    }
  }
  for (std::size_t s = 1; s < batch.slots.size(); ++s) {
    const BodyId i = batch.slots[s];
    if (inertiaOf[i] == Inertia::kGiven) continue;
    const Displacement& given = batch.given[s];
    moved[i].u += masses[i].inverse * given.u;
    if (inertiaOf[i] != Inertia::kNone) {
      moved[i].theta += rotationOf(batch.masses[s], given.theta);
    }
    toLane(batch, static_cast<int>(s));
  }
  return true;
}

}  // namespace physics
