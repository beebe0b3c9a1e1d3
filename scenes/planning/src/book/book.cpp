// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/planning/book.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "book/exploded.h"
#include "vps_scenes/fits/check.h"
#include "vps_scenes/scene/scene_parts.h"

namespace vps::scenes {

std::size_t Book::steps() const {
  std::size_t count = 0;
  for (const BookChapter& chapter : chapters) count += chapter.steps.size();
  return count;
}

namespace {

/// Joins a leg to the previous one if both are the same motion: straight in one direction, or about one
/// direction with the same advance. The plan divides turns into pieces of an eighth of a turn.
void addLeg(std::vector<BookLeg>& legs, const BookLeg& leg) {
  constexpr double kNoMove_m = 1e-9, kNoTurn_rad = 1e-9, kSame = 1e-4;
  const double turn_rad = leg.turn_W.norm(), move_m = leg.move_W.norm();
  if (move_m < kNoMove_m && turn_rad < kNoTurn_rad) return;
  if (!legs.empty()) {
    BookLeg& last = legs.back();
    const double last_rad = last.turn_W.norm(), last_m = last.move_W.norm();
    const bool is_straight = turn_rad < kNoTurn_rad && last_rad < kNoTurn_rad;
    const bool is_turn = turn_rad >= kNoTurn_rad && last_rad >= kNoTurn_rad;
    const bool goes_on = is_straight && leg.move_W.dot(last.move_W) > (1 - kSame) * move_m * last_m;
    const bool turns_on = is_turn && leg.turn_W.dot(last.turn_W) > (1 - kSame) * turn_rad * last_rad &&
                          std::abs(leg.turn_W.dot(leg.move_W) * last_rad * last_rad -
                                   last.turn_W.dot(last.move_W) * turn_rad * turn_rad) <=
                              kSame * turn_rad * last_rad * std::max(move_m * last_rad, last_m * turn_rad);
    if (goes_on || turns_on) {
      last.move_W += leg.move_W;
      last.turn_W += leg.turn_W;
      return;
    }
  }
  legs.push_back(leg);
}

std::vector<BookLeg> legsOf(const std::vector<Pose>& before_W, const Vec3& middle_W) {
  std::vector<BookLeg> legs;
  for (std::size_t i = 0; i < before_W.size(); ++i) {
    const Pose& from = before_W[i];
    const Pose to = i + 1 < before_W.size() ? before_W[i + 1] : Pose();
    addLeg(legs, {to * middle_W - from * middle_W, rotationVector(to.R * from.R.transpose())});
  }
  return legs;
}

class BookMaker {
 public:
  BookMaker(const Scene& scene, const PlanResult& plan, const CheckResult& checked)
      : scene_(scene), plan_(plan), checked_(checked) {}

  Book make(bool has_density) {
    book_.name = plan_.assembly;
    if (scene_.gravity_W.norm() > 0) book_.up_W = -scene_.gravity_W.normalized();
    // The plan lists each subassembly after the assembly that mounts it.
    for (std::size_t i = plan_.assemblies.size(); i-- > 0;) {
      const PlannedAssembly& assembly = plan_.assemblies[i];
      for (const std::string& name : assembly.fixed) note(name);
      for (const PlannedStep& step : assembly.steps)
        for (const std::string& name : step.parts) note(name);
    }
    placeParts();
    listItems(has_density);
    for (std::size_t i = plan_.assemblies.size(); i-- > 0;) addChapter(plan_.assemblies[i]);
    for (const OverlapChoice& choice : plan_.choices)
      if (!choice.left_out.empty() && !book_.parts.contains(choice.left_out) &&
          std::ranges::find(book_.left_out, choice.left_out, &BookLeftOut::name) == book_.left_out.end())
        book_.left_out.push_back({choice.left_out, choice.words});
    return std::move(book_);
  }

 private:
  void note(const std::string& name) {
    if (known_.insert(name).second) order_.push_back(name);
  }

  void placeParts() {
    std::map<std::string, Pose> target_of;  // as for drawnParts(), without copies of the meshes
    for (const SceneStep& step : scene_.steps)
      target_of[scene_.parts[step.part].part.name] = step.X_WP_target;
    std::map<std::string, Box> boxes_W;
    for (std::size_t i = 0; i < scene_.parts.size(); ++i) {
      const ScenePart& part = scene_.parts[i];
      if (!known_.contains(part.part.name)) continue;
      const auto target = target_of.find(part.part.name);
      BookPart& placed = book_.parts[part.part.name];
      placed.part = i;
      placed.X_WP = target == target_of.end() ? part.X_WP : target->second;
      placed.box_P = bounds(part.part.mesh);
      boxes_W[part.part.name] = placed.box_W();
    }
    for (const auto& [name, by_W] : explodedView(plan_, boxes_W, book_.up_W))
      book_.parts.at(name).apart_W = by_W;
  }

  void listItems(bool has_density) {
    std::map<std::string, const EqualParts*> equal_of;
    for (const EqualParts& equal : plan_.equal)
      for (const std::string& name : equal.names) equal_of[name] = &equal;
    std::map<std::string, std::string> fasteners;
    for (const Fastener& fastener : plan_.fasteners) fasteners[fastener.part] = fastener.words;
    std::map<const EqualParts*, std::size_t> item_of;
    for (const std::string& name : order_) {
      const auto equal = equal_of.find(name);
      if (equal != equal_of.end()) {
        const auto [known, is_new] = item_of.try_emplace(equal->second, book_.items.size());
        if (!is_new) {
          book_.items[known->second].names.push_back(name);
          book_.parts.at(name).item = known->second;
          continue;
        }
      }
      BookPart& placed = book_.parts.at(name);
      placed.item = book_.items.size();
      BookItem item;
      item.number = book_.items.size() + 1;
      item.names = {name};
      if (const auto words = fasteners.find(name); words != fasteners.end()) item.fastener = words->second;
      if (!placed.box_P.isEmpty()) item.size_m = placed.box_P.size();
      if (has_density) {
        const ScenePart& part = scene_.parts[placed.part];
        const double volume_m3 = partMass(part).volume_m3;
        if (volume_m3 > 0) item.mass_kg = volume_m3 * part.part.material.density_kg_m3;
      }
      book_.items.push_back(std::move(item));
    }
  }

  void addChapter(const PlannedAssembly& assembly) {
    BookChapter chapter{assembly.name, assembly.fixed, assembly.fixed_reason, {}};
    std::set<std::string> in_place(assembly.fixed.begin(), assembly.fixed.end());
    for (const PlannedStep& step : assembly.steps) {
      chapter.steps.push_back(stepOf(assembly, step, in_place));
      in_place.insert(step.parts.begin(), step.parts.end());
    }
    for (const BlockedPart& blocked : assembly.blocked) book_.blocked.push_back(blocked);
    book_.chapters.push_back(std::move(chapter));
  }

  BookStep stepOf(const PlannedAssembly& assembly, const PlannedStep& planned,
                  const std::set<std::string>& in_place) {
    BookStep step;
    step.number = ++steps_;
    step.planned = planned;
    const std::set<std::string> moved(planned.parts.begin(), planned.parts.end());
    Box box_W;
    for (const std::string& name : planned.parts) {
      const Box own_W = book_.parts.at(name).box_W();
      if (own_W.isEmpty()) continue;
      box_W.add(own_W.min);
      box_W.add(own_W.max);
    }
    step.legs = legsOf(planned.before_W, box_W.isEmpty() ? Vec3(Vec3::Zero()) : box_W.center());
    for (const PlannedOrder& order : assembly.order)
      if (order.after == planned.name) step.needs.push_back(order);
    for (const PlannedContact& contact : plan_.contacts) {
      const bool is_a = moved.contains(contact.a) && in_place.contains(contact.b);
      if (!is_a && !(moved.contains(contact.b) && in_place.contains(contact.a))) continue;
      step.neighbours.push_back({is_a ? contact.b : contact.a, contact.state, contact.clearance_m});
    }
    for (const CheckedFit& fit : checked_.fits)
      if ((moved.contains(fit.shaft) && in_place.contains(fit.bore)) ||
          (moved.contains(fit.bore) && in_place.contains(fit.shaft)))
        step.fits.push_back(fit);
    for (const CheckedPart& part : checked_.parts)
      if (moved.contains(part.name) && part.play) step.measured.push_back(part);
    for (const SceneStep& stated : scene_.steps)
      if (scene_.parts[stated.part].part.name == planned.name) step.torque_Nm = stated.torque_Nm;
    return step;
  }

  const Scene& scene_;
  const PlanResult& plan_;
  const CheckResult& checked_;
  Book book_;
  std::vector<std::string> order_;  ///< all parts, in the order of assembly
  std::set<std::string> known_;     ///< the parts in order_
  std::size_t steps_ = 0;
};

}  // namespace

Book makeBook(const Scene& scene, const PlanResult& plan, const CheckResult& checked, bool has_density) {
  return BookMaker(scene, plan, checked).make(has_density);
}

}  // namespace vps::scenes
