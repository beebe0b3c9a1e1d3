// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/deeper_neighbours.h"

#include <algorithm>

#include "narrowphase/contact_selection.h"
#include "narrowphase/manifold_writer.h"

namespace vps::bullet::inline v0 {

namespace {

constexpr double kDeeper_m = 1e-6;  // as reduceByCell() prefers last step's contacts
// Half of what parts may overlap. assumed: with 2 um a falling bolt gained energy where such points were
// pushed out.
constexpr double kOverlap_m = 5e-6;
constexpr int kMostSteps = 4;  // of a walk. assumed

/// What is known of points, by their number: walks from neighbouring points meet the same ones.
class KnownPoints {
 public:
  void start(std::size_t count) {
    for (const std::uint32_t id : set_) state_[id] = kUnknown;
    set_.clear();
    if (state_.size() < count) state_.resize(count, kUnknown);
  }
  [[nodiscard]] bool isUnknown(std::uint32_t id) const { return state_[id] == kUnknown; }
  [[nodiscard]] bool isTrue(std::uint32_t id) const { return state_[id] == kTrue; }
  void set(std::uint32_t id, bool is_true) {
    state_[id] = is_true ? kTrue : kFalse;
    set_.push_back(id);
  }

 private:
  enum : std::uint8_t { kUnknown, kFalse, kTrue };
  std::vector<std::uint8_t> state_;
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
        beside_edge_(pointsBesideEdges()) {
    beside_edge_.start(own_.shape->models().shell->size());
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
  }

 private:
  static KnownPoints& pointsBesideEdges() {
    thread_local KnownPoints points;  // keeps its memory
    return points;
  }
  /// True if an edge of the other part is so near that the field may read too much.
  [[nodiscard]] bool isBesideEdge(std::uint32_t id) {
    constexpr double kNear = 0.5;  // of a voxel, as fieldError_m()
    if (beside_edge_.isUnknown(id))
      beside_edge_.set(id, other_.shape->edges().isAnyNear(X_MP_ * own_.shape->models().shell->points[id],
                                                           kNear * other_.shape->models().map->voxel_m()));
    return beside_edge_.isTrue(id);
  }
  [[nodiscard]] bool isRefined(std::uint32_t id) const {
    return std::any_of(refined_.begin(), refined_.end(), [&](const Candidate& c) {
      return c.side == own_.side && !c.isCrossing() && c.id == id;
    });
  }
  bool moveToDeepest(Candidate& at) {
    thread_local std::vector<Candidate> beside;
    beside.clear();
    for (const std::uint32_t id : own_.shape->edgeNeighbours().of(at.id))
      if (isBesideEdge(id) && !isRefined(id)) beside.push_back(byField(id));
    if (beside.empty()) return false;
    refineAll(pair_, motion_, settings_, beside);
    measureAtEnd(pair_, motion_, settings_, beside);
    dropUnreachable(motion_, beside);
    const auto deepest =
        std::min_element(beside.begin(), beside.end(), [](const Candidate& a, const Candidate& b) {
          return a.distance_m != b.distance_m ? a.distance_m < b.distance_m : a.id < b.id;
        });
    if (deepest == beside.end() || deepest->distance_m > at.distance_m - kDeeper_m) return false;
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
  KnownPoints& beside_edge_;
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
