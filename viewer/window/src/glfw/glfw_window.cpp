// SPDX-License-Identifier: BSD-3-Clause
#include "glfw/glfw_window.h"

#include <epoxy/gl.h>
// GLFW must not include its own OpenGL header, which collides with epoxy's.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace vps::viewer {
namespace {

// Dear ImGui may need up to three frames to show the effect of an event.
constexpr int kFramesAfterEvent = 3;

std::string lastError() {
  const char* words = nullptr;
  glfwGetError(&words);
  return words != nullptr ? words : "no reason given";
}

const char* nameOf(int key) {
  static constexpr std::array<std::pair<int, const char*>, 11> kNames = {{{GLFW_KEY_SPACE, "Space"},
                                                                          {GLFW_KEY_ENTER, "Enter"},
                                                                          {GLFW_KEY_KP_ENTER, "Enter"},
                                                                          {GLFW_KEY_LEFT, "Left"},
                                                                          {GLFW_KEY_RIGHT, "Right"},
                                                                          {GLFW_KEY_UP, "Up"},
                                                                          {GLFW_KEY_DOWN, "Down"},
                                                                          {GLFW_KEY_HOME, "Home"},
                                                                          {GLFW_KEY_END, "End"},
                                                                          {GLFW_KEY_F11, "F11"},
                                                                          {GLFW_KEY_ESCAPE, "Escape"}}};
  for (const auto& [code, name] : kNames)
    if (code == key) return name;
  return nullptr;
}

GlfwWindow& self(GLFWwindow* window) {
  return *static_cast<GlfwWindow*>(glfwGetWindowUserPointer(window));
}

void openDisplay() {
  if (glfwInit() != GLFW_TRUE)
    throw std::runtime_error("no window can be opened: " + lastError() +
                             "; is there a display (DISPLAY or WAYLAND_DISPLAY)? Without one, vps snapshot "
                             "and vps assemble make pictures");
}

void loadFont(float scale) {
  static const std::array<const char*, 3> kFiles = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                                    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                                                    "/usr/share/fonts/TTF/DejaVuSans.ttf"};
  for (const char* file : kFiles) {
    if (!std::filesystem::exists(file)) continue;
    ImGui::GetIO().Fonts->AddFontFromFileTTF(file, 14 * scale);
    return;
  }
  ImGui::GetIO().FontGlobalScale = scale;
}

}  // namespace

void requireDisplay() {
  openDisplay();
  glfwTerminate();
}

GlfwWindow::GlfwWindow(const std::string& title, PictureSize size, bool wants_stereo) {
  openDisplay();
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  glfwWindowHint(GLFW_STEREO, wants_stereo ? GLFW_TRUE : GLFW_FALSE);
  window_ = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
  if (window_ == nullptr && wants_stereo) {
    glfwWindowHint(GLFW_STEREO, GLFW_FALSE);
    window_ = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
  }
  if (window_ == nullptr) {
    const std::string why = lastError();
    glfwTerminate();
    throw std::runtime_error("no window can be opened: the display has no OpenGL 3.3 (" + why +
                             "); Mesa draws without a GPU (Debian: apt install libgl1-mesa-dri)");
  }
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  glfwSetWindowUserPointer(window_, this);
  openImGui();
  if (wants_stereo) {  // a driver may ignore the hint
    GLboolean is_stereo = GL_FALSE;
    glGetBooleanv(GL_STEREO, &is_stereo);
    has_stereo_ = is_stereo == GL_TRUE;
  }
  glGenTextures(1, &texture_);
  if (has_stereo_) glGenTextures(1, &right_texture_);
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &greatest_picture_);
}

GlfwWindow::~GlfwWindow() {
  glDeleteTextures(1, &texture_);
  if (has_stereo_) glDeleteTextures(1, &right_texture_);
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void GlfwWindow::onAny(GLFWwindow* window) {
  self(window).frames_due_ = kFramesAfterEvent;
}

void GlfwWindow::openImGui() {
  // These callbacks are set before ImGui sets its own, which call these callbacks.
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int) {
    onAny(w);
    const char* name = nameOf(key);
    if (action != GLFW_RELEASE && name != nullptr && self(w).on_key) self(w).on_key(name);
  });
  glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned letter) {
    onAny(w);
    if (letter > ' ' && letter < 127 && self(w).on_key)
      self(w).on_key(std::string(1, static_cast<char>(std::toupper(static_cast<int>(letter)))));
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int, int, int) { onAny(w); });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double) { onAny(w); });
  glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double, double) { onAny(w); });
  glfwSetCursorEnterCallback(window_, [](GLFWwindow* w, int) { onAny(w); });
  glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int) { onAny(w); });
  glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) { onAny(w); });
  glfwSetWindowPosCallback(window_, [](GLFWwindow* w, int, int) { onAny(w); });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { onAny(w); });

  float across = 1, down = 1;
  glfwGetWindowContentScale(window_, &across, &down);
  scale_ = std::clamp(across, 0.5f, 4.0f);
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // ImGui writes no settings file
  ImGui_ImplGlfw_InitForOpenGL(window_, true);
  ImGui_ImplOpenGL3_Init("#version 330");
  ImGui::GetStyle().ScaleAllSizes(scale_);
  loadFont(scale_);
}

bool GlfwWindow::wait(double longest_s) {
  if (frames_due_ > 0)
    glfwPollEvents();
  else
    glfwWaitEventsTimeout(std::max(1e-3, longest_s));
  if (has_news_.exchange(false)) frames_due_ = std::max(frames_due_, 1);
  if (frames_due_ == 0) return false;
  --frames_due_;
  return true;
}

void GlfwWindow::wake() {
  has_news_ = true;
  glfwPostEmptyEvent();
}

bool GlfwWindow::isClosed() const {
  return glfwWindowShouldClose(window_) == GLFW_TRUE;
}

bool GlfwWindow::setFullScreen(bool is_full, int monitor) {
  auto& [x, y, width, height] = windowed_;
  if (!is_full) {
    if (is_full_screen_) glfwSetWindowMonitor(window_, nullptr, x, y, width, height, GLFW_DONT_CARE);
    is_full_screen_ = false;
    return true;
  }
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  if (monitor >= count) return false;
  const GLFWvidmode* mode = glfwGetVideoMode(monitors[monitor]);
  if (mode == nullptr) return false;
  glfwGetWindowPos(window_, &x, &y);
  glfwGetWindowSize(window_, &width, &height);
  glfwSetWindowMonitor(window_, monitors[monitor], 0, 0, mode->width, mode->height, mode->refreshRate);
  is_full_screen_ = true;
  return true;
}

PictureSize GlfwWindow::size() const {
  PictureSize size;
  glfwGetFramebufferSize(window_, &size.width, &size.height);
  return size;
}

int GlfwWindow::screenRow() const {
  int x = 0, y = 0, width = 0, height = 0;
  glfwGetWindowPos(window_, &x, &y);
  glfwGetWindowSize(window_, &width, &height);
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  int top = 0;
  for (int i = 0; i < count; ++i) {
    int left = 0, above = 0;
    glfwGetMonitorPos(monitors[i], &left, &above);
    const GLFWvidmode* mode = glfwGetVideoMode(monitors[i]);
    if (mode == nullptr || x < left || y < above || x >= left + mode->width || y >= above + mode->height)
      continue;
    top = above;
  }
  // Some displays count in units of several pixels; windows then start at whole units.
  const int pixels = height > 0 ? std::max(1, size().height / height) : 1;
  return (y - top) * pixels;
}

void GlfwWindow::beginFrame(bool is_dark) {
  if (is_dark)
    ImGui::StyleColorsDark();
  else
    ImGui::StyleColorsLight();
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

void GlfwWindow::drawPanels() const {
  const PictureSize now = size();
  glViewport(0, 0, now.width, now.height);
  glClearColor(0.9f, 0.9f, 0.9f, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void GlfwWindow::endFrame() {
  ImGui::Render();
  if (!has_stereo_) return drawPanels();
  glDrawBuffer(GL_BACK_RIGHT);
  const auto swapPictures = [](const ImTextureID& from, const ImTextureID& to) {
    const ImDrawData& drawn = *ImGui::GetDrawData();
    for (int i = 0; i < drawn.CmdListsCount; ++i)
      for (ImDrawCmd& command : drawn.CmdLists[i]->CmdBuffer)
        if (command.TextureId == from) command.TextureId = to;
  };
  auto* const right = reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(right_texture_));
  swapPictures(picture(), right);
  drawPanels();
  glDrawBuffer(GL_BACK_LEFT);
  swapPictures(right, picture());
  drawPanels();
}

void GlfwWindow::present() {
  glfwSwapBuffers(window_);
}

namespace {

/// Uploads `width` columns of the image, from column from_x.
void upload(unsigned texture, const Image& image, int from_x, int width, bool has_size) {
  glBindTexture(GL_TEXTURE_2D, texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, image.width);
  const std::uint8_t* first = image.rgb.data() + 3 * static_cast<std::size_t>(from_x);
  if (has_size) {
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, image.height, GL_RGB, GL_UNSIGNED_BYTE, first);
  } else {
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, width, image.height, 0, GL_RGB, GL_UNSIGNED_BYTE, first);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  }
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

}  // namespace

void GlfwWindow::setPicture(const Image& image) {
  const int width = has_stereo_ ? image.width / 2 : image.width;
  const PictureSize size{width, image.height};
  const bool has_size = size == texture_size_;
  upload(texture_, image, 0, width, has_size);
  if (has_stereo_) upload(right_texture_, image, width, width, has_size);
  texture_size_ = size;
  has_picture_ = true;
}

void* GlfwWindow::picture() const {
  return reinterpret_cast<void*>(static_cast<std::uintptr_t>(texture_));
}

Image GlfwWindow::readBack() const {
  const PictureSize now = size();
  Image flipped(now.width, now.height), image(now.width, now.height);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadBuffer(GL_BACK);
  glReadPixels(0, 0, now.width, now.height, GL_RGB, GL_UNSIGNED_BYTE, flipped.rgb.data());
  for (int y = 0; y < now.height; ++y)
    std::copy_n(flipped.at(0, now.height - 1 - y), 3 * std::size_t(now.width), image.at(0, y));
  return image;
}

}  // namespace vps::viewer
