// SPDX-License-Identifier: BSD-3-Clause
// A folder of files that can be made again: written whole, limited in size, the longest unused removed first.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>

namespace vps {

/// Thread-safe. Several programs may use one folder: a file that another one removes is only built again.
class CacheFolder {
 public:
  using Warn = std::function<void(const std::string&)>;

  /// @param limit_bytes  of all files together; 0: no limit
  CacheFolder(std::filesystem::path folder, Warn warn, std::uint64_t limit_bytes)
      : folder_(std::move(folder)), warn_(std::move(warn)), limit_bytes_(limit_bytes) {}

  [[nodiscard]] std::filesystem::path fileOf(const std::string& name) const { return folder_ / name; }
  /// Notes that the file was used now.
  static void touch(const std::filesystem::path& file);
  /// Keeps what `write` puts into the file of the given name, which returns false where it could not. If that
  /// fails, it warns once, and nothing more is written.
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
  std::mutex mutex_;         ///< of what follows
  bool has_failed_ = false;  ///< a file could not be written
  bool is_counted_ = false;  ///< bytes_ holds the files that were there before
  std::uint64_t bytes_ = 0;  ///< of the folder, as far as known: others may write to it
};

}  // namespace vps
