// The parts of a study's case that compare: [reference] and [[quantity]].
#pragma once

#include "scenes/read/reference_table.h"
#include "scenes/read/table_reader.h"
#include "scenes/study/study_case.h"

namespace scenes {

void readReference(TableReader& root, StudyCase& study);

// After the reference, whose columns they name; `scene` has the bodies.
void readQuantities(TableReader& root, const Scene& scene, StudyCase& study);

}  // namespace scenes
