// SPDX-License-Identifier: BSD-3-Clause
#include "trade/trade_plan.h"

#include <algorithm>

namespace vps::scenes {

namespace {

/// The scene's own fidelity with one change.
template <typename Change>
TradeSetting changed(const Scene& scene, const std::string& name, TradeKnob knob, const Change& change) {
  TradeSetting setting{name, knob, scene.fidelity};
  change(setting);
  return setting;
}

void scaleLengths(Fidelity& f, double factor) {
  f.voxel_m *= factor;
  f.spacing_m *= factor;
}

void coarsen(TradeSetting& setting) {
  scaleLengths(setting.fidelity, 2);
  setting.fidelity.sides = Sides::One;
  setting.fidelity.contact_limit = std::max(4, setting.fidelity.contact_limit / 2);
  setting.fidelity.solver_iterations = std::max(4, setting.fidelity.solver_iterations / 2);
}

void refine(TradeSetting& setting) {
  scaleLengths(setting.fidelity, 0.5);
  setting.fidelity.sides = Sides::Both;
  setting.fidelity.contact_limit *= 2;
  setting.fidelity.solver_iterations *= 2;
}

}  // namespace

const char* toText(TradeKnob knob) {
  switch (knob) {
    case TradeKnob::Own:
      return "own";
    case TradeKnob::Voxel:
      return "voxel";
    case TradeKnob::Spacing:
      return "spacing";
    case TradeKnob::Sides:
      return "sides";
    case TradeKnob::Gradient:
      return "gradient";
    case TradeKnob::Contact:
      return "contact";
    case TradeKnob::ContactLimit:
      return "contact_limit";
    case TradeKnob::HapticRate:
      return "haptic_rate";
    case TradeKnob::PhysicsRate:
      return "physics_rate";
    case TradeKnob::SolverIterations:
      return "solver_iterations";
    case TradeKnob::Together:
      return "together";
    case TradeKnob::Reference:
      return "reference";
  }
  return "";
}

std::vector<TradeSetting> tradeDesign(const Scene& scene) {
  std::vector<TradeSetting> all;
  const auto add = [&](const std::string& name, TradeKnob knob, const auto& change) {
    all.push_back(changed(scene, name, knob, change));
  };
  const bool has_both = scene.fidelity.sides == Sides::Both,
             has_constraints = scene.fidelity.contact_method == ContactMethod::Constraint,
             is_continuous = scene.fidelity.gradient == Gradient::Continuous;
  add("as it is", TradeKnob::Own, [](TradeSetting&) {});
  add("all coarser", TradeKnob::Together, coarsen);
  add("spacing x2", TradeKnob::Spacing, [](TradeSetting& t) { t.fidelity.spacing_m *= 2; });
  add("voxel x2", TradeKnob::Voxel, [](TradeSetting& t) { t.fidelity.voxel_m *= 2; });
  add(has_both ? "one side" : "both sides", TradeKnob::Sides,
      [=](TradeSetting& t) { t.fidelity.sides = has_both ? Sides::One : Sides::Both; });
  add("physics rate /2", TradeKnob::PhysicsRate, [](TradeSetting& t) { t.fidelity.physics_rate_hz /= 2; });
  add("voxel /2", TradeKnob::Voxel, [](TradeSetting& t) { t.fidelity.voxel_m /= 2; });
  add("solver /4", TradeKnob::SolverIterations,
      [](TradeSetting& t) { t.fidelity.solver_iterations = std::max(4, t.fidelity.solver_iterations / 4); });
  add("contacts /4", TradeKnob::ContactLimit,
      [](TradeSetting& t) { t.fidelity.contact_limit = std::max(4, t.fidelity.contact_limit / 4); });
  add(is_continuous ? "trilinear" : "continuous", TradeKnob::Gradient, [=](TradeSetting& t) {
    t.fidelity.gradient = is_continuous ? Gradient::Trilinear : Gradient::Continuous;
  });
  add(has_constraints ? "penalty" : "constraint", TradeKnob::Contact, [=](TradeSetting& t) {
    t.fidelity.contact_method = has_constraints ? ContactMethod::Penalty : ContactMethod::Constraint;
  });
  add("haptic rate x2", TradeKnob::HapticRate, [](TradeSetting& t) { t.fidelity.haptic_rate_hz *= 2; });
  add("spacing /2", TradeKnob::Spacing, [](TradeSetting& t) { t.fidelity.spacing_m /= 2; });
  add("all finer", TradeKnob::Together, refine);
  add("spacing x4", TradeKnob::Spacing, [](TradeSetting& t) { t.fidelity.spacing_m *= 4; });
  add("voxel x4", TradeKnob::Voxel, [](TradeSetting& t) { t.fidelity.voxel_m *= 4; });
  add("contacts x4", TradeKnob::ContactLimit, [](TradeSetting& t) { t.fidelity.contact_limit *= 4; });
  add("solver x4", TradeKnob::SolverIterations, [](TradeSetting& t) { t.fidelity.solver_iterations *= 4; });
  return all;
}

std::vector<TradeSetting> tradeReferences(const Scene& scene) {
  const auto reference = [&](const char* name, double lengths, double rates) {
    return changed(scene, name, TradeKnob::Reference, [&](TradeSetting& t) {
      scaleLengths(t.fidelity, lengths);
      t.fidelity.sides = Sides::Both;
      t.fidelity.contact_limit *= 4;
      t.fidelity.solver_iterations *= 4;
      t.fidelity.haptic_rate_hz *= rates;
      t.fidelity.physics_rate_hz *= rates;
      t.fidelity.contact_method = ContactMethod::Constraint;
    });
  };
  return {reference("reference", 0.5, 2), reference("reference at the scene's rates", 0.5, 1),
          reference("reference at the scene's rates, 0.7 of its lengths", 0.7, 1)};
}

TradeSetting tradeSuggestion(const Scene& scene, const std::vector<TradeRow>& rows) {
  TradeSetting best{"", TradeKnob::Together, scene.fidelity};
  const TradeRow* own = nullptr;
  for (const TradeRow& row : rows)
    if (row.setting.knob == TradeKnob::Own) own = &row;
  if (own == nullptr || !own->has_run || !own->has_probe) return best;
  const auto cheapest = [&](TradeKnob knob) {
    const TradeRow* found = own;
    for (const TradeRow& row : rows)
      if (row.setting.knob == knob && row.has_run && row.run.completed &&
          errorOf(row) <= 1.1 * errorOf(*own) && row.probe.force <= 1.25 * own->probe.force + 0.01 &&
          row.run.physics.cpu_p99_us < 0.97 * found->run.physics.cpu_p99_us)
        found = &row;
    return found;
  };
  int changes = 0;
  const auto take = [&](TradeKnob knob, const auto& copy) {
    const TradeRow* found = cheapest(knob);
    if (found == own) return;
    copy(found->setting);
    best.name += (changes++ > 0 ? " + " : "") + found->setting.name;
  };
  take(TradeKnob::Voxel, [&](const TradeSetting& t) { best.fidelity.voxel_m = t.fidelity.voxel_m; });
  take(TradeKnob::Spacing, [&](const TradeSetting& t) { best.fidelity.spacing_m = t.fidelity.spacing_m; });
  take(TradeKnob::Sides, [&](const TradeSetting& t) { best.fidelity.sides = t.fidelity.sides; });
  take(TradeKnob::Gradient, [&](const TradeSetting& t) { best.fidelity.gradient = t.fidelity.gradient; });
  take(TradeKnob::ContactLimit,
       [&](const TradeSetting& t) { best.fidelity.contact_limit = t.fidelity.contact_limit; });
  take(TradeKnob::SolverIterations,
       [&](const TradeSetting& t) { best.fidelity.solver_iterations = t.fidelity.solver_iterations; });
  if (changes < 2) best.name.clear();  // a fidelity with a single changed setting was measured already
  return best;
}

}  // namespace vps::scenes
