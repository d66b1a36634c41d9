#include "physics/solver/elimination_order.h"

#include <algorithm>
#include <iterator>

namespace physics {

EliminationOrder::EliminationOrder(std::span<const std::set<int>> meets, std::span<const int> sizes)
    : rows_(meets.size()), mark_(meets.size(), 0) {
  for (std::size_t i = 0; i < meets.size(); ++i) {
    rows_[i].meets.assign(meets[i].begin(), meets[i].end());
    rows_[i].size = sizes[i];
  }
}

std::vector<int> EliminationOrder::find() {
  for (int i = 0; i < static_cast<int>(rows_.size()); ++i) {
    rows_[i].fills = fillsOf(i, {});
    left_.insert(rankOf(i));
  }
  std::vector<int> order;
  while (!left_.empty()) {
    order.push_back(std::get<2>(*left_.begin()));
    eliminate(order.back());
  }
  return order;
}

// Of the pairs of rows that it meets those that do not meet yet, by their numbers. All of `clique`,
// sorted, meet each other: to be seen are the pairs with the others.
long EliminationOrder::fillsOf(int i, std::span<const int> clique) {
  enum { kInClique = 1, kOther = 2 };
  long all = 0, squares = 0, ofClique = 0, cliqueSquares = 0, met = 0, metTwice = 0;
  others_.clear();
  auto next = clique.begin();
  for (const int j : rows_[i].meets) {
    const long size = rows_[j].size;
    next = std::lower_bound(next, clique.end(), j);
    const bool isOne = next != clique.end() && *next == j;
    mark_[j] = isOne ? kInClique : kOther;
    all += size;
    squares += size * size;
    if (!isOne) {
      others_.push_back(j);
      continue;
    }
    ofClique += size;
    cliqueSquares += size * size;
  }
  for (const int j : others_) {
    long here = 0, others = 0;
    for (const int k : rows_[j].meets) {
      if (mark_[k] == kInClique) here += rows_[k].size;
      if (mark_[k] == kOther) others += rows_[k].size;
    }
    met += rows_[j].size * here;
    metTwice += rows_[j].size * others;
  }
  for (const int j : rows_[i].meets) mark_[j] = 0;
  return (all * all - squares - (ofClique * ofClique - cliqueSquares) - metTwice) / 2 - met;
}

// What it meets meets each other from now on. What that changes for others is less to fill: of the
// pairs that meet now, where they meet both.
void EliminationOrder::eliminate(int i) {
  const Row gone = std::move(rows_[i]);
  left_.erase({gone.fills, gone.height, i});
  const std::vector<int>& clique = gone.meets;
  std::vector<int> both;
  for (const int j : clique) left_.erase(rankOf(j));
  if (gone.fills > 0) {
    for (std::size_t a = 0; a < clique.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) meetNow(clique[a], clique[b]);
    }
  }
  for (const int j : clique) {
    Row& row = rows_[j];
    row.height = std::max(row.height, gone.height + 1);
    both.clear();
    std::set_union(row.meets.begin(), row.meets.end(), clique.begin(), clique.end(),
                   std::back_inserter(both));
    std::erase_if(both, [&](int k) { return k == i || k == j; });
    row.meets.swap(both);
  }
  for (const int j : clique) {
    rows_[j].fills = fillsOf(j, clique);
    left_.insert(rankOf(j));
  }
}

// Two rows that did not.
void EliminationOrder::meetNow(int j, int k) {
  const std::vector<int>&ofJ = rows_[j].meets, &ofK = rows_[k].meets;
  if (std::binary_search(ofJ.begin(), ofJ.end(), k)) return;
  std::vector<int> both;
  std::set_intersection(ofJ.begin(), ofJ.end(), ofK.begin(), ofK.end(), std::back_inserter(both));
  for (const int m : both) {
    const auto place = left_.find(rankOf(m));
    if (place == left_.end()) continue;  // it is of those that are counted anew
    left_.erase(place);
    rows_[m].fills -= long{rows_[j].size} * rows_[k].size;
    left_.insert(rankOf(m));
  }
}

}  // namespace physics
