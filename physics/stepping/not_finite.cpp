// Numbers that are not finite: whose they are, and the way back.
#include "physics/stepping/not_finite.h"

#include <algorithm>
#include <cmath>

#include "physics/effects/choose_scheme.h"
#include "physics/motion/second_order.h"

namespace physics {
namespace {

// Keeps the hardest push on one body; nothing is harder than one that is not finite.
struct Hardest {
  BodyId body;
  double most = 0;

  template <class Bodies>
  bool beats(const Bodies& bodies, double size) {
    if (!std::isfinite(most) || !(size > most || !std::isfinite(size))) return false;
    if (std::find(bodies.begin(), bodies.end(), body) == bodies.end()) return false;
    most = size;
    return true;
  }
};

double pushOf(const ContactPair& pair) {
  double sum = 0;
  for (int k = 0; k < pair.count; ++k) {
    sum += std::abs(pair.points[k].normalTotal) + pair.points[k].frictionTotal.norm();
  }
  return sum;
}

}  // namespace

void nameHardest(const WorldState& w, StepReport& report) {
  if (!report.notFinite || !report.notFinite->constraint.empty()) return;
  Hardest hardest{report.notFinite->body};
  const auto name = [&](const char* kind, std::size_t k) {
    nameCulprit(report, kind, k, hardest.body);
  };
  forEachKind(w.kinds, [&](const auto& kind) {
    using K = std::decay_t<decltype(kind)>;
    for (std::size_t k = 0; k < kind.set.items.size(); ++k) {
      const double size = kind.set.lambda[k].total.norm();
      if (hardest.beats(kind.set.items[k].bodies, size)) name(K::kWord, k);
    }
  });
  for (std::size_t k = 0; k < w.contacts.pairs.size(); ++k) {
    const ContactPair& pair = w.contacts.pairs[k];
    if (hardest.beats(std::array{pair.a, pair.b}, pushOf(pair))) name("contact", k);
  }
  for (std::size_t k = 0; k < w.small.contacts().size(); ++k) {
    const ContactPair pair = pairOf(w.small.contacts()[k], 1);
    if (hardest.beats(std::array{pair.a, pair.b}, pushOf(pair))) name("contact", k);
  }
  for (std::size_t k = 0; k < w.softContacts.size(); ++k) {
    const SoftContact& c = w.softContacts[k];
    const double size = std::abs(c.normalTotal) + c.frictionTotal.norm();
    if (hardest.beats(std::array{c.from, c.to, c.body}, size)) name("soft contact", k);
  }
}

void checkSolved(const WorldState& w, StepReport& report) {
  if (report.notFinite) return;
  checkFinite(w, report);
  nameHardest(w, report);
}

void restore(WorldState& w) {
  Bodies& b = w.bodies;
  for (const BodyId i : b.active) {
    b.pose[i] = b.start[i] = w.last.pose[i];
    b.velocity[i] = w.last.velocity[i];
    forgetPast(b.second, i);
  }
  for (auto set = w.last.replaced.rbegin(); set != w.last.replaced.rend(); ++set) {
    b.velocity[set->first] = set->second;
  }
  w.contacts.pairs.clear();
  w.small.forget();
  w.softContacts.clear();
  undo(w.arms);
  forEachKind(w.kinds, [](auto& kind) {
    for (auto& lambda : kind.set.lambda) lambda = {};
  });
}

}  // namespace physics
