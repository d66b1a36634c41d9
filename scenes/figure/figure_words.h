// The words of a figure's sheet that make no picture: [[plot]] and [[measure]].
#pragma once

#include "scenes/figure/figure_sheet.h"
#include "scenes/read/table_reader.h"

namespace scenes {

void readPlot(TableReader& reader, FigureSheet& sheet);
void readMeasure(TableReader& reader, FigureSheet& sheet);

// The index of the run that a panel or a run of that name shows.
int readRunName(TableReader& reader, const char* key, const FigureSheet& sheet);

std::array<double, 2> readPair(const Value& value, const Spot& spot);

// The tables [[word]]; none where absent.
std::span<const Value> itemsOf(const TableReader& reader, const char* word);

}  // namespace scenes
