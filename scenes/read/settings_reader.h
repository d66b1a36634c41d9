// The tables of a scene file that make no bodies.
#pragma once

#include "scenes/read/table_reader.h"
#include "scenes/scene.h"

namespace scenes {

// [simulation] [gravity] [contact] [sleep] -> scene.settings, fps and seed. Contacts are on where
// there is a [contact] table, a plane or a body with friction of its own, unless `[contact] enabled
// = false`.
void readSettings(TableReader& root, Scene& scene);

const char* wordOf(physics::Method method);  // as [simulation] has it
const char* wordOf(physics::Stepping stepping);
// `method = "xpbd"`; of the default by another stepping than its own, that.
std::string solverText(const physics::Settings& settings);
std::string substepsText(const physics::Settings& settings);  // as a reader is told them

// [film]: how long a step of the simulation is.
void readFilm(TableReader& root, Scene& scene);

// [camera] [light] [overlays] [[label]] [golden] [[expect]] and the background.
void readPresentation(TableReader& root, Scene& scene);
void readLooks(TableReader& root, Scene& scene);  // of these, light, background and labels
void readValue(const Value& value, const Spot& spot, Patterns& out);

// [camera], and the same words in a figure's panel.
void readCamera(TableReader& reader, CameraDef& camera);
void readOverlays(TableReader& reader, Overlays& overlays);

// The keys `metric` and `body`, which must fit each other; `metricKey` and `bodyKey` are their
// names.
void readMetric(TableReader& reader, std::string& metric, std::string& body,
                const char* metricKey = "metric", const char* bodyKey = "body");

// A table by its word: calls read(reader) and checks that every key was known. Nothing where
// absent.
template <class Read>
void readTable(TableReader& parent, const char* word, Read read) {
  const Value* value = parent.take(word);
  if (value == nullptr) return;
  if (!value->isTable())
    failExpected(parent.spot({word}), *value, std::string("a table [") + word + "]");
  TableReader reader(*value, word, parent.context());
  read(reader);
  reader.finish();
}

// An array of tables by its word: the same for each element.
template <class Read>
void readTables(TableReader& parent, const char* word, Read read) {
  const Value* value = parent.take(word);
  if (value == nullptr) return;
  if (!value->isArray()) {
    failExpected(parent.spot({word}), *value, std::string("tables [[") + word + "]]");
  }
  for (const Value& item : value->items) {
    if (!item.isTable()) failExpected(parent.spot({word}), item, "a table");
    TableReader reader(item, word, parent.context());
    read(reader);
    reader.finish();
  }
}

}  // namespace scenes
