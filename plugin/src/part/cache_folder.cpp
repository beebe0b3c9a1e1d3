// SPDX-License-Identifier: BSD-3-Clause
#include "part/cache_folder.h"

#include <algorithm>
#include <chrono>
#include <vector>

#include "vps/write_file.h"

namespace vps {
namespace {

namespace fs = std::filesystem;

struct Kept {
  fs::file_time_type used;
  fs::path file;
  std::uint64_t bytes;
};

/// True for files that this library writes. A user's own files are neither counted nor removed.
bool isOurs(const fs::path& file) {
  constexpr std::size_t kDigits = 32;  // of nameOf()
  const std::string name = file.filename().string(), end = file.extension().string();
  return name.find_first_not_of("0123456789abcdef") == kDigits && name[kDigits] == '.' &&
         (end == ".voxmap" || end == ".shell" || end == ".bytes" || end == ".unfinished");
}

/// The folder's files, in the order of their last use.
std::vector<Kept> filesOf(const fs::path& folder) {
  std::vector<Kept> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code gone;  // another program may remove files at any time
    const std::uint64_t bytes = isOurs(it->path()) ? it->file_size(gone) : 0;
    if (!isOurs(it->path()) || gone) continue;
    const fs::file_time_type used = it->last_write_time(gone);
    if (!gone) files.push_back({used, it->path(), bytes});
  }
  std::ranges::sort(files, [](const Kept& a, const Kept& b) {
    return a.used != b.used ? a.used < b.used : a.file < b.file;
  });
  return files;
}

/// True for an unfinished file of a program that was killed while it wrote.
bool isAbandoned(const Kept& kept) {
  return kept.file.extension() == ".unfinished" &&
         fs::file_time_type::clock::now() - kept.used > std::chrono::hours(1);
}

}  // namespace

void CacheFolder::touch(const fs::path& file) {
  std::error_code ignored;  // the folder may be read-only
  fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
}

void CacheFolder::warn(const fs::path& about, const std::string& text) {
  if (!warn_) return;
  const std::lock_guard lock(mutex_);
  warn_(about.string() + ": " + text);
}

bool CacheFolder::write(const fs::path& file, const std::function<bool(const fs::path&)>& write) const {
  std::error_code error;
  if (!fs::exists(folder_, error)) {
    fs::create_directories(folder_, error);
    if (error) return false;
    fs::permissions(folder_, fs::perms::owner_all, error);  // because files of the folder are trusted
  }
  WholeFile whole(file);
  return write(whole.temporary()) && !whole.commit();
}

void CacheFolder::keep(const fs::path& file, const std::function<bool(const fs::path&)>& write) {
  {
    const std::lock_guard lock(mutex_);
    if (has_failed_) return;
  }
  if (this->write(file, write)) return limit(file);
  {
    const std::lock_guard lock(mutex_);
    if (has_failed_) return;
    has_failed_ = true;
  }
  warn(folder_,
       "models could not be kept in this folder and will be built again next time; check that the folder "
       "exists, that you may write to it, and that the disk is not full");
}

void CacheFolder::limit(const fs::path& newest) {
  if (limit_bytes_ == 0) return;
  const std::lock_guard lock(mutex_);
  std::error_code error;
  const std::uint64_t bytes = fs::file_size(newest, error);
  if (!error) bytes_ += bytes;
  // The folder is read for the first file and when it may be too large, not for each file.
  if (is_counted_ && bytes_ <= limit_bytes_) return;
  is_counted_ = true;
  bytes_ = removeLongestUnused(newest);
}

std::uint64_t CacheFolder::removeLongestUnused(const fs::path& newest) const {
  const std::vector<Kept> files = filesOf(folder_);
  std::uint64_t bytes = 0;
  for (const Kept& kept : files) bytes += kept.bytes;
  // A tenth of the limit is left free, so that not every later file needs another removal.
  const bool is_full = bytes > limit_bytes_;
  const std::uint64_t wanted = limit_bytes_ - limit_bytes_ / 10;
  for (const Kept& kept : files) {
    const bool is_removed = isAbandoned(kept) || (is_full && bytes > wanted && kept.file != newest &&
                                                  kept.file.extension() != ".unfinished");
    std::error_code error;
    if (is_removed && fs::remove(kept.file, error) && !error) bytes -= kept.bytes;
  }
  return bytes;
}

}  // namespace vps
