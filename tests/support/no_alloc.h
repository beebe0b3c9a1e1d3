// SPDX-License-Identifier: BSD-3-Clause
// Proves that a stretch of code neither allocates nor frees: malloc's family is overridden in the test
// programs.
#pragma once

#include <cstddef>

namespace vps_test {

/// While it lives, every allocation and release of this thread (new, malloc and their kin) is counted; its
/// destructor adds a test failure when there was one. VPS_NO_ALLOC_ABORT=1 in the environment aborts at the
/// first instead, so that a debugger shows who it was. Scopes nest. Under AddressSanitizer and
/// ThreadSanitizer, which own malloc, only operator new and delete are seen.
class NoAllocScope {
 public:
  NoAllocScope() noexcept;
  ~NoAllocScope();
  NoAllocScope(const NoAllocScope&) = delete;
  NoAllocScope& operator=(const NoAllocScope&) = delete;

  /// Allocations and releases since the scope began.
  [[nodiscard]] std::size_t count() const noexcept;

 private:
  std::size_t count_before_;
};

}  // namespace vps_test
