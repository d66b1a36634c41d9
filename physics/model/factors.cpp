// What of a world follows a table over time.
#include "physics/model/factors.h"

#include "physics/constraints/constraint_response.h"

namespace physics {
namespace {

template <class C>
bool isByBdf2(const C& item, const Bodies& bodies) {
  return !bodies.second.empty() && bodies.second.scheme[moverOf(item, bodies)] == Scheme::kBdf2;
}

}  // namespace

void takeFactors(Kinds& kinds, const Bodies& bodies, double from, double to) {
  forEachOverTime(kinds, [&](auto& item) {
    const OverTime& table = *item.factor.table;
    item.factor.now = isByBdf2(item, bodies) ? valueAt(table, to) : meanOf(table, from, to);
  });
}

double nextPoint(const Kinds& kinds, double time) {
  double next = std::numeric_limits<double>::infinity();
  forEachOverTime(
      kinds, [&](const auto& item) { next = std::min(next, nextPoint(*item.factor.table, time)); });
  return next;
}

double nextPart(const Kinds& kinds, double time, double wanted, double least) {
  const double next = nextPoint(kinds, time + least);
  return next < time + wanted - least ? next - time : wanted;
}

}  // namespace physics
