// SPDX-License-Identifier: BSD-3-Clause
// Named memory that processes of one user share, and the roles of live processes. Only the source file uses
// POSIX.
//
// A process that takes a role holds a lock on one byte of the region for as long as it lives. The system
// frees the lock however the process ends, so the lock shows that the process is alive; a region whose
// owner's lock is free was left behind by a crash. The locks of roles guard no data, and no haptic thread
// takes or tests one.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>

namespace vps::scenes {

/// Role of a process in a session.
enum class NodeRole : unsigned char { Render, Device, Watch };

class SharedRegion {
 public:
  SharedRegion() = default;
  SharedRegion(SharedRegion&& other) noexcept;
  SharedRegion& operator=(SharedRegion&& other) noexcept;
  SharedRegion(const SharedRegion&) = delete;
  SharedRegion& operator=(const SharedRegion&) = delete;
  ~SharedRegion();

  /// Creates a region of zeros that this process owns in the role Render; only this user can read and write
  /// it. A region of the same name whose owner is dead is replaced. Throws LoadError if the owner is alive,
  /// or the system refuses.
  /// @param session  name of the session for its main region; for a further region, the name of the session,
  /// a dot and another name
  static SharedRegion create(const std::string& session, std::size_t bytes);
  /// Opens the region of a session; the result is not open if the region does not exist or is still being
  /// created. Throws LoadError for a region that other users could have written.
  static SharedRegion open(const std::string& session, bool is_writable);

  [[nodiscard]] bool isOpen() const { return !memory_.empty(); }
  [[nodiscard]] std::span<std::byte> memory() const { return memory_; }

  /// Takes a role until the region is closed. Returns false if another process has the role.
  bool take(NodeRole role) const;
  /// Whether a live process has the role.
  [[nodiscard]] bool isTaken(NodeRole role) const;
  /// Marks this process as a watcher; needs no write access.
  void markWatcher() const;
  [[nodiscard]] std::size_t watchers() const;

  /// Removes the name; the memory stays valid for processes that have it open.
  void removeName();

 private:
  SharedRegion(int file, std::span<std::byte> memory, std::string name)
      : file_(file), memory_(memory), name_(std::move(name)) {}

  int file_ = -1;
  std::span<std::byte> memory_;
  std::string name_;  ///< name to remove with this object; empty: another process removes it
};

/// Removes the regions of this user whose owners are dead. Returns the number of removed regions.
std::size_t removeDeadRegions();
/// Removes the region of a session if its owner is dead.
void removeIfDead(const std::string& session);

/// Throws LoadError for an invalid session name; valid are up to 32 letters, digits, - and _.
void requireSessionName(const std::string& session);
/// Composes "session 'demo'", for messages.
std::string sessionWords(const std::string& session);

}  // namespace vps::scenes
