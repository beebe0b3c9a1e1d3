// SPDX-License-Identifier: BSD-3-Clause
// Sessions for an hour: one run that does not end, and short runs that follow each other. The resources that
// the processes use at the end are compared with those after a tenth of the time.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "rows.h"
#include "support/process/child_process.h"
#include "support/temporary_folder.h"

namespace vps::bench {

namespace {

namespace fs = std::filesystem;

constexpr double kLook_s = 20;
constexpr double kGrowthBar_MB = 1;  // assumed: about the memory that an allocator keeps

long segmentsOf(const std::string& session) {
  long count = 0;
  for (const auto& entry : fs::directory_iterator("/dev/shm"))
    count += entry.path().filename().string().find("." + session) != std::string::npos;
  return count;
}

/// A peg above its hole, for a hand that a web page moves, with a time limit so long that the run does not
/// end.
void writeLongScene(const fs::path& file) {
  std::ofstream(file) << "unit = 'mm'\n[[part]]\nfile = '" VPS_SCENE_FOLDER
                         "/peg_in_hole/hole.stl'\nfixed = true\n[[part]]\nfile = '" VPS_SCENE_FOLDER
                         "/peg_in_hole/peg.stl'\npose = {position = [0, 0, -15]}\n[[step]]\npart = 'peg'\n"
                         "start = {position = [0, 0, 40]}\ntimeout_s = 1e6\n";
}
/// The peg's target is 25 mm higher, without contact, so the step takes a second.
void writeShortScene(const fs::path& file) {
  std::ofstream(file) << "unit = 'mm'\n[[part]]\nfile = '" VPS_SCENE_FOLDER
                         "/peg_in_hole/hole.stl'\nfixed = true\n[[part]]\nfile = '" VPS_SCENE_FOLDER
                         "/peg_in_hole/peg.stl'\npose = {position = [0, 0, 10]}\n[[step]]\npart = 'peg'\n"
                         "start = {position = [0, 0, 14]}\ntolerance = '2mm'\nholds = true\ntimeout_s = 5\n";
}

struct Watched {
  std::string name;
  const test::ChildProcess* process;
  test::Usage early, last;
};

}  // namespace

bool enduranceRow(double seconds) {
  const test::TemporaryFolder folder;
  const std::string name = std::to_string(getpid()), endless = "endless-" + name, brief = "brief-" + name;
  const fs::path long_scene = folder.path() / "long.toml", short_scene = folder.path() / "short.toml";
  writeLongScene(long_scene);
  writeShortScene(short_scene);
  const auto start = [&](std::vector<std::string> words, const std::string& session, const char* output) {
    words.insert(words.begin(), VPS_PROGRAM);
    words.insert(words.end(), {"--session", session});
    return test::ChildProcess(std::move(words), (folder.path() / output).string());
  };
  const auto render = [&](const fs::path& scene, const std::string& session, const char* output) {
    return start({"render", scene.string(), "--no-pictures", "--out", (folder.path() / session).string()},
                 session, output);
  };
  test::ChildProcess long_render = render(long_scene, endless, "long_render.txt");
  test::ChildProcess page = start({"watch", "--web", "0", "--allow-hand"}, endless, "page.txt");
  test::ChildProcess watch = start({"watch", "--terminal"}, endless, "watch.txt");
  test::ChildProcess device = start({"device", "--stay"}, brief, "device.txt");
  test::ChildProcess other_page = start({"watch", "--web", "0"}, brief, "other_page.txt");
  test::ChildProcess short_render = render(short_scene, brief, "short_render.txt");
  std::vector<Watched> all = {{"render of one run", &long_render, {}, {}},
                              {"its device and page", &page, {}, {}},
                              {"its watcher", &watch, {}, {}},
                              {"device of many runs", &device, {}, {}},
                              {"page of many runs", &other_page, {}, {}}};
  using Clock = std::chrono::steady_clock;
  const auto begun = Clock::now();
  const auto since_s = [&] { return std::chrono::duration<double>(Clock::now() - begun).count(); };
  long runs = 0, most_segments = 0;
  bool is_early_known = false, has_ended = false;
  for (double next_s = kLook_s; since_s() < seconds && !has_ended;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    if (!short_render.isRunning()) {
      short_render.wait();
      ++runs;
      short_render = render(short_scene, brief, "short_render.txt");
    }
    if (since_s() < next_s) continue;
    next_s += kLook_s;
    for (Watched& one : all) {
      has_ended = has_ended || !one.process->isRunning();
      one.last = test::usageOf(one.process->id());
      if (!is_early_known) one.early = one.last;
    }
    is_early_known = since_s() > 0.1 * seconds;
    most_segments = std::max(most_segments, segmentsOf(endless) + segmentsOf(brief));
    std::fprintf(stderr, "%6.0f s  %ld runs, %ld segments;", since_s(), runs,
                 segmentsOf(endless) + segmentsOf(brief));
    for (const Watched& one : all)
      std::fprintf(stderr, " %.2f MB %ld files %ld threads;", one.last.memory_MB, one.last.files,
                   one.last.threads);
    std::fprintf(stderr, "\n");
  }
  for (test::ChildProcess* process : {&long_render, &page, &watch, &device, &other_page, &short_render})
    while (process->isRunning()) {  // the signal is repeated, since a process that has just started may miss
                                    // a signal
      process->interrupt();
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  const long left = segmentsOf(endless) + segmentsOf(brief);
  bool is_good = !has_ended && left == 0 && runs > 0;
  std::string words = has_ended ? "a process ended; " : "";
  words += std::to_string(runs) + " short runs; segments " + std::to_string(most_segments) + " at most, " +
           std::to_string(left) + " at the end";
  for (const Watched& one : all) {
    const bool is_steady = one.last.memory_MB - one.early.memory_MB <= kGrowthBar_MB &&
                           one.last.files <= one.early.files && one.last.threads <= one.early.threads;
    is_good = is_good && is_steady;
    char text[160];
    std::snprintf(text, sizeof text, "; %s %.2f to %.2f MB, %ld to %ld files, %ld to %ld threads",
                  one.name.c_str(), one.early.memory_MB, one.last.memory_MB, one.early.files, one.last.files,
                  one.early.threads, one.last.threads);
    words += text;
  }
  char what[80];
  std::snprintf(what, sizeof what, "sessions for %.0f s", seconds);
  printRow(what, "no growth (1 MB) from a tenth of the time on", words, is_good);
  return is_good;
}

}  // namespace vps::bench
