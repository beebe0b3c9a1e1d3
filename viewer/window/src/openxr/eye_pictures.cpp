// SPDX-License-Identifier: BSD-3-Clause
#include "openxr/eye_pictures.h"

#include <algorithm>

namespace vps::viewer {
namespace {

/// Our bytes are sRGB, which only formats that say so keep; the others are shown too bright.
std::int64_t formatOf(XrSession session) {
  std::uint32_t count = 0;
  check(xrEnumerateSwapchainFormats(session, 0, &count, nullptr), "xrEnumerateSwapchainFormats");
  std::vector<std::int64_t> offered(count);
  check(xrEnumerateSwapchainFormats(session, count, &count, offered.data()), "xrEnumerateSwapchainFormats");
  for (const std::int64_t wanted : {GL_SRGB8_ALPHA8, GL_SRGB8, GL_RGBA8})
    if (std::ranges::find(offered, wanted) != offered.end()) return wanted;
  throw std::runtime_error("the headset's runtime takes no pictures of 8 bits a colour");
}

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
  // OpenGL's rows begin at the bottom.
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

}  // namespace vps::viewer
