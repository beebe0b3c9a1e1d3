// SPDX-License-Identifier: BSD-3-Clause
#include "openxr/eye_pictures.h"

#include <algorithm>
#include <stdexcept>

namespace vps::viewer {
namespace {

/// The best format that the runtime offers. Our bytes are sRGB; a runtime shows them too bright from a linear
/// format.
std::int64_t formatOf(XrSession session) {
  std::uint32_t count = 0;
  check(xrEnumerateSwapchainFormats(session, 0, &count, nullptr), "xrEnumerateSwapchainFormats");
  std::vector<std::int64_t> offered(count);
  check(xrEnumerateSwapchainFormats(session, count, &count, offered.data()), "xrEnumerateSwapchainFormats");
  for (const std::int64_t wanted : {GL_SRGB8_ALPHA8, GL_SRGB8, GL_RGBA8})
    if (std::ranges::find(offered, wanted) != offered.end()) return wanted;
  throw std::runtime_error("the headset's runtime accepts no pictures with 8 bits per colour");
}

[[noreturn]] void fail(Display* display, const std::string& what) {
  if (display != nullptr) XCloseDisplay(display);
  throw std::runtime_error("a headset needs " + what);
}

/// Ignores X errors for its lifetime, since Xlib's own handler ends the process.
class QuietErrors {
 public:
  explicit QuietErrors(Display* display) : display_(display) {}
  ~QuietErrors() {
    XSync(display_, 0);
    XSetErrorHandler(before_);
  }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  Display* display_;
  XErrorHandler before_ = XSetErrorHandler([](Display*, XErrorEvent*) { return 0; });
};

}  // namespace

EyePictures::EyePictures(XrSession session, int width, int height) : width_(width), height_(height) {
  auto wanted = xrStruct<XrSwapchainCreateInfo>(XR_TYPE_SWAPCHAIN_CREATE_INFO);
  wanted.usageFlags = XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT | XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT |
                      XR_SWAPCHAIN_USAGE_SAMPLED_BIT;
  wanted.format = formatOf(session);
  wanted.sampleCount = wanted.faceCount = wanted.arraySize = wanted.mipCount = 1;
  wanted.width = static_cast<std::uint32_t>(width);
  wanted.height = static_cast<std::uint32_t>(height);
  check(xrCreateSwapchain(session, &wanted, &swapchain_), "xrCreateSwapchain");
  std::uint32_t count = 0;
  check(xrEnumerateSwapchainImages(swapchain_, 0, &count, nullptr), "xrEnumerateSwapchainImages");
  std::vector<XrSwapchainImageOpenGLKHR> images(
      count, xrStruct<XrSwapchainImageOpenGLKHR>(XR_TYPE_SWAPCHAIN_IMAGE_OPENGL_KHR));
  check(xrEnumerateSwapchainImages(swapchain_, count, &count,
                                   reinterpret_cast<XrSwapchainImageBaseHeader*>(images.data())),
        "xrEnumerateSwapchainImages");
  for (const XrSwapchainImageOpenGLKHR& image : images) textures_.push_back(image.image);
}

EyePictures::~EyePictures() {
  if (swapchain_ != XR_NULL_HANDLE) xrDestroySwapchain(swapchain_);
}

XrSwapchainSubImage EyePictures::put(const Image& image) {
  const int width = std::min(image.width, width_), height = std::min(image.height, height_);
  std::uint32_t index = 0;
  check(xrAcquireSwapchainImage(swapchain_, nullptr, &index), "xrAcquireSwapchainImage");
  auto wait = xrStruct<XrSwapchainImageWaitInfo>(XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO);
  wait.timeout = XR_INFINITE_DURATION;
  check(xrWaitSwapchainImage(swapchain_, &wait), "xrWaitSwapchainImage");
  // Rows are flipped, since those of OpenGL begin at the bottom.
  const std::size_t row = 3 * static_cast<std::size_t>(width);
  flipped_.resize(row * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y)
    std::copy_n(image.at(0, height - 1 - y), row, flipped_.data() + row * static_cast<std::size_t>(y));
  glBindTexture(GL_TEXTURE_2D, textures_[index]);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, flipped_.data());
  glBindTexture(GL_TEXTURE_2D, 0);
  check(xrReleaseSwapchainImage(swapchain_, nullptr), "xrReleaseSwapchainImage");
  XrSwapchainSubImage place{};
  place.swapchain = swapchain_;
  place.imageRect.extent = {width, height};
  return place;
}

GlxContext::GlxContext() : display_(XOpenDisplay(nullptr)) {
  // This connection to the display is separate, so that no other thread uses it.
  if (display_ == nullptr) fail(nullptr, "an X display; set DISPLAY (under Wayland: XWayland's display)");
  const int screen = DefaultScreen(display_);
  if (epoxy_glx_version(display_, screen) < 13 ||
      !epoxy_has_glx_extension(display_, screen, "GLX_ARB_create_context_profile"))
    fail(display_, "GLX 1.3 with OpenGL 3.3 on its X display (Debian: libgl1-mesa-dri)");
  const int wanted[] = {GLX_DRAWABLE_TYPE,
                        GLX_PBUFFER_BIT | GLX_WINDOW_BIT,
                        GLX_RENDER_TYPE,
                        GLX_RGBA_BIT,
                        GLX_RED_SIZE,
                        8,
                        GLX_GREEN_SIZE,
                        8,
                        GLX_BLUE_SIZE,
                        8,
                        0};
  int count = 0;
  GLXFBConfig* configs = glXChooseFBConfig(display_, screen, wanted, &count);
  if (configs == nullptr || count == 0) fail(display_, "a GLX visual with 8 bits per colour");
  config_ = configs[0];
  XFree(configs);
  if (XVisualInfo* visual = glXGetVisualFromFBConfig(display_, config_); visual != nullptr) {
    visual_ = static_cast<unsigned>(visual->visualid);
    XFree(visual);
  }
  const int version[] = {
      GLX_CONTEXT_MAJOR_VERSION_ARB,    3, GLX_CONTEXT_MINOR_VERSION_ARB, 3, GLX_CONTEXT_PROFILE_MASK_ARB,
      GLX_CONTEXT_CORE_PROFILE_BIT_ARB, 0};
  const int size[] = {GLX_PBUFFER_WIDTH, 1, GLX_PBUFFER_HEIGHT, 1, 0};
  {
    const QuietErrors quiet(display_);
    context_ = glXCreateContextAttribsARB(display_, config_, nullptr, 1, version);
    surface_ = glXCreatePbuffer(display_, config_, size);
  }
  if (context_ == nullptr) fail(display_, "OpenGL 3.3 on its X display (Debian: libgl1-mesa-dri)");
}

GlxContext::~GlxContext() {
  release();
  glXDestroyPbuffer(display_, surface_);
  glXDestroyContext(display_, context_);
  XCloseDisplay(display_);
}

void GlxContext::makeCurrent() const {
  if (!glXMakeContextCurrent(display_, surface_, surface_, context_))
    throw std::runtime_error("the headset's OpenGL context cannot be used");
}

void GlxContext::release() const {
  glXMakeContextCurrent(display_, 0, 0, nullptr);
}

XrGraphicsBindingOpenGLXlibKHR GlxContext::binding() const {
  auto made = xrStruct<XrGraphicsBindingOpenGLXlibKHR>(XR_TYPE_GRAPHICS_BINDING_OPENGL_XLIB_KHR);
  made.xDisplay = display_;
  made.visualid = visual_;
  made.glxFBConfig = config_;
  made.glxDrawable = surface_;
  made.glxContext = context_;
  return made;
}

}  // namespace vps::viewer
