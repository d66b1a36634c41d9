// libFuzzer's entry: any bytes are a model (MJCF, URDF) that is run, or are refused at their place.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/try_scene.h"

// Sanitized and without optimisation, a step of the pyramid's 210 bodies takes more than
// libFuzzer's limit.
constexpr int kMostStepped = 60;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size), path = "fuzz.xml";
  const tests::Tried tried = tests::tryScene(text, path, kMostStepped);
  if (tried.code == app::ExitCode::kBadInput && !tests::hasPlace(tried.told, path)) {
    std::fprintf(stderr, "without a place: %s\n", tried.told.c_str());
    std::abort();
  }
  return 0;
}
