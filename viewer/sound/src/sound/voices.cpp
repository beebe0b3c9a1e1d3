// SPDX-License-Identifier: BSD-3-Clause
#include "sound/voices.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>

#include "vps/solid.h"
#include "vps/voxmap.h"
#include "vps_scenes/scene/scene_parts.h"

namespace vps::viewer {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kAir_kg_m3 = 1.204, kSound_m_s = 343.2;  // air at 20 degrees Celsius

// Amplitudes decay as exp(-d t), d = (a + b w^2) / 2. assumed: a steel part on a bench or in a hand rings for
// about a tenth of a second; a freely suspended part would ring ten times as long.
constexpr double kDampingLow_per_s = 40, kDampingHigh_s = 3e-8;

/// Radiated power of a body as a share of a flat piston's power. The share is small if the body is small
/// compared to the wavelength. Source: pulsating sphere, Kinsler et al., "Fundamentals of Acoustics", 2000,
/// section 7.5.
double radiated(double omega, double surface_m2) {
  const double ka = omega / kSound_m_s * std::sqrt(surface_m2 / (4 * kPi));
  return ka * ka / (1 + ka * ka);
}

// Radius of curvature at the contact. assumed: edges and fillets of a part.
constexpr double kCurvature_m = 5e-3;

using IsInside = std::function<bool(const Vec3& p_P)>;

/// Inside test of a part, by the part's voxmap. If the part has no voxmap, or only a voxmap of some regions,
/// a map is built here: for the millions of tests, a solid takes ten times as long as a map and its
/// construction. Only for walls that are thin compared to the map's voxels the solid is used.
IsInside insideOf(const scenes::ScenePart& part, double volume_m3) {
  // About as fine as the samples of bricks, with ten bricks across a part.
  constexpr double kVoxelsAcross = 250;
  constexpr double kVoxelsInWall = 3;
  if (part.model && part.model->map && !part.is_cropped)
    return [map = part.model->map](const Vec3& p_P) { return map->isInsideCoarse(p_P); };
  const Mesh& mesh = part.part.mesh;
  const double voxel_m = bounds(mesh).size().maxCoeff() / kVoxelsAcross, wall_m = 2 * volume_m3 / area(mesh);
  if (!(wall_m > kVoxelsInWall * voxel_m))
    return [solid = std::make_shared<const Solid>(mesh, part.part.name)](const Vec3& p_P) {
      return solid->isInside(p_P);
    };
  VoxMapSettings settings;
  settings.voxel_m = voxel_m;
  return [map = buildVoxMap(mesh, settings, part.part.name)](const Vec3& p_P) {
    return map.isInsideCoarse(p_P);
  };
}

constexpr double kBeep_s = 0.09, kPause_s = 0.06, kRamp_s = 0.005;
constexpr std::size_t kMost = 6;

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
    r.b = T * std::exp(-d * T) * std::sin(damped * T) / std::max(damped, 1e-9);  // response to an impulse f T
    // The radiated power is spread over a sphere around the part.
    const double power =
        radiated(w, modes_.surface_m2) * modes_.surface_m2 * std::pow(modes_.normal_rms[i], 2);
    r.gain = kAir_kg_m3 * kSound_m_s * std::sqrt(power / (4 * kPi)) / distance_m;
    resonators_.push_back(r);
  }
  // An accelerated sphere of radius a displaces air: p = rho a^3 / (2 c r) dA/dt in the direction of its
  // acceleration A. Source: Koss and Alfredson, J. Sound Vib. 27, 1973, for a << wave.
  click_Pa_s_per_N_ = kAir_kg_m3 * 3 * volume_m3 / (4 * kPi) / (2 * kSound_m_s * distance_m * mass_kg);
  quiet_after_ = rate_hz;  // assumed: a second after the last force, when the sound has decayed by 170 dB
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

double planeStrain_Pa(const scenes::ScenePart& part) {
  return 0.5 * part.youngs_modulus_Pa / (1 - part.poissons_ratio * part.poissons_ratio);
}

double impactDuration_s(double mass_kg, double plane_strain_Pa, double speed_m_s) {
  const double v = std::max(speed_m_s, 1e-4);
  return 2.87 * std::pow(mass_kg * mass_kg / (kCurvature_m * plane_strain_Pa * plane_strain_Pa * v), 0.2);
}

double Impact::force_N(long sample, double rate_hz) const {
  constexpr double kHalfTurn = std::numbers::pi;
  const double from = static_cast<double>(sample - start), to = std::min(from + 1, length);
  if (from >= length) return 0;
  const double share = 0.5 * (std::cos(kHalfTurn * from / length) - std::cos(kHalfTurn * to / length));
  return impulse_Ns * share * rate_hz;
}

PartVoice partVoice(const scenes::ScenePart& part, const SoundSettings& settings) {
  const Material& material = part.part.material;
  const double volume_m3 = std::max(1e-12, std::abs(scenes::partMass(part).volume_m3));
  BodyModes modes;
  if (settings.has_rings) {
    modes = findModes(part.part.mesh, insideOf(part, volume_m3), material.density_kg_m3,
                      {part.youngs_modulus_Pa, part.poissons_ratio});
  }
  return {std::move(modes), volume_m3, volume_m3 * material.density_kg_m3, settings.rate_hz,
          settings.distance_m};
}

void Beeper::add(device::Beep beep) {
  if (std::find(pitches_hz_.begin(), pitches_hz_.end(), beep.pitch_hz) != pitches_hz_.end()) return;
  for (int i = 0; i < beep.count && pitches_hz_.size() < kMost; ++i) pitches_hz_.push_back(beep.pitch_hz);
}

double Beeper::next() {
  if (pitches_hz_.empty()) return 0;
  const double t_s = static_cast<double>(at_++) / rate_hz_, pitch_hz = pitches_hz_.front();
  if (t_s >= kBeep_s + kPause_s) {
    pitches_hz_.pop_front();
    at_ = 0;
    return 0;
  }
  if (t_s >= kBeep_s) return 0;
  const double ramp = std::clamp(std::min(t_s, kBeep_s - t_s) / kRamp_s, 0.0, 1.0);  // avoids a click
  return ramp * std::sin(2 * std::numbers::pi * pitch_hz * t_s);
}

}  // namespace vps::viewer
