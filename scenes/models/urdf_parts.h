// URDF: shapes, their meshes, colours and places.
#pragma once

#include <map>

#include "scenes/models/model.h"
#include "scenes/models/tag.h"

namespace scenes {

const XmlElement* childOf(const XmlElement& element, const char* tag, ModelSurvey& survey);
physics::Pose originOf(const XmlElement& element, ModelSurvey& survey);  // its <origin>

struct UrdfParts {
  std::string folder;  // of the file
  ModelSurvey& survey;
  std::map<std::string, std::vector<double>> colors{};  // of materials, by name

  void readMaterial(const XmlElement& element);
  // A <collision> or <visual>; none where its kind is not read.
  std::optional<ModelPart> read(const XmlElement& element);
  std::optional<physics::Vec3> colorOf(const XmlElement& visual);

 private:
  bool readGeometry(const XmlElement& element, ModelPart& part);
  bool readMesh(const Tag& tag, ModelPart& part);
  std::string findFile(const Tag& tag) const;
};

}  // namespace scenes
