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

/// A cache of byte strings that can be computed again. Each byte string is kept in a file whose name is the
/// 128-bit hash (XXH3) of its inputs. Damage, sharing between programs, the size limit and read-only disks
/// are handled as in VoxMapCache. VoxMapCache and ByteCache may use one folder; the limit then applies to the
/// files of both together.
class VPS_API ByteCache {
 public:
  using Warn = std::function<void(const std::string&)>;

  /// @param limit_bytes  limit of the total size of all files; 0: no limit
  explicit ByteCache(std::filesystem::path folder, Warn warn = {}, std::uint64_t limit_bytes = 0);

  /// @param made_from  everything that determines the bytes, and the version of the program that makes them
  /// @return nothing if the cache has no such file or, after a warning, if the file is damaged
  [[nodiscard]] std::optional<std::string> find(std::string_view made_from) const;
  /// Writes the file, replacing an older one. If the file cannot be written, a warning is given once.
  void keep(std::string_view made_from, std::string_view bytes) const;
  /// Path of the file for the inputs `made_from`. The file need not exist.
  [[nodiscard]] std::filesystem::path fileOf(std::string_view made_from) const;

 private:
  std::shared_ptr<CacheFolder> folder_;
};

}  // namespace vps
