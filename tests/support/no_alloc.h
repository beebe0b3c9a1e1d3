// SPDX-License-Identifier: BSD-3-Clause
// Checks that a section of code neither allocates nor frees memory: the test programs override malloc and
// related functions.
#pragma once

#include <cstddef>

namespace vps_test {

/// Counts every allocation and release of this thread (new, malloc and related functions) while the scope
/// exists; its destructor adds a test failure if there was an allocation or release. With
/// VPS_NO_ALLOC_ABORT=1 in the environment the program aborts at the first allocation or release instead, so
/// that a debugger shows the caller. Scopes may be nested. Under AddressSanitizer and ThreadSanitizer, which
/// replace malloc, only operator new and delete are counted.
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
