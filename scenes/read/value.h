// What a scene file says, as a plain tree that remembers where each value was written.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenes/read/input_error.h"

namespace scenes {

struct Place {
  int line = 0, column = 0;  // 1-based, in the file
  std::string setting{};     // "--set key=value" where the value came from the command line
  std::string file{};        // where it is not the scene's own: one that it includes
};

struct Member;

struct Value {
  enum class Kind { kTable, kArray, kBoolean, kInteger, kNumber, kString, kDate };
  Value();  // these out of line: hundreds of places make and drop one
  Value(const Value&);
  Value(Value&&) noexcept;
  Value& operator=(const Value&);
  Value& operator=(Value&&) noexcept;
  ~Value();

  Kind kind = Kind::kTable;
  Place place;
  bool boolean = false;
  std::int64_t integer = 0;
  double number = 0;  // of an integer too
  std::string text;
  std::vector<Value> items;     // of an array
  std::vector<Member> members;  // of a table, in the order of the file

  bool isTable() const { return kind == Kind::kTable; }
  bool isArray() const { return kind == Kind::kArray; }
  bool isNumber() const { return kind == Kind::kInteger || kind == Kind::kNumber; }
  bool isString() const { return kind == Kind::kString; }
  const Value* find(const std::string& key) const;  // of a table; null where absent
  Value* find(const std::string& key);
};

struct Member {
  std::string key;
  Place place;
  Value value;
};

bool isTables(const Value& value);  // [[rows]] of them
// Out of a table; nothing where it is not there.
std::optional<Value> takeMember(Value& table, const std::string& key);

// "-3", "'ball'", "a table": how an error names a value.
std::string describe(const Value& value);

// Throws InputError("file:line:col: expected UTF-8 ...") where `text` is none.
void checkLetters(const std::string& text, const std::string& path);

// Throws InputError("file:line:col: expected ...") where `text` is not TOML.
Value parseToml(const std::string& text, const std::string& path);

// Applies "a.b.c=value" to the tree; "a.b=none" takes a table, or all tables of that word, out.
// Arrays are addressed by index, arrays of tables by name as well; a key that is not there is added
// and left to the schema to judge. Throws InputError.
void applyOverride(Value& root, const std::string& setting);

// What is at "a.b.c" by the same rules; null where nothing is.
const Value* findValue(const Value& root, const std::string& key);

// "; did you mean 'x'?" with the nearest candidate, or nothing where none is near.
std::string didYouMean(const std::string& word, const std::vector<std::string>& candidates);
// The same, or "; expected x, y or z" with all of them where none is near.
std::string nearestOrAll(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace scenes
