// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "sound/voices.h"
#include "vps/voxmap.h"
#include "vps_device/random.h"
#include "vps_scenes/scene/scene_parts.h"
#include "vps_viewer/sound/sound.h"

namespace vps::viewer {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
// A smaller rise of the force within a step is no impact. assumed: the weight of a few grams
constexpr double kLeastRise_N = 0.05;
// Forces of resting contacts vary from step to step, so an impact's force must exceed all forces of this time
// before the impact. assumed
constexpr double kMemory_s = 0.01;
constexpr double kRoughness_m = 0.1e-3;  // wavelength of the surface roughness. assumed: a milled surface
constexpr double kRubShare = 0.1;        // share of the normal force that roughness modulates. assumed
constexpr double kRollShare = 0.01;      // share kRubShare for rolling contacts: 20 dB less. assumed

/// The contacts of one step, combined to one force.
struct TotalContact {
  double force_N = 0, slip_m_s = 0;
  double roll_m_s = 0;  ///< speed at which the contact point moves over both surfaces
  Vec3 p_W = Vec3::Zero(), n_W = Vec3::Zero();
};
TotalContact totalOf(const std::vector<scenes::ContactMark>& marks) {
  TotalContact total;
  for (const scenes::ContactMark& mark : marks) {
    total.force_N += mark.force_N;
    total.p_W += mark.force_N * mark.p_W;
    total.slip_m_s += mark.force_N * mark.slip_W.norm();
    total.n_W += mark.force_N * mark.n_W;
  }
  if (total.force_N <= 0) return {};
  total.p_W /= total.force_N;
  total.slip_m_s /= total.force_N;
  if (total.n_W.norm() > 0) total.n_W.normalize();
  return total;
}

struct Sounding {
  std::optional<PartVoice> voice;
  std::vector<Impact> impacts;
  Touch rubbed;
  double plane_strain_Pa = 1;
  Vec3 center_P = Vec3::Zero();  ///< centre of mass
};

/// Speed of a contact point over a rolling part: from the part's rotation about axes perpendicular to the
/// normal, as if the part were round about its centre of mass (wheels, balls and pins are).
double rollSpeed_m_s(const Pose& X_before, const Pose& X_now, double step_s, const TotalContact& total,
                     const Vec3& center_P) {
  const Vec3 w_W = rotationVector(X_now.R * X_before.R.transpose()) / step_s;
  return (w_W - total.n_W * total.n_W.dot(w_W)).norm() * (total.p_W - X_now * center_P).norm();
}

}  // namespace

struct RunSound::Impl {
  const scenes::Scene& scene;
  SoundSettings settings;
  std::map<std::size_t, Sounding> parts;  ///< parts that were touched so far
  Samples samples;
  Beeper beeper;
  device::Random random{1};
  long now = 0;                                 ///< current sample
  std::vector<std::pair<double, double>> past;  ///< time and contact force
  std::optional<scenes::BodySnapshot> moved;    ///< moving part in the last snapshot
  double noise = 0;

  explicit Impl(const scenes::Scene& scene, const SoundSettings& settings)
      : scene(scene), settings(settings), beeper(settings.rate_hz) {}

  Sounding& sounding(std::size_t part);
  [[nodiscard]] std::optional<std::size_t> touchedBy(std::size_t moving, const Vec3& p_W,
                                                     const scenes::Snapshot& shot) const;
  void strike(const TotalContact& total, double rise_N, double step_s, const scenes::Snapshot& shot,
              std::size_t moving);
  void render(long end, const TotalContact& total);
};

Sounding& RunSound::Impl::sounding(std::size_t index) {
  Sounding& sounding = parts[index];
  if (sounding.voice) return sounding;
  const scenes::ScenePart& part = scene.parts[index];
  sounding.plane_strain_Pa = planeStrain_Pa(part);
  sounding.center_P = scenes::partMass(part).com;
  sounding.voice.emplace(partVoice(part, settings));
  return sounding;
}

/// The fixed or mounted part whose surface is nearest to a contact point.
std::optional<std::size_t> RunSound::Impl::touchedBy(std::size_t moving, const Vec3& p_W,
                                                     const scenes::Snapshot& shot) const {
  std::optional<std::size_t> best;
  double best_m = 1e-3;  // a contact point lies on both surfaces, up to the error of the distance fields
  for (const scenes::BodySnapshot& body : shot.bodies) {
    const std::shared_ptr<const PartModel>& model = scene.parts[body.part].model;
    if (body.part == moving || !model || !model->map || body.role == scenes::BodyRole::Waiting) continue;
    const double distance_m = std::abs(model->map->distance(body.X_WP.inverse() * p_W));
    if (distance_m >= std::min(best_m, model->map->band_m())) continue;
    best_m = distance_m;
    best = body.part;
  }
  return best;
}

void RunSound::Impl::strike(const TotalContact& total, double rise_N, double step_s,
                            const scenes::Snapshot& shot, std::size_t moving) {
  const std::optional<std::size_t> other = touchedBy(moving, total.p_W, shot);
  const double impulse_Ns = std::max(0.0, rise_N) * step_s;
  const double mass_kg = sounding(moving).voice->mass_kg();
  for (const scenes::BodySnapshot& body : shot.bodies) {
    if (body.part != moving && body.part != other) continue;
    Sounding& part = sounding(body.part);
    Touch touch = part.voice->touch(body.X_WP.inverse() * total.p_W,
                                    body.X_WP.R.transpose() * total.n_W * (body.part == moving ? 1 : -1));
    part.rubbed = touch;
    if (impulse_Ns <= 0) continue;
    const double length_s = impactDuration_s(mass_kg, part.plane_strain_Pa, impulse_Ns / mass_kg);
    part.impacts.push_back({std::move(touch), impulse_Ns, now, std::max(1.0, length_s * settings.rate_hz)});
  }
}

void RunSound::Impl::render(long end, const TotalContact& total) {
  // Roughness is noise, low-pass filtered at the rate at which its waves pass the contact.
  const double speed_m_s = total.slip_m_s + total.roll_m_s;
  const double passing_hz = std::min(speed_m_s / kRoughness_m, 0.4 * settings.rate_hz);
  const double keep = std::exp(-2 * kHalfTurn * passing_hz / settings.rate_hz);
  const double share =
      speed_m_s > 0 ? (kRubShare * total.slip_m_s + kRollShare * total.roll_m_s) / speed_m_s : 0;
  const double friction = passing_hz > 1 ? share * total.force_N : 0;
  for (; now < end; ++now) {
    noise = keep * noise + std::sqrt(1 - keep * keep) * (2 * random.uniform() - 1);
    double pressure_Pa = 0;
    for (auto& [index, part] : parts) {
      for (const Impact& impact : part.impacts)
        part.voice->push(impact.touch, impact.force_N(now, settings.rate_hz));
      if (friction > 0) part.voice->push(part.rubbed, friction * noise);
      std::erase_if(part.impacts, [&](const Impact& impact) { return impact.isOver(now + 1); });
      pressure_Pa += part.voice->next();
    }
    samples.pressure_Pa.push_back(static_cast<float>(pressure_Pa));
    samples.beeps.push_back(static_cast<float>(beeper.next()));
  }
}

RunSound::RunSound(const scenes::Scene& scene, const SoundSettings& settings)
    : impl_(std::make_unique<Impl>(scene, settings)) {}
RunSound::~RunSound() = default;
RunSound::RunSound(RunSound&&) noexcept = default;
RunSound& RunSound::operator=(RunSound&&) noexcept = default;
int RunSound::rate_hz() const {
  return impl_->settings.rate_hz;
}

void RunSound::prepare(std::size_t part) {
  impl_->sounding(part);
}

void RunSound::hear(const scenes::Snapshot& shot) {
  Impl& impl = *impl_;
  const long end = std::lround(shot.time_s * impl.settings.rate_hz);
  const double step_s = static_cast<double>(end - impl.now) / impl.settings.rate_hz;
  if (step_s <= 0) return;
  TotalContact total = totalOf(shot.contacts);
  std::erase_if(impl.past, [&](const auto& entry) { return entry.first < shot.time_s - kMemory_s; });
  double before_N = 0;
  for (const auto& [time_s, force_N] : impl.past) before_N = std::max(before_N, force_N);
  impl.past.emplace_back(shot.time_s, total.force_N);
  const auto moving = std::find_if(shot.bodies.begin(), shot.bodies.end(), [](const auto& body) {
    return body.role == scenes::BodyRole::InHand || body.role == scenes::BodyRole::Released;
  });
  if (moving != shot.bodies.end()) {
    if (total.force_N > 0 && impl.moved && impl.moved->part == moving->part)
      total.roll_m_s =
          rollSpeed_m_s(impl.moved->X_WP, moving->X_WP, step_s, total, impl.sounding(moving->part).center_P);
    impl.moved = *moving;
  }
  const double rise_N = total.force_N - before_N;
  if (total.force_N > 0 && moving != shot.bodies.end())
    impl.strike(total, rise_N > kLeastRise_N ? rise_N : 0, step_s, shot, moving->part);
  impl.render(end, total);
}

void RunSound::beep(device::Beep beep) {
  impl_->beeper.add(beep);
}

RunSound::Samples RunSound::take() {
  return std::exchange(impl_->samples, {});
}

}  // namespace vps::viewer
