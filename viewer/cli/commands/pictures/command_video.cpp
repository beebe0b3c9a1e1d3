// SPDX-License-Identifier: BSD-3-Clause
// vps video: makes a film of a recording.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

#include "input/file_kind.h"
#include "output/command.h"
#include "output/output.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps_scenes/run/replay.h"
#include "vps_viewer/window/video.h"
#include "work/heard_run.h"

namespace vps::viewer {

namespace {

struct VideoArguments {
  std::string recording, out, frames, sound;
  std::string camera = "fixed", display, stereo = "mono";
  bool has_sound = false;
  VideoSettings settings;
};

/// Makes the sound track of the film by running the recording again. Returns the bytes of a WAV file.
std::string soundOf(const device::RecordedRun& run, const Progress& progress) {
  HeardRun heard;
  scenes::ReplayOptions options;
  heard.listenTo(options);
  options.on_scene = [&heard](const scenes::Scene& scene) { heard.hear(scene); };
  options.progress = progress;
  options.stop = &stopRequested();
  const scenes::ReplayResult replayed = scenes::replay(run, options);
  throwIfStopped();
  if (!replayed.departure.empty())
    warn(run.file +
         " gives other results when it runs again, so the sound does not match the pictures from " +
         replayed.departure + " on");
  return heard.wav();
}

void requireSound(const VideoArguments& given) {
  if (!given.has_sound) return;
  if (given.settings.speed != 1)
    throw LoadError("", "", "--sound is for films at the run's own speed; leave out --speed");
  if (!given.sound.empty() && lowerExtension(given.sound) != ".wav")
    throw LoadError(
        given.sound, "",
        "is not a WAV file; --sound alone, at the end of the line, makes the track from the recording");
}

int runVideo(const VideoArguments& given) {
  const std::filesystem::path film(given.out);
  if (film.extension() != ".mp4") throw LoadError(given.out, "", "must end in .mp4");
  const std::string folder = given.frames.empty()
                                 ? (film.parent_path() / (film.stem().string() + "_frames")).string()
                                 : given.frames;
  requireSound(given);
  const device::RecordedRun run = device::loadRecording(given.recording);
  OutputFile out(given.out, {given.recording, given.sound, given.display});
  OutputFolder frames(folder);
  ProgressBar bar;
  VideoSettings settings = given.settings;
  settings.progress = bar.progress();
  settings.path = given.camera == "orbit"    ? CameraPath::Orbit
                  : given.camera == "follow" ? CameraPath::Follow
                                             : CameraPath::Fixed;
  settings.stereo = stereoModeOf(given.stereo);
  if (!given.display.empty()) settings.display = scenes::loadDisplay(given.display);
  const std::size_t count = writeFrames(run, frames.partial(), settings);
  std::string track = given.sound;
  if (given.has_sound && track.empty()) {
    track = frames.partial() + "/sound.wav";
    frames.write("sound.wav", soundOf(run, bar.progress()));
  }
  bar.progress()("encoding", 1);
  const std::string failure = encodeVideo(frames.partial(), settings.frames_per_s, track, out.partial());
  frames.commit();
  bar.clear();
  std::printf("%zu pictures: %s\n", count, folder.c_str());
  if (!failure.empty())
    throw LoadError(given.out, "", "was not made: " + failure + "; the pictures are complete");
  out.commit();
  std::printf("film: %s\n", given.out.c_str());
  return kGood;
}

}  // namespace

std::function<int()> addVideo(CLI::App& command) {
  const auto given = std::make_shared<VideoArguments>();
  command.parse_complete_callback([given, &command] { given->has_sound = command.count("--sound") > 0; });
  command.add_option("recording", given->recording, "recording that vps assemble --record wrote")
      ->required()
      ->type_name("RECORDING");
  command.add_option("-o,--out", given->out, "film to write")->required()->type_name("FILE.mp4");
  command.add_option("--frames", given->frames, "folder for the pictures (default: NAME_frames)")
      ->type_name("DIR");
  command
      .add_option("--sound", given->sound,
                  "add a sound track: made by running the recording again, or this file, which vps assemble "
                  "--sound wrote of the same run")
      ->expected(0, 1)
      ->check(CLI::ExistingFile)
      ->type_name("[FILE.wav]");
  VideoSettings& settings = given->settings;
  command.add_option("--width", settings.width, "width of the pictures")
      ->capture_default_str()
      ->check(CLI::Range(16, 4096));
  command.add_option("--height", settings.height, "height of the pictures")
      ->capture_default_str()
      ->check(CLI::Range(16, 4096));
  command.add_option("--rate", settings.frames_per_s, "pictures per second")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 240.0));
  command.add_option("--speed", settings.speed, "speed of the run in the film; 1: the original speed")
      ->capture_default_str()
      ->check(CLI::Range(0.001, 1000.0));
  command.add_option("--view", settings.view, "direction from which the scene is seen")
      ->capture_default_str()
      ->check(CLI::IsMember({"iso", "front", "back", "left", "right", "top", "bottom"}));
  command
      .add_option(
          "--camera", given->camera,
          "motion of the camera: fixed, orbit (once around the scene) or follow (with the part in hand)")
      ->capture_default_str()
      ->check(CLI::IsMember({"fixed", "orbit", "follow"}));
  std::vector<std::string> modes;
  for (const StereoMode mode : stereoModes())
    if (mode != StereoMode::Spectral) modes.emplace_back(toText(mode));
  command.add_option("--stereo", given->stereo, "how the pictures for both eyes are combined")
      ->capture_default_str()
      ->check(CLI::IsMember(modes));
  CLI::Option* display = command
                             .add_option("--display", given->display,
                                         "display file (TOML): the film shows its first screen as seen by "
                                         "its first viewer; a recorded head follows the run's time")
                             ->type_name("FILE");
  for (const char* name : {"--width", "--height", "--view", "--camera"}) display->excludes(name);
  return [given] { return runVideo(*given); };
}

}  // namespace vps::viewer
