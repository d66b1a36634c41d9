// The constraints and forces of a World as values, for whoever takes the same scene elsewhere.
#pragma once

#include <variant>

#include "physics/constraints/kinds.h"

namespace physics {

template <class Table>
struct ItemOf;
template <class... K>
struct ItemOf<std::tuple<K...>> {
  using Any = std::variant<typename K::Item...>;
};

struct ConstraintItem {
  const char* kind;         // its word
  ItemOf<Kinds>::Any item;  // anchors and axes in body frames
};

}  // namespace physics
