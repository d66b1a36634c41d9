// The one error for what a user wrote: a scene, an argument, an asset.
#pragma once

#include <stdexcept>
#include <string>

namespace scenes {

// what() is complete: "bridge.toml:14:3: ball_socket: no body 'plonk'; did you mean 'plank'?".
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace scenes
