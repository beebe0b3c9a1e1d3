// SPDX-License-Identifier: BSD-3-Clause
#include "ways/way.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

namespace vps::scenes {

namespace {

/// Bounding box in the bench's frame B, whose z axis points up.
Box boxOf(const PlacedSurface& part, const Pose& X_BW) {
  Box box;
  const Pose X_BP = X_BW * part.X_WP;
  for (const Vec3& p : part.surface->mesh().vertices) box.add(X_BP * p);
  return box;
}

void add(Box& box, const Box& other) {
  if (other.isEmpty()) return;
  box.add(other.min);
  box.add(other.max);
}

Box shifted(const Box& box, const Vec3& by) {
  return {box.min + by, box.max + by};
}

/// Bounding box of a box that moves by a displacement.
Box swept(const Box& box, const Vec3& by) {
  Box out = box;
  add(out, shifted(box, by));
  return out;
}

/// Places rectangles around a rectangle without overlap: four strips like the sails of a windmill, then the
/// next ring of four strips around everything placed so far.
///
///     left | top  ----
///          +-------+
///     left | inner | right
///     ---- +-------+ right
///            bottom --->
class Rings {
 public:
  Rings(const Box& inner, double gap_m) : gap_m_(gap_m) { begin(grown(inner, gap_m)); }

  /// Returns the lower left corner (x, y) of the next rectangle.
  std::array<double, 2> next(double width_m, double depth_m) {
    const bool is_flat = side_ % 2 == 0;
    const double along_m = is_flat ? width_m : depth_m;
    const double room_m = is_flat ? rect_.size().x() : rect_.size().y();
    if (used_m_ > 0 && used_m_ + along_m > room_m) {
      if (++side_ == 4) begin(grown(all_, gap_m_));
      used_m_ = 0;
      return next(width_m, depth_m);
    }
    std::array<double, 2> at{};
    switch (side_) {
      case 0:
        at = {rect_.min.x() + used_m_, rect_.min.y() - depth_m};
        break;
      case 1:
        at = {rect_.max.x(), rect_.min.y() + used_m_};
        break;
      case 2:
        at = {rect_.max.x() - used_m_ - width_m, rect_.max.y()};
        break;
      default:
        at = {rect_.min.x() - width_m, rect_.max.y() - used_m_ - depth_m};
    }
    used_m_ += along_m + gap_m_;
    all_.add(Vec3(at[0], at[1], 0));
    all_.add(Vec3(at[0] + width_m, at[1] + depth_m, 0));
    return at;
  }

 private:
  void begin(const Box& rect) {
    rect_ = all_ = rect;
    side_ = 0;
    used_m_ = 0;
  }
  double gap_m_;
  Box rect_, all_;
  int side_ = 0;
  double used_m_ = 0;  ///< used length of the current strip
};

class Bench {
 public:
  Bench(const Placing& placing, const PlannedAssembly& assembly) : placing_(placing) {
    X_WB_ = Pose(Quat::FromTwoVectors(Vec3::UnitZ(), placing.up_W).toRotationMatrix(), Vec3::Zero());
    X_BW_ = X_WB_.inverse();
    for (std::size_t i = 0; i < placing.parts.size(); ++i) number_[placing.parts[i].name] = i;
    for (const std::string& name : assembly.fixed) addHome(name);
    for (const PlannedStep& step : assembly.steps) {
      for (const std::string& name : step.parts) addHome(name);
      Box start;
      for (const Pose& before_W : step.before_W)
        for (const std::string& name : step.parts) {
          const Box at = boxOf(partAt(name, before_W), X_BW_);
          add(reached_, at);
          if (&before_W == &step.before_W.front()) add(start, at);
        }
      starts_.push_back(start);
      tallest_m_ = std::max(tallest_m_, start.size().z());
    }
    add(reached_, home_);
    constexpr double kGap = 0.05;  // gap between parts, relative to the size of the assembly
    gap_m_ = kGap * home_.size().maxCoeff();
    level_m_ = reached_.min.z();
    clear_m_ = std::max(reached_.max.z(), level_m_ + tallest_m_) + gap_m_;
  }

  void layOut(PlannedAssembly& assembly) {
    std::vector<Box> in_place;
    for (const std::string& name : assembly.fixed) in_place.push_back(homes_.at(name));
    std::vector<std::optional<Vec3>> asides;
    Box inner = reached_;
    for (std::size_t i = 0; i < assembly.steps.size(); ++i) {
      asides.push_back(wayUp(starts_[i], in_place));
      if (asides.back()) add(inner, shifted(starts_[i], *asides.back()));
      for (const std::string& name : assembly.steps[i].parts) in_place.push_back(homes_.at(name));
    }
    Rings rings(inner, gap_m_);
    for (std::size_t i = 0; i < assembly.steps.size(); ++i) {
      if (!asides[i]) continue;
      const Vec3 size_m = starts_[i].size();
      const std::array<double, 2> at = rings.next(size_m.x(), size_m.y());
      begin(assembly.steps[i], starts_[i], *asides[i], Vec3(at[0], at[1], level_m_));
    }
  }

 private:
  [[nodiscard]] PlacedSurface partAt(const std::string& name, const Pose& before_W) const {
    PlacedSurface part = placing_.parts[number_.at(name)];
    part.X_WP = before_W * part.X_WP;
    return part;
  }

  void addHome(const std::string& name) {
    const Box box = boxOf(placing_.parts[number_.at(name)], X_BW_);
    homes_[name] = box;
    add(home_, box);
  }

  /// Sideways displacement of a part at its start after which it can be lifted past all parts in place; empty
  /// if no displacement is free.
  [[nodiscard]] std::optional<Vec3> wayUp(const Box& start, const std::vector<Box>& in_place) const {
    const auto isFree = [&](const Box& box, const Vec3& by) {
      const Box way = swept(box, by);
      return std::ranges::none_of(in_place, [&](const Box& held) { return overlap(way, held); });
    };
    const auto up = [&](const Box& box) { return Vec3(0, 0, clear_m_ - box.min.z()); };
    if (isFree(start, up(start))) return Vec3(Vec3::Zero());
    for (const int axis : {0, 1})
      for (const double sign : {1.0, -1.0}) {
        const double far_m =
            sign > 0 ? reached_.max[axis] - start.min[axis] : start.max[axis] - reached_.min[axis];
        const Vec3 by = sign * (far_m + gap_m_) * Vec3::Unit(axis);
        if (isFree(start, by) && isFree(shifted(start, by), up(start))) return by;
      }
    return std::nullopt;
  }

  /// Prepends the motions from the bench to the step's path: lift, move across, lower, move aside.
  void begin(PlannedStep& step, const Box& start, const Vec3& aside, const Vec3& corner) const {
    const Vec3 lie = corner - start.min;
    const Vec3 lifted(lie.x(), lie.y(), clear_m_ - start.min.z()), over(aside.x(), aside.y(), lifted.z());
    std::vector<Vec3> offsets = {lie, lifted, over};
    if (!aside.isZero(0)) offsets.push_back(aside);
    std::vector<Pose> before_W;
    for (const Vec3& offset : offsets)
      before_W.push_back(Pose::translation(X_WB_.R * offset) * step.before_W.front());
    step.before_W.insert(step.before_W.begin(), before_W.begin(), before_W.end());
    step.is_on_bench = true;
  }

  const Placing& placing_;
  Pose X_WB_, X_BW_;
  std::map<std::string, std::size_t> number_;
  std::map<std::string, Box> homes_;
  std::vector<Box> starts_;
  Box home_, reached_;
  double tallest_m_ = 0, gap_m_ = 0, level_m_ = 0, clear_m_ = 0;
};

}  // namespace

void layOnBench(const Placing& placing, PlannedAssembly& assembly) {
  if (!assembly.steps.empty()) Bench(placing, assembly).layOut(assembly);
}

}  // namespace vps::scenes
