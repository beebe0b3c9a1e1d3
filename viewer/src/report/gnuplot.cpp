// SPDX-License-Identifier: BSD-3-Clause
#include "report/gnuplot.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>

#include "vps/write_file.h"

extern char** environ;

namespace vps::viewer::inline v0 {
namespace {

constexpr const char* kMissing = "gnuplot is not installed (Debian: apt install gnuplot-nox)";

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

std::string contents(std::FILE* file) {
  std::rewind(file);
  std::string text;
  char chunk[1024];
  while (const std::size_t count = std::fread(chunk, 1, sizeof chunk, file)) text.append(chunk, count);
  return text;
}

/// Runs gnuplot on a script. Returns nothing on success, and otherwise the reason of the failure.
std::string run(const std::string& script) {
  // Unnamed files instead of pipes: a full pipe could deadlock, and an early end of gnuplot would raise
  // SIGPIPE.
  const File input(std::tmpfile()), messages(std::tmpfile());
  if (!input || !messages) return std::string("no temporary file: ") + std::strerror(errno);
  if (std::fwrite(script.data(), 1, script.size(), input.get()) != script.size() ||
      std::fflush(input.get()) != 0)
    return std::string("no temporary file: ") + std::strerror(errno);
  std::rewind(input.get());

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(input.get()), 0);
  posix_spawn_file_actions_adddup2(&actions, fileno(messages.get()), 1);
  posix_spawn_file_actions_adddup2(&actions, fileno(messages.get()), 2);
  char name[] = "gnuplot";
  char* arguments[] = {name, nullptr};
  pid_t child = 0;
  const int error = posix_spawnp(&child, name, &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0)
    return error == ENOENT ? kMissing : std::string("gnuplot cannot run: ") + std::strerror(error);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127) return kMissing;
  return "gnuplot failed: " + contents(messages.get()).substr(0, 400);
}

}  // namespace

bool hasGnuplot() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((folder + "/gnuplot").c_str(), X_OK) == 0) return true;
  return false;
}

namespace gnuplot {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) continue;
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

std::string number(double value) {
  if (!std::isfinite(value)) return "NaN";
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string dataBlock(const std::string& name, const std::vector<std::vector<double>>& rows) {
  std::string out = std::string("$").append(name) + " << END_OF_DATA\n";
  for (const std::vector<double>& row : rows) {
    for (const double value : row) out += number(value) + ' ';
    out += '\n';
  }
  return out + "END_OF_DATA\n";
}

std::vector<std::pair<double, double>> thinned(const std::vector<std::pair<double, double>>& points,
                                               std::size_t bucket_count) {
  if (points.size() <= 2 * bucket_count) return points;
  std::vector<std::pair<double, double>> kept;
  for (std::size_t b = 0; b < bucket_count; ++b) {
    const auto begin = points.begin() + static_cast<std::ptrdiff_t>(b * points.size() / bucket_count);
    const auto end = points.begin() + static_cast<std::ptrdiff_t>((b + 1) * points.size() / bucket_count);
    auto [least, greatest] =
        std::minmax_element(begin, end, [](const auto& p, const auto& q) { return p.second < q.second; });
    if (least > greatest) std::swap(least, greatest);
    kept.push_back(*least);
    if (least != greatest) kept.push_back(*greatest);
  }
  return kept;
}

PlotOutcome draw(const std::string& body, const std::string& file, int width, int height) {
  namespace fs = std::filesystem;
  if (std::any_of(file.begin(), file.end(), [](unsigned char c) { return c < 0x20; }))
    return {false, "the plot's file name has control characters"};
  const std::string size = std::to_string(width) + "," + std::to_string(height);
  // gnuplot's pngcairo renders fonts at 72 dots per inch and svg at 96, hence the different point sizes.
  const std::pair<const char*, std::string> kinds[] = {
      {".png", "set terminal pngcairo size " + size + " font \"DejaVu Sans,11\" linewidth 1.2 noenhanced\n"},
      {".svg", "set terminal svg size " + size +
                   " font \"DejaVu Sans,13\" linewidth 1.2 background \"white\" noenhanced\n"}};
  std::error_code error;
  if (const fs::path folder = fs::path(file).parent_path(); !folder.empty())
    fs::create_directories(folder, error);
  for (const auto& [ending, terminal] : kinds) {
    WholeFile target(file + ending);
    const std::string failure_reason = run(terminal + "set output " + quoted(target.temporary().string()) +
                                           "\n" + body + "\nunset output\n");
    if (!failure_reason.empty()) return {false, failure_reason};
    if (const std::error_code failed = target.commit())
      return {false, file + ending + ": cannot be written: " + failed.message()};
  }
  return {true, {}};
}

}  // namespace gnuplot
}  // namespace vps::viewer::inline v0
