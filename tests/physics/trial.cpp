// Every kind of the table, as a trial of it.
#include "tests/physics/trial.h"

#include <algorithm>

#include "physics/constraints/frozen_row.h"
#include "tests/physics/kind_cases.h"

namespace physics::testing {

#define DBD_VISITS_HERE(C) DBD_VISITS(, C)
DBD_EVERY_KIND(DBD_VISITS_HERE)

namespace {

template <class K>
class TrialOf final : public Trial {
 public:
  using Item = typename K::Item;
  explicit TrialOf(Item item) : item_(std::move(item)) {}
  static std::unique_ptr<Trial> make(Random& random, Bodies& bodies) {
    return std::make_unique<TrialOf>(Case<Item>::make(random, bodies));
  }

  bool visit(Bodies& bodies) override { return testing::visit(item_, lambda_, bodies); }
  void iterate(Bodies& bodies, int visits) override {
    lambda_ = testing::iterate(item_, bodies, visits);
  }
  double total() const override { return lambda_.total.norm(); }
  double residual(const Bodies& bodies) const override {
    return residualOf(item_, lambda_, bodies);
  }
  void makeScalar() override {
    if constexpr (requires { item_.form; }) item_.form = Form::kScalar;
  }
  void satisfy(Bodies& bodies) override { Case<Item>::satisfy(item_, bodies); }
  void toGradient(Random& random, Bodies& bodies) const override {
    Case<Item>::toGradient(item_, random, bodies);
  }
  std::unique_ptr<Trial> swapped(const Bodies& bodies) const override {
    Item other = Case<Item>::swapped(item_, bodies);
    std::reverse(other.bodies.begin(), other.bodies.end());
    return std::make_unique<TrialOf>(std::move(other));
  }
  PlainRow rowAt(const Bodies& bodies) const override { return plainRowOf(item_, bodies); }
  std::optional<Mat3> stiffness(const Bodies& bodies) const override {
    if constexpr (Force<Item>) {
      Mat3 k = Mat3::Zero();
      k.topLeftCorner<Item::kRows, Item::kRows>() = rowOf(item_, bodies).k;
      return k;
    }
    return std::nullopt;
  }
  void expectFrozen(const Bodies& bodies) const override;

 private:
  Item item_;
  Multipliers<Item> lambda_;
};

template <class K>
void TrialOf<K>::expectFrozen(const Bodies& bodies) const {
  Kinds kinds;
  auto& set = std::get<K>(kinds).set;
  set.items.push_back(item_);
  set.lambda.emplace_back();
  set.tuned.push_back({1, 0});
  const Evaluated<Item> own = rowOf(item_, bodies);
  const auto compare = [&](auto& list, int place) {
    list.resize(1);
    auto& frozen = list[0];
    evaluate(kinds, place, 0, {bodies.pose, bodies.start, 1.0 / 60}, frozen);
    EXPECT_EQ(frozen.total, &set.lambda[0].total);
    EXPECT_TRUE(std::equal(frozen.bodies.begin(), frozen.bodies.end(), item_.bodies.begin()));
    EXPECT_EQ(frozen.row.c, own.c);
    EXPECT_EQ(frozen.row.longest, own.longest);
    Response<Item> response;
    EXPECT_EQ(effectiveMassInverse(frozen, frozen.row, bodies.inverse, frozen.response),
              effectiveMassInverse(item_, own, bodies.inverse, response));
    if constexpr (Force<Item>) {
      EXPECT_EQ(frozen.row.f, own.f);
      EXPECT_EQ(frozen.row.k, own.k);
    } else {
      EXPECT_EQ(frozen.row.alpha, own.alpha);
      EXPECT_EQ(frozen.row.low, own.low);
      EXPECT_EQ(frozen.row.high, own.high);
    }
  };
  FrozenRows rows;
  int lists = 0, compared = 0;
  forEachList(kinds, rows, [&](auto& list, const KindPlace& kind) {
    ++lists;
    EXPECT_STREQ(kind.word, K::kWord);
    EXPECT_EQ(kind.count, 1U);
    if constexpr (std::is_same_v<std::decay_t<decltype(list)>, std::vector<FrozenOf<Item>>>) {
      compare(list, kind.place);
      ++compared;
    }
  });
  EXPECT_EQ(lists, 1);
  EXPECT_EQ(compared, 1);
}

template <class... K>
std::vector<KindOfTrial> kindsOf(const std::tuple<K...>*) {
  return {
      {K::kWord, countOf<typename K::Item>(), isExternal<typename K::Item>(), TrialOf<K>::make}...};
}

// Central difference of c by coordinate k of body b: 0..2 dx, 3..5 a turn q <- exp(d) q.
Vec3 difference(const std::function<PlainRow(const Bodies&)>& rowAt, const Bodies& bodies, int b,
                int k) {
  constexpr double kStep = 1e-5;  // truncation 1e-10 of c''', rounding 1e-11: both below 1e-7
  Vec3 dx = Vec3::Zero(), turn = Vec3::Zero();
  (k < 3 ? dx : turn)[k % 3] = kStep;
  Bodies ahead = bodies, behind = bodies;
  displace(ahead.pose[b], dx, turn);
  displace(behind.pose[b], -dx, -turn);
  return (rowAt(ahead).c - rowAt(behind).c) / (2 * kStep);
}

}  // namespace

std::vector<KindOfTrial> kindsOfTrials() { return kindsOf(static_cast<const Kinds*>(nullptr)); }

double deviation(const std::function<PlainRow(const Bodies&)>& rowAt, const Bodies& bodies) {
  const PlainRow row = rowAt(bodies);
  double worst = 0, largest = 0;
  for (int b = 0; b < static_cast<int>(row.linear.size()); ++b) {
    for (int k = 0; k < 6; ++k) {
      const Vec3 entries = (k < 3 ? row.linear : row.angular)[b].col(k % 3);
      const Vec3 wrong = entries - difference(rowAt, bodies, b, k);
      worst = std::max(worst, wrong.cwiseAbs().maxCoeff());
      largest = std::max(largest, entries.cwiseAbs().maxCoeff());
    }
  }
  return worst / largest;
}

}  // namespace physics::testing
