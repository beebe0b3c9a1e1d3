// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/merged_log.h"

#include <optional>

namespace vps::scenes::inline v0 {

namespace {

/// How many ticks precede it; empty: it belongs to the tick before.
std::optional<std::int32_t> ticksBefore(const device::LogEntry& entry) {
  const auto* event = std::get_if<device::SyncEvent>(&entry);
  if (event == nullptr) return {};
  return event->kind == device::SyncEventKind::Tick ? event->tick - 1 : event->tick;
}

}  // namespace

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
  if (number != next_) return lose(number - next_);
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

// A tick is complete once what follows it has come: the next tick, or an event between two.
bool MergedLog::passUntil(const Tick& until) {
  for (; !loop_.empty(); passLoopEntry())
    if (const auto ticks = ticksBefore(loop_.front()); ticks && *ticks >= until.tick) return true;
  return false;
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

void MergedLog::passLoopEntry() {
  log_.add(loop_.front());
  loop_.pop_front();
}

}  // namespace vps::scenes::inline v0
