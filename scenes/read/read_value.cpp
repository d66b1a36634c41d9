// One function per type that a scene file can hold; each checks type, range and finiteness.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "physics/base/rotation.h"
#include "physics/make/soft.h"
#include "scenes/read/glossary.h"
#include "scenes/read/table_reader.h"

namespace scenes {
namespace {

using physics::Unit;
using physics::Vec3;

// " >= 0 [m]": behind what is expected.
std::string range(const physics::Field& field) {
  const std::string word = rangeWord(field);
  return word.empty() ? "" : " " + word;
}

std::string unitName(Unit unit) {
  const std::string word = unitWord(unit);
  return word.empty() ? "" : " [" + word + "]";
}

// `infinite`: +inf says something here, such as a torque without a limit.
double number(const Value& value, const Spot& spot, bool infinite = false) {
  const bool sound = value.isNumber() && !std::isnan(value.number) &&
                     (std::isfinite(value.number) || (infinite && value.number > 0));
  if (!sound || value.number < spot.field.low || value.number > spot.field.high) {
    const bool wild = value.isNumber() && !std::isfinite(value.number);
    failExpected(spot, value,
                 fmt::format("a {}number{}{}", wild ? "finite " : "", range(spot.field),
                             unitName(spot.field.unit)));
  }
  return spot.field.unit == Unit::kDegrees ? value.number * M_PI / 180 : value.number;
}

const Value& arrayOf(size_t count, const Value& value, const Spot& spot, const char* what) {
  if (!value.isArray() || value.items.size() != count) failExpected(spot, value, what);
  return value;
}

std::int64_t integer(const Value& value, const Spot& spot) {
  const double low = std::max(spot.field.low, -2147483648.0);
  const double high = std::min(spot.field.high, 2147483647.0);
  if (!value.isNumber() || value.number != std::floor(value.number) || value.number < low ||
      value.number > high) {
    failExpected(spot, value, "an integer" + range(spot.field));
  }
  return static_cast<std::int64_t>(value.number);
}

physics::BodyId bodyNamed(const Value& value, const Spot& spot) {
  if (!value.isString()) failExpected(spot, value, "the name of a body");
  const auto& ids = *spot.context.ids;
  if (const auto found = ids.find(value.text); found != ids.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [name, id] : ids) names.push_back(name);
  const std::string word = spot.key.substr(0, spot.key.rfind('.'));
  fail(spot.context, value.place,
       fmt::format("{}: no body '{}'{}", word, value.text, didYouMean(value.text, names)));
}

void readBodies(const Value& value, const Spot& spot, std::span<physics::BodyId> out) {
  std::set<physics::BodyId> known;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = bodyNamed(value.items[i], spot);
    if (known.insert(out[i]).second) continue;
    fail(spot.context, value.place,
         fmt::format("{}: expected {}different bodies, got '{}' twice", spot.key,
                     out.size() == 2 ? "two " : "", value.items[i].text));
  }
}

}  // namespace

void readValue(const Value& value, const Spot& spot, bool& out) {
  if (value.kind != Value::Kind::kBoolean) failExpected(spot, value, "true or false");
  out = value.boolean;
}

void readValue(const Value& value, const Spot& spot, int& out) {
  out = static_cast<int>(integer(value, spot));
}

void readValue(const Value& value, const Spot& spot, unsigned& out) {
  Spot natural = spot;
  natural.field.low = std::max(0.0, spot.field.low);
  out = static_cast<unsigned>(integer(value, natural));
}

void readValue(const Value& value, const Spot& spot, double& out) {
  out = number(value, spot, std::isinf(out));
}

void readValue(const Value& value, const Spot& spot, std::string& out) {
  if (!value.isString()) failExpected(spot, value, "a string");
  out = value.text;
}

void readValue(const Value& value, const Spot& spot, Vec3& out) {
  arrayOf(3, value, spot, "[x, y, z]");
  for (int i = 0; i < 3; ++i) out[i] = number(value.items[i], spot);
  if (spot.field.unit == Unit::kDirection && out.norm() < kPositive) {
    failExpected(spot, value, "a direction that is not zero");
  }
}

void readValue(const Value& value, const Spot& spot, physics::Vec2& out) {
  arrayOf(2, value, spot, "[width, height]");
  for (int i = 0; i < 2; ++i) out[i] = number(value.items[i], spot);
}

void readValue(const Value& value, const Spot& spot, physics::GridIndex& out) {
  arrayOf(2, value, spot, "[i, j]");
  readValue(value.items[0], spot, out.i);
  readValue(value.items[1], spot, out.j);
}

void readValue(const Value& value, const Spot& spot, physics::BodyRef& out) {
  out.id = bodyNamed(value, spot);
}

// [w, x, y, z], or { axis = [x, y, z], degrees = number }.
void readValue(const Value& value, const Spot& spot, physics::Quat& out) {
  if (value.isTable()) {
    Vec3 axis = Vec3::UnitY();
    double angle = 0;
    TableReader reader(value, spot.key, spot.context);
    reader(physics::Field{"axis", Unit::kDirection, true}, axis);
    reader(physics::Field{"degrees", Unit::kDegrees, true}, angle);
    reader.finish();
    out = physics::exponential(angle * axis.stableNormalized());
    return;
  }
  arrayOf(4, value, spot, "[w, x, y, z] or { axis, degrees }");
  Eigen::Vector4d wxyz;
  for (int i = 0; i < 4; ++i) wxyz[i] = number(value.items[i], spot);
  if (wxyz.norm() < 1e-9) failExpected(spot, value, "a quaternion that is not zero");
  wxyz.normalize();
  out = physics::Quat(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
}

void readValue(const Value& value, const Spot& spot, std::array<physics::BodyId, 1>& out) {
  out[0] = bodyNamed(value, spot);
}

void readValue(const Value& value, const Spot& spot, std::array<physics::BodyId, 2>& out) {
  arrayOf(2, value, spot, "the names of two bodies");
  readBodies(value, spot, out);
}

void readValue(const Value& value, const Spot& spot, std::array<int, 3>& out) {
  const bool bodies = spot.field.unit == physics::Unit::kBody;
  arrayOf(3, value, spot, bodies ? "the names of three bodies" : "[nx, ny, nz]");
  if (bodies) return readBodies(value, spot, out);
  for (int i = 0; i < 3; ++i) readValue(value.items[i], spot, out[i]);
}

void readValue(const Value& value, const Spot& spot, std::array<physics::BodyId, 4>& out) {
  arrayOf(4, value, spot, "the names of four bodies");
  readBodies(value, spot, out);
}

void readValue(const Value& value, const Spot& spot, std::vector<int>& out) {
  const bool bodies = spot.field.unit == physics::Unit::kBody;
  if (!value.isArray()) failExpected(spot, value, bodies ? "the names of bodies" : "an array");
  out.resize(value.items.size());
  if (bodies && out.size() < 2) failExpected(spot, value, "the names of at least two bodies");
  if (bodies) return readBodies(value, spot, out);
  for (std::size_t i = 0; i < out.size(); ++i) readValue(value.items[i], spot, out[i]);
}

void readValue(const Value& value, const Spot& spot, std::array<double, 2>& out) {
  arrayOf(2, value, spot, "[low, high]");
  for (int i = 0; i < 2; ++i) out[i] = number(value.items[i], spot);
  if (out[0] > out[1]) {
    fail(spot.context, value.place,
         fmt::format("{}: expected [low, high] with low <= high, got [{}, {}]", spot.key,
                     value.items[0].number, value.items[1].number));
  }
}

void readValue(const Value& value, const Spot& spot, std::array<Vec3, 2>& out) {
  arrayOf(2, value, spot, "two points [[x, y, z], [x, y, z]]");
  for (int i = 0; i < 2; ++i) readValue(value.items[i], spot, out[i]);
}

// A number for both, or { static, dynamic }.
void readValue(const Value& value, const Spot& spot, physics::Friction& out) {
  if (value.isNumber()) {
    Spot positive = spot;
    positive.field.low = 0;
    out.staticCoefficient = out.dynamicCoefficient = number(value, positive);
    return;
  }
  if (!value.isTable()) failExpected(spot, value, "a number or { static, dynamic }");
  TableReader reader(value, spot.key, spot.context);
  reader(physics::Field{"static", Unit::kNone, true, 0}, out.staticCoefficient);
  out.dynamicCoefficient = out.staticCoefficient;
  reader(physics::Field{"dynamic", Unit::kNone, false, 0}, out.dynamicCoefficient);
  reader.finish();
  if (out.dynamicCoefficient > out.staticCoefficient) {
    reader.failAt("dynamic", fmt::format("expected a number <= static = {}, got {}",
                                         out.staticCoefficient, out.dynamicCoefficient));
  }
}

int readChoice(const Value& value, const Spot& spot, std::span<const char* const> choices) {
  std::vector<std::string> known(choices.begin(), choices.end());
  for (size_t i = 0; i < known.size(); ++i) {
    if (value.isString() && value.text == known[i]) return static_cast<int>(i);
  }
  std::string list;
  for (const std::string& choice : known) list += (list.empty() ? "'" : ", '") + choice + "'";
  failExpected(
      spot, value,
      (known.size() == 1 ? "" : "one of ") + list + (value.isString() ? "" : " as a string"));
}

}  // namespace scenes
