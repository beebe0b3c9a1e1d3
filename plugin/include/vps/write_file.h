// SPDX-License-Identifier: BSD-3-Clause
// Writing files so that readers find either the complete file or the old one.
#pragma once

#include <filesystem>
#include <string_view>
#include <system_error>

#include "vps/export.h"

namespace vps {

/// A file that is written under a temporary name in the target's folder and then renamed to the target, so
/// that readers find either the old content or the complete new content.
///
///     WholeFile file("part.voxmap");
///     std::ofstream out(file.temporary(), std::ios::binary);
///     ...
///     out.close();
///     if (const std::error_code error = out ? file.commit() : std::make_error_code(std::errc::io_error)) ...
class VPS_API WholeFile {
 public:
  /// Chooses a temporary name from the target's name, the process id and a count, so that no two writers
  /// share it. Creates nothing. Thread-safe.
  explicit WholeFile(std::filesystem::path target);
  /// Removes the temporary file unless commit() has succeeded.
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  [[nodiscard]] const std::filesystem::path& target() const noexcept { return target_; }
  /// The file to write; close it before commit().
  [[nodiscard]] const std::filesystem::path& temporary() const noexcept { return temporary_; }
  /// Renames the temporary file to the target. On an error the target is unchanged.
  [[nodiscard]] std::error_code commit() noexcept;

 private:
  std::filesystem::path target_, temporary_;
  bool is_committed_ = false;
};

/// Writes `bytes` as the whole content of `file`. The folder must exist. Throws LoadError with the system's
/// reason; `file` is then unchanged.
VPS_API void writeWholeFile(const std::filesystem::path& file, std::string_view bytes);

}  // namespace vps
