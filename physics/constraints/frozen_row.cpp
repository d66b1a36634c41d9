// What differs from kind to kind of a frozen row.
#include "physics/constraints/frozen_row.h"

#include <limits>
#include <type_traits>

namespace physics {
namespace {

// f(set) of the kind at `place`, if its rows are of shape R.
template <class R, class K, class F>
void atPlace(K& kinds, int place, F&& f) {
  int here = 0;
  forEachKind(kinds, [&](auto& kind) {
    using C = typename std::decay_t<decltype(kind)>::Item;
    if constexpr (std::is_same_v<FrozenOf<C>, R>) {
      if (here == place) f(kind.set);
    }
    ++here;
  });
}

// Of a row that is kept: one-sided kinds set one bound and trust that the other is open.
template <class C>
void evaluateAt(const C& item, const Configuration& x, Evaluated<C>& row) {
  constexpr double kFree = std::numeric_limits<double>::infinity();
  row.active = true;
  row.longest = kFree;
  if constexpr (!Force<C>) {
    row.low = -kFree;
    row.high = kFree;
  }
  item.evaluate(x, row);
}

template <class C>
void take(Set<C>& set, std::size_t k, const Configuration& x, FrozenOf<C>& frozen) {
  const C& item = set.items[k];
  frozen.bodies = item.bodies;
  frozen.isLinear = C::kLinear;
  frozen.isAngular = isAngular<C>();
  frozen.stands = canStand<C>();
  frozen.form = formOf(item);
  if constexpr (requires { item.anchors; }) {
    frozen.isAnchored = true;
    frozen.anchors = item.anchors;
  }
  frozen.tuned = set.tuned[k];
  frozen.total = &set.lambda[k].total;
  evaluateAt(item, x, frozen.row);
}

}  // namespace

template <class R>
void evaluate(Kinds& kinds, int place, std::size_t item, const Configuration& x, R& frozen) {
  atPlace<R>(kinds, place, [&](auto& set) { take(set, item, x, frozen); });
}

template <class R>
void evaluateForce(const Kinds& kinds, int place, std::size_t item, const Configuration& x,
                   R& frozen) {
  if constexpr (R::kIsForce) {
    const auto look = [&](const auto& set) {
      std::decay_t<decltype(frozen.row)> there;
      set.items[item].evaluate(x, there);
      frozen.row.active = frozen.row.active && there.active;
      frozen.row.f = there.f;
      frozen.row.k = there.k;
      frozen.row.longest = there.longest;
    };
    atPlace<R>(kinds, place, look);
  }
}

std::int64_t evaluateAll(Kinds& kinds, const Configuration& x, FrozenRows& rows) {
  std::int64_t all = 0;
  forEachList(kinds, rows, [&](auto& list, const KindPlace& kind) {
    list.resize(kind.count);
    for (std::size_t k = 0; k < list.size(); ++k) evaluate(kinds, kind.place, k, x, list[k]);
    all += static_cast<std::int64_t>(kind.count);
  });
  return all;
}

// A kind of another shape adds a line; the linker asks for it.
#define DBD_SHAPE(bodies, rows, isForce)                                            \
  template void evaluate(Kinds&, int, std::size_t, const Configuration&,            \
                         FrozenRow<bodies, rows, isForce>&);                        \
  template void evaluateForce(const Kinds&, int, std::size_t, const Configuration&, \
                              FrozenRow<bodies, rows, isForce>&)
DBD_SHAPE(1, 3, true);
DBD_SHAPE(2, 1, true);
DBD_SHAPE(2, 3, true);
DBD_SHAPE(3, 3, true);
DBD_SHAPE(2, 1, false);
DBD_SHAPE(2, 2, false);
DBD_SHAPE(2, 3, false);
DBD_SHAPE(4, 1, false);
DBD_SHAPE(kMany, 1, false);
#undef DBD_SHAPE

}  // namespace physics
