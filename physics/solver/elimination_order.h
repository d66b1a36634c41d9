// In which order the rows of a sparse symmetric matrix are eliminated.
//
// Next comes what fills the least, and among equals what the fewest wait for. What a push on a row
// runs through is the way from it to the last one, each eliminated into the next: as long as a
// chain or a loop where these are taken off end by end, and a few rows where they are from many
// places at a time. W. F. Tinney and J. W. Walker, Proc. IEEE 55 (1967), scheme 3; of ways
// J. A. G. Jess and H. G. M. Kees, IEEE Trans. Computers 31 (1982).
#pragma once

#include <set>
#include <span>
#include <tuple>
#include <vector>

namespace physics {

class EliminationOrder {
 public:
  // By row: those that it meets, itself not among them; and how many numbers it stands for.
  EliminationOrder(std::span<const std::set<int>> meets, std::span<const int> sizes);

  std::vector<int> find();

 private:
  struct Row {
    std::vector<int> meets;  // of those that are left, sorted
    int size = 1, height = 0;
    long fills = 0;
  };
  using Rank = std::tuple<long, int, int>;  // what it fills, its height, and which it is

  Rank rankOf(int i) const { return {rows_[i].fills, rows_[i].height, i}; }
  long fillsOf(int i, std::span<const int> clique);
  void eliminate(int i);
  void meetNow(int j, int k);

  std::vector<Row> rows_;
  std::set<Rank> left_;
  std::vector<char> mark_;   // scratch, by row
  std::vector<int> others_;  // the same
};

}  // namespace physics
