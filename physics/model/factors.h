// What of a world follows a table over time: the means of its factors over the substep that comes.
#pragma once

#include "physics/constraints/kinds.h"

namespace physics {

// Times in s, from < to. By bdf2, whose forces are those of the substep's end, the values there.
void takeFactors(Kinds& kinds, const Bodies& bodies, double from, double to);

// The first point of any table that is later [s]; infinity: none.
double nextPoint(const Kinds& kinds, double time);

// Of a step of `wanted` from `time`, up to the first point in it; points within `least` of either
// end are at the end.
double nextPart(const Kinds& kinds, double time, double wanted, double least);

// f(item) of each that has a table.
template <class K, class F>
void forEachOverTime(K& kinds, F&& f) {
  forEachKind(kinds, [&](auto& kind) {
    if constexpr (requires { kind.set.items[0].factor; }) {
      for (const int k : kind.set.overTime) f(kind.set.items[k]);
    }
  });
}

}  // namespace physics
