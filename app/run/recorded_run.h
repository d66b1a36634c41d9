// A run made again from its run.json, wherever the scene's file is by now.
#pragma once

#include <string>

#include "app/run/run_record.h"

namespace app {

bool namesRecord(const std::string& scene);  // rather than a scene: a path that ends in .json

// Throw InputError.
RunRecord openRecord(const std::string& file);
scenes::Scene recordedScene(const RunRecord& record, const std::vector<std::string>& overrides);

}  // namespace app
