// SPDX-License-Identifier: BSD-3-Clause
#include "requests/recording_name.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace vps::scenes {

bool isRecordingName(const std::string& name) {
  const auto is_good = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
  };
  return name.size() > 5 && name.ends_with(".mcap") && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), is_good);
}

std::string recordingName(const std::string& file) {
  constexpr std::size_t kLongest = 63;  // length limit of AskMessage::text
  const std::string name = std::filesystem::path(file).filename().string();
  return isRecordingName(name) && name.size() <= kLongest ? name : "run.mcap";
}

}  // namespace vps::scenes
