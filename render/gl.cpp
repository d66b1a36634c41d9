// Programs, textures and framebuffers, each made in one call.
#include "render/gl.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace render {
namespace {

GLuint compile(GLenum stage, const std::string& defines, const char* source) {
  const GLuint shader = glCreateShader(stage);
  const std::string text = "#version 330 core\n" + defines + source;
  const char* const pointer = text.c_str();
  glShaderSource(shader, 1, &pointer, nullptr);
  glCompileShader(shader);
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled != GL_TRUE) {
    std::vector<char> log(4096);
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::runtime_error(std::string("shader does not compile: ") + log.data());
  }
  return shader;
}

void bindSharedNames(GLuint program) {
  const GLuint block = glGetUniformBlockIndex(program, "Frame");
  if (block != GL_INVALID_INDEX) glUniformBlockBinding(program, block, 0);
  glUseProgram(program);
  const auto setSampler = [program](const char* name, TextureUnit unit) {
    const GLint location = glGetUniformLocation(program, name);
    if (location >= 0) glUniform1i(location, unit);
  };
  setSampler("shadowMap", kShadowUnit);
  setSampler("sharpMask", kSharpUnit);
  setSampler("wideMask", kWideUnit);
  setSampler("source", kSourceUnit);
  setSampler("lights", kLightsUnit);
}

void setFilter(GLenum filter) {
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(filter));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(filter));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
}

// By a polynomial: no libm, whose last bit depends on the CPU. Error below 1e-3.
float linear(float c) { return c * (c * (c * 0.305306011f + 0.682171111f) + 0.012522878f); }

}  // namespace

GLuint makeProgram(const char* vertex, const char* fragment, const std::string& defines) {
  const GLuint program = glCreateProgram();
  const GLuint vertexShader = compile(GL_VERTEX_SHADER, defines, vertex);
  const GLuint fragmentShader = compile(GL_FRAGMENT_SHADER, defines, fragment);
  glAttachShader(program, vertexShader);
  glAttachShader(program, fragmentShader);
  glLinkProgram(program);
  glDeleteShader(vertexShader);
  glDeleteShader(fragmentShader);
  GLint linked = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked != GL_TRUE) {
    std::vector<char> log(4096);
    glGetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::runtime_error(std::string("shaders do not link: ") + log.data());
  }
  bindSharedNames(program);
  return program;
}

GLuint makeBuffer() {
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  return buffer;
}

GLuint makeVertexArray() {
  GLuint array = 0;
  glGenVertexArrays(1, &array);
  return array;
}

void setAttribute(GLuint index, int size, std::size_t stride, std::size_t offset) {
  glEnableVertexAttribArray(index);
  glVertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                        reinterpret_cast<const void*>(offset));
}

Color linearColor(const Color& color) {
  return {linear(color.x()), linear(color.y()), linear(color.z()), color.w()};
}

GLuint makeTexture(GLenum internalFormat, int width, int height, GLenum filter) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  const bool depth = internalFormat == GL_DEPTH_COMPONENT16 ||
                     internalFormat == GL_DEPTH_COMPONENT24 ||
                     internalFormat == GL_DEPTH_COMPONENT32F;
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internalFormat), width, height, 0,
               depth ? GL_DEPTH_COMPONENT : GL_RGBA, depth ? GL_FLOAT : GL_UNSIGNED_BYTE, nullptr);
  setFilter(filter);
  return texture;
}

GLuint makeMultisampleTexture(GLenum internalFormat, int samples, int width, int height) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, texture);
  glTexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, samples, internalFormat, width, height,
                          GL_TRUE);
  return texture;
}

GLuint makeRenderbuffer(GLenum internalFormat, int samples, int width, int height) {
  GLuint buffer = 0;
  glGenRenderbuffers(1, &buffer);
  glBindRenderbuffer(GL_RENDERBUFFER, buffer);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, internalFormat, width, height);
  return buffer;
}

void requireCompleteFramebuffer(const char* name) {
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error(std::string("the driver refuses the framebuffer for ") + name);
}

GLuint makeFramebuffer(GLuint colorTexture, const char* name) {
  GLuint framebuffer = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colorTexture, 0);
  requireCompleteFramebuffer(name);
  return framebuffer;
}

void cutTo(const Bounds& bounds, int width, int height, int margin) {
  const auto pixel = [](float share, int size) {
    return static_cast<int>(std::floor(share * static_cast<float>(size)));
  };
  const int left = pixel(bounds.low.x(), width) - margin;
  const int bottom = pixel(bounds.low.y(), height) - margin;
  const int right = pixel(bounds.high.x(), width) + 1 + margin;
  const int top = pixel(bounds.high.y(), height) + 1 + margin;
  glScissor(left, bottom, std::max(right - left, 0), std::max(top - bottom, 0));
  glEnable(GL_SCISSOR_TEST);
}

void uncut() { glDisable(GL_SCISSOR_TEST); }

void drawWholeViewport() { glDrawArrays(GL_TRIANGLES, 0, 3); }

void bindTexture(TextureUnit unit, GLenum target, GLuint texture) {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(target, texture);
}

}  // namespace render
