// SPDX-License-Identifier: BSD-3-Clause
// Results of long computations as bytes, in the folder of a VoxMapCache.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "vps/export.h"

namespace vps {

class CacheFolder;

/// Bytes that can be made again, each in a file that is named by a 128-bit hash (XXH3) of what they were made
/// from. What VoxMapCache promises of damage, sharing, the limit and disks that cannot be written holds here
/// too, and both may use one folder, whose limit then counts the files of both.
class VPS_API ByteCache {
 public:
  using Warn = std::function<void(const std::string&)>;

  /// @param limit_bytes  of all files together; 0: no limit
  explicit ByteCache(std::filesystem::path folder, Warn warn = {}, std::uint64_t limit_bytes = 0);

  /// @param made_from  everything that determines the bytes, with a version of what makes them
  /// @return nothing where they are not kept, or, after a warning, where their file cannot be trusted
  [[nodiscard]] std::optional<std::string> find(std::string_view made_from) const;
  /// Replaces a file that is there. A failure is a warning, once.
  void keep(std::string_view made_from, std::string_view bytes) const;
  /// Whether the file exists or not.
  [[nodiscard]] std::filesystem::path fileOf(std::string_view made_from) const;

 private:
  std::shared_ptr<CacheFolder> folder_;
};

}  // namespace vps
