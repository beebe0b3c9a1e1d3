// SPDX-License-Identifier: BSD-3-Clause
// A folder of cached files: written whole and limited in size; the files unused for the longest time are
// removed first.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>

namespace vps {

/// Thread-safe. Several programs may use one folder; a file that another program removes is built again.
class CacheFolder {
 public:
  using Warn = std::function<void(const std::string&)>;

  /// @param limit_bytes  limit of the total size of all files; 0: no limit
  CacheFolder(std::filesystem::path folder, Warn warn, std::uint64_t limit_bytes)
      : folder_(std::move(folder)), warn_(std::move(warn)), limit_bytes_(limit_bytes) {}

  [[nodiscard]] std::filesystem::path fileOf(const std::string& name) const { return folder_ / name; }
  /// Sets the file's time of last use to now.
  static void touch(const std::filesystem::path& file);
  /// Creates a file whose content `write` writes; `write` returns false if it failed. After a failure, the
  /// cache warns once and writes no more files.
  void keep(const std::filesystem::path& file,
            const std::function<bool(const std::filesystem::path&)>& write);
  void warn(const std::filesystem::path& about, const std::string& text);

 private:
  [[nodiscard]] bool write(const std::filesystem::path& file,
                           const std::function<bool(const std::filesystem::path&)>& write) const;
  void limit(const std::filesystem::path& newest);
  [[nodiscard]] std::uint64_t removeLongestUnused(const std::filesystem::path& newest) const;

  const std::filesystem::path folder_;
  const Warn warn_;
  const std::uint64_t limit_bytes_;
  std::mutex mutex_;         ///< guards the members below
  bool has_failed_ = false;  ///< a file could not be written
  bool is_counted_ = false;  ///< bytes_ includes the files that were in the folder at first
  std::uint64_t bytes_ = 0;  ///< size of the folder's files, as far as known: other programs may write to it
};

}  // namespace vps
