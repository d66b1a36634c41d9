// [parameters], "= 2 * n" and [[repeat]]: a tree of values becomes one without them.
#include "scenes/read/expand.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "scenes/read/expression.h"
#include "scenes/read/settings_reader.h"

namespace scenes {
namespace {

using physics::Field;
using physics::Unit;

constexpr int kMostTurns = 1'000'000, kMostTables = 300'000, kDeepestRepeat = 8;
constexpr double kMostInteger = 9007199254740992;  // 2^53

class Expander {
 public:
  explicit Expander(const Context& context) : context_(context) {}

  void run(Value& tree);

 private:
  double evaluate(const std::string& text, const Value& from, int offset);
  void replaceNumber(Value& value);
  void fillIn(Value& value);
  void walk(Value& value);
  bool defines(const Member& parameter);
  std::vector<std::string> define(const Value& parameters);
  void repeat(const Value& table, Value& into, int depth);
  void turn(const Value& table, Value& into, int depth);

  const Context& context_;
  Expressions known_;
  std::map<std::string, std::string> texts_;  // parameters that are texts
  bool hasNames_ = false;                     // "{" in a text means something
  int turns_ = 0, tables_ = 0;                // made by repeats
};

bool isFormula(const Value& value) { return value.isString() && value.text.starts_with('='); }

// `offset`: where the text begins in the value, so that an error is at its letter.
double Expander::evaluate(const std::string& text, const Value& from, int offset) {
  try {
    return known_.evaluate(text);
  } catch (const ExpressionError& error) {
    Place place = from.place;
    if (error.position >= 0) place.column += 1 + offset + error.position;  // behind the quote
    fail(context_, place, fmt::format("'{}': {}", from.text, error.what()));
  }
}

void Expander::replaceNumber(Value& value) {
  const double number = evaluate(value.text.substr(1), value, 1);
  const bool isWhole = number == std::floor(number) && std::fabs(number) < kMostInteger;
  value.kind = isWhole ? Value::Kind::kInteger : Value::Kind::kNumber;
  value.integer = isWhole ? static_cast<std::int64_t>(number) : 0;
  value.number = number + 0.0;
  value.text.clear();
}

// "{i}" in a text; "{{" is a brace.
void Expander::fillIn(Value& value) {
  std::string filled;
  const std::string& text = value.text;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const bool isPair = at + 1 < text.size() && text[at + 1] == text[at];
    if ((text[at] == '{' || text[at] == '}') && isPair) {
      filled += text[at++];
      continue;
    }
    if (text[at] != '{') {
      filled += text[at];
      continue;
    }
    const std::size_t end = text.find('}', at);
    if (end == std::string::npos) {
      fail(context_, value.place, fmt::format("'{}': expected a '}}' behind '{{'", text));
    }
    const std::string inside = text.substr(at + 1, end - at - 1);
    if (const auto word = texts_.find(inside); word != texts_.end()) {
      filled += word->second;
    } else {
      filled += fmt::format("{}", evaluate(inside, value, static_cast<int>(at) + 1) + 0.0);
    }
    at = end;
  }
  value.text = std::move(filled);
}

void Expander::walk(Value& value) {
  if (isFormula(value)) return replaceNumber(value);
  if (value.isString() && hasNames_ && value.text.find_first_of("{}") != std::string::npos) {
    return fillIn(value);
  }
  for (Value& item : value.items) walk(item);
  for (Member& member : value.members) walk(member.value);
}

// False: it needs a name that is not known yet.
bool Expander::defines(const Member& parameter) {
  Value value = parameter.value;
  const auto waits = [&](const Value& v) {
    if (!isFormula(v)) return false;
    try {
      known_.evaluate(v.text.substr(1));
    } catch (const ExpressionError&) {
      return true;
    }
    return false;
  };
  if (waits(value)) return false;
  if (std::any_of(value.items.begin(), value.items.end(), waits)) return false;
  walk(value);
  std::vector<double> list;
  for (const Value& item : value.items) {
    if (!item.isNumber()) {
      fail(context_, item.place,
           fmt::format("parameters.{}: expected numbers, got {}", parameter.key, describe(item)));
    }
    list.push_back(item.number);
  }
  if (value.isString()) {
    texts_[parameter.key] = value.text;
  } else if (value.isArray()) {
    known_.define(parameter.key, std::move(list));
  } else if (value.isNumber() || value.kind == Value::Kind::kBoolean) {
    known_.define(parameter.key, value.isNumber() ? value.number : value.boolean ? 1 : 0);
  } else {
    fail(context_, value.place,
         fmt::format("parameters.{}: expected a number, a list of numbers or a text, got {}",
                     parameter.key, describe(value)));
  }
  return true;
}

// In whatever order they are written; the names.
std::vector<std::string> Expander::define(const Value& parameters) {
  if (!parameters.isTable()) {
    fail(context_, parameters.place, "parameters: expected a table, got " + describe(parameters));
  }
  std::vector<const Member*> left;
  std::vector<std::string> names;
  for (const Member& member : parameters.members) {
    if (known_.knows(member.key) || texts_.contains(member.key)) {
      fail(context_, member.place, fmt::format("parameters: '{}' is a name already", member.key));
    }
    if (!Expressions::mayName(member.key)) {
      fail(context_, member.place,
           fmt::format("parameters: expected a name of letters, digits and '_' that is no "
                       "function's, got '{}'",
                       member.key));
    }
    names.push_back(member.key);
    left.push_back(&member);
  }
  hasNames_ = hasNames_ || !names.empty();
  const auto isText = [](const Member* m) { return m->value.isString() && !isFormula(m->value); };
  std::stable_partition(left.begin(), left.end(), [&](const Member* m) { return !isText(m); });
  while (!left.empty()) {
    if (std::erase_if(left, [&](const Member* member) { return defines(*member); }) > 0) continue;
    Value value = left.front()->value;
    walk(value);  // which tells what it waits for
  }
  return names;
}

// ---- repeat

// The tables of one turn, with the names of this turn known.
void Expander::turn(const Value& table, Value& into, int depth) {
  std::vector<std::string> names;
  if (const Value* own = table.find("parameters")) names = define(*own);
  for (const Member& member : table.members) {
    if (member.key == "count" || member.key == "index" || member.key == "parameters") continue;
    if (!isTables(member.value)) {
      fail(context_, member.place,
           fmt::format("repeat: expected [[repeat.{}]], got {}", member.key,
                       describe(member.value)));
    }
    if (member.key == "repeat") {
      for (const Value& inner : member.value.items) repeat(inner, into, depth + 1);
      continue;
    }
    Value* row = into.find(member.key);
    if (row == nullptr) {
      into.members.push_back({member.key, member.place, {}});
      row = &into.members.back().value;
      row->kind = Value::Kind::kArray;
      row->place = member.value.place;
    }
    if (!row->isArray()) {
      fail(context_, member.place, fmt::format("repeat: [{}] is no [[table]]", member.key));
    }
    for (const Value& item : member.value.items) {
      if (++tables_ > kMostTables) {
        fail(context_, table.place, fmt::format("repeat: more than {} tables", kMostTables));
      }
      row->items.push_back(item);
      walk(row->items.back());
    }
  }
  for (const std::string& name : names) {
    known_.forget(name);
    texts_.erase(name);
  }
}

void Expander::repeat(const Value& table, Value& into, int depth) {
  if (depth > kDeepestRepeat) fail(context_, table.place, "repeat: nested too deep");
  Value head;
  head.place = table.place;
  for (const char* word : {"count", "index"}) {
    if (const Value* value = table.find(word)) {
      head.members.push_back({word, value->place, *value});
      walk(head.members.back().value);
    }
  }
  int count = 0;
  std::string index = "i";
  TableReader reader(head, "repeat", context_);
  reader(Field{"count", Unit::kNone, true, 0, kMostTurns}, count);
  reader(Field{"index"}, index);
  if (context_.glossary != nullptr) context_.glossary->noteTable("repeat");
  if (!Expressions::mayName(index)) {
    reader.failAt("index", fmt::format("expected a name, got '{}'", index));
  }
  if (known_.knows(index) || texts_.contains(index)) {
    reader.failHere(fmt::format("the index '{}' is a name already: say another", index));
  }
  hasNames_ = true;
  for (int i = 0; i < count; ++i) {
    if (++turns_ > kMostTurns) {
      reader.failHere(fmt::format("expected at most {} turns in all", kMostTurns));
    }
    known_.define(index, i);
    turn(table, into, depth);
  }
  known_.forget(index);
}

void Expander::run(Value& tree) {
  if (const std::optional<Value> parameters = takeMember(tree, "parameters")) {
    define(*parameters);
    if (context_.glossary != nullptr) context_.glossary->noteTable("parameters");
  }
  const std::optional<Value> repeats = takeMember(tree, "repeat");
  walk(tree);
  if (!repeats) return;
  if (!isTables(*repeats)) {
    fail(context_, repeats->place, "repeat: expected [[repeat]], got " + describe(*repeats));
  }
  for (const Value& table : repeats->items) repeat(table, tree, 1);
}

}  // namespace

std::vector<std::string> setParameters(Value& tree, std::span<const std::string> overrides) {
  std::vector<std::string> others;
  for (const std::string& setting : overrides) {
    if (!setting.starts_with("parameters.")) {
      others.push_back(setting);
      continue;
    }
    const std::string name = setting.substr(11, setting.find('=') - 11);
    const Value* parameters = tree.find("parameters");
    if (parameters == nullptr || !parameters->isTable()) {
      throw InputError(fmt::format("--set {}: the scene has no [parameters]", setting));
    }
    std::vector<std::string> names;
    for (const Member& member : parameters->members) names.push_back(member.key);
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      throw InputError(
          fmt::format("--set {}: no parameter '{}'{}", setting, name, nearestOrAll(name, names)));
    }
    applyOverride(tree, setting);
  }
  return others;
}

void expand(Value& tree, const Context& context) { Expander(context).run(tree); }

}  // namespace scenes
