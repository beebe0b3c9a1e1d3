// SPDX-License-Identifier: BSD-3-Clause
#include "vps/write_file.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <fstream>
#include <string>

#include "vps/errors.h"

namespace vps {
namespace {

std::filesystem::path temporaryName(const std::filesystem::path& target) {
  static std::atomic<unsigned> count = 0;
  std::filesystem::path name = target;
  // append() is used because GCC 12 warns of an overflow in "text" + std::string, which does not exist.
  name += std::string(".").append(std::to_string(getpid())).append(".");
  name += std::to_string(count++).append(".unfinished");
  return name;
}

[[noreturn]] void fail(const std::filesystem::path& file, const std::error_code& error) {
  throw LoadError(
      file.string(), "",
      "cannot be written: " + error.message() + "; check the folder, its permissions and the free space");
}

/// The reason of the last failed operation, since streams report none of their own.
std::error_code lastError() {
  return errno != 0 ? std::error_code(errno, std::generic_category())
                    : std::make_error_code(std::errc::io_error);
}

}  // namespace

WholeFile::WholeFile(std::filesystem::path target)
    : target_(std::move(target)), temporary_(temporaryName(target_)) {}

WholeFile::~WholeFile() {
  if (is_committed_) return;
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

std::error_code WholeFile::commit() noexcept {
  std::error_code error;
  std::filesystem::rename(temporary_, target_, error);
  is_committed_ = !error;
  return error;
}

void writeWholeFile(const std::filesystem::path& file, std::string_view bytes) {
  WholeFile whole(file);
  errno = 0;
  std::ofstream out(whole.temporary(), std::ios::binary);
  if (out) out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (out) out.close();
  if (!out) fail(file, lastError());
  if (const std::error_code error = whole.commit()) fail(file, error);
}

}  // namespace vps
