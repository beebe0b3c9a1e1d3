// SPDX-License-Identifier: BSD-3-Clause
#include "run/presentation.h"

#include <algorithm>

namespace vps::viewer {

namespace {

constexpr std::size_t kMostWaiting = 64;  // a second, several times of what waits

}  // namespace

void Presentation::add(scenes::Snapshot shot, std::int64_t taken_ns, std::int64_t now_ns) {
  taken_ns = std::min(taken_ns, now_ns);
  if (!waiting_.empty()) taken_ns = std::max(taken_ns, waiting_.back().taken_ns);  // their order stays
  late_ += taken_ns + after_ns_ < now_ns;
  if (waiting_.size() >= kMostWaiting) waiting_.pop_front();
  waiting_.push_back({std::move(shot), taken_ns});
}

}  // namespace vps::viewer
