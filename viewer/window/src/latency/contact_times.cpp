// SPDX-License-Identifier: BSD-3-Clause
#include "latency/contact_times.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace vps::viewer {
namespace {

constexpr double kApartContacts_s = 0.06;  // assumed: bounces of a part are shorter
constexpr double kLongest_s = 0.3;         // a later event does not belong to the contact
constexpr double kBefore_s = 0.05;         // force and sound without contact are those from kBefore_s ...
constexpr double kNear_s = 5e-3;           // ... to kNear_s before the contact
constexpr double kForceStep_N = 0.5;       // assumed: a person feels such a step
constexpr float kClick = 4;                // a click is this much louder than the peak before the contact
constexpr float kSilence = 1e-5F;          // share of full scale: -100 dB

template <class List, class TimeOf>
auto firstAt(const List& list, double time_s, TimeOf timeOf) {
  return std::partition_point(list.begin(), list.end(),
                              [&](const auto& entry) { return timeOf(entry) < time_s; });
}

double forceStep(const LatencyLog& log, double read_s) {
  const auto read = [](const DeviceTick& tick) { return tick.read_s; };
  Vec3 mean = Vec3::Zero();
  int count = 0;
  for (auto tick = firstAt(log.ticks, read_s - kBefore_s, read);
       tick != log.ticks.end() && tick->read_s < read_s - kNear_s; ++tick, ++count)
    mean += tick->f_Ho_D;
  if (count == 0) return -1;
  mean /= count;
  for (auto tick = firstAt(log.ticks, read_s, read);
       tick != log.ticks.end() && tick->read_s < read_s + kLongest_s; ++tick)
    if ((tick->f_Ho_D - mean).norm() > kForceStep_N) return tick->written_s - read_s;
  return -1;
}

double clickWritten(const LatencyLog& log, double read_s) {
  const auto time = [](const LatencyLog::Written& written) { return written.time_s; };
  float before = kSilence;
  auto at = firstAt(log.written, read_s - kBefore_s, time);
  for (; at != log.written.end() && at->time_s < read_s; ++at) before = std::max(before, at->peak);
  for (; at != log.written.end() && at->time_s < read_s + kLongest_s; ++at)
    if (at->peak > kClick * before) return at->time_s - read_s;
  return -1;
}

double clickHeard(const LatencyLog& log, double read_s) {
  const auto time = [](const LatencyLog::Heard& heard) { return heard.time_s; };
  float before = kSilence;
  for (auto heard = firstAt(log.heard, read_s - kBefore_s, time);
       heard != log.heard.end() && heard->time_s < read_s + kLongest_s; ++heard)
    for (std::size_t i = 0; i < heard->samples.size(); ++i) {
      const double time_s = heard->time_s + static_cast<double>(i) / log.rate_hz;
      const float size = std::abs(heard->samples[i]);
      if (time_s < read_s)
        before = std::max(before, size);
      else if (size > kClick * before)
        return time_s - read_s;
    }
  return -1;
}

void findFlash(const LatencyLog& log, double read_s, ContactTimes& times) {
  const auto done = [](const LatencyLog::Picture& picture) { return picture.done_s; };
  for (auto picture = firstAt(log.pictures, read_s + times.found_s, done);
       picture != log.pictures.end() && picture->done_s < read_s + kLongest_s; ++picture) {
    if (!picture->is_lit) continue;
    times.drawing_s = picture->begun_s - read_s;
    times.picture_s = picture->done_s - read_s;
    return;
  }
}

}  // namespace

double ContactTimes::apart_s(bool has_sound) const {
  double first_s = std::min(force_s, picture_s), last_s = std::max(force_s, picture_s);
  if (has_sound) {
    first_s = std::min(first_s, sound_s);
    last_s = std::max(last_s, sound_s);
  }
  return first_s < 0 ? -1 : last_s - first_s;
}

const std::vector<LatencyStage>& latencyStages() {
  static const std::vector<LatencyStage> kStages = {
      {"found", "physics: end of the step with the contact", &ContactTimes::found_s},
      {"force", "force: wrench written to the device", &ContactTimes::force_s},
      {"sound_written", "sound: sample given to the card", &ContactTimes::sound_written_s, true},
      {"sound", "sound: sample played", &ContactTimes::sound_s, true},
      {"drawing", "picture: drawing begins", &ContactTimes::drawing_s},
      {"picture", "picture: drawn and read back", &ContactTimes::picture_s}};
  return kStages;
}

std::vector<double> LatencyResult::apart_s() const {
  std::vector<double> all_s;
  for (const ContactTimes& times : contacts) all_s.push_back(times.apart_s(hasSound()));
  return all_s;
}

bool LatencyResult::isGood() const {
  const std::vector<double> all_s = apart_s();
  return std::ranges::all_of(all_s, [](double value) { return value >= 0; }) &&
         percentile(all_s, 0.99) <= kApart_s;
}

double percentile(std::vector<double> values, double share) {
  std::erase_if(values, [](double value) { return !(value >= 0); });
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  return values[std::clamp<std::size_t>(rank, 1, values.size()) - 1];
}

std::size_t lateSamples(const LatencyLog& log, double from_s) {
  if (log.written.empty()) return 0;
  const auto at = firstAt(log.written, from_s, [](const LatencyLog::Written& one) { return one.time_s; });
  return log.written.back().gaps - (at != log.written.begin() ? std::prev(at)->gaps : 0);
}

std::size_t lateMixes(const LatencyLog& log, double from_s) {
  std::size_t gaps = 0;
  constexpr double kRounding_s = 1e-6;
  for (std::size_t i = 1; i < log.heard.size(); ++i) {
    const LatencyLog::Heard& before = log.heard[i - 1];
    const double end_s = before.time_s + static_cast<double>(before.samples.size()) / log.rate_hz;
    if (before.time_s >= from_s && log.heard[i].time_s > end_s + kRounding_s) ++gaps;
  }
  return gaps;
}

std::vector<ContactTimes> findContacts(const LatencyLog& log, double from_s) {
  std::vector<ContactTimes> contacts;
  double touched_s = -1;
  for (const LatencyLog::Step& step : log.steps) {
    if (!(step.contact_N > 0)) continue;
    const bool is_new = step.done_s > touched_s + kApartContacts_s;
    touched_s = step.done_s;
    if (!is_new || step.read_s < from_s) continue;
    ContactTimes& times = contacts.emplace_back();
    times.found_s = step.done_s - step.read_s;
    times.force_s = forceStep(log, step.read_s);
    times.sound_written_s = clickWritten(log, step.read_s);
    times.sound_s = clickHeard(log, step.read_s);
    findFlash(log, step.read_s, times);
  }
  return contacts;
}

}  // namespace vps::viewer
