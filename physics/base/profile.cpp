// Tells who measures which scope a step is in.
#include "physics/base/profile.h"

#include <utility>

namespace physics {
namespace {

thread_local const Listening::Listener* listening = nullptr;

}  // namespace

Listening::Listening(Listener listener)
    : listener_(std::move(listener)), before_(std::exchange(listening, &listener_)) {}
Listening::~Listening() { listening = before_; }

void profileScope(const char* work) {
  if (listening != nullptr) (*listening)(work);
}

}  // namespace physics
