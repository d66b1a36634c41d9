// Expressions by muParser; the only file that knows it.
#include "scenes/read/expression.h"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>

#include "scenes/read/value.h"

namespace scenes {
namespace {

constexpr std::size_t kMostLetters = 1000;
constexpr const char* kFunctions[] = {"sin", "cos",   "tan",  "asin",  "acos",  "atan", "atan2",
                                      "exp", "log",   "sqrt", "abs",   "min",   "max",  "sum",
                                      "rad", "floor", "ceil", "round", "random"};

bool isLetter(unsigned char c) { return std::isalnum(c) || c == '_'; }

double remainder(double a, double b) {
  return b == 0 ? std::numeric_limits<double>::quiet_NaN() : a - b * std::floor(a / b);
}
double negation(double a) { return a == 0 ? 1 : 0; }
double radians(double degrees) { return degrees * (M_PI / 180); }

// Sebastiano Vigna's splitmix64, over the bits of each number in turn.
double random(const double* numbers, int count) {
  std::uint64_t state = 0;
  for (int i = 0; i < count; ++i) {
    state += std::bit_cast<std::uint64_t>(numbers[i] + 0.0) + 0x9e3779b97f4a7c15;
    state = (state ^ (state >> 30)) * 0xbf58476d1ce4e5b9;
    state = (state ^ (state >> 27)) * 0x94d049bb133111eb;
    state ^= state >> 31;
  }
  return std::ldexp(static_cast<double>(state >> 11), -53);
}

double elementOf(void* list, double k) {
  const auto& values = *static_cast<const std::vector<double>*>(list);
  const double last = static_cast<double>(values.size()) - 1;
  if (!(k >= 0 && k <= last) || k != std::floor(k)) {
    throw ExpressionError(
        fmt::format("expected a whole number in [0, {}] in a list, got {}", last, k), -1);
  }
  return values[static_cast<std::size_t>(k)];
}

}  // namespace

struct Expressions::Name {
  bool known = false, isList = false;
  double value = 0;
  std::vector<double> values;
};

struct Expressions::Compiled {
  mu::Parser parser;
  std::vector<std::string> uses;
};

Expressions::Expressions() = default;
Expressions::~Expressions() = default;

bool Expressions::mayName(const std::string& word) {
  const bool isWord = !word.empty() && std::all_of(word.begin(), word.end(), isLetter) &&
                      !std::isdigit(static_cast<unsigned char>(word[0]));
  return isWord && word != "pi" &&
         std::find(std::begin(kFunctions), std::end(kFunctions), word) == std::end(kFunctions);
}

bool Expressions::knows(const std::string& name) const {
  const auto found = names_.find(name);
  return found != names_.end() && found->second.known;
}

std::vector<std::string> Expressions::names() const {
  std::vector<std::string> known;
  for (const auto& [name, entry] : names_) {
    if (entry.known) known.push_back(name);
  }
  return known;
}

void Expressions::define(const std::string& name, double value) {
  Name& entry = names_[name];
  if (entry.isList) compiled_.clear();  // they call it
  entry = {true, false, value, {}};
}

void Expressions::define(const std::string& name, std::vector<double> values) {
  Name& entry = names_[name];
  if (!entry.isList) compiled_.clear();  // they read a number
  entry = {true, true, 0, std::move(values)};
}

void Expressions::forget(const std::string& name) { names_[name].known = false; }

Expressions::Compiled& Expressions::compile(const std::string& text) {
  std::unique_ptr<Compiled>& compiled = compiled_[text];
  if (compiled != nullptr) return *compiled;
  auto fresh = std::make_unique<Compiled>();
  mu::Parser& parser = fresh->parser;
  parser.ClearConst();
  parser.DefineConst("pi", M_PI);
  parser.ClearFun();
  using Plain = double (*)(double);
  const std::pair<const char*, Plain> plain[] = {
      {"sin", std::sin},   {"cos", std::cos},    {"tan", std::tan}, {"asin", std::asin},
      {"acos", std::acos}, {"atan", std::atan},  {"exp", std::exp}, {"log", std::log},
      {"sqrt", std::sqrt}, {"abs", std::fabs},   {"rad", radians},  {"floor", std::floor},
      {"ceil", std::ceil}, {"round", std::round}};
  for (const auto& [name, function] : plain) parser.DefineFun(name, function);
  using Many = double (*)(const double*, int);
  const std::pair<const char*, Many> many[] = {
      {"min", [](const double* x, int n) { return *std::min_element(x, x + n); }},
      {"max", [](const double* x, int n) { return *std::max_element(x, x + n); }},
      {"sum",
       [](const double* x, int n) {
         double sum = 0;
         for (int i = 0; i < n; ++i) sum += x[i];
         return sum;
       }},
      {"random", random}};
  for (const auto& [name, function] : many) parser.DefineFun(name, function);
  parser.DefineFun("atan2", static_cast<double (*)(double, double)>(std::atan2));
  parser.DefineOprt("%", remainder, mu::prMUL_DIV);
  parser.DefineInfixOprt("!", negation);
  for (auto& [name, entry] : names_) {
    if (!entry.isList) continue;
    parser.DefineFunUserData(name, elementOf, &entry.values);
  }
  parser.SetVarFactory(
      [](const char* name, void* self) {
        return &static_cast<Expressions*>(self)->names_[name].value;
      },
      this);
  parser.SetExpr(text);
  for (const auto& [name, place] : parser.GetUsedVar()) fresh->uses.push_back(name);
  compiled = std::move(fresh);
  return *compiled;
}

// What is wrong at this letter.
std::string Expressions::mistakeOf(const std::string& text, std::size_t at,
                                   const std::string& token) const {
  std::size_t begin = at;
  while (begin > 0 && isLetter(text[begin - 1])) --begin;
  const std::string word = text.substr(begin, at - begin);
  if (token == "(" && mayName(word)) {
    std::vector<std::string> known(std::begin(kFunctions), std::end(kFunctions));
    for (const auto& [name, entry] : names_) {
      if (entry.known && entry.isList) known.push_back(name);
    }
    return fmt::format("no function or list '{}'{}", word, nearestOrAll(word, known));
  }
  return "expected an expression" + (token.empty() ? "" : fmt::format(", got '{}'", token));
}

double Expressions::evaluate(const std::string& text) {
  if (text.size() > kMostLetters) {
    throw ExpressionError(
        fmt::format("expected at most {} letters, got {}", kMostLetters, text.size()), -1);
  }
  try {
    Compiled& compiled = compile(text);
    for (const std::string& name : compiled.uses) {
      const int at = static_cast<int>(text.find(name));
      if (names_[name].isList)
        throw ExpressionError(fmt::format("'{0}' is a list: say {0}(k)", name), at);
      if (knows(name)) continue;
      throw ExpressionError(fmt::format("unknown name '{}'{}", name, nearestOrAll(name, names())),
                            at);
    }
    const double value = compiled.parser.Eval();
    if (std::isfinite(value)) return value;
    throw ExpressionError(fmt::format("expected a finite number, got {}", value), -1);
  } catch (const mu::ParserError& error) {
    const std::size_t at = std::min<std::size_t>(error.GetPos(), text.size());
    throw ExpressionError(mistakeOf(text, at, error.GetToken()), static_cast<int>(at));
  }
}

}  // namespace scenes
