// SPDX-License-Identifier: BSD-3-Clause
// Reads and writes PNG files.
#include <png.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "vps/errors.h"
#include "vps/write_file.h"
#include "vps_viewer/draw/image.h"

namespace vps::viewer {
namespace {

// libpng's simplified interface returns errors as text and needs no setjmp.
png_image newPngImage() {
  png_image png;
  std::memset(&png, 0, sizeof png);
  png.version = PNG_IMAGE_VERSION;
  return png;
}

}  // namespace

std::string pngBytes(const Image& image) {
  if (image.width <= 0 || image.height <= 0 ||
      image.rgb.size() != std::size_t(3) * image.width * image.height)
    throw std::runtime_error("cannot save an image of " + std::to_string(image.width) + " x " +
                             std::to_string(image.height) + " pixels with " +
                             std::to_string(image.rgb.size()) + " bytes");
  png_image png = newPngImage();
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string bytes(size, '\0');
  if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr))
    throw std::runtime_error(std::string("cannot be encoded as PNG: ") + png.message);
  bytes.resize(size);
  return bytes;
}

void savePng(const Image& image, const std::string& file) {
  try {
    writeWholeFile(file, pngBytes(image));
  } catch (const LoadError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(file + ": " + error.what());
  }
}

Image loadPng(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw LoadError(file, "", std::string("cannot be read: ") + std::strerror(errno));
  const std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};

  // libpng accepts a file that ends after the last pixel; a whole file also has the chunk IEND with its CRC.
  if (bytes.rfind("IEND\xAE\x42\x60\x82") == std::string::npos)
    throw LoadError(file, "", "is not a whole PNG image (its end is missing); save it again");
  png_image png = newPngImage();
  const auto refuse = [&]() {
    const std::string found = png.message;
    png_image_free(&png);
    throw LoadError(file, "", "is not a whole PNG image (" + found + "); save it again");
  };
  if (!png_image_begin_read_from_memory(&png, bytes.data(), bytes.size())) refuse();
  // A damaged header can state any size, so it is checked before memory is allocated.
  constexpr png_uint_32 kMaxSide = 16384;
  if (png.width > kMaxSide || png.height > kMaxSide) {
    png_image_free(&png);
    throw LoadError(file, "", "is wider or higher than 16384 pixels; make it smaller");
  }
  png.format = PNG_FORMAT_RGB;
  Image image(static_cast<int>(png.width), static_cast<int>(png.height));
  const png_color white = {255, 255, 255};
  if (!png_image_finish_read(&png, &white, image.rgb.data(), 0, nullptr)) refuse();
  return image;
}

}  // namespace vps::viewer
