// Links of a model as [[body]], and what joins them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenes/models/mass.h"
#include "scenes/models/model_survey.h"
#include "scenes/models/words.h"

namespace scenes {

// A link, or a ring between two joints of one, as a body.
struct WrittenBody {
  std::string name;     // "world" where it does not move
  physics::Pose frame;  // world, of what its points are given in
};

struct Written {
  const Model& model;
  ModelSurvey& survey;
  Value root;
  std::vector<physics::Pose> pose;              // world, Z up, by link
  std::vector<int> carrier;                     // the link that a link moves with, by link
  std::vector<ModelLink> whole;                 // by link: a carrier with all that it carries
  std::vector<WrittenBody> bodies;              // by link: its carrier's
  std::vector<std::vector<std::string>> names;  // of bodies that have the link's shapes
  std::map<std::string, int> used;              // names of bodies
};

// Models have Z up, our words Y.
physics::Vec3 yUp(const physics::Vec3& v);
physics::Pose yUp(const physics::Pose& pose);

void findCarriers(Written& written);
void writeBodies(Written& written);
void writeJoints(Written& written);
void writePairs(Written& written);

// The share of a link's mass that each ring between its joints has.
inline constexpr double kRingShare = 0.01;

}  // namespace scenes
