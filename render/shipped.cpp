// Looks for the font, which every place has.
#include "render/shipped.h"

namespace render {

namespace fs = std::filesystem;

namespace {

constexpr const char* kFont = "assets/fonts/DejaVuSans.ttf";

}  // namespace

fs::path shippedFolder() {
  std::error_code error;
  const fs::path beside = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const fs::path& near : {beside, beside / "../share/dbd", fs::path(DBD_SOURCE_FOLDER)}) {
    if (!near.empty() && fs::exists(near / kFont, error)) return near;
  }
  return DBD_DATA_FOLDER;
}

std::string shippedFont() { return (shippedFolder() / kFont).string(); }

}  // namespace render
