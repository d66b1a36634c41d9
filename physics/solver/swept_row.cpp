// Rows of a deformable: what is different from kind to kind.
#include "physics/solver/swept_row.h"

#include <type_traits>
#include <utility>

namespace physics::swept {
namespace {

template <class C>
bool isBothWays(const C& item) {
  if constexpr (std::is_same_v<C, Link>) return !item.rope;
  return isEquality(item);
}

template <class K>
void addItem(const K& kind, JointRef ref, SweptRows& rows) {
  using C = typename K::Item;
  const C& item = kind.set.items[ref.item];
  auto& list = std::get<std::vector<SweptRow<C::kRows>>>(rows.lists);
  const int end = static_cast<int>(list.size());
  if (rows.runs.empty() || rows.runs.back().kind != ref.kind) {
    rows.runs.push_back({ref.kind, K::kWord, C::kRows, end, end});
  }
  ++rows.runs.back().end;
  SweptRow<C::kRows>& swept = list.emplace_back();
  swept.ref = ref;
  swept.isForce = Force<C>;
  swept.isLink = std::is_same_v<C, Link>;
  swept.isLength = std::is_same_v<C, RopeLength>;
  swept.stands = canStand<C>();
  swept.isPair = !Force<C> && C::kBodies == 2 && C::kLinear;
  swept.isBothWays = isBothWays(item);
  swept.moves = C::kLinear;
  swept.turns = isAngular<C>();
  swept.bodies.assign(item.bodies.begin(), item.bodies.end());
  if constexpr (C::kLinear) swept.linear.resize(item.bodies.size());
  if constexpr (isAngular<C>()) swept.angular.resize(item.bodies.size());
}

// alpha and c of a push f that falls off by k: J u + K^-1 lambda = K^-1 f.
template <int kRows>
void takeForce(const typename SweptRow<kRows>::Vector& f, const typename SweptRow<kRows>::Matrix& k,
               SweptRow<kRows>& swept) {
  swept.low = -kUnbounded;
  swept.high = kUnbounded;
  swept.isLoad = !(k.trace() > 0);
  swept.constant = f;
  if (swept.isLoad) return;
  swept.alpha = complianceOf(k);
  swept.constant = -(swept.alpha * f);
}

template <class C>
void take(const Set<C>& set, const Evaluated<C>& row, Seen seen, SweptRow<C::kRows>& swept) {
  const C& item = set.items[swept.ref.item];
  swept.active = row.active;
  swept.longest = row.longest;
  swept.c = row.c;
  if constexpr (std::is_same_v<C, Link> || std::is_same_v<C, RopeLength>) {
    swept.length = item.length + row.c[0];
  }
  for (std::size_t b = 0; b < item.bodies.size(); ++b) {
    if constexpr (C::kLinear) swept.linear[b].j = row.linear[b];
    if constexpr (isAngular<C>()) swept.angular[b].j = row.angular[b];
  }
  if (seen == Seen::kGradients || !row.active) return;
  if constexpr (Force<C>) {
    swept.regularisation = 0;
    takeForce<C::kRows>(row.f, row.k, swept);
  } else {
    swept.regularisation = set.tuned[swept.ref.item].regularisation;
    swept.low = row.low;
    swept.high = row.high;
    swept.alpha = row.alpha * SweptRow<C::kRows>::Matrix::Identity();
    swept.constant = row.c;
  }
}

template <class C>
void evaluateItem(const Set<C>& set, const Configuration& at, Seen seen, Row<kMany, 1>& many,
                  SweptRow<C::kRows>& swept) {
  if constexpr (C::kBodies == kMany) {
    set.items[swept.ref.item].evaluate(at, many);
    take(set, many, seen, swept);
  } else {
    Evaluated<C> row;
    set.items[swept.ref.item].evaluate(at, row);
    take(set, row, seen, swept);
  }
}

using Add = void (*)(const Kinds&, JointRef, SweptRows&);
template <int kRows>
using Evaluate = void (*)(const Kinds&, const Configuration&, Seen, Row<kMany, 1>&,
                          SweptRow<kRows>&);

template <std::size_t kKind>
using ItemOf = typename std::tuple_element_t<kKind, Kinds>::Item;

template <int kRows, std::size_t kKind>
constexpr Evaluate<kRows> evaluateOf() {
  if constexpr (ItemOf<kKind>::kRows == kRows) {
    return [](const Kinds& kinds, const Configuration& at, Seen seen, Row<kMany, 1>& many,
              SweptRow<kRows>& swept) {
      evaluateItem(std::get<kKind>(kinds).set, at, seen, many, swept);
    };
  }
  return nullptr;
}

template <std::size_t... kKind>
constexpr auto addsOf(std::index_sequence<kKind...>) {
  return std::array<Add, sizeof...(kKind)>{[](const Kinds& kinds, JointRef ref, SweptRows& rows) {
    addItem(std::get<kKind>(kinds), ref, rows);
  }...};
}

template <int kRows, std::size_t... kKind>
constexpr auto evaluatesOf(std::index_sequence<kKind...>) {
  return std::array<Evaluate<kRows>, sizeof...(kKind)>{evaluateOf<kRows, kKind>()...};
}

using AllKinds = std::make_index_sequence<std::tuple_size_v<Kinds>>;
constexpr auto kAdds = addsOf(AllKinds{});
template <int kRows>
constexpr auto kEvaluates = evaluatesOf<kRows>(AllKinds{});

}  // namespace

SweptRows rowsOf(std::span<const JointRef> refs, const Kinds& kinds) {
  SweptRows rows;
  for (const JointRef ref : refs) kAdds[ref.kind](kinds, ref, rows);
  return rows;
}

template <int kRows>
void evaluate(const Kinds& kinds, const Configuration& at, Seen seen, Row<kMany, 1>& many,
              SweptRow<kRows>& swept) {
  kEvaluates<kRows>[swept.ref.kind](kinds, at, seen, many, swept);
}
template void evaluate(const Kinds&, const Configuration&, Seen, Row<kMany, 1>&, SweptRow<1>&);
template void evaluate(const Kinds&, const Configuration&, Seen, Row<kMany, 1>&, SweptRow<2>&);
template void evaluate(const Kinds&, const Configuration&, Seen, Row<kMany, 1>&, SweptRow<3>&);

}  // namespace physics::swept
