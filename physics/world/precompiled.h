// What most files here include, compiled once. Every file includes what it uses, and none this one.
#pragma once

#include "physics/state/world_state.h"
#include "physics/world.h"
