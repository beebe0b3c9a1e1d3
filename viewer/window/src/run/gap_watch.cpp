// SPDX-License-Identifier: BSD-3-Clause
#include "run/gap_watch.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include "vps_scenes/fits/check.h"

namespace vps::viewer {
namespace {

std::string describe(const std::string& other, const scenes::CheckedPair& pair) {
  char words[80];
  switch (pair.state) {
    case scenes::PairState::Apart:
      std::snprintf(words, sizeof words, ": %.4g µm apart", pair.clearance_m * 1e6);
      break;
    case scenes::PairState::Contact:
      std::snprintf(words, sizeof words, ": contact");
      break;
    case scenes::PairState::PressFit:
    case scenes::PairState::Thread:
    case scenes::PairState::Seal:
    case scenes::PairState::Insert:
    case scenes::PairState::Clash:
      std::snprintf(words, sizeof words, ": %s, %.4g µm deep", toText(pair.state),
                    pair.interference_depth_m * 1e6);
      break;
  }
  return other + words;
}

}  // namespace

GapWatch::GapWatch(const scenes::Scene& scene, std::function<void()> on_news)
    : scene_(scene), on_news_(std::move(on_news)) {}

GapWatch::~GapWatch() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void GapWatch::request(const scenes::Snapshot& shot, std::vector<std::size_t> parts) {
  if (parts.empty()) return;
  {
    const std::lock_guard lock(mutex_);
    Request wanted = {shot, std::move(parts)};
    if (last_ && isSame(*last_, wanted)) return;
    last_ = wanted_ = std::move(wanted);
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
  }
  wake_.notify_one();
}

bool GapWatch::isSame(const Request& a, const Request& b) {
  const auto same_body = [](const scenes::BodySnapshot& x, const scenes::BodySnapshot& y) {
    return x.part == y.part && x.role == y.role && x.X_WP.R == y.X_WP.R && x.X_WP.p == y.X_WP.p;
  };
  return a.parts == b.parts && a.shot.time_s == b.shot.time_s &&
         a.shot.contacts.size() == b.shot.contacts.size() &&
         std::ranges::equal(a.shot.bodies, b.shot.bodies, same_body);
}

std::optional<MeasuredGaps> GapWatch::of(std::size_t part) const {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(measured_, part, &MeasuredGaps::part);
  if (found == measured_.end()) return {};
  return *found;
}

void GapWatch::run() {
  constexpr auto kLeastPause = std::chrono::milliseconds(50);
  const scenes::PartGaps gaps(scene_);
  std::unique_lock lock(mutex_);
  while (!is_ending_) {
    wake_.wait(lock, [this] { return is_ending_ || wanted_; });
    if (is_ending_) return;
    const Request asked = *std::exchange(wanted_, std::nullopt);
    lock.unlock();
    const std::vector<scenes::PartTouch> touches = gaps.touches(asked.shot);
    std::vector<MeasuredGaps> measured;
    for (const std::size_t part : asked.parts) {
      MeasuredGaps of_part{part, asked.shot.time_s, gaps.of(part, asked.shot, kMost_m), {}};
      for (const scenes::PartTouch& touch : touches)
        if (touch.a == part || touch.b == part) of_part.touches.push_back(touch);
      measured.push_back(std::move(of_part));
    }
    lock.lock();
    measured_ = std::move(measured);
    if (on_news_) {
      lock.unlock();
      on_news_();
      lock.lock();
    }
    wake_.wait_for(lock, kLeastPause, [this] { return is_ending_; });
  }
}

std::vector<std::string> gapLines(const scenes::Scene& scene, const MeasuredGaps& measured) {
  std::vector<std::string> lines;
  char words[80];
  const auto touchOf = [&](std::size_t other) {
    return std::ranges::find_if(measured.touches,
                                [other](const scenes::PartTouch& t) { return t.a == other || t.b == other; });
  };
  for (const scenes::PartGap& gap : measured.gaps) {
    if (const auto touch = touchOf(gap.other); touch != measured.touches.end())
      std::snprintf(words, sizeof words, ": touches this part, %.3g N", touch->force_N);
    else if (gap.distance_m > 0)
      std::snprintf(words, sizeof words, ": %.4g µm away", gap.distance_m * 1e6);
    else
      std::snprintf(words, sizeof words, ": contact");
    lines.push_back(scene.parts[gap.other].part.name + words);
  }
  if (lines.empty()) lines.push_back("nothing within 1 mm");
  return lines;
}

std::vector<std::string> Neighbours::of(const std::string& part) {
  if (!checked_.valid())
    checked_ = std::async(std::launch::async, [this] {
                 scenes::CheckSettings settings;
                 settings.has_fits = settings.has_play = false;
                 return scenes::checkAssembly(scene_.name, scenes::drawnParts(scene_), settings);
               }).share();
  if (checked_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return {"measuring ..."};
  std::vector<std::string> lines;
  try {
    for (const scenes::CheckedPair& pair : checked_.get().pairs) {
      if (pair.a == part) lines.push_back(describe(pair.b, pair));
      if (pair.b == part) lines.push_back(describe(pair.a, pair));
    }
  } catch (const std::exception& error) {
    return {std::string("not measured: ") + error.what()};
  }
  if (lines.empty()) lines.push_back("nothing within 1 mm");
  return lines;
}

}  // namespace vps::viewer
