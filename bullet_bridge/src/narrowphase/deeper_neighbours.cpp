// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/deeper_neighbours.h"

#include <cstdint>
#include <span>
#include <vector>

#include "narrowphase/contact_selection.h"
#include "narrowphase/manifold_writer.h"

namespace vps::bullet::inline v0 {

namespace {

constexpr double kDeeper_m = 1e-6;  // as reduceByCell() prefers last step's contacts
// Half of what parts may overlap. assumed: with 2 um a falling bolt gained energy where such points were
// pushed out.
constexpr double kOverlap_m = 5e-6;
constexpr int kMostSteps = 4;  // of a walk. assumed

/// Values by the number of a point, which are forgotten at once.
template <typename Value>
class ByPoint {
 public:
  void start(std::size_t count, Value usual) {
    for (const std::uint32_t id : set_) value_[id] = usual;
    set_.clear();
    if (value_.size() < count) value_.resize(count, usual);
  }
  [[nodiscard]] Value operator[](std::uint32_t id) const { return value_[id]; }
  void set(std::uint32_t id, Value value) {
    value_[id] = value;
    set_.push_back(id);
  }

 private:
  std::vector<Value> value_;
  std::vector<std::uint32_t> set_;
};

/// One side's points at their places, refined one after the other.
class Walker {
 public:
  Walker(const PairView& pair, int i, const RelativeMotion& motion, const Settings& settings,
         ManifoldWriter* writer, std::vector<Candidate>& refined)
      : pair_(pair),
        motion_(motion),
        settings_(settings),
        writer_(writer),
        refined_(refined),
        own_(pair.side(i)),
        other_(pair.side(1 - i)),
        X_MP_(other_.X_WM.inverse() * own_.X_WM),
        memory_(memory()) {
    memory_.measured.clear();
    memory_.place.start(own_.shape->models().shell->size(), kUnknown);
    for (const Candidate& c : refined)
      if (c.side == i && !c.isCrossing()) memory_.place.set(c.id, kNone);
  }

  void walkFrom(const Candidate& start) {
    if (start.distance_m > motion_.contact_margin_m) return;
    Candidate at = start;
    for (int step = 0; step < kMostSteps; ++step)
      if (!moveToDeepest(at)) break;
    if (at.id == start.id || at.distance_m > -kOverlap_m) return;
    thread_local std::vector<Candidate> added;
    added.assign(1, at);
    if (writer_) writer_->markExistingContacts(added);
    refined_.push_back(added.front());
    memory_.place.set(at.id, kNone);
  }

 private:
  static constexpr std::uint32_t kUnknown = ~0U;
  static constexpr std::uint32_t kNone = kUnknown - 1;  ///< not beside an edge, out of reach, or refined

  /// Walks from neighbouring points meet the same points. Each is measured once.
  struct Memory {
    ByPoint<std::uint32_t> place;  ///< of a point among those measured
    std::vector<Candidate> measured;
  };
  static Memory& memory() {
    thread_local Memory memory;  // keeps its memory
    return memory;
  }

  /// True if an edge of the other part is so near that the field may read too much.
  [[nodiscard]] bool isBesideEdge(std::uint32_t id) const {
    constexpr double kNear = 0.5;  // of a voxel, as fieldError_m()
    return other_.shape->edges().isAnyNear(X_MP_ * own_.shape->models().shell->points[id],
                                           kNear * other_.shape->models().map->voxel_m());
  }
  void measure(std::span<const std::uint32_t> ids) {
    thread_local std::vector<Candidate> beside;
    beside.clear();
    for (const std::uint32_t id : ids) {
      if (memory_.place[id] != kUnknown) continue;
      memory_.place.set(id, kNone);
      if (isBesideEdge(id)) beside.push_back(byField(id));
    }
    if (beside.empty()) return;
    refineAll(pair_, motion_, settings_, beside);
    measureAtEnd(pair_, motion_, settings_, beside);
    dropUnreachable(motion_, beside);
    for (const Candidate& c : beside) {
      memory_.place.set(c.id, static_cast<std::uint32_t>(memory_.measured.size()));
      memory_.measured.push_back(c);
    }
  }
  bool moveToDeepest(Candidate& at) {
    const std::span<const std::uint32_t> ids = own_.shape->edgeNeighbours().of(at.id);
    measure(ids);
    const Candidate* deepest = nullptr;
    for (const std::uint32_t id : ids) {
      const std::uint32_t place = memory_.place[id];
      if (place == kUnknown || place == kNone) continue;
      const Candidate& c = memory_.measured[place];
      if (!deepest || c.distance_m < deepest->distance_m ||
          (c.distance_m == deepest->distance_m && c.id < deepest->id))
        deepest = &c;
    }
    if (!deepest || deepest->distance_m > at.distance_m - kDeeper_m) return false;
    at = *deepest;
    return true;
  }
  [[nodiscard]] Candidate byField(std::uint32_t id) const {
    const VoxMap& map = *other_.shape->models().map;
    const PointShell& shell = *own_.shape->models().shell;
    const Vec3 p_M = X_MP_ * shell.points[id];
    const VoxMap::Sample at = map.sample(p_M);
    Contact contact;
    contact.id = id;
    contact.p_M = p_M;
    contact.n_M = at.normal;
    contact.distance_m = at.distance_m;
    contact.area_m2 = shell.area_m2[id];
    contact.owner = map.owner(p_M);
    return candidateOf(contact, own_, other_);
  }

  const PairView& pair_;
  const RelativeMotion& motion_;
  const Settings& settings_;
  ManifoldWriter* writer_;
  std::vector<Candidate>& refined_;
  SideView own_, other_;
  Pose X_MP_;
  Memory& memory_;
};

}  // namespace

void addDeeperNeighbours(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
                         ManifoldWriter* writer, std::vector<Candidate>& refined) {
  for (int i = 0; i < 2; ++i) {
    if (!queriesPoints(pair, i, settings.sides) || !pair.hasMap(1 - i)) continue;
    Walker walker(pair, i, motion, settings, writer, refined);
    const std::size_t count = refined.size();
    for (std::size_t k = 0; k < count; ++k) {
      const Candidate c = refined[k];
      if (c.side == i && !c.isCrossing() && pair.shape[i]->isEdgePoint(c.id)) walker.walkFrom(c);
    }
  }
}

}  // namespace vps::bullet::inline v0
