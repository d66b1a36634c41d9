// A page of want / got / difference for images that were compared.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "render/compare.h"
#include "render/flip.h"

namespace app {

struct ImagePair {
  std::string name;         // "pyramid 00030"
  render::Image want, got;  // empty: there is none
  render::Comparison comparison;
  bool passed = false;
  std::string remark;                // which layer moved
  std::optional<render::Flip> flip;  // for information, where the images differ
};

bool exists(const render::Image& image);

// Compares; a missing side never passes.
ImagePair comparePair(std::string name, render::Image want, render::Image got);

// "412 pixels ...; FLIP mean 0.0012, 95 % below 0.004": what was found.
std::string findings(const ImagePair& pair);

// One line: "FAIL  pyramid 00030  412 pixels ...".
std::string describePair(const ImagePair& pair);

// FOLDER/index.html and the images of the pairs that failed. Returns the page's path.
std::filesystem::path writeImageReport(const std::string& title,
                                       const std::vector<ImagePair>& pairs,
                                       const std::filesystem::path& folder);

}  // namespace app
