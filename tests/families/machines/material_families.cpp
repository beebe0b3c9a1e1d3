// SPDX-License-Identifier: BSD-3-Clause
// A: the fixed parts of a scene are one body, and each contact has the material of the part that it touches.
// The scene has several plates in any order, each with its own block.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "families/family.h"
#include "support/random_draw.h"
#include "vps/friction.h"
#include "vps_scenes/run/simulate.h"

namespace vps::families {

namespace {

using test::Random;

constexpr double kGravity_m_s2 = 9.81;
constexpr double kPitch_m = 16e-3;  // from plate to plate
const Vec3 kBlock_m(10e-3, 8e-3, 6e-3);

/// Plates with their tops at z = 0, and a block on each plate.
struct Pairs {
  std::vector<Material> plates, blocks;
  std::vector<int> place;  // place of each plate along y; the parts are in random order
  ContactMethod method = ContactMethod::Constraint;
};

/// 2 to 10 plates.
Pairs pairsOf(Random& random) {
  Pairs pairs;
  const int count = 2 + random.index(9);
  pairs.plates.resize(static_cast<std::size_t>(count));
  pairs.blocks.resize(pairs.plates.size());
  pairs.place.resize(pairs.plates.size());
  std::iota(pairs.place.begin(), pairs.place.end(), 0);
  for (int i = count - 1; i > 0; --i)
    std::swap(pairs.place[static_cast<std::size_t>(i)],
              pairs.place[static_cast<std::size_t>(random.index(i + 1))]);
  return pairs;
}

scenes::ScenePart partOf(const std::string& name, const Mesh& mesh, const Vec3& p_WP,
                         const Material& material) {
  scenes::ScenePart part;
  part.part.name = name;
  part.part.mesh = mesh;
  part.part.material = material;
  part.X_WP = Pose::translation(p_WP);
  part.file = name + ".stl";
  return part;
}

/// @param start  start of each block, relative to the middle of its plate
scenes::Scene sceneOf(const Pairs& pairs, const Vec3& plate_m, const Vec3& start, const Vec3& velocity_m_s) {
  scenes::Scene scene;
  scene.file = scene.name = "plates";
  scene.fidelity.contact_method = pairs.method;
  scene.fidelity.voxel_m = 1e-3;
  scene.fidelity.spacing_m = 2e-3;
  for (std::size_t i = 0; i < pairs.plates.size(); ++i) {
    const Vec3 at(0, kPitch_m * pairs.place[i], 0);
    scene.parts.push_back(partOf("plate" + std::to_string(i), makeBox(plate_m),
                                 at - Vec3(0, 0, plate_m.z() / 2), pairs.plates[i]));
    scene.parts.back().is_fixed = true;
    scene.parts.push_back(partOf("block" + std::to_string(i), makeBox(kBlock_m),
                                 at + start + Vec3(0, 0, kBlock_m.z() / 2), pairs.blocks[i]));
    scene.parts.back().V_WP_W.v = velocity_m_s;
  }
  return scene;
}

// --- Friction, by the distance that a block slides

constexpr double kSpeed_m_s = 0.5, kTime_s = 0.12;

Pairs frictionPairs(int member) {
  Random random(1000 + static_cast<std::uint64_t>(member));
  Pairs pairs = pairsOf(random);
  if (member == 0) pairs.plates.resize(2), pairs.blocks.resize(2), pairs.place = {0, 1};
  for (std::size_t i = 0; i < pairs.plates.size(); ++i) {
    pairs.plates[i].friction = random.chance(0.2) ? 0 : random.uniform(0, 1);
    pairs.blocks[i].friction = random.uniform(0.3, 1);
  }
  if (member == 0) {  // the second block stops after 25.5 mm, and nothing brakes the first
    pairs.plates[0].friction = 0;
    pairs.plates[1].friction = pairs.blocks[1].friction = 0.5;
  }
  if (member % 3 == 2) pairs.method = ContactMethod::Penalty;
  return pairs;
}

/// The distance after which a block stops: v^2 / (2 mu g), corrected for steps of dt, each of which moves the
/// block by the velocity at the end of the step.
double way_m(double mu, double dt_s) {
  double sum_m = 0;
  for (int k = 1; k <= static_cast<int>(std::lround(kTime_s / dt_s)); ++k)
    sum_m += dt_s * std::max(0.0, kSpeed_m_s - k * dt_s * mu * kGravity_m_s2);
  return sum_m;
}

double frictionError(int member) {
  const Pairs pairs = frictionPairs(member);
  const double from_m = -35e-3;
  scenes::Scene scene = sceneOf(pairs, {90e-3, 12e-3, 4e-3}, {from_m, 0, 0}, {kSpeed_m_s, 0, 0});
  const scenes::SimulateResult result = scenes::simulate(scene, kTime_s);
  double worst = 0;
  for (std::size_t i = 0; i < pairs.plates.size(); ++i) {
    const double expected_m = way_m(combinedFriction(pairs.plates[i].friction, pairs.blocks[i].friction),
                                    1 / scene.fidelity.physics_rate_hz);
    worst = std::max(worst, std::abs(result.bodies[i].X_WP.p.x() - from_m - expected_m) / expected_m);
  }
  return worst;
}

// --- Restitution, by the speeds before and after the impact of a fall

Pairs restitutionPairs(int member) {
  Random random(2000 + static_cast<std::uint64_t>(member));
  Pairs pairs = pairsOf(random);
  for (std::size_t i = 0; i < pairs.plates.size(); ++i) {
    pairs.plates[i].restitution = random.chance(0.2) ? 0 : random.uniform(0, 1);
    pairs.blocks[i].restitution = random.uniform(0.5, 1);
  }
  return pairs;
}

double restitutionError(int member) {
  const Pairs pairs = restitutionPairs(member);
  constexpr double kFall_m = 10e-3;  // in Bullet, impacts slower than 0.2 m/s have no restitution
  scenes::Scene scene = sceneOf(pairs, {14e-3, 12e-3, 4e-3}, {0, 0, kFall_m}, Vec3::Zero());
  scene.fidelity.physics_rate_hz =
      10'000;  // gravity then adds a hundredth of a per cent of the speed in a step
  std::vector<double> fall_m_s(pairs.plates.size(), 0), rise_m_s = fall_m_s;
  scenes::SimulateOptions options;
  options.trace = [&](double, const std::vector<scenes::BodyState>& bodies, double) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const double v_m_s = bodies[i].V_WP_W.v.z();
      fall_m_s[i] = std::max(fall_m_s[i], -v_m_s);
      rise_m_s[i] = std::max(rise_m_s[i], v_m_s);
    }
  };
  scenes::simulate(scene, 1.2 * std::sqrt(2 * kFall_m / kGravity_m_s2), options);
  double worst = 0;
  for (std::size_t i = 0; i < pairs.plates.size(); ++i)
    worst = std::max(worst, std::abs(rise_m_s[i] / fall_m_s[i] -
                                     pairs.plates[i].restitution * pairs.blocks[i].restitution));
  return worst;
}

// --- Stiffness of penalty contact, by how deep a block sinks: weight / (k A), where the areas of the points
// of both sides that lie in the contact add up to the face to a tenth

Pairs stiffnessPairs(int member) {
  Random random(3000 + static_cast<std::uint64_t>(member));
  Pairs pairs = pairsOf(random);
  pairs.method = ContactMethod::Penalty;
  for (std::size_t i = 0; i < pairs.plates.size(); ++i) {
    pairs.plates[i].stiffness_N_per_m3 = random.logUniform(3e7, 3e9);
    pairs.blocks[i].stiffness_N_per_m3 = random.logUniform(3e7, 3e9);
  }
  return pairs;
}

double stiffnessError(int member) {
  const Pairs pairs = stiffnessPairs(member);
  scenes::Scene scene = sceneOf(pairs, {14e-3, 12e-3, 4e-3}, Vec3::Zero(), Vec3::Zero());
  scene.fidelity.voxel_m = 0.25e-3;
  scene.fidelity.spacing_m = 0.5e-3;
  const scenes::SimulateResult result = scenes::simulate(scene, 0.4);
  double worst = 0;
  for (std::size_t i = 0; i < pairs.plates.size(); ++i) {
    const double k_N_per_m3 =
        std::min(pairs.plates[i].stiffness_N_per_m3, pairs.blocks[i].stiffness_N_per_m3);
    const double pressure_Pa = pairs.blocks[i].density_kg_m3 * kBlock_m.z() * kGravity_m_s2;
    const double sinks_m = kBlock_m.z() / 2 - result.bodies[i].X_WP.p.z();
    worst = std::max(worst, std::abs(sinks_m * k_N_per_m3 / pressure_Pa - 1));
  }
  return worst;
}

std::string inWords(const Pairs& pairs, double Material::*value) {
  std::string words = pairs.method == ContactMethod::Penalty ? "penalty" : "constraint";
  for (std::size_t i = 0; i < pairs.plates.size(); ++i) {
    char each[100];
    std::snprintf(each, sizeof each, ", %.3g on %.3g at place %d", pairs.blocks[i].*value,
                  pairs.plates[i].*value, pairs.place[i]);
    words += each;
  }
  return words;
}

}  // namespace

std::vector<Family> materialFamilies() {
  Family friction{"A_friction", "greatest relative error of the distance that a block slides", 0.01, 60, 6,
                  frictionError};
  friction.describe = [](int i) { return inWords(frictionPairs(i), &Material::friction); };
  Family restitution{"A_restitution", "greatest error of speed after impact over speed before", 0.01, 60, 6,
                     restitutionError};
  restitution.describe = [](int i) { return inWords(restitutionPairs(i), &Material::restitution); };
  Family stiffness{"A_stiffness", "greatest relative error of a block's depth in its plate", 0.1, 60, 6,
                   stiffnessError};
  stiffness.describe = [](int i) { return inWords(stiffnessPairs(i), &Material::stiffness_N_per_m3); };
  return {friction, restitution, stiffness};
}

}  // namespace vps::families
