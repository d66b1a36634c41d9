// What local substeps keep. How they step: groups.h.
#pragma once

#include <array>
#include <tuple>
#include <vector>

#include "physics/constraints/contact.h"
#include "physics/constraints/kinds.h"
#include "physics/constraints/soft_contact.h"
#include "physics/model/islands.h"
#include "physics/sweep/joint_system.h"

namespace physics {

struct Group {
  int substeps = 1;
  std::vector<BodyId> bodies, anisotropic;
  int turning = 0;
  std::array<std::vector<int>, std::tuple_size_v<Kinds>> items;
  std::vector<ContactPair> contacts;
  std::vector<SoftContact> softContacts;
  JointSystem joints;  // as it is laid out for these
};

struct Local {
  std::vector<int> asked;     // by body: at least
  std::vector<int> wanted;    // by body: for the next step
  std::vector<int> substeps;  // by body: of this step, its island's
  std::vector<int> last;      // by body: of the step before
  std::vector<int> calm;      // by body: steps in a row that fewer would have done
  bool full = true;           // all islands take all: they step together, and ask now and then
  Islands islands;            // of this step
  std::vector<Group> groups;  // of this step, by increasing number; kept while nothing changes
  std::vector<std::array<BodyId, 2>> joins;  // of islands that met within this step
  std::vector<Pose> start, end;              // scratch: of all, for a look from within a group
};

}  // namespace physics
