// SPDX-License-Identifier: BSD-3-Clause
// Work in forked copies of this process: a reader whose library may crash, and results that are computed on
// all cores by a library that is not known to be safe in threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "import/readers.h"

namespace vps::scenes::import {

/// Runs read() in a child process and returns its result, bit for bit. The child's progress is passed to
/// `progress` in this process and thread, and its LoadError is thrown here in the same words. If the child
/// ends without a result, throws LoadError "<file>: <library> crashed while reading it; ...". `progress` is
/// called five times a second, so that it can end the child by an exception however long a library computes;
/// the child ignores Ctrl-C, which is for this process. A child that exceeds the settings' limits of memory
/// and time is ended, and a LoadError names the limit. Other effects of read() on memory stay in the child.
/// Without ImportSettings::in_own_process, without fork(), and under AddressSanitizer in a program with
/// threads, runs read() in this process.
///
/// The child is a fork of this process with the calling thread alone. For a program with more threads POSIX
/// promises little, but with glibc malloc and stdio work in the child. Malloc and stdio suffice if `read`
/// starts no threads and no other thread of this process uses the same library, whose locks would stay
/// locked. Cost in addition to read(): a fork (about 1 ms for each 100 MB of this process) and one copy of
/// the parts.
RawCad inOwnProcess(const std::string& file, const std::string& library, const ImportSettings& limits,
                    const Progress& progress, const std::function<RawCad(const Progress&)>& read);

/// Whether a fork of this process can compute. AddressSanitizer's malloc, unlike glibc's, does not work in
/// the fork of a program with threads: a lock that one of the threads held stays locked (GCC 12: the child
/// hangs).
bool mayFork();

/// Calls make(order[0]), make(order[1]) and so on in as many forked copies of this process as there are
/// cores. Element i of the result is what make(i) returned, byte for byte. `order` names each of 0 to n - 1
/// once; a copy that is free takes the next index. `done` is called in this process after each result. A
/// result that a copy does not return, since the copy crashed or make() threw in it, is made in this process,
/// so that the error appears as without copies. All results are made in this process where mayFork() is
/// false, for one copy, and for one result.
/// @param copies  0: as many as there are cores
/// @param look    called in this process several times a second while the copies compute; may throw, which
/// ends them
///
/// Meant for a library that is not known to be safe in threads, within a process that may start no threads:
/// the child that reads a file. The copies end with this process.
std::vector<std::string> madeInCopies(const std::vector<std::size_t>& order,
                                      const std::function<std::string(std::size_t)>& make,
                                      const std::function<void()>& done, std::size_t copies = 0,
                                      const std::function<void()>& look = {});

/// The number of this process, which differs in a fork; 0 without fork().
long processNumber();

/// A number that this process and its later forks share.
class SharedCounter {
 public:
  SharedCounter();
  ~SharedCounter();
  SharedCounter(const SharedCounter&) = delete;
  SharedCounter& operator=(const SharedCounter&) = delete;

  /// Adds to the number and returns its value before.
  std::size_t add(std::size_t count);
  [[nodiscard]] std::size_t value() const;
  /// Whether forks share the number; false where memory is short, and without fork().
  [[nodiscard]] bool isShared() const { return memory_ != nullptr; }

 private:
  using Counter = std::atomic<std::size_t>;
  static_assert(Counter::is_always_lock_free);  // a counter with a lock would not work across processes
  void* memory_ = nullptr;                      // of the process and its forks
  Counter own_ = 0;                             // used without shared memory
  Counter* counter_ = &own_;
};

}  // namespace vps::scenes::import
