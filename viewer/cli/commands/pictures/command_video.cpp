// SPDX-License-Identifier: BSD-3-Clause
// vps video: a recording as a film.
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

/// A track for the film: the recorded run happens again, and is heard.
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
    warn(run.file + " does not run again as it was recorded, so sound and pictures differ from " +
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
        "is no WAV file; --sound alone, at the end of the line, makes the track from the recording");
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
    throw LoadError(given.out, "", "is not made: " + failure + "; the pictures are there");
  out.commit();
  std::printf("film: %s\n", given.out.c_str());
  return kGood;
}

}  // namespace

std::function<int()> addVideo(CLI::App& command) {
  const auto given = std::make_shared<VideoArguments>();
  command.parse_complete_callback([given, &command] { given->has_sound = command.count("--sound") > 0; });
  command.add_option("recording", given->recording, "what vps assemble --record wrote")
      ->required()
      ->type_name("RECORDING");
  command.add_option("-o,--out", given->out, "film to write")->required()->type_name("FILE.mp4");
  command.add_option("--frames", given->frames, "folder of the pictures; without it NAME_frames")
      ->type_name("DIR");
  command
      .add_option(
          "--sound", given->sound,
          "sound track: made from the recording, whose run happens again for it; or this file, which vps "
          "assemble --sound wrote of the same run")
      ->expected(0, 1)
      ->check(CLI::ExistingFile)
      ->type_name("[FILE.wav]");
  VideoSettings& settings = given->settings;
  command.add_option("--width", settings.width, "of the pictures")
      ->capture_default_str()
      ->check(CLI::Range(16, 4096));
  command.add_option("--height", settings.height, "of the pictures")
      ->capture_default_str()
      ->check(CLI::Range(16, 4096));
  command.add_option("--rate", settings.frames_per_s, "pictures a second")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 240.0));
  command.add_option("--speed", settings.speed, "of the run in the film; 1: as it was")
      ->capture_default_str()
      ->check(CLI::Range(0.001, 1000.0));
  command.add_option("--view", settings.view, "side to look from")
      ->capture_default_str()
      ->check(CLI::IsMember({"iso", "front", "back", "left", "right", "top", "bottom"}));
  command
      .add_option("--camera", given->camera, "fixed, orbit (once around) or follow (with the part in hand)")
      ->capture_default_str()
      ->check(CLI::IsMember({"fixed", "orbit", "follow"}));
  std::vector<std::string> modes;
  for (const StereoMode mode : stereoModes())
    if (mode != StereoMode::Spectral) modes.emplace_back(toText(mode));
  command.add_option("--stereo", given->stereo, "how the pictures of both eyes are brought to a screen")
      ->capture_default_str()
      ->check(CLI::IsMember(modes));
  CLI::Option* display =
      command
          .add_option("--display", given->display,
                      "display file (TOML): the film is its first screen, seen by its first viewer, whose "
                      "recorded head goes with the run's time")
          ->type_name("FILE");
  for (const char* name : {"--width", "--height", "--view", "--camera"}) display->excludes(name);
  return [given] { return runVideo(*given); };
}

}  // namespace vps::viewer
