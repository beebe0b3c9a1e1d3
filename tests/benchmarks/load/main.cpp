// SPDX-License-Identifier: BSD-3-Clause
// vps_bench_load product FOLDER      a product of 67 solids and 1720 faces: import, explain, check, assemble
// vps_bench_load parts N T S FOLDER  a scene of N parts with T triangles each, of S shapes (0: all differ)
// vps_bench_load curve FOLDER        parts.dat for plots/load.gp: 10 to 10,000 parts
// vps_bench_load write ...           as above, but only writes product.step or the scene
// The program is measured from outside: processor time, wall time, peak memory.
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "products.h"

extern char** environ;

namespace vps::bench {

#ifndef VPS_HAS_OPEN_CASCADE
ProductSize writeProduct(const std::string& /*file*/, bool /*is_shared*/) {
  throw std::runtime_error("the product is made by Open CASCADE, which this build has not found");
}
#endif

namespace {

struct ProgramRun {
  int status = -1;        ///< exit status; -1: a signal ended the program
  bool is_ended = false;  ///< false: the program was killed at the limit
  double wall_s = 0, cpu_s = 0;
  double peak_bytes = 0;  ///< resident memory
};

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Runs a program and measures it from outside.
/// @param output  file for its output
ProgramRun runProgram(const std::vector<std::string>& words, const std::filesystem::path& output,
                      double limit_s) {
  std::vector<std::string> copies = words;
  std::vector<char*> argv;
  for (std::string& word : copies) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 1, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&files, 1, 2);
  pid_t id = 0;
  const int error = posix_spawn(&id, argv[0], &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw std::runtime_error("cannot start " + words.front());

  using Clock = std::chrono::steady_clock;
  const Clock::time_point begun = Clock::now();
  const auto elapsed_s = [&] { return std::chrono::duration<double>(Clock::now() - begun).count(); };
  ProgramRun run;
  int status = 0;
  rusage usage{};
  for (;;) {
    run.is_ended = wait4(id, &status, WNOHANG, &usage) == id;
    if (run.is_ended) break;
    if (elapsed_s() > limit_s) {
      kill(id, SIGKILL);
      wait4(id, &status, 0, &usage);
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  run.wall_s = elapsed_s();
  run.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  run.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  run.peak_bytes = 1024.0 * static_cast<double>(usage.ru_maxrss);
  return run;
}

namespace fs = std::filesystem;
constexpr double kMost_bytes = 2.0 * 1024 * 1024 * 1024;

double loadAverage() {
  double load = 0;
  return getloadavg(&load, 1) == 1 ? load : 0;
}

/// A row of the table. `bar_s` is the bar of the wall time; 0 means that the row has no bar.
bool printRow(const std::string& what, const ProgramRun& run, double bar_s) {
  const bool is_good = run.is_ended && run.status >= 0 && run.status != 2 &&
                       (bar_s == 0 || run.wall_s <= bar_s) && run.peak_bytes <= kMost_bytes;
  const std::string bar = bar_s > 0 ? std::to_string(std::lround(bar_s)) + " s" : "";
  std::printf("| %s | %s | %.1f s%s | %.1f s | %.2f GB | %d | %.1f | %s |\n", what.c_str(), bar.c_str(),
              run.wall_s, run.is_ended ? "" : " (killed)", run.cpu_s, 1e-9 * run.peak_bytes, run.status,
              loadAverage(), is_good ? "reached" : "MISSED");
  std::fflush(stdout);
  return is_good;
}

void printHead() {
  std::printf(
      "| case | bar | wall | processor | peak memory | exit | load average | "
      "|\n|---|---|---|---|---|---|---|---|\n");
}

/// Runs the program `vps` and writes its output to files in the folder.
class Measured {
 public:
  explicit Measured(fs::path folder) : folder_(std::move(folder)) {}

  ProgramRun operator()(const std::string& name, std::vector<std::string> words, double limit_s) const {
    words.insert(words.begin(), VPS_PROGRAM);
    return runProgram(words, folder_ / (name + ".txt"), limit_s);
  }

 private:
  fs::path folder_;
};

void productRows(const fs::path& folder) {
  const std::string step = folder / "product.step", cache = folder / "cache",
                    scene = folder / "scene/scene.toml";
  const Measured run(folder);
  printHead();
  fs::remove_all(cache);
  printRow("import", run("import", {"import", step, "-o", folder / "scene", "--force"}, 300), 10);
  printRow("explain", run("explain", {"explain", scene}, 300), 5);
  printRow("check", run("check", {"check", step}, 600), 60);
  const auto load = [&](const std::string& name) {
    // Ten physics steps, so that nearly all of the time is for building the models.
    return run(
        name, {"simulate", scene, "--seconds", "0.01", "--cache", cache, "--json", folder / (name + ".json")},
        300);
  };
  printRow("load, cold", load("cold"), 0);
  printRow("load, warm", load("warm"), 0);
  const double kSteps = 66;
  const ProgramRun whole = run("assemble",
                               {"assemble", scene, "--no-pictures", "--cache", cache, "--out", folder / "out",
                                "--json", folder / "assemble.json"},
                               1200);
  printRow("assemble, 66 steps", whole, 10 * kSteps);
}

void partRows(const fs::path& folder, const ManyParts& size) {
  const std::string scene = writeManyParts(folder, size);
  const Measured run(folder);
  const std::string what = std::to_string(size.parts) + " parts of " + std::to_string(size.triangles) + ", ";
  printHead();
  printRow(what + "explain", run("explain", {"explain", scene}, 600), 0);
  printRow(what + "check", run("check", {"check", scene}, 600), 0);
  for (const char* name : {"assemble, cold", "assemble, warm"})
    printRow(
        what + name,
        run("assemble",
            {"assemble", scene, "--no-pictures", "--cache", folder / "cache", "--out", folder / "out"}, 600),
        0);
}

/// Time, memory and step time against the number of parts, of 500 triangles each.
void curve(const fs::path& folder) {
  fs::create_directories(folder);
  std::ofstream data(folder / "parts.dat");
  data << "# parts explain_cpu_s explain_GB check_cpu_s check_GB assemble_cpu_s assemble_GB build_s "
          "step_median_us\n";
  for (const std::size_t parts : {10, 30, 100, 300, 1000, 3000, 10000}) {
    const fs::path of = folder / std::to_string(parts);
    const std::string scene = writeManyParts(of, {.parts = parts, .triangles = 500, .shapes = 0});
    const Measured run(of);
    const ProgramRun explain = run("explain", {"explain", scene}, 600),
                     check = run("check", {"check", scene}, 600),
                     assemble = run("assemble",
                                    {"assemble", scene, "--no-pictures", "--no-cache", "--out", of / "out",
                                     "--json", of / "assemble.json"},
                                    600);
    const auto json = nlohmann::json::parse(std::ifstream(of / "assemble.json"), nullptr, false);
    const double nan = std::nan("");
    const bool has_run = !json.is_discarded();
    data << parts;
    for (const ProgramRun* one : {&explain, &check, &assemble})
      data << " " << (one->is_ended ? one->cpu_s : nan) << " "
           << (one->is_ended ? 1e-9 * one->peak_bytes : nan);
    data << " " << (has_run ? json["wall"]["build_s"].get<double>() : nan) << " "
         << (has_run ? json["wall"]["physics"]["tick_us"]["p50"].get<double>() : nan) << std::endl;
    fs::remove_all(of);
  }
}

int run(std::vector<std::string> words) {
  const bool only_writes = !words.empty() && words.front() == "write";
  if (only_writes) words.erase(words.begin());
  const auto number = [&](std::size_t i) { return static_cast<std::size_t>(std::atoll(words[i].c_str())); };
  if (words.size() == 2 && words[0] == "product") {
    fs::create_directories(words[1]);
    const ProductSize size = writeProduct(fs::path(words[1]) / "product.step", false);
    std::printf("%d solids, %d faces\n", size.solids, size.faces);
    if (!only_writes) productRows(words[1]);
  } else if (words.size() == 5 && words[0] == "parts") {
    const ManyParts size = {.parts = number(1), .triangles = number(2), .shapes = number(3)};
    if (only_writes)
      writeManyParts(words[4], size);
    else
      partRows(words[4], size);
  } else if (words.size() == 2 && words[0] == "curve" && !only_writes) {
    curve(words[1]);
  } else {
    std::fprintf(
        stderr,
        "usage: vps_bench_load [write] product FOLDER | parts N TRIANGLES SHAPES FOLDER | curve FOLDER\n");
    return 2;
  }
  return 0;
}

}  // namespace
}  // namespace vps::bench

int main(int argc, char** argv) {
  try {
    return vps::bench::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
