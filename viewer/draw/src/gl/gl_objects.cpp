// SPDX-License-Identifier: BSD-3-Clause
#include "gl/gl_objects.h"

#include <stdexcept>

namespace vps::viewer::gl {
namespace {

GLuint compile(const char* name, GLenum stage, const std::string& source) {
  const GLuint shader = glCreateShader(stage);
  const std::string text = "#version 450 core\n" + source;
  const char* pointer = text.c_str();
  glShaderSource(shader, 1, &pointer, nullptr);
  glCompileShader(shader);
  GLint is_ok = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &is_ok);
  if (is_ok == 0) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    glDeleteShader(shader);
    throw std::runtime_error(std::string("the OpenGL driver rejects the shader '") + name + "': " + log);
  }
  return shader;
}

}  // namespace

void requireSound() {
  if (glGetGraphicsResetStatus() != GL_NO_ERROR)
    throw std::runtime_error(
        "the graphics card was reset, and the picture is lost; if it happens again, look for the driver's "
        "messages (dmesg), or draw without the card: LIBGL_ALWAYS_SOFTWARE=1");
  GLenum first = GL_NO_ERROR;
  constexpr int kMost = 16;  // a lost context may report errors without end
  for (int i = 0; i < kMost; ++i) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) break;
    if (first == GL_NO_ERROR || error == GL_OUT_OF_MEMORY) first = error;
  }
  if (first == GL_OUT_OF_MEMORY)
    throw std::runtime_error(
        "the graphics card has too little free memory for this picture; make the picture or window smaller, "
        "close other programs that draw, or draw without the card: LIBGL_ALWAYS_SOFTWARE=1");
  if (first != GL_NO_ERROR)
    throw std::runtime_error("the OpenGL driver reports error " + std::to_string(first) +
                             "; try Mesa's own renderer: LIBGL_ALWAYS_SOFTWARE=1");
}

Buffer makeBuffer(const void* data, std::size_t byte_count, GLenum usage) {
  GLuint id = 0;
  glCreateBuffers(1, &id);
  glNamedBufferData(id, static_cast<GLsizeiptr>(byte_count), data, usage);
  return Buffer(id);
}

VertexArray makeVertexArray() {
  GLuint id = 0;
  glCreateVertexArrays(1, &id);
  return VertexArray(id);
}

void addAttribute(const VertexArray& array, const Buffer& buffer, GLuint location, int count,
                  std::size_t offset, std::size_t stride, GLuint divisor) {
  // Each attribute has a binding point of its own; OpenGL guarantees sixteen, and the renderer needs fewer.
  glVertexArrayVertexBuffer(array.id(), location, buffer.id(), static_cast<GLintptr>(offset),
                            static_cast<GLsizei>(stride));
  glVertexArrayAttribFormat(array.id(), location, count, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(array.id(), location, location);
  glVertexArrayBindingDivisor(array.id(), location, divisor);
  glEnableVertexArrayAttrib(array.id(), location);
}

Texture makeTexture(GLenum format, int width, int height, GLenum filter) {
  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &id);
  glTextureStorage2D(id, 1, format, width, height);
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(filter));
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(filter));
  glTextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return Texture(id);
}

Texture makeMultisampleTexture(GLenum format, int width, int height, int samples) {
  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_2D_MULTISAMPLE, 1, &id);
  // Fixed sample positions, to match the renderbuffer that holds the depth.
  glTextureStorage2DMultisample(id, samples, format, width, height, GL_TRUE);
  return Texture(id);
}

Renderbuffer makeRenderbuffer(GLenum format, int width, int height, int samples) {
  GLuint id = 0;
  glCreateRenderbuffers(1, &id);
  glNamedRenderbufferStorageMultisample(id, samples, format, width, height);
  return Renderbuffer(id);
}

Framebuffer makeFramebuffer() {
  GLuint id = 0;
  glCreateFramebuffers(1, &id);
  return Framebuffer(id);
}

void requireComplete(const Framebuffer& framebuffer, const char* what) {
  const GLenum status = glCheckNamedFramebufferStatus(framebuffer.id(), GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error(std::string("the OpenGL driver rejects the framebuffer for ") + what +
                             " (status " + std::to_string(status) + "); try a smaller picture");
}

Program::Program(const char* name, const std::string& vertex_source, const std::string& fragment_source)
    : program_(glCreateProgram()) {
  for (const auto& [stage, source] :
       {std::pair(GL_VERTEX_SHADER, &vertex_source), std::pair(GL_FRAGMENT_SHADER, &fragment_source)}) {
    const GLuint shader = compile(name, static_cast<GLenum>(stage), *source);
    glAttachShader(program_.id(), shader);
    glDeleteShader(shader);  // the linked program keeps the shader
  }
  glLinkProgram(program_.id());
  GLint is_ok = 0;
  glGetProgramiv(program_.id(), GL_LINK_STATUS, &is_ok);
  if (is_ok == 0) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    glGetProgramInfoLog(program_.id(), static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw std::runtime_error(std::string("the OpenGL driver cannot link the shader '") + name + "': " + log);
  }
}

void Program::set(const char* uniform, int value) const {
  glProgramUniform1i(program_.id(), at(uniform), value);
}
void Program::set(const char* uniform, float value) const {
  glProgramUniform1f(program_.id(), at(uniform), value);
}
void Program::set(const char* uniform, const Eigen::Vector2f& value) const {
  glProgramUniform2fv(program_.id(), at(uniform), 1, value.data());
}
void Program::set(const char* uniform, const Eigen::Vector2i& value) const {
  glProgramUniform2iv(program_.id(), at(uniform), 1, value.data());
}
void Program::set(const char* uniform, const Eigen::Vector3f& value) const {
  glProgramUniform3fv(program_.id(), at(uniform), 1, value.data());
}
void Program::set(const char* uniform, const Eigen::Vector4f& value) const {
  glProgramUniform4fv(program_.id(), at(uniform), 1, value.data());
}
void Program::set(const char* uniform, const Eigen::Matrix4f& value) const {
  glProgramUniformMatrix4fv(program_.id(), at(uniform), 1, GL_FALSE, value.data());
}

}  // namespace vps::viewer::gl
