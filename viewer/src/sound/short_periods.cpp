// SPDX-License-Identifier: BSD-3-Clause
// OpenAL Soft 1.19 ignores the wish of a program for short periods (ALC_REFRESH): a card gets periods of 23
// ms. Its settings file is heeded, and can be named by an environment variable.
#if defined(__linux__)
#include <sys/mman.h>
#include <unistd.h>
#endif

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "sound/live_sound.h"

namespace vps::viewer::inline v0 {
namespace {

/// Whether a line of the file sets periods.
bool setsPeriods(const std::filesystem::path& file) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (const std::size_t at = line.find_first_not_of(" \t");
        at != std::string::npos && line.compare(at, 6, "period") == 0)
      return true;
  return false;
}

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

/// Where OpenAL Soft looks for the settings of machine and user.
std::vector<std::filesystem::path> settingsFiles() {
  std::vector<std::filesystem::path> files = {"/etc/openal/alsoft.conf"};
  const std::filesystem::path home = variable("HOME"), config = variable("XDG_CONFIG_HOME");
  if (!home.empty()) files.push_back(home / ".alsoftrc");
  if (!config.empty())
    files.push_back(config / "alsoft.conf");
  else if (!home.empty())
    files.push_back(home / ".config" / "alsoft.conf");
  return files;
}

}  // namespace

void askForShortPeriods() {
#if defined(__linux__)
  if (!variable("ALSOFT_CONF").empty()) return;
  for (const std::filesystem::path& file : settingsFiles())
    if (setsPeriods(file)) return;
  // The mixer's thread is to go first, too, where the system allows it.
  const std::string settings =
      "[general]\nfrequency = 48000\nrt-prio = 1\nperiod_size = " + std::to_string(kCardPeriod) +
      "\nperiods = " + std::to_string(kCardPeriods) + "\n";
  const int file = memfd_create("alsoft.conf", MFD_CLOEXEC);  // open until the process ends
  if (file < 0) return;
  if (write(file, settings.data(), settings.size()) == static_cast<ssize_t>(settings.size()))
    setenv("ALSOFT_CONF", ("/proc/self/fd/" + std::to_string(file)).c_str(), 1);
  else
    close(file);
#endif
}

}  // namespace vps::viewer::inline v0
