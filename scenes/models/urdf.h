// URDF, http://wiki.ros.org/urdf/XML: a robot of links and joints.
#pragma once

#include "scenes/models/model.h"
#include "scenes/models/model_survey.h"

namespace scenes {

Model readUrdf(const XmlElement& root, const std::string& path, ModelSurvey& survey);

}  // namespace scenes
