// Arithmetic in a scene file: "= 2 * pitch * (i - 1)".
#pragma once

#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace scenes {

struct ExpressionError : std::runtime_error {
  ExpressionError(const std::string& message, int at) : runtime_error(message), position(at) {}
  int position;  // of the expression's letters, from 0; -1: of all of it
};

// Numbers and lists of numbers by name, and what is computed with them. Texts are compiled once.
//   + - * / % ^, == != < <= > >=, && || !, a ? b : c, pi
//   sin cos tan asin acos atan atan2 (radians), rad (of degrees), exp log sqrt abs floor ceil round
//   min max sum, list(k): the k-th of a list from 0
//   random(a, b, ...): in [0, 1), a number that follows from a, b, ...
class Expressions {
 public:
  Expressions();
  ~Expressions();
  Expressions(const Expressions&) = delete;
  Expressions& operator=(const Expressions&) = delete;

  // Names are letters, digits and underscores; false: it is none, or a function's.
  static bool mayName(const std::string& word);
  bool knows(const std::string& name) const;
  std::vector<std::string> names() const;

  void define(const std::string& name, double value);
  void define(const std::string& name, std::vector<double> values);
  void forget(const std::string& name);

  // Throws ExpressionError where it is none, a name is unknown or the result is not finite.
  double evaluate(const std::string& text);

 private:
  struct Name;
  struct Compiled;
  Compiled& compile(const std::string& text);
  std::string mistakeOf(const std::string& text, std::size_t at, const std::string& token) const;

  std::map<std::string, Name> names_;  // compiled expressions point into it
  std::map<std::string, std::unique_ptr<Compiled>> compiled_;
};

}  // namespace scenes
