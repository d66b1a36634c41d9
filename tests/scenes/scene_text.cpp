// Reading scenes from strings.
#include "tests/scenes/scene_text.h"

namespace scenes {

Scene sceneOf(const std::string& text, const std::vector<std::string>& overrides) {
  return parseScene(text, "test.toml", overrides);
}

std::string errorOf(const std::string& text, const std::vector<std::string>& overrides) {
  try {
    sceneOf(text, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string ball(const std::string& name) {
  return "[[body]]\nname = \"" + name + "\"\nshape = { sphere = { radius = 1 } }\n";
}

}  // namespace scenes
