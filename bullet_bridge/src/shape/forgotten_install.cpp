// SPDX-License-Identifier: BSD-3-Clause
#include "shape/forgotten_install.h"

#include <atomic>

#include "log/report.h"

namespace vps::bullet {

namespace {

std::atomic<bool> g_is_installed{false};
std::atomic<int> g_boxes{0};

}  // namespace

void setContactInstalled() {
  g_is_installed = true;
}

bool isContactInstalled() {
  return g_is_installed.load(std::memory_order_relaxed);
}

void warnOfForgottenInstall() {
  // A body asks once when it is added and then once in each step. assumed: a world of one part that is
  // stepped a hundredth of a second.
  constexpr int kBoxes = 12;
  if (++g_boxes != kBoxes) return;
  report(LogLevel::Error,
         "a bullet::Shape is in a world, and install() was not called for any dispatcher: it collides with "
         "nothing, or as a mesh that Bullet does not support. Call vps::bullet::install(dispatcher) before "
         "the first step");
}

}  // namespace vps::bullet
