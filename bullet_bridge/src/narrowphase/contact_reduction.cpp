// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "narrowphase/contact_candidate.h"

namespace vps::bullet {

namespace {

// A candidate that was a contact keeps its place against one that is nearer by less than this. Well above the
// noise of a resting part (1 nm), below any depth that matters. Assumed.
constexpr double kStickiness_m = 1e-6;

constexpr std::uint64_t kEmpty = ~std::uint64_t{0};

// Two measures, and neither will do alone. Where a point will be in free motion finds what is about to be
// hit. But contact bends that motion: a light part on a stiff coupling, turned by its contacts against the
// coupling's pull, sank 25 um at points that free motion would have lifted. So where a point is now counts as
// much.
enum class Measure { Now, Then };

double urgency(const Candidate& c, Measure measure) {
  return (measure == Measure::Now ? c.distance_m : c.predicted_m) - (c.was_contact ? kStickiness_m : 0);
}

double urgency(const Candidate& c) {
  return std::min(urgency(c, Measure::Now), urgency(c, Measure::Then));
}

bool isMoreUrgent(const Candidate& a, const Candidate& b, Measure measure) {
  const double ua = urgency(a, measure), ub = urgency(b, measure);
  return ua != ub ? ua < ub : a.key() < b.key();
}

// Which of 6 x 2 x 2 cells of the cube's surface a direction falls in.
std::uint32_t directionCell(const Vec3& n) {
  int axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  return static_cast<std::uint32_t>(((axis * 2 + (n[axis] > 0)) * 2 + (n[u] > 0)) * 2 + (n[v] > 0));
}

std::uint64_t cellOf(const Candidate& c, const Vec3& origin, double cell_m) {
  const auto at = [&](int axis) {
    return static_cast<std::uint64_t>(std::clamp((c.p_W[axis] - origin[axis]) / cell_m, 0.0, 65535.0));
  };
  return (((at(0) << 16 | at(1)) << 16 | at(2)) << 8) | (directionCell(c.n_W) << 2) |
         (c.isCrossing() ? 2U : 0U) | c.side;
}

// Marks the most urgent candidates of each cell, now and then. A small open-addressed table, cell -> its best
// so far: one pass, where sorting 5000 candidates took five times as long. A full table drops nobody: what
// finds no room is kept.
void markBest(const std::vector<Candidate>& candidates, const Vec3& origin, double cell_m,
              std::vector<std::uint8_t>& keep) {
  constexpr std::size_t kSlots = 4096, kProbes = 16;
  struct Slot {
    std::uint64_t cell = kEmpty;
    std::uint32_t now = 0, then = 0;
  };
  thread_local std::vector<Slot> slots;
  slots.assign(kSlots, Slot{});
  for (std::uint32_t i = 0; i < candidates.size(); ++i) {
    const Candidate& c = candidates[i];
    const std::uint64_t cell = cellOf(c, origin, cell_m);
    std::size_t at = (cell * 0x9E3779B97F4A7C15ull) >> 52;  // Fibonacci hashing to 12 bits
    std::size_t probe = 0;
    for (; probe < kProbes && slots[at].cell != cell && slots[at].cell != kEmpty; ++probe)
      at = (at + 1) % kSlots;
    if (c.was_contact || probe == kProbes) keep[i] = 1;
    if (probe == kProbes) continue;
    Slot& slot = slots[at];
    if (slot.cell == kEmpty) slot = {cell, i, i};
    if (isMoreUrgent(c, candidates[slot.now], Measure::Now)) slot.now = i;
    if (isMoreUrgent(c, candidates[slot.then], Measure::Then)) slot.then = i;
  }
  for (const Slot& slot : slots)
    if (slot.cell != kEmpty) keep[slot.now] = keep[slot.then] = 1;
}

// Candidates as chooseSpread() weighs them: side by side and in floats, so that a look at all of them is
// quick.
struct Spread {
  Eigen::Array<float, Eigen::Dynamic, 6> place;  // by candidate: position in units of length, and normal
  Eigen::ArrayXf nearest2;                       // squared distance to the nearest chosen one; chosen: -1
  Eigen::ArrayXf urgency;                        // -1 to 1, in slacks
  Eigen::Index size = 0;                         // of them in use

  void take(const std::vector<Candidate>& candidates, double length_m, double contact_margin_m) {
    const auto count = static_cast<Eigen::Index>(candidates.size());
    if (place.rows() < count) place.resize(count, 6);
    if (urgency.size() < count) urgency.resize(count);
    if (nearest2.size() < count) nearest2.resize(count);
    nearest2.head(count).setConstant(std::numeric_limits<float>::infinity());
    size = count;
    // About the first: far from the world's origin floats would not tell places apart.
    const Vec3 origin = candidates.front().p_W;
    for (Eigen::Index i = 0; i < count; ++i) {
      const Candidate& c = candidates[static_cast<std::size_t>(i)];
      const Vec3 p = (c.p_W - origin) / length_m;
      for (int k = 0; k < 3; ++k) {
        place(i, k) = static_cast<float>(p[k]);
        place(i, 3 + k) = static_cast<float>(c.n_W[k]);
      }
      urgency[i] = static_cast<float>(std::clamp(vps::bullet::urgency(c) / contact_margin_m, -1.0, 1.0));
    }
  }

  // Takes i out. The others come no farther from those chosen.
  void choose(std::size_t i) {
    const auto at = static_cast<Eigen::Index>(i);
    nearest2[at] = -1;
    const Eigen::Array<float, 1, 6> chosen = place.row(at);
    const auto off2 = [&](int k) { return (place.col(k).head(size) - chosen[k]).square(); };
    nearest2.head(size) = nearest2.head(size).min(off2(0) + off2(1) + off2(2) + off2(3) + off2(4) + off2(5));
  }

  [[nodiscard]] bool isChosen(std::size_t i) const { return nearest2[static_cast<Eigen::Index>(i)] < 0; }

  // Extent, weighed against the gap: a contact a slack away is worth as much less as a body's length of
  // spread.
  [[nodiscard]] std::size_t best() const {
    Eigen::Index best = size;
    float best_worth = -std::numeric_limits<float>::infinity();
    for (Eigen::Index i = 0; i < size; ++i) {
      if (nearest2[i] < 0) continue;
      const float wanted = best_worth + urgency[i];  // a root costs more than to see that it is not needed
      if (wanted > 0 && nearest2[i] < (1 - 1e-6f) * wanted * wanted) continue;
      const float worth = std::sqrt(nearest2[i]) - urgency[i];
      if (worth > best_worth) {
        best_worth = worth;
        best = i;
      }
    }
    return static_cast<std::size_t>(best);
  }
};

}  // namespace

void thinOut(std::vector<Candidate>& candidates, double cell_m) {
  if (candidates.empty()) return;
  Vec3 origin = candidates.front().p_W;
  for (const Candidate& c : candidates) origin = origin.cwiseMin(c.p_W);
  // The grid stands still in the world, so that a resting part's cells do not shift with its first point.
  origin = (origin / cell_m).array().floor().matrix() * cell_m;

  thread_local std::vector<std::uint8_t> keep;
  keep.assign(candidates.size(), 0);
  markBest(candidates, origin, cell_m, keep);
  thread_local std::vector<Candidate> kept;
  kept.clear();
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (keep[i]) kept.push_back(candidates[i]);
  candidates.swap(kept);
}

void chooseSpread(std::vector<Candidate>& candidates, std::size_t limit, double length_m,
                  double contact_margin_m) {
  const std::size_t count = candidates.size();
  if (count > limit) {
    thread_local Spread spread;
    spread.take(candidates, length_m, contact_margin_m);
    thread_local std::vector<Candidate> chosen;
    chosen.clear();
    const auto choose = [&](std::size_t i) {
      chosen.push_back(candidates[i]);
      spread.choose(i);
    };
    // Those that carried load last step: dropping one is a jolt. At most half of the room, so that new ones
    // get in.
    for (std::size_t i = 0; i < count && chosen.size() < limit / 2; ++i)
      if (candidates[i].impulse_Ns > 0) choose(i);
    // The most urgent.
    for (const Measure measure : {Measure::Now, Measure::Then}) {
      std::size_t first = 0;
      for (std::size_t i = 1; i < count; ++i)
        if (isMoreUrgent(candidates[i], candidates[first], measure)) first = i;
      if (!spread.isChosen(first)) choose(first);
    }
    while (chosen.size() < limit) choose(spread.best());
    candidates.swap(chosen);
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.key() < b.key(); });
}

}  // namespace vps::bullet
