// SPDX-License-Identifier: BSD-3-Clause
// Passes Open CASCADE's progress on, and ends its work when the callback throws.
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <mutex>
#include <utility>

#include <Message_ProgressIndicator.hxx>
#include <Message_ProgressRange.hxx>
#include <Message_ProgressScope.hxx>

namespace vps::scenes::import {

/// Give `indicator->Start()` to an algorithm of Open CASCADE, then call rethrow(). Exceptions of the callback
/// do not pass through Open CASCADE's frames: the algorithm is asked to break off, and rethrow() throws.
class OcctProgress : public Message_ProgressIndicator {
 public:
  /// @param tell  called with the share done, 0 to 1; may throw
  explicit OcctProgress(std::function<void(double)> tell) : tell_(std::move(tell)) {}

  void rethrow() const {
    if (stop_) std::rethrow_exception(stop_);
  }

 protected:
  Standard_Boolean UserBreak() override {
    call();
    return is_stopped_;
  }
  /// Called under the indicator's lock, also on Open CASCADE's own threads.
  void Show(const Message_ProgressScope&, const Standard_Boolean) override { call(); }

 private:
  void call() {
    // Open CASCADE asks UserBreak() without a lock, on any of its threads.
    const std::lock_guard lock(calling_);
    const auto now = std::chrono::steady_clock::now();
    if (is_stopped_ || !tell_ || now - told_ < std::chrono::milliseconds(20)) return;
    told_ = now;
    try {
      tell_(GetPosition());
    } catch (...) {
      stop_ = std::current_exception();
      is_stopped_ = true;
    }
  }

  std::function<void(double)> tell_;
  std::exception_ptr stop_;
  std::atomic<bool> is_stopped_ = false;
  std::chrono::steady_clock::time_point told_ = {};
  std::mutex calling_;
};

}  // namespace vps::scenes::import
