// From the text of a figure's sheet to its checked parts: runs and panels here, plots and measures
// in figure_words.cpp.
#include "scenes/figure/figure_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "scenes/figure/figure_words.h"
#include "scenes/read/settings_reader.h"

namespace scenes {
namespace {

namespace fs = std::filesystem;
using physics::Field;
using physics::Unit;

// Paths are relative to the sheet; a bare name is one of the library.
std::string scenePath(const std::string& word, const std::string& sheet) {
  const bool isPath = word.find('/') != std::string::npos || word.ends_with(".toml");
  return isPath ? (fs::path(sheet).parent_path() / word).string() : word;
}

// The same scene with the same settings is one run, whoever asks for it.
int addRun(TableReader& reader, const std::string& name, FigureSheet& sheet) {
  std::string scene;
  std::vector<std::string> set;
  reader(Field{"scene", Unit::kNone, true}, scene);
  reader(Field{"set"}, set);
  FigureRun run{name, {}};
  try {
    run.scene = readScene(scenePath(scene, sheet.path), set);
  } catch (const InputError& error) {
    reader.failAt("scene", error.what());
  }
  for (size_t i = 0; i < sheet.runs.size(); ++i) {
    const Scene& other = sheet.runs[i].scene;
    const bool same = other.path == run.scene.path && other.overrides == run.scene.overrides;
    if (same && (name.empty() || sheet.runs[i].name.empty())) return static_cast<int>(i);
  }
  sheet.runs.push_back(std::move(run));
  return static_cast<int>(sheet.runs.size()) - 1;
}

void readRun(TableReader& reader, FigureSheet& sheet) {
  std::string name;
  reader(Field{"name", Unit::kNone, true}, name);
  for (const FigureRun& run : sheet.runs) {
    if (run.name == name) reader.failAt("name", fmt::format("'{}' is a run already", name));
  }
  addRun(reader, name, sheet);
}

int readRunOfPanel(TableReader& reader, FigureSheet& sheet) {
  reader.exactlyOne("scene", "run");
  if (!reader.has("run")) return addRun(reader, "", sheet);
  reader.atMostOne("run", "set");
  return readRunName(reader, "run", sheet);
}

void checkFrames(TableReader& reader, const char* key, const Scene& scene,
                 const FigurePanel& panel) {
  if (panel.frames.empty()) reader.failAt(key, "expected at least one");
  for (size_t i = 0; i < panel.frames.size(); ++i) {
    if (panel.frames[i] >= scene.frameCount()) {
      reader.failAt(key, fmt::format("expected frames below {} ({:g} s), got {}",
                                     scene.frameCount(), scene.duration, panel.frames[i]));
    }
    if (i > 0 && panel.frames[i] <= panel.frames[i - 1]) {
      reader.failAt(key, "expected them in increasing order");
    }
  }
}

// `frames`, or `times` in seconds, or else the last frame.
void readFrames(TableReader& reader, const Scene& scene, FigurePanel& panel) {
  std::vector<double> times;
  reader(Field{"frames", Unit::kNone, false, 0}, panel.frames);
  reader(Field{"times", Unit::kNone, false, 0}, times);
  reader.atMostOne("frames", "times");
  for (const double time : times) {
    panel.frames.push_back(static_cast<int>(std::lround(time * scene.fps)));
  }
  const char* key = reader.has("times") ? "times" : "frames";
  if (!reader.has(key)) panel.frames = {scene.frameCount() - 1};
  checkFrames(reader, key, scene, panel);
}

void readNote(TableReader& reader, FigurePanel& panel) {
  FigureNote note;
  reader(Field{"text", Unit::kNone, true}, note.text);
  reader(Field{"at", Unit::kPoint}, note.at);
  reader(Field{"body"}, note.body);
  if (const Value* offset = reader.take("offset")) {
    note.offset = readPair(*offset, reader.spot({"offset"}));
  }
  panel.notes.push_back(note);
}

FigurePanel readPanel(TableReader& reader, FigureSheet& sheet) {
  FigurePanel panel;
  reader(Field{"name"}, panel.name);
  reader(Field{"label"}, panel.label);
  panel.run = readRunOfPanel(reader, sheet);
  const Scene& scene = sheet.runs[static_cast<size_t>(panel.run)].scene;
  readFrames(reader, scene, panel);
  if (reader.has("ghost")) panel.ghost = readRunName(reader, "ghost", sheet);
  const auto readOwnCamera = [&](const char* key, std::optional<CameraDef>& own) {
    readTable(reader, key, [&](TableReader& camera) { readCamera(camera, own.emplace()); });
  };
  readOwnCamera("camera", panel.camera);
  readOwnCamera("film_camera", panel.filmCamera);
  panel.overlays = scene.overlays;
  readTable(reader, "overlays",
            [&](TableReader& overlays) { readOverlays(overlays, panel.overlays); });
  reader(Field{"opacity", Unit::kNone, false, kPositive, 1}, panel.opacity);
  reader(Field{"ground"}, panel.ground);
  reader(Field{"stamp"}, panel.stamp);
  reader(Field{"span", Unit::kNone, false, 1, 12}, panel.span);
  reader(Field{"aspect", Unit::kNone, false, 0.2, 8}, panel.aspect);
  readTables(reader, "note", [&](TableReader& note) { readNote(note, panel); });
  return panel;
}

void addPanelTiles(const FigureSheet& sheet, int index, std::vector<FigureTile>& tiles) {
  const FigurePanel& panel = sheet.panels[static_cast<size_t>(index)];
  if (sheet.layout == FigureSheet::Layout::kOnionSkin) {
    tiles.push_back({false, index, panel.frames, panel.span, panel.aspect, true});
    return;
  }
  for (const int frame : panel.frames) {
    tiles.push_back(
        {false, index, {frame}, panel.span, panel.aspect, frame == panel.frames.front()});
  }
}

// Panels and plots interleave as they stand in the file, and get letters in that order.
void readTiles(TableReader& root, FigureSheet& sheet) {
  std::vector<std::pair<int, FigureTile>> placed;  // by line
  readTables(root, "panel", [&](TableReader& reader) {
    const int index = static_cast<int>(sheet.panels.size());
    sheet.panels.push_back(readPanel(reader, sheet));
    placed.push_back({reader.table().place.line, {false, index, {}, 1, {}, true}});
  });
  for (const Value& item : itemsOf(root, "plot")) {
    const int index = static_cast<int>(placed.size() - sheet.panels.size());
    placed.push_back({item.place.line, {true, index, {}, 1, {}, true}});
  }
  std::stable_sort(placed.begin(), placed.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  char letter = 'a';
  for (const auto& [line, tile] : placed) {
    if (!tile.isPlot) {
      FigurePanel& panel = sheet.panels[static_cast<size_t>(tile.index)];
      if (panel.name.empty()) panel.name = std::string(1, letter);
      addPanelTiles(sheet, tile.index, sheet.tiles);
    } else {
      sheet.tiles.push_back(tile);
    }
    ++letter;
  }
  if (sheet.tiles.empty()) root.failHere("expected at least one [[panel]] or [[plot]]");
}

void readHead(TableReader& root, FigureSheet& sheet) {
  root(Field{"number", Unit::kNone, false, 1, 99}, sheet.number);
  root(Field{"title", Unit::kNone, true}, sheet.title);
  root(Field{"claim", Unit::kNone, true}, sheet.claim);
  root(Field{"layout"}, sheet.layout);
  root(Field{"columns", Unit::kNone, false, 1, 12}, sheet.columns);
  root(Field{"width", Unit::kNone, false, 200, 8000}, sheet.width);
  root(Field{"aspect", Unit::kNone, false, 0.2, 5}, sheet.aspect);
  root(Field{"video"}, sheet.video);
  sheet.name = sheet.number > 0 ? fmt::format("figure{:02}", sheet.number)
                                : fs::path(sheet.path).stem().string();
}

void checkSpans(const TableReader& root, const FigureSheet& sheet) {
  for (const FigureTile& tile : sheet.tiles) {
    if (tile.span <= sheet.columnCount()) continue;
    root.failHere(fmt::format("columns: expected at least {}, the span of a panel", tile.span));
  }
}

}  // namespace

std::span<const char* const> names(FigureSheet::Layout) {
  static constexpr const char* kNames[] = {"strip", "grid", "side_by_side", "onion_skin"};
  return kNames;
}

std::span<const char* const> names(FigurePanel::Stamp) {
  static constexpr const char* kNames[] = {"auto", "none", "time", "iteration"};
  return kNames;
}

int FigureSheet::columnCount() const {
  if (columns > 0) return columns;
  int cells = 0;
  for (const FigureTile& tile : tiles) cells += tile.span;
  if (layout != Layout::kGrid) return cells;
  return static_cast<int>(std::ceil(std::sqrt(static_cast<double>(cells))));
}

FigureSheet parseFigureSheet(const std::string& text, const std::string& path) {
  const Value tree = parseToml(text, path);
  FigureSheet sheet;
  sheet.path = path;
  sheet.text = text;
  const Context context{path, nullptr};
  TableReader root(tree, "", context);
  for (const char* word : {"number", "title", "claim", "layout", "columns", "width", "aspect",
                           "video", "run", "panel", "plot", "measure"}) {
    root.take(word);
  }
  root.finish();
  readHead(root, sheet);
  readTables(root, "run", [&](TableReader& reader) { readRun(reader, sheet); });
  readTiles(root, sheet);
  readTables(root, "plot", [&](TableReader& reader) { readPlot(reader, sheet); });
  for (FigureTile& tile : sheet.tiles) {
    if (!tile.isPlot) continue;
    tile.span = sheet.plots[static_cast<size_t>(tile.index)].span;
    tile.aspect = sheet.plots[static_cast<size_t>(tile.index)].aspect;
  }
  checkSpans(root, sheet);
  readTables(root, "measure", [&](TableReader& reader) { readMeasure(reader, sheet); });
  return sheet;
}

}  // namespace scenes
