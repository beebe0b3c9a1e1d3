// SPDX-License-Identifier: BSD-3-Clause
// Writes samples as a WAV file. Source: [Microsoft and IBM, "Multimedia Programming Interface", 1991].
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "vps_viewer/sound/sound.h"

namespace vps::viewer {
namespace {

constexpr double kPeak = 0.708, kBeepLevel = 0.1;  // -3 dB, -20 dB
constexpr int kBytesPerSample = 2;

void append(std::string& bytes, std::uint32_t value, int count) {
  for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);  // low byte first
}

std::string header(std::size_t samples, int rate_hz) {
  const auto data = static_cast<std::uint32_t>(samples * kBytesPerSample);
  std::string bytes = "RIFF";
  append(bytes, 36 + data, 4);
  bytes += "WAVEfmt ";
  append(bytes, 16, 4);
  append(bytes, 1, 2);  // format: integers
  append(bytes, 1, 2);  // number of channels
  append(bytes, static_cast<std::uint32_t>(rate_hz), 4);
  append(bytes, static_cast<std::uint32_t>(rate_hz * kBytesPerSample), 4);
  append(bytes, kBytesPerSample, 2);
  append(bytes, 8 * kBytesPerSample, 2);
  bytes += "data";
  append(bytes, data, 4);
  return bytes;
}

}  // namespace

std::string wavBytes(const RunSound::Samples& samples, int rate_hz, double* full_scale_Pa) {
  float most_Pa = 0;
  for (const float p : samples.pressure_Pa) most_Pa = std::max(most_Pa, std::abs(p));
  const double scale = most_Pa > 0 ? kPeak / static_cast<double>(most_Pa) : 0;
  if (full_scale_Pa != nullptr) *full_scale_Pa = scale > 0 ? 1 / scale : 0;
  std::string bytes = header(samples.pressure_Pa.size(), rate_hz);
  for (std::size_t i = 0; i < samples.pressure_Pa.size(); ++i) {
    const double beep = i < samples.beeps.size() ? static_cast<double>(samples.beeps[i]) : 0;
    const double value =
        std::clamp(scale * static_cast<double>(samples.pressure_Pa[i]) + kBeepLevel * beep, -1.0, 1.0);
    append(bytes, static_cast<std::uint32_t>(std::lround(32767 * value)), kBytesPerSample);
  }
  return bytes;
}

}  // namespace vps::viewer
