// figureNN.json beside a figure: what made it, what it measured, and what it took.
#pragma once

#include <filesystem>

#include "app/run/run_record.h"
#include "scenes/figure/figure_data.h"

namespace app {

struct FigureRecord {
  std::string name, title, claim;
  int number = 0;
  std::string asked;  // the word or path that names it: what remakes it
  Json inputs;        // of the program, the sheet, its scenes, the picture; equal: unchanged
  Json measures = Json::array();
  Json seconds = Json::object();
  Json files = Json::array();  // beside the record, the picture first
  std::string problem;         // where the simulation failed; else empty

  bool holds() const;
};

FigureRecord makeFigureRecord(const scenes::FigureSheet& sheet, const std::string& asked,
                              render::Quality quality, int width);
void addVerdict(const scenes::FigureVerdict& verdict, FigureRecord& record);

// Absent, unreadable, or without one of its files: nullopt.
std::optional<FigureRecord> readFigureRecord(const std::filesystem::path& file);
void writeFigureRecord(const FigureRecord& record, const std::filesystem::path& folder);

// Whether there is a figure in DIR, or DIR/scenes.
bool holdsParts(const std::filesystem::path& folder);
// DIR/index.html of all that is there: films of DIR/scenes, figures, studies. Returns its path.
std::filesystem::path writeFigurePage(const std::filesystem::path& folder);

}  // namespace app
