// SPDX-License-Identifier: BSD-3-Clause
#include "trade/design.h"

#include <algorithm>

namespace vps::scenes {

namespace {

/// A setting to measure, the scene's own with `change` made to it.
template <typename Change>
TradeTry changed(const Scene& scene, const std::string& name, TradeKnob knob, const Change& change) {
  TradeTry what{name, knob, scene.fidelity, scene.contact};
  change(what);
  return what;
}

void scaleLengths(Fidelity& f, double factor) {
  f.voxel_m *= factor;
  f.spacing_m *= factor;
}

void coarsen(TradeTry& what) {
  scaleLengths(what.fidelity, 2);
  what.fidelity.sides = Sides::One;
  what.fidelity.contact_limit = std::max(4, what.fidelity.contact_limit / 2);
  what.fidelity.solver_iterations = std::max(4, what.fidelity.solver_iterations / 2);
}

void refine(TradeTry& what) {
  scaleLengths(what.fidelity, 0.5);
  what.fidelity.sides = Sides::Both;
  what.fidelity.contact_limit *= 2;
  what.fidelity.solver_iterations *= 2;
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

std::vector<TradeTry> tradeDesign(const Scene& scene) {
  std::vector<TradeTry> all;
  const auto add = [&](const std::string& name, TradeKnob knob, const auto& change) {
    all.push_back(changed(scene, name, knob, change));
  };
  const bool has_both = scene.fidelity.sides == Sides::Both,
             is_rigid = scene.contact == ContactMethod::Constraint,
             is_continuous = scene.fidelity.gradient == Gradient::Continuous;
  add("as it is", TradeKnob::Own, [](TradeTry&) {});
  add("all coarser", TradeKnob::Together, coarsen);
  add("spacing x2", TradeKnob::Spacing, [](TradeTry& t) { t.fidelity.spacing_m *= 2; });
  add("voxel x2", TradeKnob::Voxel, [](TradeTry& t) { t.fidelity.voxel_m *= 2; });
  add(has_both ? "one side" : "both sides", TradeKnob::Sides,
      [=](TradeTry& t) { t.fidelity.sides = has_both ? Sides::One : Sides::Both; });
  add("physics rate /2", TradeKnob::PhysicsRate, [](TradeTry& t) { t.fidelity.physics_rate_hz /= 2; });
  add("voxel /2", TradeKnob::Voxel, [](TradeTry& t) { t.fidelity.voxel_m /= 2; });
  add("solver /4", TradeKnob::SolverIterations,
      [](TradeTry& t) { t.fidelity.solver_iterations = std::max(4, t.fidelity.solver_iterations / 4); });
  add("contacts /4", TradeKnob::ContactLimit,
      [](TradeTry& t) { t.fidelity.contact_limit = std::max(4, t.fidelity.contact_limit / 4); });
  add(is_continuous ? "trilinear" : "continuous", TradeKnob::Gradient,
      [=](TradeTry& t) { t.fidelity.gradient = is_continuous ? Gradient::Trilinear : Gradient::Continuous; });
  add(is_rigid ? "penalty" : "constraint", TradeKnob::Contact,
      [=](TradeTry& t) { t.contact = is_rigid ? ContactMethod::Penalty : ContactMethod::Constraint; });
  add("haptic rate x2", TradeKnob::HapticRate, [](TradeTry& t) { t.fidelity.haptic_rate_hz *= 2; });
  add("spacing /2", TradeKnob::Spacing, [](TradeTry& t) { t.fidelity.spacing_m /= 2; });
  add("all finer", TradeKnob::Together, refine);
  add("spacing x4", TradeKnob::Spacing, [](TradeTry& t) { t.fidelity.spacing_m *= 4; });
  add("voxel x4", TradeKnob::Voxel, [](TradeTry& t) { t.fidelity.voxel_m *= 4; });
  add("contacts x4", TradeKnob::ContactLimit, [](TradeTry& t) { t.fidelity.contact_limit *= 4; });
  add("solver x4", TradeKnob::SolverIterations, [](TradeTry& t) { t.fidelity.solver_iterations *= 4; });
  return all;
}

std::vector<TradeTry> tradeReferences(const Scene& scene) {
  const auto reference = [&](const char* name, double lengths, double rates) {
    return changed(scene, name, TradeKnob::Reference, [&](TradeTry& t) {
      scaleLengths(t.fidelity, lengths);
      t.fidelity.sides = Sides::Both;
      t.fidelity.contact_limit *= 4;
      t.fidelity.solver_iterations *= 4;
      t.fidelity.haptic_rate_hz *= rates;
      t.fidelity.physics_rate_hz *= rates;
      t.contact = ContactMethod::Constraint;
    });
  };
  return {reference("reference", 0.5, 2), reference("reference, rates as they are", 0.5, 1),
          reference("reference, 0.7 of the lengths, rates as they are", 0.7, 1)};
}

TradeTry tradeSuggestion(const Scene& scene, const std::vector<TradeRow>& rows) {
  TradeTry best{"", TradeKnob::Together, scene.fidelity, scene.contact};
  const TradeRow* own = nullptr;
  for (const TradeRow& row : rows)
    if (row.what.knob == TradeKnob::Own) own = &row;
  if (own == nullptr || !own->has_run || !own->has_probe) return best;
  const auto cheapest = [&](TradeKnob knob) {
    const TradeRow* found = own;
    for (const TradeRow& row : rows)
      if (row.what.knob == knob && row.has_run && row.run.completed && errorOf(row) <= 1.1 * errorOf(*own) &&
          row.probe.force <= 1.25 * own->probe.force + 0.01 &&
          row.run.physics.cpu_p99_us < 0.97 * found->run.physics.cpu_p99_us)
        found = &row;
    return found;
  };
  int changes = 0;
  const auto take = [&](TradeKnob knob, const auto& copy) {
    const TradeRow* found = cheapest(knob);
    if (found == own) return;
    copy(found->what);
    best.name += (changes++ > 0 ? " + " : "") + found->what.name;
  };
  take(TradeKnob::Voxel, [&](const TradeTry& t) { best.fidelity.voxel_m = t.fidelity.voxel_m; });
  take(TradeKnob::Spacing, [&](const TradeTry& t) { best.fidelity.spacing_m = t.fidelity.spacing_m; });
  take(TradeKnob::Sides, [&](const TradeTry& t) { best.fidelity.sides = t.fidelity.sides; });
  take(TradeKnob::Gradient, [&](const TradeTry& t) { best.fidelity.gradient = t.fidelity.gradient; });
  take(TradeKnob::ContactLimit,
       [&](const TradeTry& t) { best.fidelity.contact_limit = t.fidelity.contact_limit; });
  take(TradeKnob::SolverIterations,
       [&](const TradeTry& t) { best.fidelity.solver_iterations = t.fidelity.solver_iterations; });
  if (changes < 2) best.name.clear();  // one knob alone was measured already
  return best;
}

}  // namespace vps::scenes
