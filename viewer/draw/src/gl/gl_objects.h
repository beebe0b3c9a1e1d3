// SPDX-License-Identifier: BSD-3-Clause
// Owners of OpenGL objects. The context must be current wherever one is made, used or destroyed.
#pragma once

#include <epoxy/gl.h>

#include <Eigen/Core>
#include <span>
#include <string>
#include <utility>

namespace vps::viewer::gl {

/// Throws std::runtime_error, with a remedy, if the graphics card was reset or ran out of memory since the
/// last call. The picture is invalid after such an exception.
void requireSound();

/// The name of an OpenGL object and the function that deletes the object; movable.
template <void (*Delete)(GLuint)>
class Object {
 public:
  Object() = default;
  explicit Object(GLuint id) : id_(id) {}
  Object(Object&& o) noexcept : id_(std::exchange(o.id_, 0)) {}
  Object& operator=(Object&& o) noexcept {
    std::swap(id_, o.id_);
    return *this;
  }
  ~Object() {
    if (id_ != 0) Delete(id_);
  }
  [[nodiscard]] GLuint id() const { return id_; }

 private:
  GLuint id_ = 0;
};

inline void deleteBuffer(GLuint id) {
  glDeleteBuffers(1, &id);
}
inline void deleteVertexArray(GLuint id) {
  glDeleteVertexArrays(1, &id);
}
inline void deleteTexture(GLuint id) {
  glDeleteTextures(1, &id);
}
inline void deleteFramebuffer(GLuint id) {
  glDeleteFramebuffers(1, &id);
}
inline void deleteRenderbuffer(GLuint id) {
  glDeleteRenderbuffers(1, &id);
}
inline void deleteProgram(GLuint id) {
  glDeleteProgram(id);
}

using Buffer = Object<deleteBuffer>;
using VertexArray = Object<deleteVertexArray>;
using Texture = Object<deleteTexture>;
using Framebuffer = Object<deleteFramebuffer>;
using Renderbuffer = Object<deleteRenderbuffer>;

Buffer makeBuffer(const void* data, std::size_t byte_count, GLenum usage = GL_STATIC_DRAW);
template <class T>
Buffer makeBuffer(std::span<const T> items) {
  return makeBuffer(items.data(), items.size_bytes());
}
VertexArray makeVertexArray();
/// Adds attribute `location`: `count` floats at `offset` bytes. With divisor 1 the attribute advances once
/// per instance.
void addAttribute(const VertexArray& array, const Buffer& buffer, GLuint location, int count,
                  std::size_t offset, std::size_t stride, GLuint divisor = 0);

/// A two-dimensional texture, clamped to its edge.
Texture makeTexture(GLenum format, int width, int height, GLenum filter);
/// A multisample texture that is drawn into and read sample by sample.
Texture makeMultisampleTexture(GLenum format, int width, int height, int samples);
Renderbuffer makeRenderbuffer(GLenum format, int width, int height, int samples);
Framebuffer makeFramebuffer();
/// Throws std::runtime_error with `what` and the status when the driver rejects the combination of
/// attachments.
void requireComplete(const Framebuffer& framebuffer, const char* what);

class Program {
 public:
  /// Compiles and links. Throws std::runtime_error with the driver's log.
  Program(const char* name, const std::string& vertex_source, const std::string& fragment_source);
  void use() const { glUseProgram(program_.id()); }
  void set(const char* uniform, int value) const;
  void set(const char* uniform, float value) const;
  void set(const char* uniform, const Eigen::Vector2f& value) const;
  void set(const char* uniform, const Eigen::Vector2i& value) const;
  void set(const char* uniform, const Eigen::Vector3f& value) const;
  void set(const char* uniform, const Eigen::Vector4f& value) const;
  void set(const char* uniform, const Eigen::Matrix4f& value) const;

 private:
  [[nodiscard]] GLint at(const char* uniform) const { return glGetUniformLocation(program_.id(), uniform); }
  Object<deleteProgram> program_;
};

}  // namespace vps::viewer::gl
