// The one list of parameters per kind: `static void fields(V& v, Def& d)` in each definition calls
// v(Field, member) for every member in a fixed order. The scene reader, the scene writer and the
// generic tests all walk it.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>

#include "physics/base/types.h"

namespace physics {

enum class Unit {
  kNone,
  kBody,       // ids of bodies, written as names; std::array<BodyId, 2> needs no mention
  kPoint,      // Vec3 [m], world coordinates at the start
  kDirection,  // Vec3, world coordinates at the start, normalised by the World, never zero
  kBodyPoint,  // Vec3 [m], body frame
  kDegrees,    // written in degrees, held in radians
  kMetre,
  kNewtonPerMetre,
  kNewtonSecondPerMetre,
  kNewtonMetre,
  kNewtonMetrePerRadian,
  kNewtonMetreSecond,
  kRadianPerSecond,
};

struct Field {
  const char* name;
  Unit unit = Unit::kNone;
  bool required = false;
  double low = -std::numeric_limits<double>::infinity();  // inclusive bounds of every number in it
  double high = std::numeric_limits<double>::infinity();
};

// What a member may be: std::array or std::vector of BodyId, Vec3, std::array<Vec3, 2>, double,
// std::array<double, 2> (an ordered pair low <= high), std::optional of these, bool, Quat, or an
// enum with a `names(E)` overload.
enum class Form { kVector, kScalar };  // the resistance: full matrix (73) or along the error (63)
inline std::span<const char* const> names(Form) {
  static constexpr const char* kNames[] = {"vector", "scalar"};
  return kNames;
}

// Per-constraint tuning; absent: the World's.
struct Tuning {
  std::optional<double> relaxation;  // xi of (53), 0 < xi < 2
  std::optional<double>
      regularisation;  // epsilon: alpha = epsilon * J M^-1 J^T, >= 0 (54); NOTES 3.5
  template <class V, class T>
  static void fields(V& v, T& d) {
    v(Field{"relaxation", Unit::kNone, false, 0.01, 1.99}, d.relaxation);
    v(Field{"regularisation", Unit::kNone, false, 0, 1e6}, d.regularisation);
  }
};

}  // namespace physics
