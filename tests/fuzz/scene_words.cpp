// Prints libFuzzer's dictionary: every word that the program's tables know, and every key, string
// and number of the library's files.
#include <fstream>
#include <iostream>
#include <iterator>
#include <set>

#include "scenes/measure/metrics.h"
#include "scenes/read/recipe.h"
#include "scenes/read/value.h"

namespace {

void collect(const scenes::Value& value, std::set<std::string>& words) {
  if (value.isString() && value.text.size() < 40) words.insert(value.text);
  if (value.isNumber()) words.insert(describe(value));
  for (const scenes::Value& item : value.items) collect(item, words);
  for (const scenes::Member& member : value.members) {
    words.insert(member.key);
    collect(member.value, words);
  }
}

bool isPlain(const std::string& word) {
  return !word.empty() && word.find_first_of("\"\\\n\r\t") == std::string::npos;
}

}  // namespace

int main() {
  std::set<std::string> words{"nan", "inf", "1e308", "-1", "0", "9223372036854775807", "[[", "]]"};
  for (const scenes::Word& word : scenes::bodyWords()) words.insert(word.name);
  for (const scenes::Word& word : scenes::constraintWords()) words.insert(word.name);
  for (const std::string& name : scenes::metricNames()) words.insert(name);
  for (const std::string& name : scenes::libraryScenes()) {
    const std::string path = scenes::libraryFolder() + "/" + name + ".toml";
    std::ifstream file(path);
    const std::string text(std::istreambuf_iterator<char>(file), {});
    collect(scenes::parseToml(text, path), words);
  }
  for (const std::string& word : words) {
    if (isPlain(word)) std::cout << '"' << word << "\"\n";
  }
}
