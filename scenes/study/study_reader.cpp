// [reference] and [[quantity]] of a study's case.
#include "scenes/study/study_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "scenes/measure/metrics.h"
#include "scenes/measure/sampler.h"
#include "scenes/read/settings_reader.h"
#include "scenes/study/study_files.h"
#include "scenes/study/study_quantity.h"

namespace scenes {
namespace {

using physics::Field;
using physics::Unit;

void expectColumn(const TableReader& reader, const char* key, const ReferenceTable& table,
                  const std::string& column) {
  if (table.column(column) >= 0) return;
  reader.failAt(key, fmt::format("the reference's table has no column '{}'{}", column,
                                 didYouMean(column, table.heads)));
}

void readWhere(TableReader& reader, const ReferenceTable& table, StudyReference& reference) {
  const Value* where = reader.take("where");
  if (where == nullptr) return;
  if (!where->isTable())
    failExpected(reader.spot({"where"}), *where, "a table { column = number }");
  for (const Member& member : where->members) {
    if (!member.value.isNumber()) {
      failExpected(reader.spot({"where"}), member.value, "a number");
    }
    if (table.column(member.key) < 0) {
      fail(reader.context(), member.place,
           fmt::format("reference.where: the table has no column '{}'{}", member.key,
                       didYouMean(member.key, table.heads)));
    }
    reference.where.emplace_back(member.key, member.value.number);
  }
}

std::string tablePath(const std::string& word, const std::string& from) {
  const std::filesystem::path near = std::filesystem::path(from).parent_path() / word;
  const bool isPath = word.find('/') != std::string::npos;
  return isPath ? near.lexically_normal().string()
                : (std::filesystem::path(referenceFolder()) / word).string();
}

void readTableReference(TableReader& reader, StudyCase& study) {
  StudyReference& reference = study.reference;
  std::string word;
  reader(Field{"table"}, word);
  reader(Field{"time"}, reference.time);
  reader(Field{"accuracy", Unit::kNone, false, 0}, reference.accuracy);
  reader(Field{"accuracy_column"}, reference.accuracyColumn);
  reader.atMostOne("accuracy", "accuracy_column");
  if (word.empty()) return;
  reference.table = tablePath(word, study.path);
  ReferenceTable table;
  try {
    reference.text = readStudyText(reference.table);
    table = parseReferenceTable(reference.text, reference.table);
  } catch (const InputError& error) {
    reader.failAt("table", error.what());
  }
  expectColumn(reader, "time", table, reference.time);
  if (!reference.accuracyColumn.empty()) {
    expectColumn(reader, "accuracy_column", table, reference.accuracyColumn);
  }
  readWhere(reader, table, reference);
}

void readSelf(TableReader& reader, StudyReference& reference) {
  reference.self = true;
  reference.run.iterations = {0};
  const auto one = [&](const char* key, std::vector<int>& values) {
    reader(Field{key, Unit::kNone, false, 1, 1e8}, values.front());
  };
  one("steps", reference.run.steps);
  one("substeps", reference.run.substeps);
  one("iterations", reference.run.iterations);
  reader(Field{"set"}, reference.run.set);
  if (reference.run.steps[0] % 2 != 0 && reference.run.substeps[0] % 2 != 0) {
    reader.failHere(
        "expected an even number of steps or substeps: a run with half as many "
        "estimates the error");
  }
}

// `column` of a number, `columns` of a vector; a leading '-' turns the sign.
void readColumns(TableReader& reader, const ReferenceTable& table, StudyQuantity& quantity) {
  std::string column;
  reader(Field{"column"}, column);
  reader(Field{"columns"}, quantity.columns);
  reader.atMostOne("column", "columns");
  const char* key = reader.has("column") ? "column" : "columns";
  if (reader.has("column")) quantity.columns = {column};
  if (quantity.columns.empty()) return;
  const int components = componentsOf(quantity);
  if (static_cast<int>(quantity.columns.size()) != components) {
    reader.failAt(key, fmt::format("expected {} columns for {}, got {}", components,
                                   quantity.metric, quantity.columns.size()));
  }
  if (table.rows.empty()) reader.failAt(key, "expected a `table` in [reference]");
  for (const std::string& word : quantity.columns) {
    expectColumn(reader, key, table, word.starts_with('-') ? word.substr(1) : word);
  }
}

void readMetricOrVector(TableReader& reader, StudyQuantity& quantity) {
  const Value* word = reader.take("metric");
  const bool isWord = word != nullptr && word->isString();
  if (isWord && findVectorMetric(word->text) != nullptr) {
    quantity.metric = word->text;
    reader(Field{"body", Unit::kNone, true}, quantity.body);
    return;
  }
  if (isWord && findMetric(word->text) == nullptr) {
    std::vector<std::string> known = metricNames();
    for (const std::string& vector : vectorMetricNames()) known.push_back(vector);
    reader.failAt("metric",
                  fmt::format("unknown metric '{}'{}", word->text, didYouMean(word->text, known)));
  }
  readMetric(reader, quantity.metric, quantity.body);
}

void readLaw(TableReader& reader, StudyQuantity& quantity) {
  double value = 0;
  reader(Field{"law"}, quantity.law);
  reader(Field{"value"}, value);
  reader.atMostOne("law", "value");
  if (reader.has("value")) quantity.law = {value};
  for (const char* other : {"column", "columns"}) {
    reader.atMostOne("law", other);
    reader.atMostOne("value", other);
  }
  if (!quantity.law.empty() && isOrientation(quantity)) {
    reader.failAt("metric",
                  "expected `columns` or a reference of its own: an orientation has no law");
  }
}

void readOver(TableReader& reader, StudyQuantity& quantity) {
  reader(Field{"times"}, quantity.times);
  reader(Field{"plus"}, quantity.plus);
  reader(Field{"weight", Unit::kNone, false, kPositive}, quantity.weight);
  reader(Field{"over"}, quantity.over);
  reader(Field{"from", Unit::kNone, false, 0}, quantity.from);
  reader(Field{"to", Unit::kNone, false, 0}, quantity.to);
  if (quantity.from.value_or(0) > quantity.to.value_or(1e300)) {
    reader.failAt("to", fmt::format("expected a time >= from = {:g} s", *quantity.from));
  }
}

}  // namespace

std::span<const char* const> names(StudyQuantity::Over) {
  static constexpr const char* kNames[] = {"each", "last", "max", "min", "mean", "rms"};
  return kNames;
}

void readReference(TableReader& root, StudyCase& study) {
  readTable(root, "reference", [&](TableReader& reader) {
    reader.exactlyOne("table", "self");
    readTableReference(reader, study);
    readTable(reader, "self", [&](TableReader& self) { readSelf(self, study.reference); });
  });
}

void readQuantities(TableReader& root, const Scene& scene, StudyCase& study) {
  ReferenceTable table;
  if (!study.reference.table.empty()) {
    table = parseReferenceTable(study.reference.text, study.reference.table);
  }
  const Simulation simulation(scene);
  readTables(root, "quantity", [&](TableReader& reader) {
    StudyQuantity quantity;
    readMetricOrVector(reader, quantity);
    readColumns(reader, table, quantity);
    readLaw(reader, quantity);
    readOver(reader, quantity);
    if (!quantity.body.empty() && matchingBodies(simulation, quantity.body).empty()) {
      reader.failAt("body", fmt::format("no body '{}' in {}", quantity.body, scene.path));
    }
    study.quantities.push_back(std::move(quantity));
  });
  if (study.quantities.empty()) root.failHere("expected at least one [[quantity]]");
  if (study.unit.empty()) study.unit = unitOf(study.quantities.front());
}

}  // namespace scenes
