// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/draw/image.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "vps/errors.h"

namespace vps::viewer {
namespace {

std::string scratch(const std::string& name) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "vps_image_test";
  std::filesystem::create_directories(folder);
  return (folder / name).string();
}

Image pattern() {
  Image image(23, 17);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      image.at(x, y)[0] = static_cast<std::uint8_t>(11 * x);
      image.at(x, y)[1] = static_cast<std::uint8_t>(13 * y);
      image.at(x, y)[2] = static_cast<std::uint8_t>(x * y);
    }
  return image;
}

TEST(Png, ASavedImageLoadsBackToTheBit) {
  savePng(pattern(), scratch("a.png"));
  EXPECT_EQ(loadPng(scratch("a.png")).rgb, pattern().rgb);
}

TEST(Png, TheSameImageGivesTheSameBytes) {
  savePng(pattern(), scratch("a.png"));
  savePng(pattern(), scratch("b.png"));
  EXPECT_EQ(test::bytesOf(scratch("a.png")), test::bytesOf(scratch("b.png")));
}

TEST(Png, AFileCutAtAnyByteIsALoadErrorThatNamesIt) {
  savePng(pattern(), scratch("whole.png"));
  const std::string whole = test::bytesOf(scratch("whole.png"));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::string file = scratch("cut.png");
    std::ofstream(file, std::ios::binary).write(whole.data(), static_cast<std::streamsize>(size));
    try {
      loadPng(file);
      ADD_FAILURE() << "loaded after " << size << " of " << whole.size() << " bytes";
    } catch (const LoadError& error) {
      EXPECT_NE(std::string(error.what()).find("cut.png"), std::string::npos);
    }
  }
}

TEST(Png, AFlippedBitInThePixelsIsALoadError) {
  savePng(pattern(), scratch("flipped.png"));
  std::string bytes = test::bytesOf(scratch("flipped.png"));
  bytes[bytes.find("IDAT") + 20] ^= 0x10;
  std::ofstream(scratch("flipped.png"), std::ios::binary) << bytes;
  EXPECT_THROW(loadPng(scratch("flipped.png")), LoadError);
}

TEST(Png, AMissingFileIsALoadError) {
  EXPECT_THROW(loadPng(scratch("nowhere.png")), LoadError);
}

TEST(Png, AnUnwritablePlaceIsALoadErrorThatNamesIt) {
  std::ofstream(scratch("plain")) << "a file where a folder should be";
  try {
    savePng(pattern(), scratch("plain") + "/a.png");
    FAIL() << "nothing was thrown";
  } catch (const LoadError& error) {
    EXPECT_NE(std::string(error.what()).find("plain"), std::string::npos) << error.what();
  }
}

TEST(Compare, CountsPixelsBeyondTheToleranceOnly) {
  Image a(10, 10, 100), b = a;
  b.at(3, 4)[1] = 103;  // within the tolerance
  b.at(5, 5)[0] = 140;  // beyond the tolerance
  b.at(5, 5)[2] = 90;   // the same pixel, of which the channel with the greatest difference counts
  const ImageDifference d = compare(a, b, 3);
  EXPECT_TRUE(d.is_same_size);
  EXPECT_DOUBLE_EQ(d.share_beyond, 1 / 100.0);
  EXPECT_EQ(d.greatest, 40);
  EXPECT_DOUBLE_EQ(d.mean, (3 + 40) / 100.0);
}

TEST(Compare, DifferentSizesAreEntirelyDifferent) {
  const ImageDifference d = compare(Image(10, 10), Image(10, 11), 255);
  EXPECT_FALSE(d.is_same_size);
  EXPECT_EQ(d.share_beyond, 1);
  EXPECT_THROW(differenceImage(Image(10, 10), Image(10, 11), 0), std::invalid_argument);
}

TEST(Compare, TheDifferencePictureIsRedWhereItDiffersAndGreyElsewhere) {
  Image a(4, 4, 100), b = a;
  b.at(1, 2)[0] = 200;
  const Image d = differenceImage(a, b, 2);
  EXPECT_GT(d.at(1, 2)[0], 150);
  EXPECT_LT(d.at(1, 2)[1], 100);
  EXPECT_EQ(d.at(0, 0)[0], d.at(0, 0)[1]);
}

}  // namespace
}  // namespace vps::viewer
