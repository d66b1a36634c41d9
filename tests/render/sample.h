// A picture with one of everything, for the tests and for looking at.
#pragma once

#include "render/picture.h"

namespace render {

Picture samplePicture();           // pyramid, capsules, marked spheres, cylinders, strokes, labels
Picture pyramidPicture(int base);  // a pyramid of unit boxes and nothing else
Picture clothPicture(int nodes);  // a waving sheet of nodes x nodes over a ball, and a faceted skin
Picture ragdollPicture(int count);  // capsules lying about
Hud sampleHud(int frames);

}  // namespace render
