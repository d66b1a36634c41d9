// Islands that step by an accuracy and touch.
#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/model/factors.h"
#include "physics/small_steps/island_plan.h"
#include "physics/small_steps/small_steps_impl.h"

namespace physics {
namespace {

// Contacts are in single precision: of a displacement no less than this part is known.
constexpr double kKnown = 1e-6;

double square(double x) { return x * x; }

bool slides(const KeptContact& c, double along, double normal) {
  constexpr double kOnCone = 1 - 1e-5;  // but for single precision
  return normal > 0 && along >= kOnCone * c.friction.dynamicCoefficient * normal;
}

}  // namespace

bool SmallSteps::Impl::stepsAccurately(const Model& w, const Batch& batch) const {
  return w.settings.accuracy && batch.touches && batch.deformables.empty() &&
         batch.softPairs.empty();
}

// The largest extent of what moves [m].
double SmallSteps::Impl::sizeOf(const Bodies& b, const Batch& batch) const {
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const BodyId i : batch.bodies) {
    low = low.cwiseMin(b.pose[i].x - Vec3::Constant(radius[i]));
    high = high.cwiseMax(b.pose[i].x + Vec3::Constant(radius[i]));
  }
  return (high - low).norm();
}

// What a sweep has changed, and the largest way [m]: points of bodies, in this substep.
double SmallSteps::Impl::changeOf(const Batch& batch, double& way) {
  double change = 0;
  swept.resize(batch.motions.size());
  for (std::size_t s = 1; s < batch.motions.size(); ++s) {
    const LaneMotion& now = batch.motions[s];
    double du = 0, dturn = 0, u = 0, turn = 0;
    for (int k = 0; k < 3; ++k) {
      du += square(now.u[k] - swept[s].u[k]);
      dturn += square(now.turn[k] - swept[s].turn[k]);
      u += square(now.u[k]);
      turn += square(now.turn[k]);
      swept[s].u[k] = now.u[k];
      swept[s].turn[k] = now.turn[k];
    }
    const double arm = radius[batch.slots[s]];
    change = std::max(change, std::sqrt(du) + arm * std::sqrt(dturn));
    way = std::max(way, std::sqrt(u) + arm * std::sqrt(turn));
  }
  return change;
}

// What the next sweep over contacts alone may be the last one after, where it changes no more.
void SmallSteps::Impl::watchVelocities(const Model& w, const Batch& batch) {
  double way = 0;
  if (stepsAccurately(w, batch)) changeOf(batch, way);
}

// Sweeps until they change velocities by no more than is asked.
void SmallSteps::Impl::closeVelocities(Model& w, Batch& batch, double h) {
  constexpr int kMost = 16;  // what has not settled by then the estimate tells
  if (!stepsAccurately(w, batch)) return;
  const double fall = w.settings.gravity ? h * h * w.settings.gravity->norm() : 0;
  const double part = std::max(kShareOfStep * *w.settings.accuracy, kKnown);
  for (int s = 0; s < kMost; ++s) {
    double way = fall;
    if (changeOf(batch, way) <= part * way) return;
    sweepContactVelocities(w, batch, {.first = false, .last = true});
  }
}

void SmallSteps::Impl::goBack(Bodies& b, const Batch& batch) {
  for (std::size_t k = 0; k < batch.bodies.size(); ++k) goBack(b, batch, k);
}

// From where `batch.kept` stands, in so many substeps, to the next row of its tableau.
void SmallSteps::Impl::addRow(Model& w, Batch& batch, double whole, int steps, StepReport& report) {
  goBack(w.bodies, batch);
  run(w, batch, whole / steps, steps, report);
  for (std::size_t k = 0; k < batch.bodies.size(); ++k) {
    trial.pose[k] = w.bodies.pose[batch.bodies[k]];
    trial.velocity[k] = w.bodies.velocity[batch.bodies[k]];
  }
  trial.tableau.add(steps, 1, trial.pose, trial.velocity);
  trial.steps = steps;
  noteLoads(batch, whole / steps);
  trial.coarser = trial.error;
  if (trial.tableau.rows() == 1) return;
  trial.error = trial.tableau.difference(trial.extent, trial.time, trial.levers, trial.allowed,
                                         &trial.places);
}

// A step of `whole`, by a tableau whose last row has so many substeps; and by further columns,
// where it is smooth and they do. Where contacts change no column does better than the last row's
// substeps: what these err by is the difference to all of them.
void SmallSteps::Impl::tryOut(Model& w, Batch& batch, double whole, StepChoice& choice, int most,
                              StepReport& report) {
  const int columns = choice.columns();
  const auto stepsOf = [&](int row) { return (most * row + columns - 1) / columns; };
  trial.error = trial.coarser = std::numeric_limits<double>::infinity();
  trial.places = 0;
  trial.tableau.clear(batch.bodies.size());
  for (int j = 1; j <= columns; ++j) addRow(w, batch, whole, stepsOf(j), report);
  trial.changes = changesIn(batch);
  while (trial.changes == 0 && trial.error > trial.allowed && choice.extend()) {
    addRow(w, batch, whole, stepsOf(choice.columns()), report);
    trial.changes = changesIn(batch);
  }
  if (trial.changes > 0) {
    trial.error = std::max(trial.error, trial.tableau.gain(trial.extent, trial.time, trial.levers));
  }
}

// Contacts that touch at other points at the end of a step than they did before, or that slide or
// stick now and did not.
int SmallSteps::Impl::changesIn(const Batch& batch) const {
  int count = 0;
  for (const ContactBlock& block : batch.blocks) {
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      if (block.contact[l] < 0) continue;
      const KeptContact& c = contacts[block.contact[l]];
      double sum = 0, before = 0;
      bool isChanged = false;
      for (int k = 0; k < c.count; ++k) {
        const double now = block.point[k].lambda[l];
        isChanged = isChanged || (now > 0) != (c.lambda[k] > 0);
        sum += now;
        before += c.lambda[k];
      }
      const double along = std::hypot(block.tangent[0].lambda[l], block.tangent[1].lambda[l]);
      count += isChanged || slides(c, along, sum) != slides(c, c.tangential.norm(), before);
    }
  }
  return count;
}

// What contacts carry where a row ends, and where the one before it ended.
void SmallSteps::Impl::noteLoads(const Batch& batch, double h) {
  std::swap(trial.loads, trial.coarserLoads);
  trial.loads.resize(batch.blocks.size());
  for (std::size_t i = 0; i < batch.blocks.size(); ++i) {
    const ContactBlock& block = batch.blocks[i];
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      for (int k = 0; k < block.points; ++k) {
        trial.loads[i][l][k] = block.point[k].lambda[l] / (h * h);
      }
    }
  }
}

// A contact gives way by its load and h^2, so that what rests would be at another place in each
// row. The load that two rows agree on is the contact's: about it the law is, as it is about the
// loads that a scene starts with, and what rests is where it touches in all of them.
void SmallSteps::Impl::holdLoads(const Batch& batch) {
  if (trial.changes > 0) return;
  for (std::size_t i = 0; i < batch.blocks.size(); ++i) {
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      if (batch.blocks[i].contact[l] < 0) continue;
      KeptContact& c = contacts[batch.blocks[i].contact[l]];
      const auto isNone = [](double load) { return load == 0; };
      if (!std::all_of(c.held.begin(), c.held.end(), isNone)) continue;
      const auto &load = trial.loads[i][l], &coarser = trial.coarserLoads[i][l];
      double sum = 0, difference = 0;
      for (int k = 0; k < c.count; ++k) {
        sum += load[k];
        difference = std::max(difference, std::abs(load[k] - coarser[k]));
      }
      if (difference <= trial.allowed * sum) std::copy_n(load.begin(), c.count, c.held.begin());
    }
  }
}

// Where `trial` is, something is off the ground that the last row ends on.
bool SmallSteps::Impl::opensAtTrial(const Bodies& b, const Batch& batch) {
  for (std::size_t k = 0; k < batch.bodies.size(); ++k) trialNow[batch.bodies[k]] = trial.pose[k];
  for (std::size_t i = 0; i < batch.blocks.size(); ++i) {
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      if (batch.blocks[i].contact[l] < 0) continue;
      const KeptContact& c = contacts[batch.blocks[i].contact[l]];
      const auto& load = trial.loads[i][l];
      const bool carries =
          std::any_of(load.begin(), load.begin() + c.count, [](double of) { return of > 0; });
      if (carries && gapAtTrial(b, c) > kClose) return true;
    }
  }
  return false;
}

// What rests is left to rest: where the last row's end is known no better, it is that. And where
// contacts hold there: what extrapolates does not know that nothing passes a surface.
void SmallSteps::Impl::takeBest(Model& w, const Batch& batch) {
  if (trial.changes > 0) return;
  if (!(trial.tableau.gain(trial.extent, trial.time, trial.levers) > kKnown)) return;
  trial.tableau.best(trial.pose, trial.velocity);
  if (opensAtTrial(w.bodies, batch)) return;
  for (std::size_t k = 0; k < batch.bodies.size(); ++k) {
    w.bodies.pose[batch.bodies[k]] = trial.pose[k];
    w.bodies.velocity[batch.bodies[k]] = trial.velocity[k];
  }
}

void SmallSteps::Impl::begin(const Model& w, const Batch& batch, double dt) {
  const std::size_t size = batch.bodies.size();
  trial.extent = sizeOf(w.bodies, batch);
  trial.time = dt;
  trial.allowed = std::max(kShareOfStep * *w.settings.accuracy, kKnown);
  trial.levers.resize(size);
  trial.pose.resize(size);
  trial.velocity.resize(size);
  for (std::size_t k = 0; k < size; ++k) {
    const BodyId i = batch.bodies[k];
    trial.levers[k] = w.bodies.inverseInertia[i].isZero(0) ? 0 : radius[i];
  }
}

// An island that touches, by the substeps of the default: their error has all powers of h while
// nothing comes into touch or leaves it, and the steps are divided about where something does.
// Where bodies err or contacts change in many places at once no step resolves it: it goes on by the
// default, and the estimate tells.
void SmallSteps::Impl::advanceAccurately(Model& w, Batch& batch, double dt, int count,
                                         StepReport& report) {
  constexpr double kLeastPart = 1.0 / 1024;  // what goes with h^2 is then kKnown of the whole's
  // Of a step, each at its moment: what has more is no motion to follow.
  constexpr int kMostPlaces = 4;
  StepChoice& choice = choices[batch.bodies.front()];
  AccuracyReport told;
  int flights = 0;
  const double from = now;
  bool hits = false;  // an impact comes next: by itself, and what flies on then flies exactly
  begin(w, batch, dt);
  for (double left = dt; left > 0;) {
    if (const double flown = flights < kMostPlaces ? flyToTouch(w, batch, left) : 0; flown > 0) {
      left = flown == left ? 0 : left - flown;
      hits = w.bodies.mostRestitution > 0;
      ++flights;
      continue;
    }
    const double next = hits ? 0 : choice.next(left, dt);
    const double wanted = std::min(std::max(next, kLeastPart * dt), left);
    now = from + (dt - left);
    const double whole = nextPart(w.kinds, now, wanted, kLeastPart * dt);
    const int most = std::max(choice.columns(), static_cast<int>(std::ceil(count * whole / dt)));
    keepStart(w, batch);
    tryOut(w, batch, whole, choice, most, report);
    const bool isSmall = trial.error <= trial.allowed;
    const bool isFew = trial.places <= kMostPlaces && trial.changes <= kMostPlaces;
    if (!isSmall && whole > kLeastPart * dt && isFew) {
      ++told.rejected;
      goBack(w.bodies, batch);
      choice.reject(whole, trial.error, trial.allowed);
      continue;
    }
    if (isSmall) {
      if (!hits) {  // a jump is no smoother in shorter substeps
        takeBest(w, batch);
        choice.accept(whole, trial.error, trial.coarser, trial.allowed, dt);
      }
      told.order = std::max(told.order, choice.columns());
    } else {
      choice.giveUp();
    }
    hits = false;
    takeOver(w, batch);
    holdLoads(batch);
    batch.joints.finish(w.kinds, whole / trial.steps);
    ++told.accepted;
    told.least = told.least > 0 ? std::min(told.least, whole) : whole;
    told.estimate += trial.error;
    left = whole == left ? 0 : left - whole;
  }
  StepListening::tell({batch.bodies.front(), static_cast<int>(batch.bodies.size()), dt,
                       trial.extent, trial.allowed, told});
  add(told, report.accuracy);
  if (told.accepted > 0) {
    ask(w, batch, dt / count);
  } else {
    rest(batch);
  }
}

// Its contacts have carried nothing.
void SmallSteps::Impl::rest(Batch& batch) {
  for (const int k : batch.contacts) {
    KeptContact& c = contacts[k];
    c.lambda = c.before = c.held = {};
    c.tangential.setZero();
    c.twist = 0;
  }
  for (const BodyId i : batch.bodies) {
    asked[i] = 0;
    askedSweeps[i] = 1;
  }
}

}  // namespace physics
