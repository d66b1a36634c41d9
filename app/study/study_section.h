// One case of a study as a part of a page.
#pragma once

#include <string>

#include "app/study/study_page.h"
#include "app/study/study_table.h"

namespace app {

std::string caseSection(const StudyChapter& chapter);

}  // namespace app
