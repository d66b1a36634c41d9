// A constraint or force as it was evaluated last. Of its kind only the evaluation knows; whoever
// solves it goes by its shape: the numbers of its bodies and rows, and whether it is a force.
#pragma once

#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "physics/constraints/constraint.h"
#include "physics/constraints/kinds.h"

namespace physics {

template <int kBodyCount, int kRowCount, bool kForce>
struct FrozenRow {
  static constexpr int kBodies = kBodyCount, kRows = kRowCount;
  static constexpr bool kIsForce = kForce;
  using Vector = typename Gradients<kBodies, kRows>::Vector;
  using Matrix = typename Gradients<kBodies, kRows>::Matrix;

  PerBody<kBodies, BodyId> bodies;
  bool isLinear = true, isAngular = true;  // it has J along x, along theta
  bool stands = true;                      // what it wants is a place, not a speed
  Form form = Form::kVector;
  bool isAnchored = false;
  std::array<Vec3, 2> anchors{Vec3::Zero(), Vec3::Zero()};  // body frames, where it has any
  Tuned tuned{};
  Vector* total = nullptr;  // its multiplier, where reports look for it

  std::conditional_t<kForce, Push<kBodies, kRows>, Row<kBodies, kRows>> row;
  ResponseOf<kBodies, kRows> response;
  Matrix a;  // J M^-1 J^T

  Vector f;  // as a spring, lambda(u) = f - k J u, times h^2: penalty forces only
  Matrix k;
};

template <class C>
using FrozenOf = FrozenRow<C::kBodies, C::kRows, Force<C>>;

template <class Table>
struct FrozenTable;
template <class... K>
struct FrozenTable<std::tuple<K...>> {
  using Rows = std::tuple<std::vector<FrozenOf<typename K::Item>>...>;
};

// Rows by kind, in the order of the table of kinds.
using FrozenRows = FrozenTable<Kinds>::Rows;

// Everything but response and A, of one item of the kind at `place` of the table.
template <class R>
void evaluate(Kinds& kinds, int place, std::size_t item, const Configuration& x, R& frozen);

// What a force is at x, along the J that it has: f, K and its bound. Of a constraint nothing.
template <class R>
void evaluateForce(const Kinds& kinds, int place, std::size_t item, const Configuration& x,
                   R& frozen);

struct KindPlace {
  int place;
  const char* word;
  std::size_t count;  // of its items
};

// f(list of rows, KindPlace) for every kind that there is.
template <class F, std::size_t... kPlace>
void forEachList(const Kinds& kinds, FrozenRows& rows, F& f, std::index_sequence<kPlace...>) {
  const auto offer = [&](auto& list, const KindPlace& kind) {
    if (kind.count > 0) f(list, kind);
  };
  (offer(std::get<kPlace>(rows), {kPlace, std::tuple_element_t<kPlace, Kinds>::kWord,
                                  std::get<kPlace>(kinds).set.items.size()}),
   ...);
}
template <class F>
void forEachList(const Kinds& kinds, FrozenRows& rows, F&& f) {
  forEachList(kinds, rows, f, std::make_index_sequence<std::tuple_size_v<FrozenRows>>());
}

// Every item at x. Returns their number.
std::int64_t evaluateAll(Kinds& kinds, const Configuration& x, FrozenRows& rows);

}  // namespace physics
