// MJCF: a whole file, in the order in which its sections need each other.
#include "scenes/models/mjcf.h"

#include <fmt/format.h>

#include <filesystem>

#include "scenes/read/file_text.h"

namespace scenes {
namespace {

namespace fs = std::filesystem;

constexpr int kMostFiles = 100;

std::string textOf(const fs::path& path, const Tag& tag) {
  const std::optional<std::string> text = fileText(path.string());
  if (!text) tag.fail(fmt::format("no file '{}' that can be read", path.string()));
  return *text;
}

XmlElement rootOf(const fs::path& path, const Tag& tag, const char* expected) {
  XmlElement root = parseXml(textOf(path, tag), path.string(), path.string());
  if (root.tag != expected && root.tag != "mujocoinclude") {
    scenes::fail(tag.survey().context(), root.place,
                 fmt::format("expected <{}>, got <{}>", expected, root.tag));
  }
  return root;
}

struct Includer {
  const std::string& folder;
  ModelSurvey& survey;
  std::vector<std::string> open;
  int count = 0;

  void run(XmlElement& element) {
    std::vector<XmlElement> children;
    for (XmlElement& child : element.children) {
      if (child.tag != "include") {
        run(child);
        children.push_back(std::move(child));
        continue;
      }
      const Tag tag(child, survey);
      const fs::path path = (fs::path(folder) / tag.required("file")).lexically_normal();
      if (std::find(open.begin(), open.end(), path.string()) != open.end()) {
        tag.fail(fmt::format("{} includes itself", path.string()));
      }
      if (++count > kMostFiles) tag.fail(fmt::format("more than {} files", kMostFiles));
      XmlElement root = rootOf(path, tag, "mujoco");
      open.push_back(path.string());
      run(root);
      open.pop_back();
      for (XmlElement& inner : root.children) children.push_back(std::move(inner));
    }
    element.children = std::move(children);
  }
};

void readAttachable(Mjcf& mjcf, int depth) {
  for (const XmlElement* assets : childrenOf(*mjcf.root, "asset", mjcf.survey)) {
    for (const XmlElement* element : childrenOf(*assets, "model", mjcf.survey)) {
      const Tag tag(*element, mjcf.survey);
      const fs::path path = fs::path(mjcf.folder) / tag.required("file");
      if (depth > 10) tag.fail("models attach models more than ten deep");
      XmlElement root = rootOf(path, tag, "mujoco");
      const XmlAttribute* own = root.find("model");
      const std::string name = tag.name(own == nullptr ? path.stem().string() : own->text);
      mjcf.survey.asked("mujoco", "model");
      mjcf.attachable[name] = openMjcf(std::move(root), path.parent_path().string(), mjcf.survey,
                                       mjcf.model, depth + 1);
    }
  }
}

void scaleMasses(Model& model, double total) {
  double own = 0;
  for (const ModelLink& link : model.links) own += inertialOf(link).mass;
  if (!(own > 0)) return;
  const double share = total / own;
  for (ModelLink& link : model.links) {
    for (ModelPart& part : link.parts) part.mass = share * inertialOf(part).mass;
    if (!link.inertial) continue;
    link.inertial->mass *= share;
    link.inertial->inertia *= share;
  }
}

}  // namespace

void includeXml(XmlElement& root, const std::string& folder, ModelSurvey& survey) {
  Includer{folder, survey, {fs::path(survey.context().path).lexically_normal().string()}}.run(root);
}

std::shared_ptr<Mjcf> openMjcf(XmlElement root, const std::string& folder, ModelSurvey& survey,
                               Model& model, int depth) {
  includeXml(root, folder, survey);
  auto mjcf = std::make_shared<Mjcf>(Mjcf{survey, model, folder});
  mjcf->root = std::make_shared<XmlElement>(std::move(root));
  survey.keep(mjcf->root);
  readCompiler(*mjcf);
  readDefaults(*mjcf);
  readAssets(*mjcf);
  readAttachable(*mjcf, depth);
  return mjcf;
}

Model readMjcf(XmlElement root, const std::string& path, ModelSurvey& survey,
               const std::string& keyframe) {
  Model model;
  model.place = root.place;
  survey.asked(root.tag, "model");
  const XmlAttribute* title = root.find("model");
  model.title = title == nullptr ? "" : title->text;
  const auto mjcf =
      openMjcf(std::move(root), fs::path(path).parent_path().string(), survey, model, 0);
  readOptions(*mjcf);
  readBodies(*mjcf);
  if (mjcf->compiler.totalMass) scaleMasses(model, *mjcf->compiler.totalMass);
  readActuators(*mjcf);
  readPairs(*mjcf);
  readTendons(*mjcf);
  readKeyframes(*mjcf, keyframe);
  return model;
}

}  // namespace scenes
