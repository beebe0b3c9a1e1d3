// SPDX-License-Identifier: BSD-3-Clause
#include "link/shared_region.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <thread>
#include <utility>
#include <vector>

#include "vps/errors.h"

namespace vps::scenes {

namespace {

constexpr mode_t kMode = 0600;
constexpr const char* kFolder =
    "/dev/shm";  // where Linux lists shared memory; on other systems dead regions are not searched
constexpr int kLockTries =
    20;  // another process may hold the lock for moments while it searches for dead regions
constexpr std::chrono::milliseconds kPause{10};
constexpr off_t kWatchers = 1000;          // locks on bytes from here on mark watchers
constexpr off_t kMostProcesses = 1 << 22;  // greatest process number in Linux

std::string prefix() {
  return "/bullet-vps." + std::to_string(getuid()) + ".";
}
/// Name of a session's region. Further regions of a session append a dot and another name.
std::string nameOf(const std::string& session) {
  requireSessionName(session.substr(0, session.find('.')));
  return prefix() + session;
}

[[noreturn]] void refuse(const std::string& session, const std::string& what) {
  throw LoadError("", "", sessionWords(session) + ": " + what);
}

struct flock byteOf(NodeRole role, short kind) {
  struct flock lock {};
  lock.l_type = kind;
  lock.l_whence = SEEK_SET;
  lock.l_start = static_cast<off_t>(role);
  lock.l_len = 1;
  return lock;
}
bool lockByte(int file, NodeRole role) {
  struct flock lock = byteOf(role, F_WRLCK);
  return fcntl(file, F_OFD_SETLK, &lock) == 0;
}
bool isLocked(int file, NodeRole role) {
  // A file that is open for reading only can only request, and test, a read lock.
  struct flock lock = byteOf(role, F_RDLCK);
  return fcntl(file, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

/// Whether the name still refers to this file.
bool isNamed(int file, const std::string& name) {
  const int other = shm_open(name.c_str(), O_RDONLY | O_CLOEXEC, 0);
  if (other < 0) return false;
  struct stat a {
  }, b{};
  const bool is_same =
      fstat(file, &a) == 0 && fstat(other, &b) == 0 && a.st_ino == b.st_ino && a.st_dev == b.st_dev;
  close(other);
  return is_same;
}

/// Removes the name if its region's owner is dead. Returns false if the owner is alive.
bool removeDead(const std::string& name) {
  const int file = shm_open(name.c_str(), O_RDWR | O_CLOEXEC, 0);
  if (file < 0) return errno == ENOENT;
  const bool is_dead = lockByte(file, NodeRole::Render);
  if (is_dead && isNamed(file, name)) shm_unlink(name.c_str());
  close(file);
  return is_dead;
}

std::span<std::byte> mapped(int file, std::size_t bytes, bool is_writable) {
  void* memory = mmap(nullptr, bytes, is_writable ? PROT_READ | PROT_WRITE : PROT_READ, MAP_SHARED, file, 0);
  if (memory == MAP_FAILED) return {};
  return {static_cast<std::byte*>(memory), bytes};
}

}  // namespace

std::string sessionWords(const std::string& session) {
  return std::string("session '")
      .append(session)
      .append("'");  // concatenation with + causes a false warning of GCC 12
}

void requireSessionName(const std::string& session) {
  const auto is_good = [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; };
  if (!session.empty() && session.size() <= 32 && std::all_of(session.begin(), session.end(), is_good))
    return;
  throw LoadError("", "",
                  sessionWords(session) + ": use up to 32 letters, digits, - and _ for the session's name");
}

SharedRegion::SharedRegion(SharedRegion&& other) noexcept
    : file_(std::exchange(other.file_, -1)),
      memory_(std::exchange(other.memory_, {})),
      name_(std::exchange(other.name_, {})) {}

SharedRegion& SharedRegion::operator=(SharedRegion&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(memory_, other.memory_);
  std::swap(name_, other.name_);
  return *this;
}

SharedRegion::~SharedRegion() {
  removeName();
  if (!memory_.empty()) munmap(memory_.data(), memory_.size());
  if (file_ >= 0) close(file_);  // closing the file frees the roles
}

void SharedRegion::removeName() {
  if (!name_.empty() && isNamed(file_, name_)) shm_unlink(name_.c_str());
  name_.clear();
}

SharedRegion SharedRegion::create(const std::string& session, std::size_t bytes) {
  const std::string name = nameOf(session);
  for (int i = 0; i < kLockTries; ++i) {
    const int file = shm_open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kMode);
    if (file < 0 && errno != EEXIST)
      refuse(session, std::string("shared memory cannot be created: ") + std::strerror(errno));
    if (file < 0) {
      if (!removeDead(name)) std::this_thread::sleep_for(kPause);
      continue;
    }
    SharedRegion region(file, {}, name);
    // Another process that searches for dead regions may hold the lock of a new region, and remove its name.
    if (!region.take(NodeRole::Render) || !isNamed(file, name)) continue;
    if (ftruncate(file, static_cast<off_t>(bytes)) != 0)
      refuse(session, std::string("there is not enough shared memory: ") + std::strerror(errno));
    region.memory_ = mapped(file, bytes, true);
    if (!region.isOpen())
      refuse(session, std::string("shared memory cannot be mapped: ") + std::strerror(errno));
    return region;
  }
  refuse(session,
         "another vps render already runs this session; choose another --session, or stop that vps render");
}

SharedRegion SharedRegion::open(const std::string& session, bool is_writable) {
  const std::string name = nameOf(session);
  const int file = shm_open(name.c_str(), (is_writable ? O_RDWR : O_RDONLY) | O_CLOEXEC, 0);
  if (file < 0) {
    if (errno == ENOENT) return {};
    refuse(session, std::string("the session's shared memory cannot be opened: ") + std::strerror(errno));
  }
  SharedRegion region(file, {}, "");
  struct stat status {};
  if (fstat(file, &status) != 0 || status.st_size <= 0) return {};
  if (status.st_uid != getuid() || (status.st_mode & 0777) != kMode)
    refuse(session, "the session's shared memory is accessible to other users and is not used; remove " +
                        std::string(kFolder) + name);
  region.memory_ = mapped(file, static_cast<std::size_t>(status.st_size), is_writable);
  if (!region.isOpen())
    refuse(session, std::string("the session's shared memory cannot be mapped: ") + std::strerror(errno));
  return region;
}

bool SharedRegion::take(NodeRole role) const {
  return lockByte(file_, role);
}

// Takes a read lock on a byte for the process's number; read locks do not exclude each other.
void SharedRegion::markWatcher() const {
  struct flock lock = byteOf(NodeRole::Watch, F_RDLCK);
  lock.l_start = kWatchers + getpid();
  fcntl(file_, F_OFD_SETLK, &lock);
}

// The system reports any lock of a range, not necessarily the first, so the ranges on both sides of that lock
// are searched.
std::size_t SharedRegion::watchers() const {
  std::size_t count = 0;
  std::vector<std::pair<off_t, off_t>> ranges = {{kWatchers, kWatchers + kMostProcesses}};
  while (!ranges.empty()) {
    const auto [from, to] = ranges.back();
    ranges.pop_back();
    if (from >= to) continue;
    struct flock lock = byteOf(NodeRole::Watch, F_WRLCK);
    lock.l_start = from;
    lock.l_len = to - from;
    if (fcntl(file_, F_OFD_GETLK, &lock) != 0 || lock.l_type == F_UNLCK) continue;
    ++count;
    ranges.emplace_back(from, lock.l_start);
    ranges.emplace_back(lock.l_len == 0 ? to : lock.l_start + lock.l_len, to);
  }
  return count;
}

bool SharedRegion::isTaken(NodeRole role) const {
  return isLocked(file_, role);
}

std::size_t removeDeadRegions() {
  std::size_t removed = 0;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder, error)) {
    const std::string name = std::string("/").append(entry.path().filename().string());
    if (!name.starts_with(prefix()) || !removeDead(name)) continue;
    removed += !std::filesystem::exists(entry.path(), error);
  }
  return removed;
}

void removeIfDead(const std::string& session) {
  removeDead(nameOf(session));
}

}  // namespace vps::scenes
