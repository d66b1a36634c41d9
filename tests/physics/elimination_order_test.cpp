#include "physics/solver/elimination_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>
#include <vector>

namespace physics {
namespace {

using Graph = std::vector<std::set<int>>;

void join(Graph& graph, int a, int b) {
  if (a == b) return;
  graph[a].insert(b);
  graph[b].insert(a);
}

Graph chainOf(int count) {
  Graph graph(count);
  for (int i = 1; i < count; ++i) join(graph, i - 1, i);
  return graph;
}

Graph ringOf(int count) {
  Graph graph = chainOf(count);
  join(graph, 0, count - 1);
  return graph;
}

// Of edges that a fixed sequence picks, sizes of one and three.
Graph anyOf(int count, int edges) {
  Graph graph(count);
  unsigned state = 7;
  const auto next = [&] {
    return static_cast<int>((state = state * 1664525u + 1013904223u) >> 16);
  };
  for (int k = 0; k < edges; ++k) join(graph, next() % count, next() % count);
  return graph;
}

std::vector<int> orderOf(const Graph& graph, const std::vector<int>& sizes) {
  return EliminationOrder(graph, sizes).find();
}

long fillsOf(const Graph& graph, const std::vector<int>& sizes, int i) {
  long fills = 0;
  for (const int j : graph[i]) {
    for (const int k : graph[i]) {
      if (j < k && !graph[j].contains(k)) fills += sizes[j] * sizes[k];
    }
  }
  return fills;
}

struct Eliminated {
  long fills = 0;
  int height = 0;
};

// As it says, by sets: at each place every row that is left is asked.
Eliminated eliminate(Graph graph, const std::vector<int>& sizes, const std::vector<int>& order) {
  Eliminated sum;
  std::vector<int> heights(graph.size(), 0);
  std::set<int> left;
  for (int i = 0; i < static_cast<int>(graph.size()); ++i) left.insert(i);
  for (const int i : order) {
    const auto rank = [&](int k) { return std::tuple(fillsOf(graph, sizes, k), heights[k], k); };
    for (const int k : left) EXPECT_LE(rank(i), rank(k));
    sum.fills += fillsOf(graph, sizes, i);
    left.erase(i);
    const std::set<int> meets = graph[i];
    for (const int j : meets) {
      graph[j].erase(i);
      for (const int k : meets) join(graph, j, k);
      heights[j] = std::max(heights[j], heights[i] + 1);
      sum.height = std::max(sum.height, heights[j] + 1);
    }
  }
  EXPECT_TRUE(left.empty());
  return sum;
}

TEST(EliminationOrder, TakesWhatFillsTheLeastAndOfEqualsWhatTheFewestWaitFor) {
  for (const int edges : {40, 90, 200}) {
    const Graph graph = anyOf(60, edges);
    std::vector<int> sizes;
    for (int i = 0; i < 60; ++i) sizes.push_back(i % 3 == 0 ? 1 : 3);
    eliminate(graph, sizes, orderOf(graph, sizes));
  }
}

TEST(EliminationOrder, TakesAChainFromBothEndsAndFillsNothing) {
  const std::vector<int> sizes(100, 3);
  const Eliminated chain = eliminate(chainOf(100), sizes, orderOf(chainOf(100), sizes));
  EXPECT_EQ(chain.fills, 0);
  EXPECT_LE(chain.height, 51);
}

// Every triangulation of a ring of n has n - 3 more edges; end by end its way is n.
TEST(EliminationOrder, OfALoopTheWayIsItsLogarithm) {
  const std::vector<int> sizes(128, 1);
  const Eliminated ring = eliminate(ringOf(128), sizes, orderOf(ringOf(128), sizes));
  EXPECT_EQ(ring.fills, 125);
  EXPECT_LE(ring.height, 9);
}

}  // namespace
}  // namespace physics
