// What most files here include, compiled once. Nothing includes this: every file includes what it uses.
#pragma once

#include "physics/state/world_state.h"
#include "physics/world.h"
