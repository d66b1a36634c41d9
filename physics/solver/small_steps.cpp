// The default method: the step, and how many substeps and sweeps the next one takes.
#include "physics/solver/small_steps.h"

#include <algorithm>
#include <cmath>

#include "physics/not_finite.h"
#include "physics/presence.h"
#include "physics/solver/small_steps_impl.h"

namespace physics {
namespace {

constexpr double kLargestSag = 1.25e-4;  // of the smaller body, on the average of the load
constexpr double kLargestStrain = 0.02;  // of what holds a mesh, in the same way
constexpr int kMostSubsteps = 64;
constexpr double kRest =
    1e-6;  // what a velocity sweep still changes, of an island's energy in g h^2
constexpr int kMostSweeps = 8, kMostJointedSweeps = 2;  // joints are solved again in each

// What goes with h^2 and is `times` too large.
int substepsFor(int present, double times) {
  return static_cast<int>(std::min<double>(std::ceil(present * std::sqrt(times)), kMostSubsteps));
}

}  // namespace

SmallSteps::SmallSteps() : impl_(std::make_unique<Impl>()) {}
SmallSteps::~SmallSteps() = default;
SmallSteps::SmallSteps(SmallSteps&&) noexcept = default;
SmallSteps& SmallSteps::operator=(SmallSteps&&) noexcept = default;

std::vector<KeptContact>& SmallSteps::contacts() { return impl_->contacts; }
const std::vector<KeptContact>& SmallSteps::contacts() const { return impl_->contacts; }
void SmallSteps::topologyChanged() { impl_->known = false; }
int SmallSteps::substepsOf(BodyId body) const {
  return body < static_cast<BodyId>(impl_->substeps.size()) ? impl_->substeps[body] : 1;
}
void SmallSteps::forget() {
  impl_->contacts.clear();
  sleeping.clear();
  impl_->known = false;
  impl_->fresh = true;
  std::fill(impl_->asked.begin(), impl_->asked.end(), 0);
  std::fill(impl_->askedSweeps.begin(), impl_->askedSweeps.end(), 1);
}

std::size_t SmallSteps::bytes() const {
  std::size_t sum = (impl_->contacts.capacity() + impl_->before.capacity()) * sizeof(KeptContact);
  for (const Batch& batch : impl_->batches) {
    sum += batch.blocks.capacity() * sizeof(ContactBlock) +
           batch.motions.capacity() * sizeof(LaneMotion);
  }
  return sum;
}

bool takesSmallSteps(const World::Impl& w) {
  return w.settings.method == Method::kSmallSteps && w.settings.stepping == Stepping::kPaper;
}

void SmallSteps::Impl::makeRoom(std::size_t bodies) {
  substeps.resize(bodies, 1);
  sweeps.resize(bodies, 1);
  asked.resize(bodies, 0);
  askedSweeps.resize(bodies, 1);
  batchOf.resize(bodies);
  slotOf.resize(bodies);
  colours.resize(bodies);
  coloursFixed.resize(bodies);
  masses.resize(bodies);
  moved.resize(bodies);
  lanesBefore.resize(bodies);
  stiffness.resize(bodies, Mat3::Zero());
  load.resize(bodies);
  sag.resize(bodies);
  energy.resize(bodies);
  change.resize(bodies);
}

// Contacts from the present poses to where the bodies would be after dt. False: the look met bodies
// that sleep, which are awake now.
bool SmallSteps::Impl::look(World::Impl& w, double dt) {
  if (!w.touches && w.softCollider.empty()) return true;
  Bodies& b = w.bodies;
  const Vec3 fall = w.settings.gravity ? Vec3(dt * dt * *w.settings.gravity) : Vec3::Zero().eval();
  for (const BodyId i : b.active) {
    w.ahead[i] = b.pose[i];
    if (b.motion[i] == Motion::kDynamic) w.ahead[i].x += fall;
    displace(w.ahead[i], dt * b.velocity[i].v, dt * b.velocity[i].w);
  }
  if (!lookSoft(w)) return false;
  if (!w.touches) return true;
  const auto found = w.collider.find(b.pose, w.ahead, w.settings.contact->margin);
  if (w.sleep.count > 0) {
    const std::size_t called = w.sleep.called.size();
    for (const Manifold& m : found) {
      for (const BodyId i : {m.a, m.b}) callAwake(w, i);
    }
    if (w.sleep.called.size() > called) {
      wakeCalled(w);
      return false;
    }
  }
  std::swap(contacts, before);
  keep(before, found, b, contacts);
  return true;
}

// The same of points and links: which of them may meet a body in this step.
bool SmallSteps::Impl::lookSoft(World::Impl& w) {
  softPairs.clear();
  if (!w.settings.contact || w.softCollider.empty()) return true;
  const bool some = w.sleep.count > 0;
  if (some) notePresence(w);
  const auto leftOut = some ? std::span<const char>(w.present) : std::span<const char>{};
  const std::size_t called = w.sleep.called.size();
  for (const SoftTouch& touch :
       w.softCollider.find(w.bodies.pose, w.ahead, w.settings.contact->margin, leftOut)) {
    const bool again = !softPairs.empty() && softPairs.back().element == touch.element &&
                       softPairs.back().body == touch.body;
    if (!again) softPairs.push_back({touch.element, touch.body});
    const SoftElement& element = w.softCollider.element(touch.element);
    for (const BodyId i : {element.from, element.to, touch.body}) callAwake(w, i);
  }
  if (w.sleep.called.size() == called) return true;
  wakeCalled(w);
  return false;
}

// Contacts of points and links from the batches, in the collider's order.
void SmallSteps::Impl::gatherSoft(World::Impl& w) {
  if (w.softCollider.empty()) return;
  w.softContacts.clear();
  for (std::size_t k = 0; k < batchCount; ++k) {
    w.softContacts.insert(w.softContacts.end(), batches[k].soft.begin(), batches[k].soft.end());
  }
  std::stable_sort(w.softContacts.begin(), w.softContacts.end(),
                   [](const SoftContact& a, const SoftContact& b) {
                     return a.element != b.element ? a.element < b.element : a.body < b.body;
                   });
}

// True where two bodies of a contact come closer in dt by more than `far` [m].
bool SmallSteps::Impl::closesBy(const World::Impl& w, double dt, double far) {
  const Bodies& b = w.bodies;
  const auto speed = [&](BodyId i) {  // of any point of it, at the most
    return b.velocity[i].v.norm() + boundingRadius(b.shape[i]) * b.velocity[i].w.norm();
  };
  for (const BodyId i : b.active) load[i] = speed(i);
  const auto known = [&](BodyId i) { return isMovable(b, i) ? load[i] : 0.0; };
  for (const KeptContact& c : contacts) {
    if (dt * (known(c.a) + known(c.b)) <= far) continue;
    const Velocity &va = b.velocity[c.a], &vb = b.velocity[c.b];
    const Vec3 n = normalOf(c, b.pose);
    for (int k = 0; k < c.count; ++k) {
      const Vec3 armA = b.pose[c.a].q * c.points[k].coreA;
      const Vec3 armB = b.pose[c.b].q * c.points[k].coreB;
      if (-dt * n.dot(va.v + va.w.cross(armA) - vb.v - vb.w.cross(armB)) > far) return true;
    }
  }
  return false;
}

// The same of the overlaps of points and links, relative to their thickness.
void SmallSteps::Impl::askSoft(World::Impl& w, Batch& batch) {
  const Bodies& b = w.bodies;
  if (batch.soft.empty()) return;
  for (const BodyId i : batch.bodies) change[i] = 0;
  for (const SoftContact& c : batch.soft) {
    const BodyId root = islands[isMovable(b, c.from) ? c.from : c.to];
    load[root] += c.normalTotal;
    change[root] += c.normalTotal * std::max(-gapOf(c, b.pose), 0.0) / c.radius;
  }
  for (const BodyId i : batch.bodies) {
    if (islands[i] != i || !(load[i] > 0)) continue;
    asked[i] =
        std::max(asked[i], substepsFor(batch.substeps, change[i] / load[i] / kLargestStrain));
  }
  for (const BodyId i : batch.bodies) load[i] = change[i] = 0;
}

// How many substeps and sweeps the next step wants: the sag of a contact under what it has carried
// for two steps goes with h^2, and what the last sweep changed tells whether an island is at rest.
void SmallSteps::Impl::ask(World::Impl& w, Batch& batch, double h) {
  const Bodies& b = w.bodies;
  const double g = w.settings.gravity ? w.settings.gravity->norm() : 0;
  for (const BodyId i : batch.bodies) {
    asked[i] = 0;
    energy[i] = change[i] = load[i] = sag[i] = 0;
  }
  for (const int k : batch.deformables) {
    const double off = deformables[k].strain(w.kinds, {b.pose, b.start, h});
    const BodyId first = deformables[k].bodies().front();
    asked[first] = substepsFor(batch.substeps, off / kLargestStrain);
  }
  askSoft(w, batch);
  for (const BodyId i : batch.bodies) {
    if (b.motion[i] != Motion::kDynamic) continue;
    energy[islands[i]] += b.mass[i] * (g * g * h * h * h * h + moved[i].u.squaredNorm());
  }
  for (const ContactBlock& block : batch.blocks) {
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      if (block.contact[l] < 0) continue;
      const KeptContact& c = contacts[block.contact[l]];
      const BodyId body = isMovable(b, c.a) ? c.a : c.b;
      change[islands[body]] += block.change[l];
      const double soft = (1 - block.scale[l]) / (block.scale[l] * block.rate[l]);
      const bool jointed = articulationOf[c.a] >= 0 || articulationOf[c.b] >= 0;
      const double size = std::min(boundingRadius(b.shape[c.a]), boundingRadius(b.shape[c.b]));
      for (int k = 0; k < c.count; ++k) {
        const double inverse = block.point[k].inverse[l],
                     lambda = std::min(c.lambda[k], c.before[k]);
        if (!(inverse > 0) || !(size > 0) || jointed) continue;
        load[islands[body]] += lambda;
        sag[islands[body]] += lambda * soft * lambda / inverse / size;
      }
    }
  }
  for (const BodyId i : batch.bodies) {
    const BodyId root = islands[i];
    if (load[root] > 0) {
      const double off = sag[root] / load[root];
      asked[i] = std::max(asked[i], substepsFor(batch.substeps, off / kLargestSag));
    }
    const double relative = energy[root] > 0 ? change[root] / energy[root] : 0;
    askedSweeps[i] = batch.sweeps;
    const int most = batch.articulations.empty() ? kMostSweeps : kMostJointedSweeps;
    if (relative > kRest) askedSweeps[i] = std::min(most, batch.sweeps + 1);
    if (relative < 0.1 * kRest) askedSweeps[i] = std::max(1, batch.sweeps - 1);
  }
}

void SmallSteps::Impl::advance(World::Impl& w, StepReport& report) {
  const double dt = w.settings.dt;
  while (!look(w, dt)) {
  }
  // Where pairs come closer by more than they are watched within, contacts are looked for twice.
  const bool isFast =
      w.touches && w.settings.substeps > 1 && closesBy(w, dt, w.settings.contact->margin);
  const int looks = isFast ? 2 : 1;
  for (int part = 0; part < looks; ++part) {
    if (part > 0) {
      while (!look(w, dt / looks)) {
      }
    }
    divide(w);
    fly(w, dt / looks);
    report.work.moves += static_cast<std::int64_t>(free.size());
    for (std::size_t k = 0; k < batchCount; ++k) {
      Batch& batch = batches[k];
      const int count = (batch.substeps + looks - 1) / looks;
      const double h = dt / looks / count;
      report.substeps = std::max(report.substeps, looks * count);
      layOut(w, batch);
      for (int i = 0; i < count; ++i) {
        predict(w, batch, h);
        if (i == 0 && !batch.blocks.empty()) rows(w, batch, h);
        lookAgain(w, batch, h);
        noteApproach(w, batch, h);
        substep(w, batch, h, report);
      }
      takeOver(batch, h);
      ask(w, batch, h);
      for (const int a : batch.articulations) articulations[a].finish(w.kinds, h);
      for (const int d : batch.deformables) deformables[d].finish(w.kinds, h);
      report.work.moves += static_cast<std::int64_t>(batch.bodies.size()) * count;
    }
    gatherSoft(w);
    checkSolved(w, report);
    if (report.notFinite) return;
  }
}

// Where nothing is known of what contacts carry, steps are trials for the one that counts, as many
// as the load needs to find its way down. Always as many: no island is to know of another.
void SmallSteps::Impl::learnLoads(World::Impl& w) {
  constexpr int kTrials = 16;
  const Bodies& b = w.bodies;
  fresh = false;
  const std::vector<Pose> pose = b.pose;
  const std::vector<Velocity> velocity = b.velocity;
  for (int trial = 0; trial < kTrials; ++trial) {
    StepReport unused;
    advance(w, unused);
    w.bodies.pose = pose;
    w.bodies.velocity = velocity;
    for (Articulation& articulation : articulations) articulation.forget();
    if (contacts.empty() || unused.notFinite) return;
  }
  for (KeptContact& c : contacts) {
    for (int k = 0; k < c.count; ++k) c.held[k] = c.lambda[k] / (c.step * c.step);
  }
}

void SmallSteps::step(World::Impl& w, StepReport& report) {
  impl_->learn(w);
  if (impl_->fresh && w.touches) impl_->learnLoads(w);
  impl_->advance(w, report);
}

}  // namespace physics
