// Sorted lists of structures that are dear to move: each is copied once, to where it belongs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace physics {

// Carries what `leaves` from one list to another, both sorted by `isBefore`.
template <class T, class Order, class F>
void carry(std::vector<T>& from, std::vector<T>& to, Order&& isBefore, F&& leaves) {
  const auto leaving = static_cast<std::size_t>(std::count_if(from.begin(), from.end(), leaves));
  if (leaving == 0) return;
  std::vector<T> stayed, joined;
  stayed.reserve(from.capacity());
  joined.reserve(std::max(to.capacity(), to.size() + leaving));
  auto next = to.begin();
  for (const T& item : from) {
    if (!leaves(item)) {
      stayed.push_back(item);
      continue;
    }
    while (next != to.end() && isBefore(*next, item)) joined.push_back(*next++);
    joined.push_back(item);
  }
  while (next != to.end()) joined.push_back(*next++);
  std::swap(from, stayed);
  std::swap(to, joined);
}

}  // namespace physics
