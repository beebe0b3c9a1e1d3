// SPDX-License-Identifier: BSD-3-Clause
#include "output/progress_bar.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "output/terminal.h"

namespace vps::viewer {

namespace {

/// "42 %: " ; nothing where the share is not known.
std::string inWords(double share) {
  if (!std::isfinite(share)) return {};
  return std::to_string(static_cast<int>(100 * std::clamp(share, 0.0, 1.0))).append(" %: ");
}

}  // namespace

ProgressBar::ProgressBar() : is_on_(isTerminal()), begun_(Clock::now()), drawn_(begun_) {}

void ProgressBar::show(std::string_view doing, double share) {
  throwIfStopped();
  const auto now = Clock::now();
  if (!is_on_) {
    constexpr auto kSayEvery = std::chrono::seconds(10);
    if (now - drawn_ < kSayEvery) return;
    drawn_ = now;
    say(inWords(share) + std::string(doing));
    return;
  }
  // At most ten times a second.
  if (now - begun_ < std::chrono::seconds(1) || (is_drawn_ && now - drawn_ < std::chrono::milliseconds(100)))
    return;
  drawn_ = now;
  is_drawn_ = true;
  constexpr int kWidth = 30;
  constexpr std::size_t kWords = 40;
  share = std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0;
  const int filled = static_cast<int>(share * kWidth);
  const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                          std::string(static_cast<std::size_t>(kWidth - filled), '.');
  std::fprintf(stderr, "\r\033[K[%s] %3d %% %.*s", bar.c_str(), static_cast<int>(100 * share),
               static_cast<int>(std::min(doing.size(), kWords)), doing.data());
  std::fflush(stderr);
}

void ProgressBar::clear() {
  if (is_drawn_) std::fputs("\r\033[K", stderr);
  is_drawn_ = false;
}

}  // namespace vps::viewer
