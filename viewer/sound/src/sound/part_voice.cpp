// SPDX-License-Identifier: BSD-3-Clause
#include "sound/part_voice.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace vps::viewer {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kAir_kg_m3 = 1.204, kSound_m_s = 343.2;  // at 20 degrees

// Amplitudes decay as exp(-d t), d = (a + b w^2) / 2. assumed: steel on a bench or in a hand, about a tenth
// of a second; a part that hangs free rings ten times as long
constexpr double kDampingLow_per_s = 40, kDampingHigh_s = 3e-8;

/// Share of the power of a flat piston that a body of this size radiates: little where it is small beside the
/// wave. Source: the pulsating sphere, Kinsler et al., "Fundamentals of Acoustics", 2000, section 7.5.
double radiated(double omega, double surface_m2) {
  const double ka = omega / kSound_m_s * std::sqrt(surface_m2 / (4 * kPi));
  return ka * ka / (1 + ka * ka);
}

}  // namespace

PartVoice::PartVoice(BodyModes modes, double volume_m3, double mass_kg, int rate_hz, double distance_m)
    : modes_(std::move(modes)), mass_kg_(mass_kg), rate_hz_(rate_hz) {
  const double T = 1.0 / rate_hz;
  for (std::size_t i = 0; i < modes_.frequency_hz.size(); ++i) {
    const double w = 2 * kPi * modes_.frequency_hz[i];
    const double d = 0.5 * (kDampingLow_per_s + kDampingHigh_s * w * w);
    const double damped = std::sqrt(std::max(0.0, w * w - d * d));
    Resonator r;
    r.a1 = 2 * std::exp(-d * T) * std::cos(damped * T);
    r.a2 = std::exp(-2 * d * T);
    r.b = T * std::exp(-d * T) * std::sin(damped * T) / std::max(damped, 1e-9);  // of an impulse f T
    // The power of a vibrating surface, spread over a sphere around it.
    const double power =
        radiated(w, modes_.surface_m2) * modes_.surface_m2 * std::pow(modes_.normal_rms[i], 2);
    r.gain = kAir_kg_m3 * kSound_m_s * std::sqrt(power / (4 * kPi)) / distance_m;
    resonators_.push_back(r);
  }
  // A sphere that is accelerated pushes air aside: p = rho a^3 / (2 c r) dA/dt along its way.
  // Source: Koss and Alfredson, J. Sound Vib. 27, 1973, for a << wave.
  click_Pa_s_per_N_ = kAir_kg_m3 * 3 * volume_m3 / (4 * kPi) / (2 * kSound_m_s * distance_m * mass_kg);
  quiet_after_ = rate_hz;  // assumed: a second after the last force; by then -170 dB
  quiet_samples_ = quiet_after_ + 1;
}

Touch PartVoice::touch(const Vec3& p_P, const Vec3& n_P) const {
  Touch touch;
  if (modes_.frequency_hz.empty()) return touch;
  for (const Vec3& shape : modes_.shapesAt(p_P)) touch.drive.push_back(shape.dot(n_P));
  return touch;
}

void PartVoice::push(const Touch& touch, double force_N) {
  for (std::size_t i = 0; i < std::min(touch.drive.size(), resonators_.size()); ++i)
    resonators_[i].force += touch.drive[i] * force_N;
  force_N_ += force_N;
  quiet_samples_ = 0;
}

double PartVoice::next() {
  if (isQuiet()) return 0;
  double pressure_Pa = click_Pa_s_per_N_ * (force_N_ - force_before_N_) * rate_hz_;
  for (Resonator& r : resonators_) {
    const double q = r.a1 * r.q1 - r.a2 * r.q2 + r.b * r.force;
    pressure_Pa += r.gain * (q - r.q1) * rate_hz_;
    r.q2 = std::exchange(r.q1, q);
    r.force = 0;
  }
  force_before_N_ = std::exchange(force_N_, 0);
  ++quiet_samples_;
  return pressure_Pa;
}

}  // namespace vps::viewer
