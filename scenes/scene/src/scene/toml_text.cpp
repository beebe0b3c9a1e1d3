// SPDX-License-Identifier: BSD-3-Clause
#include "scene/toml_text.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "vps/errors.h"

namespace vps::scenes {

std::string readTomlText(const std::string& file, const std::string& what, const std::string& example) {
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw LoadError(file, "", "no such file; name a " + what + " (" + example + ")");
  if (std::filesystem::is_directory(file, error))
    throw LoadError(file, "", "is a folder; name the " + what + " in it (" + example + ")");
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw LoadError(file, "", "cannot be read; check its permissions");
  return text.str();
}

toml::table parseToml(const std::string& text, const std::string& file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    std::string words(error.description());
    // The message stays on one line, whatever the file holds.
    std::replace_if(
        words.begin(), words.end(), [](unsigned char c) { return c < 0x20; }, ' ');
    throw LoadError(file + ":" + std::to_string(error.source().begin.line), "", "not valid TOML: " + words);
  }
}

}  // namespace vps::scenes
