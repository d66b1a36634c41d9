// One function per type that a scene file can hold, and the errors they give.
#pragma once

#include <array>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "physics/base/fields.h"
#include "physics/bodies/body.h"
#include "physics/constraints/over_time.h"
#include "physics/make/tet_mesh.h"
#include "scenes/read/value.h"

namespace physics {
struct BodyRef;
struct GridIndex;
}  // namespace physics

namespace scenes {

struct Glossary;

// What errors and names need to know about the file being read.
struct Context {
  std::string path;                                             // as the user gave it
  const std::map<std::string, physics::BodyId>* ids = nullptr;  // every name a constraint may use
  Glossary* glossary = nullptr;                                 // notes every word that is known
};

// The place a value is read for: "file:line:col: key: " begins its errors.
struct Spot {
  const Context& context;
  std::string key;  // "body.mass"
  physics::Field field;
};

[[noreturn]] void fail(const Context& context, const Place& place, const std::string& message);
std::string folderOf(const Context& context, const Place& place);  // of the file that it is in
[[noreturn]] void failExpected(const Spot& spot, const Value& value, const std::string& expected);

// Bounds for numbers that must not be zero; shown as "> 0".
inline constexpr double kPositive = std::numeric_limits<double>::min();

void readValue(const Value& value, const Spot& spot, bool& out);
void readValue(const Value& value, const Spot& spot, int& out);
void readValue(const Value& value, const Spot& spot, unsigned& out);
void readValue(const Value& value, const Spot& spot, double& out);
void readValue(const Value& value, const Spot& spot, std::string& out);
void readValue(const Value& value, const Spot& spot, physics::Vec3& out);
void readValue(const Value& value, const Spot& spot, physics::Vec2& out);
void readValue(const Value& value, const Spot& spot, physics::Quat& out);
void readValue(const Value& value, const Spot& spot, std::array<physics::BodyId, 1>& out);
void readValue(const Value& value, const Spot& spot, physics::BodyRef& out);
void readValue(const Value& value, const Spot& spot, physics::GridIndex& out);
void readValue(const Value& value, const Spot& spot, std::array<physics::BodyId, 2>& out);
void readValue(const Value& value, const Spot& spot, std::array<int, 3>& out);  // or bodies
void readValue(const Value& value, const Spot& spot, std::array<physics::BodyId, 4>& out);
void readValue(const Value& value, const Spot& spot, std::vector<int>& out);  // or bodies
void readValue(const Value& value, const Spot& spot, std::array<double, 2>& out);
void readValue(const Value& value, const Spot& spot, std::array<physics::Vec3, 2>& out);
void readValue(const Value& value, const Spot& spot, physics::Friction& out);
void readValue(const Value& value, const Spot& spot, physics::Shape& out);
void readValue(const Value& value, const Spot& spot, physics::TetMesh& out);
void readValue(const Value& value, const Spot& spot, physics::OverTime& out);

// The index of the word in `choices`.
int readChoice(const Value& value, const Spot& spot, std::span<const char* const> choices);

}  // namespace scenes
