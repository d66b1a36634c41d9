// MJCF and URDF: files of other programs, as the words of scene files.
#include "scenes/models/read_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "scenes/models/mjcf.h"
#include "scenes/models/urdf.h"
#include "scenes/models/write_bodies.h"

namespace scenes {
namespace {

using physics::Vec3;

Value wordsOf(const Model& model, ModelSurvey& survey) {
  const Words words{model.place};
  Written written{model, survey, words.table(), {}, {}, {}, {}, {}, {}};
  if (!model.title.empty()) words.set(written.root, "title", words.text(model.title));
  Value gravity = words.table();
  const Vec3& g = model.gravity;
  words.set(gravity, "acceleration", words.vector({g.x(), g.z(), -g.y()}));  // Y up
  words.set(written.root, "gravity", std::move(gravity));
  words.set(written.root, "contact", words.table());
  findCarriers(written);
  writeBodies(written);
  writeJoints(written);
  writePairs(written);
  return std::move(written.root);
}

}  // namespace

bool isModelFile(const std::string& path) {
  return path.ends_with(".xml") || path.ends_with(".mjcf") || path.ends_with(".urdf");
}

bool isModel(const std::string& text, const std::string& path) {
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  return isModelFile(path) && first != std::string::npos && text[first] == '<';
}

Value readModel(const std::string& text, const std::string& path, std::vector<std::string>& told,
                const std::string& keyframe) {
  const Context context{path, nullptr, nullptr};
  ModelSurvey survey(context);
  XmlElement root = parseXml(text, path);
  Value words;
  if (root.tag == "mujoco") {
    words = wordsOf(readMjcf(std::move(root), path, survey, keyframe), survey);
  } else if (root.tag == "robot") {
    auto kept = std::make_shared<XmlElement>(std::move(root));
    survey.keep(kept);
    words = wordsOf(readUrdf(*kept, path, survey), survey);
  } else {
    fail(context, root.place,
         fmt::format("expected <mujoco> (MJCF) or <robot> (URDF), got <{}>", root.tag));
  }
  survey.compare();
  told = survey.told();
  return words;
}

}  // namespace scenes
