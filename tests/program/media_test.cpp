// SPDX-License-Identifier: BSD-3-Clause
// Films, sound, pictures for two eyes and for displays, and pages as PDF, as the program writes them.
#include <algorithm>

#include "program.h"
#include "vps_viewer/draw/image.h"

namespace vps {
namespace {

bool has(const char* program) {
  return std::system(("command -v " + std::string(program) + " >/dev/null 2>&1").c_str()) == 0;
}

TEST_F(Program, AFilmHasAPictureForEachInstantAndIsOneFile) {
  const std::string scene = VPS_SOURCE_DIR "/scenes/peg_in_hole/scene.toml";
  ASSERT_EQ(run("assemble " + scene + " --out a --no-pictures --record run.mcap").status, 0);
  const std::string options = "video run.mcap -o run.mp4 --width 64 --height 48 --rate 2 --camera orbit";
  const Ran ran = run(options);
  // The run takes some seconds; there is a picture at 0, 0.5, 1, ... s.
  std::size_t pictures = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "run_frames"))
    pictures += entry.path().extension() == ".png";
  EXPECT_GE(pictures, 8u);
  EXPECT_NE(ran.out.find(std::to_string(pictures) + " pictures"), std::string::npos) << ran.out;
  const bool has_ffmpeg = has("ffmpeg");
  EXPECT_EQ(ran.status, has_ffmpeg ? 0 : 2) << ran.err;
  EXPECT_EQ(fs::exists(folder_ / "run.mp4"), has_ffmpeg);
  if (has_ffmpeg) {
    EXPECT_EQ(slurp(folder_ / "run.mp4").substr(4, 4), "ftyp");
  }
  // Without ffmpeg the pictures are written, and the message says that ffmpeg is missing.
  const Ran alone = run(options + " --frames alone; true");
  EXPECT_EQ(slurp(folder_ / "alone/000001.png"), slurp(folder_ / "run_frames/000001.png")) << alone.err;
}

TEST_F(Program, AFilmHasTheSoundOfTheRunThatWasRecorded) {
  const std::string scene = VPS_SOURCE_DIR "/scenes/peg_in_hole/scene.toml";
  ASSERT_EQ(run("assemble " + scene + " --out a --no-pictures --record run.mcap").status, 0);
  ASSERT_EQ(run("assemble " + scene + " --out b --no-pictures --sound run.wav").status, 0);
  const Ran film = run("video run.mcap -o run.mp4 --width 64 --height 48 --rate 2 --sound");
  EXPECT_EQ(film.status, has("ffmpeg") ? 0 : 2) << film.err;
  EXPECT_NE(film.out.find("sound: at most"), std::string::npos) << film.out;
  EXPECT_TRUE(slurp(folder_ / "run_frames/sound.wav") == slurp(folder_ / "run.wav"))
      << "the film has the same sound as the run itself, to the bit";
  if (has("ffprobe")) {
    std::system(("ffprobe -v error -show_entries stream=codec_type -of csv=p=0 '" +
                 (folder_ / "run.mp4").string() + "' > '" + (folder_ / "streams.txt").string() + "'")
                    .c_str());
    EXPECT_NE(slurp(folder_ / "streams.txt").find("audio"), std::string::npos);
  }
  expectRefused("video run.mcap -o slow.mp4 --speed 0.5 --sound", "--speed");
  expectRefused("video -o odd.mp4 --sound run.mcap run.mcap", "is not a WAV file");
}

TEST_F(Program, AFilmThatFollowsThePartBeginsWithItInTheMiddle) {
  const std::string scene = VPS_SOURCE_DIR "/scenes/peg_in_hole/scene.toml";
  ASSERT_EQ(run("assemble " + scene + " --out a --no-pictures --record run.mcap").status, 0);
  run("video run.mcap -o run.mp4 --width 320 --height 240 --rate 1 --camera follow");
  const viewer::Image first = viewer::loadPng((folder_ / "run_frames/000001.png").string());
  ASSERT_EQ(first.height, 240);
  int top = first.height, bottom = 0;
  for (int y = 24; y < 216; ++y)  // between title and legend
    for (int x = 0; x < first.width; ++x)
      if (first.at(x, y)[2] > first.at(x, y)[0] + 100) {  // the blue of the part in hand
        top = std::min(top, y);
        bottom = std::max(bottom, y);
      }
  ASSERT_LT(top, bottom);
  // The camera looks from above, which moves the middle of the part by at most a thirtieth of the picture.
  EXPECT_NEAR(0.5 * (top + bottom), 120, 8);
}

TEST_F(Program, AFilmOfWhatIsNoRecordingIsRefused) {
  expectRefused("video missing.mcap -o run.mp4", "missing.mcap");
  expectRefused("video scene.toml -o run.mp4", "scene.toml");
  expectRefused("video scene.toml -o run.avi", ".mp4");
}

TEST_F(Program, PicturesForTwoEyesAndForADisplayAreWritten) {
  write("wall.toml",
        "[scene]\nscale = 10\n[[screen]]\nname = 'wall'\npixels = [64, 48]\nlower_left = [-0.4, 0.2, -0.3]\n"
        "lower_right = [0.4, 0.2, -0.3]\nupper_left = [-0.4, 0.2, 0.3]\n[[viewer]]\nname = 'anna'\n"
        "head = {position = [0, -1, 0.1], rpy_deg = [90, 0, 0]}\n");
  EXPECT_EQ(run("snapshot scene.toml -o a.png --size 64x48 --stereo side_by_side").status, 0);
  EXPECT_TRUE(fs::exists(folder_ / "a.png"));
  EXPECT_EQ(run("snapshot scene.toml -o b.png --size 64x48 --stereo spectral").status, 0);
  EXPECT_TRUE(fs::exists(folder_ / "b_left.png") && fs::exists(folder_ / "b_right.png"));
  EXPECT_EQ(run("snapshot scene.toml -o c.png --display wall.toml").status, 0);
  EXPECT_TRUE(fs::exists(folder_ / "c_wall.png"));
  EXPECT_EQ(run("snapshot scene.toml -o d.png --size 64x48 --show points,voxels").status, 0);
  EXPECT_TRUE(fs::exists(folder_ / "d.png"));
  expectRefused("snapshot scene.toml -o e.png --display missing.toml", "missing.toml");
  expectRefused("snapshot scene.toml -o e.png --show bricks", "--show");
  expectRefused("snapshot scene.toml -o e.png --stereo sideways", "--stereo");
}

TEST_F(Program, TheSoundOfARunHasTheSameBytesEachTimeAndIsNotSilence) {
  const std::string scene = VPS_SOURCE_DIR "/scenes/peg_in_hole/scene.toml";
  const Ran ran = run("assemble " + scene + " --out a --no-pictures --sound a.wav");
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("sound: at most"), std::string::npos) << ran.out;
  EXPECT_EQ(run("assemble " + scene + " --out b --no-pictures --sound b.wav").status, 0);
  const std::string bytes = slurp(folder_ / "a.wav");
  EXPECT_EQ(bytes, slurp(folder_ / "b.wav"));
  ASSERT_GT(bytes.size(), 44u + 2 * 48000u) << "a run takes more than a second";
  EXPECT_EQ(std::count(bytes.begin() + 44, bytes.begin() + 44 + 48000, '\0'), 48000)
      << "nothing touches in the first half second";
  EXPECT_LT(std::count(bytes.begin() + 44, bytes.end(), '\0'), static_cast<long>(bytes.size()) - 44 - 1000);
}

TEST_F(Program, SoundOfARunInRealTimeOrOfSeveralTriesIsRefused) {
  expectRefused("assemble scene.toml --sound a.wav --real-time", "--sound");
  expectRefused("assemble scene.toml --sound a.wav --tries 3", "--sound");
  expectRefused("assemble scene.toml --sound missing/a.wav", "missing");
}

// --- PDF

bool hasChromium() {
  return fs::exists("/usr/bin/chromium");
}

TEST_F(Program, ThePageOfACheckIsPrintedAsPdf) {
  if (!hasChromium()) GTEST_SKIP() << "chromium is not installed";
  const Ran ran = run("check scene.toml --pdf check.pdf");
  EXPECT_EQ(ran.status, 0) << "the pin is 0.1 mm above the plate\n" << ran.err;
  const std::string bytes = slurp(folder_ / "check.pdf");
  EXPECT_TRUE(bytes.starts_with("%PDF-"));
  EXPECT_GT(bytes.size(), 5000U) << "a page with tables and a picture";
  for (const auto& entry : fs::directory_iterator(folder_))
    EXPECT_EQ(entry.path().filename().string().find(".unfinished"), std::string::npos) << entry.path();
}

TEST_F(Program, WithoutChromiumPdfIsRefusedBeforeTheWork) {
  // No program is found in this PATH.
  const std::string command =
      "cd '" + folder_.string() + "' && PATH=/nowhere '" VPS_PROGRAM "' check scene.toml --pdf check.pdf";
  EXPECT_NE(std::system((command + " >out.txt 2>err.txt").c_str()), 0);
  const std::string said = slurp(folder_ / "err.txt");
  EXPECT_NE(said.find("--pdf needs Chromium (Debian: apt install chromium)"), std::string::npos) << said;
  EXPECT_EQ(slurp(folder_ / "out.txt"), "");
  EXPECT_FALSE(fs::exists(folder_ / "check.pdf"));
}

TEST_F(Program, APdfThatCannotBePrintedIsSaidAndLosesNothing) {
  // A browser that fails.
  fs::create_directories(folder_ / "bin");
  write("bin/chromium", "#!/bin/sh\necho no display >&2\nexit 1\n");
  fs::permissions(folder_ / "bin/chromium", fs::perms::owner_all);
  const std::string command = "cd '" + folder_.string() +
                              "' && PATH=\"$PWD/bin\" '" VPS_PROGRAM
                              "' check scene.toml --pdf check.pdf --html check.html >out.txt 2>err.txt";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 2);
  const std::string said = slurp(folder_ / "err.txt");
  EXPECT_NE(said.find("check.pdf"), std::string::npos) << said;
  EXPECT_NE(said.find("chromium failed: no display"), std::string::npos) << said;
  EXPECT_FALSE(fs::exists(folder_ / "check.pdf"));
  EXPECT_TRUE(fs::exists(folder_ / "check.html"));
  EXPECT_NE(slurp(folder_ / "out.txt"), "") << "the answer is printed";
}

}  // namespace
}  // namespace vps
