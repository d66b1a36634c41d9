// What all generators share: what bodies are made of, where copies stand, and random numbers.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "physics/base/fields.h"
#include "physics/world.h"

namespace physics {

// Members of a generator's definition may be, besides those of physics/base/fields.h: int,
// std::string, Shape, std::optional<Friction>, std::vector of these, and a struct that has `fields`
// itself.

inline constexpr double kMorePositive = std::numeric_limits<double>::min();  // a bound: > 0
inline constexpr int kMostBodies = 100000;     // of a generator, and of a scene: some 200 MB
inline constexpr double kWaterDensity = 1000;  // kg/m^3, the default

// Mass or density of each body, its friction and its restitution.
struct Matter {
  std::optional<double> mass;     // kg
  std::optional<double> density;  // kg/m^3; neither: 1000 kg/m^3
  std::optional<Friction> friction;
  std::optional<double> restitution;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"mass", Unit::kNone, false, kMorePositive}, d.mass);
    v(Field{"density", Unit::kNone, false, kMorePositive}, d.density);
    v(Field{"friction"}, d.friction);
    v(Field{"restitution", Unit::kNone, false, 0, 1}, d.restitution);
  }
};

// The body of this shape and matter at a pose; throws std::invalid_argument where mass is not given
// and the shape has no volume.
BodyDef bodyOf(const Shape& shape, const Matter& matter, const Pose& pose);
double massOf(const Shape& shape, const Matter& matter);  // kg

// Half the shape's extent along a world direction at orientation q, to both sides of its centre of
// mass [m]: the largest d . p over the shape.
double reach(const Shape& shape, const Quat& q, const Vec3& direction);

// Numbers that depend on the seed only (splitmix64).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double uniform(double low, double high);
  Vec3 inBall(double radius);
  Quat rotation(double largestAngle);  // about a random axis, angle uniform in [0, largestAngle]

 private:
  std::uint64_t next();
  std::uint64_t state_;
};

}  // namespace physics
