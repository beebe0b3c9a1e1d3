// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/write_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace vps::viewer {

void writeFileAtomically(const std::string& file, std::string_view bytes) {
  const auto fail = [&](const char* what) {
    throw std::runtime_error(file + ": " + what + ": " + std::strerror(errno));
  };
  const auto folder = std::filesystem::path(file).parent_path();
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(folder.string() + ": cannot make the folder: " + error.message());

  // Beside the target, since rename() is atomic only within one file system; the pid keeps two programs
  // apart.
  const std::string temporary = file + ".tmp" + std::to_string(::getpid());
  std::FILE* stream = std::fopen(temporary.c_str(), "wb");
  if (stream == nullptr) fail("cannot be written");
  const bool is_written = std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size();
  const int write_error = errno;
  if (std::fclose(stream) != 0 || !is_written) {
    const int close_error = errno;
    ::unlink(temporary.c_str());
    errno = is_written ? close_error : write_error;
    fail("cannot be written");
  }
  if (std::rename(temporary.c_str(), file.c_str()) != 0) {
    const int rename_error = errno;
    ::unlink(temporary.c_str());
    errno = rename_error;
    fail("cannot be put in place");
  }
}

}  // namespace vps::viewer
