// SPDX-License-Identifier: BSD-3-Clause
#include "book/exploded.h"

#include <algorithm>
#include <vector>

#include "ways/way.h"

namespace vps::scenes {

namespace {

class Explosion {
 public:
  Explosion(const PlanResult& plan, const std::map<std::string, Box>& boxes_W, Vec3 up_W)
      : plan_(plan), boxes_W_(boxes_W), up_W_(std::move(up_W)) {
    Box all;
    for (const auto& [name, box] : boxes_W) add(all, box);
    if (!all.isEmpty()) gap_m_ = kGap * all.size().norm();
  }

  [[nodiscard]] std::map<std::string, Vec3> of(const PlannedAssembly& assembly) const {
    std::map<std::string, Vec3> apart_W;
    std::vector<Box> placed;
    for (const std::string& name : assembly.fixed) {
      apart_W[name] = Vec3::Zero();
      placed.push_back(boxes_W_.at(name));
    }
    for (const PlannedStep& step : assembly.steps) {
      const std::map<std::string, Vec3> own_W = within(step);
      Box together;
      for (const auto& [name, by_W] : own_W) add(together, shifted(name, by_W));
      const Vec3 out_W = outward(step, together);
      double far_m = 0;
      for (const Box& box : placed) far_m = std::max(far_m, leavingDistance_m(together, box, out_W));
      far_m += gap_m_ + kOwnGap * out_W.cwiseAbs().dot(together.size());
      for (const auto& [name, by_W] : own_W) {
        apart_W[name] = by_W + far_m * out_W;
        placed.push_back(shifted(name, apart_W[name]));
      }
    }
    return apart_W;
  }

 private:
  /// Gaps between parts, relative to the size of the assembly and of the part, so that both long and flat
  /// parts are seen apart.
  static constexpr double kGap = 0.01, kOwnGap = 0.15;

  static void add(Box& box, const Box& other) {
    if (other.isEmpty()) return;
    box.add(other.min);
    box.add(other.max);
  }

  [[nodiscard]] Box shifted(const std::string& name, const Vec3& by_W) const {
    return moved(boxes_W_.at(name), Pose::translation(by_W));
  }

  /// Displacements of the step's parts relative to each other.
  [[nodiscard]] std::map<std::string, Vec3> within(const PlannedStep& step) const {
    if (step.parts.size() > 1) {
      const auto sub = std::ranges::find(plan_.assemblies, step.name, &PlannedAssembly::name);
      if (sub != plan_.assemblies.end()) return of(*sub);
    }
    std::map<std::string, Vec3> none;
    for (const std::string& name : step.parts) none[name] = Vec3::Zero();
    return none;
  }

  /// Unit direction from the target against the last leg, or towards the start of the path.
  [[nodiscard]] Vec3 outward(const PlannedStep& step, const Box& together) const {
    if (!step.insertion_W.isZero()) return -step.insertion_W.normalized();
    if (step.before_W.empty() || together.isEmpty()) return up_W_;
    const Vec3 middle_W = together.center(), away_W = step.before_W.front() * middle_W - middle_W;
    return away_W.isZero() ? up_W_ : Vec3(away_W.normalized());
  }

  const PlanResult& plan_;
  const std::map<std::string, Box>& boxes_W_;
  Vec3 up_W_;
  double gap_m_ = 0;
};

}  // namespace

std::map<std::string, Vec3> explodedView(const PlanResult& plan, const std::map<std::string, Box>& boxes_W,
                                         const Vec3& up_W) {
  if (plan.assemblies.empty()) return {};
  return Explosion(plan, boxes_W, up_W).of(plan.assemblies.front());
}

}  // namespace vps::scenes
