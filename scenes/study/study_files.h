// Where studies find their files: cases, methods, and the references' tables.
#pragma once

#include <string>
#include <vector>

namespace scenes {

std::string studyFolder();      // scenes/studies
std::string referenceFolder();  // tests/reference

// The whole file. Throws InputError where it cannot be read.
std::string readStudyText(const std::string& path);

// *.toml of a folder in scenes/studies, sorted. Throws InputError where there is none.
std::vector<std::string> studyFiles(const std::string& folder);

// The path of `study`, which is a name in that folder of scenes/studies or a path itself.
std::string studyPath(const std::string& study, const std::string& folder);

// A path that a file at `from` names: relative to it where it has a '/' or ends in .toml, else a
// bare name.
std::string besideStudy(const std::string& word, const std::string& from);

}  // namespace scenes
