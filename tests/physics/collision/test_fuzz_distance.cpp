// Every pair of shapes at poses that are near touching, deep, aligned, almost aligned or
// coincident, of sizes from 1e-3 to 1e2 m, against a second computation. DBD_POSES=10000 tries
// more.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/physics/collision/independent_distance.h"
#include "tests/physics/collision/scene_of_two.h"

namespace physics {
namespace {

using namespace testing;

constexpr double kMargin = 0.02;

struct Sized {
  Named named;
  double least = 0.5, most = 0.5;  // of its extents [m]
};

std::vector<Sized> pool() {
  std::vector<Sized> all;
  for (const Named& named : shapes()) all.push_back({named});
  all.push_back({{"plate", Box{Vec3(1, 0.002, 0.7)}}, 0.002, 1});
  all.push_back({{"needle", Box{Vec3(0.003, 1, 0.003)}}, 0.003, 1});
  all.push_back({{"coin", Cylinder{0.5, 0.004}}, 0.004, 1});
  all.push_back({{"wire", Capsule{0.002, 1}}, 0.004, 1});
  all.push_back({{"grain", Sphere{1e-3}}, 2e-3, 2e-3});
  all.push_back({{"block", Box{Vec3(100, 60, 80)}}, 60, 100});
  return all;
}

struct Two {
  Sized a, b;
};
void PrintTo(const Two& two, std::ostream* out) { *out << two.a.named.name << two.b.named.name; }

bool isPlane(const Sized& s) { return std::holds_alternative<Plane>(s.named.shape); }
bool isPoint(const Sized& s) { return std::holds_alternative<PointShape>(s.named.shape); }

std::vector<Two> pairs() {
  std::vector<Two> result;
  const std::vector<Sized> all = pool();
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i; j < all.size(); ++j) {
      const Two two = isPlane(all[i]) ? Two{all[j], all[i]} : Two{all[i], all[j]};
      if (!isPlane(two.a) && !(isPoint(two.a) && isPoint(two.b))) result.push_back(two);
    }
  }
  return result;
}

// Curved sides and many edges: the direction of overlap is searched for, not found in a list.
bool isSearched(const Two& two) {
  const auto is = [&](const char* name) {
    return two.a.named.name == name || two.b.named.name == name;
  };
  return is("cylinder") || is("coin") || is("ball");
}

class FuzzDistance : public ::testing::TestWithParam<Two> {
 protected:
  const Two& two() const { return GetParam(); }
  double smaller() const {
    if (isPoint(two().a)) return two().b.least;
    return isPoint(two().b) ? two().a.least : std::min(two().a.least, two().b.least);
  }
  double larger() const { return std::max(two().a.most, two().b.most); }
  double size() const {  // the smaller bounding radius
    const auto radius = [](const Sized& s) {
      return isPoint(s) || isPlane(s) ? 1e300 : boundingRadius(s.named.shape);
    };
    return std::min(radius(two().a), radius(two().b));
  }
  // Neighbouring directions count as one within half of this.
  double flat() const { return (isSearched(two()) ? 3e-3 : 1e-3) * size() + exact(); }
  // GJK near touching, measured 3e-9 of the larger size; the second computation on a rim, 1e-5 m.
  double exact() const { return 1e-8 * larger() + (isSearched(two()) ? 2e-5 * size() : 0); }

  Bounds truth(const Pose& a, const Pose& b) const {
    return independentDistance(two().a.named.shape, a, two().b.named.shape, b);
  }

  Quat orientation(int kind, testing::Random& random) const {
    if (kind == 0) return random.rotation();
    const Quat quarter = turned(Vec3::Unit(static_cast<int>(random.number(0, 3))),
                                90 * std::floor(random.number(0, 4)));
    if (kind == 1) return quarter;
    const double degrees = std::pow(10, random.number(-9, 0));
    return turned(random.direction(), degrees) * quarter;
  }

  // a against b, which stands at a place of its own.
  std::array<Pose, 2> poses(int index, testing::Random& random) const {
    Pose b{Vec3(1, 2, 3), orientation(index % 3, random)}, a = b;
    a.q = index % 3 == 1 ? orientation(1, random) : orientation(index % 3, random) * b.q;
    const double reach = 0.5 * (two().a.most + two().b.most);
    if (index % 5 == 4) return {a, b};  // coincident
    const double depth = index % 5 == 3 ? 0.1 : 1;
    a.x += random.within(depth * reach * 1.2);
    if (index % 5 > 1) return {a, b};
    const Bounds at = truth(a, b);  // moved along the normal, near touching
    const double gap = index % 5 == 0 ? std::pow(10, random.number(-12, -1)) * smaller() : 0;
    a.x += (gap * (random.number(0, 1) < 0.5 ? -1 : 1) - at.low) * at.normal;
    return {a, b};
  }

  void expectDistance(double got, const Bounds& want) const {
    const bool overlaps = want.high < exact();
    const double search = overlaps && isSearched(two()) ? 0.15 * std::abs(want.low) : 0;
    EXPECT_LE(got, want.high + exact());
    EXPECT_GE(got, want.low - search - exact());
  }

  void expectManifold(const Manifold& m, const std::array<Pose, 2>& at, const Bounds& want) const {
    const std::array<Pose, 3> all{Pose{}, at[0], at[1]};
    const Vec3 n = (m.a == 1 ? 1 : -1) * (all[m.b].q * m.normal);
    ASSERT_NEAR(n.norm(), 1, 1e-12);
    const bool overlaps = want.high < exact();
    const double allowed = flat() + (overlaps && isSearched(two()) ? 0.15 * -want.low : 0);
    const auto &a = two().a.named.shape, &b = two().b.named.shape;
    EXPECT_GE(separation(a, at[0], b, at[1], n), want.low - allowed) << "a bad direction";
    const double gap = smallestGap(m, all);
    EXPECT_LE(gap, want.high + allowed);
    EXPECT_GE(gap, want.low - allowed);
    for (int k = 0; k < m.count; ++k) {
      const Point point = place(m, k, all);
      const double inside = point.gap > gap ? larger() : std::max(-gap, 0.0);
      expectOnSurface(m.a == 1 ? point.onA : point.onB, two().a, at[0], inside);
      expectOnSurface(m.a == 1 ? point.onB : point.onA, two().b, at[1], inside);
    }
  }

  // On the surface, or inside by no more than that.
  void expectOnSurface(const Vec3& point, const Sized& s, const Pose& pose, double inside) const {
    const Bounds at = independentDistance(point, s.named.shape, pose);
    EXPECT_LE(at.low, flat()) << "a contact point off the shape";
    EXPECT_GE(at.high, -inside - flat()) << "a contact point deep inside the shape";
  }
};

TEST_P(FuzzDistance, AgreesWithTheSecondComputation) {
  const char* asked = std::getenv("DBD_POSES");
  const int count = asked != nullptr ? std::atoi(asked) : 60;
  testing::Random random(3);
  for (int index = 0; index < count; ++index) {
    SCOPED_TRACE(index);
    const std::array<Pose, 2> at = poses(index, random);
    const Bounds want = truth(at[0], at[1]);
    ASSERT_LE(want.low, want.high + 2 * exact());
    const Shape &a = two().a.named.shape, &b = two().b.named.shape;
    const double got = distanceOf(a, at[0], b, at[1]);
    expectDistance(got, want);
    EXPECT_NEAR(distanceOf(b, at[1], a, at[0]), got, isSearched(two()) ? flat() : exact());
    const std::vector<Manifold> found = meet(a, at[0], b, at[1], kMargin);
    EXPECT_TRUE(!found.empty() || want.high > kMargin - flat()) << "missed";
    EXPECT_TRUE(found.empty() || want.low < kMargin + flat()) << "not within the margin";
    for (const Manifold& m : found) expectManifold(m, at, want);
  }
}

INSTANTIATE_TEST_SUITE_P(Pairs, FuzzDistance, ::testing::ValuesIn(pairs()), [](const auto& info) {
  return info.param.a.named.name + "_" + info.param.b.named.name;
});

}  // namespace
}  // namespace physics
