// What [stability], [severity] and [[variant]] of a case say, before anything is made of it.
#pragma once

#include "scenes/read/table_reader.h"
#include "scenes/study/stability_case.h"

namespace scenes {

struct StabilityTables {
  std::string family, about;
  Place familyPlace, methodsPlace;
  std::vector<std::string> methods;  // empty: the family's
  std::vector<std::string> aboutSettings;
  bool quick = false;
  std::optional<StabilitySeverity> severity;  // `stated` is not known yet
  Place severityPlace;                        // of `set`
  std::vector<StabilityVariant> variants;
};
StabilityTables readStabilityTables(const Value& tree, const Context& context);

StabilityFamily findFamily(const std::vector<StabilityFamily>& families,
                           const StabilityTables& tables, const Context& context);

// The family's settings where the case says nothing. Throws where it says what is the family's.
void applyFamily(Value& tree, const StabilityFamily& family, const StabilityTables& tables,
                 const Context& context);

}  // namespace scenes
