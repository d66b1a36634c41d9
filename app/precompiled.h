// What most files here include, compiled once. Every file includes what it uses, and none this one.
#pragma once

#include <fmt/format.h>

#include "app/base/json.h"
#include "app/run/play.h"
#include "render/renderer.h"
#include "scenes/simulation.h"
#include "scenes/view/view.h"
