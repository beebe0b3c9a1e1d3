// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/merged_log.h"

namespace vps::scenes {

void MergedLog::add(const device::LogEntry& entry) noexcept {
  if (is_over_) return;
  if (waiting_.empty())
    log_.add(entry);
  else
    waiting_.emplace_back(entry);
}

void MergedLog::lose(std::uint64_t count) noexcept {
  log_.lose(count);
  is_over_ = true;
  waiting_.clear();
  loop_.clear();
}

void MergedLog::addFromLoop(std::uint32_t number, const device::LogEntry& entry) {
  if (is_over_) return;
  const auto missing =
      static_cast<std::int32_t>(number - next_);  // the difference is right even when the numbers wrap around
  if (missing != 0)
    return lose(missing > 0 ? static_cast<std::uint64_t>(missing) : 1);  // else the entry came twice
  ++next_;
  loop_.push_back(entry);
  pass();
}

void MergedLog::pass() {
  const auto is_done = [this](const auto& item) { return passUntil(item); };
  while (!waiting_.empty() && std::visit(is_done, waiting_.front())) waiting_.pop_front();
}

bool MergedLog::passUntil(const device::LogEntry& entry) {
  log_.add(entry);
  return true;
}

bool MergedLog::passUntil(const Tick& until) {
  while (complete_ < until.tick) {
    if (loop_.empty()) return false;
    passLoopEntry();
  }
  return true;
}

bool MergedLog::passUntil(const Event& until) {
  while (!loop_.empty()) {
    const auto* event = std::get_if<device::SyncEvent>(&loop_.front());
    const bool is_last = event != nullptr && event->kind == until.kind;
    passLoopEntry();
    if (is_last) return true;
  }
  return false;
}

// The last entry of a tick is the wrench that the tick writes. A command may read the device between two
// ticks.
void MergedLog::passLoopEntry() {
  if (const auto* event = std::get_if<device::SyncEvent>(&loop_.front());
      event != nullptr && event->kind == device::SyncEventKind::Tick)
    ticking_ = event->tick;
  else if (std::holds_alternative<device::WrittenWrench>(loop_.front()))
    complete_ = ticking_;
  log_.add(loop_.front());
  loop_.pop_front();
}

}  // namespace vps::scenes
