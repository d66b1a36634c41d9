// The GLSL sources, without their #version line.
#pragma once

namespace render {

extern const char* const kBodyVertex;       // instances; with CASTER: into the shadow map
extern const char* const kFacingVertex;     // round instances; with CASTER: into the shadow map
extern const char* const kBodyFragment;     // lit, premultiplied, sRGB; SURFACE, FACING: of those
extern const char* const kSurfaceVertex;    // surfaces; with CASTER: into the shadow map
extern const char* const kCasterFragment;   // depth only
extern const char* const kFloorVertex;      // the ground, as far as it is seen
extern const char* const kFloorFragment;    // grid, shadow, fading into the background
extern const char* const kViewportVertex;   // one triangle over the viewport
extern const char* const kMaskFragment;     // shadow map -> how much of the ground is in shadow
extern const char* const kSharpFragment;    // a small blur of that
extern const char* const kWideFragment;     // a quarter of its size
extern const char* const kBlurFragment;     // one direction of a Gaussian
extern const char* const kResolveFragment;  // multisampled bodies over what is there
extern const char* const kStrokeVertex;     // lines, arrow heads, dots
extern const char* const kStrokeFragment;
extern const char* const kCanvasVertex;  // text and plots
extern const char* const kCanvasFragment;

}  // namespace render
