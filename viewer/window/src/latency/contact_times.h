// SPDX-License-Identifier: BSD-3-Clause
// Finds the contacts of a measurement in what was recorded of it.
#pragma once

#include <vector>

#include "latency/tapping_handle.h"
#include "vps_viewer/export.h"
#include "vps_viewer/window/latency.h"

namespace vps::viewer {

/// What was recorded, each list in order of time. All times by device::monotonicSeconds().
struct LatencyLog {
  struct Step {
    double read_s = 0;  ///< of the handle
    double done_s = 0;
    double contact_N = 0;
  };
  struct Written {  ///< to the sound card
    double time_s = 0;
    float peak = 0;
    std::size_t gaps = 0;  ///< SoundOutput::gaps() so far
  };
  struct Heard {        ///< a period of the sound card
    double time_s = 0;  ///< at which its first sample is played
    std::vector<float> samples;
  };
  struct Picture {
    double begun_s = 0, done_s = 0;
    bool is_lit = false;
  };
  std::vector<DeviceTick> ticks;
  std::vector<Step> steps;
  std::vector<Written> written;
  std::vector<Heard> heard;
  std::vector<Picture> pictures;
  double rate_hz = 48000;  ///< of samples
};

/// The contacts that begin after from_s, each after at least 60 ms without one, so that the step of force,
/// the click and the flash are its own.
VPS_VIEWER_API std::vector<ContactTimes> findContacts(const LatencyLog& log, double from_s);

/// Times after from_s that the card had nothing to play, since samples came too late.
VPS_VIEWER_API std::size_t lateSamples(const LatencyLog& log, double from_s);
/// And since they were mixed too late.
VPS_VIEWER_API std::size_t lateMixes(const LatencyLog& log, double from_s);

}  // namespace vps::viewer
