// SPDX-License-Identifier: BSD-3-Clause
// Memory with a name that processes of one user share, and who of them is alive. POSIX is in the source file
// only.
//
// A process that takes a role holds a lock on one byte of the region for as long as it lives. The system
// frees the lock however the process ends, so a lock tells who is alive, and a region whose owner's lock is
// free was left behind by a crash. No data is guarded by these locks, and no haptic thread takes or tests
// one.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>

namespace vps::scenes {

/// Who takes part in a session.
enum class NodeRole : unsigned char { Render, Device, Watch };

class SharedRegion {
 public:
  SharedRegion() = default;
  SharedRegion(SharedRegion&& other) noexcept;
  SharedRegion& operator=(SharedRegion&& other) noexcept;
  SharedRegion(const SharedRegion&) = delete;
  SharedRegion& operator=(const SharedRegion&) = delete;
  ~SharedRegion();

  /// A new region of zeros, which belongs to this process in the role of Render; readable and writable by
  /// this user only. A region of that name whose owner is dead is replaced. Throws LoadError where its owner
  /// is alive, or the system refuses.
  /// @param session  its name, for its own region; or that, a dot and another name
  static SharedRegion create(const std::string& session, std::size_t bytes);
  /// The region of a session; not open where there is none, or it is still being made. Throws LoadError for
  /// one that others could have written to.
  static SharedRegion open(const std::string& session, bool is_writable);

  [[nodiscard]] bool isOpen() const { return !memory_.empty(); }
  [[nodiscard]] std::span<std::byte> memory() const { return memory_; }

  /// Takes a role until the region is closed. False where another process has it.
  bool take(NodeRole role) const;
  /// Whether a process has the role.
  [[nodiscard]] bool isTaken(NodeRole role) const;
  /// Leaves a mark that this process watches, and counts the processes that do. It needs no right to write.
  void markWatcher() const;
  [[nodiscard]] std::size_t watchers() const;

  /// Removes the name; the memory stays for those who have it open.
  void removeName();

 private:
  SharedRegion(int file, std::span<std::byte> memory, std::string name)
      : file_(file), memory_(memory), name_(std::move(name)) {}

  int file_ = -1;
  std::span<std::byte> memory_;
  std::string name_;  ///< to be removed with this object; empty: another process does that
};

/// Removes the regions of this user whose owners are dead. Returns their number.
std::size_t removeDeadRegions();
/// Removes the region of a session if its owner is dead.
void removeIfDead(const std::string& session);

/// Throws LoadError for a name that cannot be a session's: letters, digits, - and _, at most 32.
void requireSessionName(const std::string& session);
/// "session 'demo'", for messages.
std::string sessionWords(const std::string& session);

}  // namespace vps::scenes
