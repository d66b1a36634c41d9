// The OpenGL 3.3 core calls that libOSMesa exports, and the few helpers the passes share.
// Objects are freed with their context; only what comes and goes between frames is deleted by hand.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <string>
#include <vector>

#include "render/bounds.h"

namespace render {

// Compiles and links; `defines` goes in front of both sources. Throws std::runtime_error with the
// driver's log. The blocks and samplers that all shaders share are bound to their fixed places.
GLuint makeProgram(const char* vertex, const char* fragment, const std::string& defines = "");

GLuint makeBuffer();
GLuint makeVertexArray();
template <typename T>
void fillBuffer(GLenum target, GLuint buffer, const std::vector<T>& data, GLenum usage) {
  glBindBuffer(target, buffer);
  glBufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), usage);
}
// Attribute `index` of the array that is bound: `size` floats, from the buffer that is bound.
void setAttribute(GLuint index, int size, std::size_t stride, std::size_t offset);

// The block that all shaders share, from now on.
template <typename T>
void fillUniforms(GLuint buffer, const T& block) {
  glBindBuffer(GL_UNIFORM_BUFFER, buffer);
  glBufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_STREAM_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, buffer);
}

// sRGB to linear, alpha as it is.
Color linearColor(const Color& color);

// A texture of one level, clamped to its edge. `filter` is GL_NEAREST or GL_LINEAR.
GLuint makeTexture(GLenum internalFormat, int width, int height, GLenum filter);
GLuint makeMultisampleTexture(GLenum internalFormat, int samples, int width, int height);
GLuint makeRenderbuffer(GLenum internalFormat, int samples, int width, int height);

// Throws std::runtime_error when the framebuffer that is bound cannot be drawn to.
void requireCompleteFramebuffer(const char* name);
// A framebuffer with one colour texture and nothing else.
GLuint makeFramebuffer(GLuint colorTexture, const char* name);

// Cuts all that follows, clears too, to these pixels and `margin` more.
void cutTo(const Bounds& bounds, int width, int height, int margin);
void uncut();

// Draws one triangle over the whole viewport; the vertex shader makes its corners from gl_VertexID.
void drawWholeViewport();

// Texture units, the same in every program.
enum TextureUnit {
  kShadowUnit = 0,
  kSharpUnit = 1,
  kWideUnit = 2,
  kSourceUnit = 3,
  kLightsUnit = 4
};
void bindTexture(TextureUnit unit, GLenum target, GLuint texture);

}  // namespace render
