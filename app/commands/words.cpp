// dbd words: every table and key of a scene file, as the reader asks for them.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string_view>

#include "app/base/console.h"
#include "app/commands/commands.h"
#include "app/run/run_record.h"
#include "scenes/read/glossary.h"
#include "scenes/read/value.h"

namespace app {

namespace {

struct WordsOptions {
  std::string table;
  bool json = false;
};

using Tables = std::map<std::string, std::vector<scenes::GlossaryKey>>;

std::string meaningOf(const std::string& table, const std::string& key) {
  const scenes::Meaning* meaning = scenes::findMeaning(table, key);
  return meaning == nullptr ? "" : meaning->text;
}

// "[[body]]  one body" for a table of the file, "{ chain.end }" for one in another.
std::string headOf(const std::string& table) {
  const scenes::Meaning* meaning = scenes::findMeaning("", table);
  if (table.empty()) return "In the file itself:";
  if (meaning == nullptr) return "{ " + table + " }";
  const bool repeats = std::string_view(meaning->type) == "[[tables]]";
  const std::string header = repeats ? "[[" + table + "]]" : "[" + table + "]";
  return fmt::format("{:<24} {}", header, meaning->text);
}

std::string rowOf(const std::string& table, const scenes::GlossaryKey& key) {
  const bool isTable = table.empty() && key.type.starts_with("[");
  if (isTable) return "  " + headOf(key.name) + "\n";
  std::string takes = key.type;
  if (!key.unit.empty()) takes += " " + key.unit;
  if (!key.range.empty()) takes += ", " + key.range;
  if (key.required) {
    takes += "; must be there";
  } else if (!key.standard.empty()) {
    takes += "; else " + key.standard;
  }
  return fmt::format("  {:<24} {}\n  {:<24}   {}\n", key.name, meaningOf(table, key.name), "",
                     takes);
}

std::string asText(const Tables& tables) {
  std::string text;
  for (const auto& [table, keys] : tables) {
    text += (text.empty() ? "" : "\n") + headOf(table) + "\n";
    for (const scenes::GlossaryKey& key : keys) text += rowOf(table, key);
  }
  return text;
}

std::string asJson(const Tables& tables) {
  Json list = Json::array();
  for (const auto& [table, keys] : tables) {
    for (const scenes::GlossaryKey& key : keys) {
      list.push_back({{"table", table},
                      {"key", key.name},
                      {"type", key.type},
                      {"unit", key.unit},
                      {"default", key.standard},
                      {"range", key.range},
                      {"required", key.required},
                      {"meaning", meaningOf(table, key.name)}});
    }
  }
  return jsonText(list, 2) + "\n";
}

// The table and those in it.
Tables chosenTables(const Tables& all, const std::string& wanted) {
  Tables chosen;
  std::vector<std::string> known;
  for (const auto& [table, keys] : all) {
    if (table == wanted || table.starts_with(wanted + ".")) chosen[table] = keys;
    if (!table.empty() && table.find('.') == std::string::npos) known.push_back(table);
  }
  if (!chosen.empty()) return chosen;
  throw scenes::InputError(
      fmt::format("words: no table '{}'{}", wanted, scenes::nearestOrAll(wanted, known)));
}

ExitCode words(const WordsOptions& options) {
  Tables tables = scenes::shippedGlossary().tables;
  if (!options.table.empty()) tables = chosenTables(tables, options.table);
  say(options.json ? asJson(tables) : asText(tables));
  return ExitCode::kDone;
}

}  // namespace

void addWords(CLI::App& line, Action& action) {
  auto options = std::make_shared<WordsOptions>();
  CLI::App* command = line.add_subcommand(
      "words", "Every table and key of a scene file: what it takes, without it, what it means");
  command->add_option("TABLE", options->table, "One table and those in it, as body or shape [all]");
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options, &action] { action = [options] { return words(*options); }; });
}

}  // namespace app
