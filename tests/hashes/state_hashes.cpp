// Prints the state hash of every scene of the library after its first frames: one line per scene,
// the same from every compiler. state_hashes [FRAMES]
#include <cstdlib>
#include <iostream>

#include "scenes/simulation.h"

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::atoi(argv[1]) : 30;
  for (const std::string& name : scenes::libraryScenes()) {
    scenes::Simulation simulation(scenes::readScene(name));
    for (int k = 0; k < frames; ++k) simulation.advance();
    std::cout << name << ' ' << std::hex << simulation.stateHash() << std::dec << std::endl;
  }
}
