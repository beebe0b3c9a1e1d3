// SPDX-License-Identifier: BSD-3-Clause
// Finds the contacts in the log of a latency measurement.
#pragma once

#include <vector>

#include "latency/tapping_handle.h"
#include "vps_viewer/export.h"
#include "vps_viewer/window/latency.h"

namespace vps::viewer {

/// Log of a measurement. Each list is sorted by time; all times are by device::monotonicSeconds().
struct LatencyLog {
  struct Step {
    double read_s = 0;  ///< reading of the handle that the step used
    double done_s = 0;
    double contact_N = 0;
  };
  struct Written {  ///< samples written to the sound card
    double time_s = 0;
    float peak = 0;
    std::size_t gaps = 0;  ///< SoundOutput::gaps() so far
  };
  struct Heard {        ///< a period of the sound card
    double time_s = 0;  ///< time at which the first sample is played
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
  double rate_hz = 48000;  ///< sampling rate
};

/// The contacts that begin after from_s and follow at least 60 ms without contact, so that the force step,
/// the click and the flash belong to this contact.
VPS_VIEWER_API std::vector<ContactTimes> findContacts(const LatencyLog& log, double from_s);

/// Number of gaps after from_s in which the card had nothing to play because samples were written too late.
VPS_VIEWER_API std::size_t lateSamples(const LatencyLog& log, double from_s);
/// Number of gaps after from_s in which the card had nothing to play because the mixer ran too late.
VPS_VIEWER_API std::size_t lateMixes(const LatencyLog& log, double from_s);

}  // namespace vps::viewer
