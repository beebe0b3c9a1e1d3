// SPDX-License-Identifier: BSD-3-Clause
// Short periods for OpenAL Soft. Version 1.19 ignores the program's request (ALC_REFRESH) and uses periods of
// 23 ms, but it follows its settings file, whose name an environment variable can set.
#if defined(__linux__)
#include <sys/mman.h>
#include <unistd.h>
#endif

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "sound/live_sound.h"

namespace vps::viewer {
namespace {

#if defined(__linux__)

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

/// The settings files of machine and user that OpenAL Soft reads.
std::vector<std::filesystem::path> settingsFiles() {
  std::vector<std::filesystem::path> files = {"/etc/openal/alsoft.conf"};
  std::string folders = variable("XDG_CONFIG_DIRS");
  if (folders.empty()) folders = "/etc/xdg";
  std::istringstream list(folders);
  for (std::string folder; std::getline(list, folder, ':');)
    if (!folder.empty()) files.push_back(std::filesystem::path(folder) / "alsoft.conf");
  const std::filesystem::path home = variable("HOME"), config = variable("XDG_CONFIG_HOME");
  if (!home.empty()) files.push_back(home / ".alsoftrc");
  if (!config.empty())
    files.push_back(config / "alsoft.conf");
  else if (!home.empty())
    files.push_back(home / ".config" / "alsoft.conf");
  return files;
}

/// Whether a line of a settings file begins with the key.
bool isSet(const std::string& key) {
  for (const std::filesystem::path& file : settingsFiles()) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);)
      if (const std::size_t at = line.find_first_not_of(" \t");
          at != std::string::npos && line.compare(at, key.size(), key) == 0)
        return true;
  }
  return false;
}

// The path has the number of the process instead of "self", so that child processes find the file, too.
std::string ownFolder() {
  return "/proc/" + std::to_string(getpid()) + "/fd/";
}

#endif

}  // namespace

bool isOwnSettings([[maybe_unused]] const std::string& name) {
#if defined(__linux__)
  return name.rfind(ownFolder(), 0) == 0;
#else
  return false;
#endif
}

void askForShortPeriods() {
#if defined(__linux__)
  if (!variable("ALSOFT_CONF").empty() || isSet("period")) return;
  std::string settings = "[general]\nperiod_size = " + std::to_string(kCardPeriod) +
                         "\nperiods = " + std::to_string(kCardPeriods) + "\n";
  if (!isSet("frequency")) settings += "frequency = 48000\n";
  // The mixer's thread gets real-time priority, if the system allows it.
  if (!isSet("rt-prio")) settings += "rt-prio = 1\n";
  const int file = memfd_create("alsoft.conf", MFD_CLOEXEC);  // stays open until the process ends
  if (file < 0) return;
  if (write(file, settings.data(), settings.size()) == static_cast<ssize_t>(settings.size()))
    setenv("ALSOFT_CONF", (ownFolder() + std::to_string(file)).c_str(), 1);
  else
    close(file);
#endif
}

}  // namespace vps::viewer
