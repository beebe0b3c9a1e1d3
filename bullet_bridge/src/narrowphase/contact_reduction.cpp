// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "narrowphase/contact_candidate.h"

namespace vps::bullet::inline v0 {

namespace {

// Hysteresis: a candidate that was a contact is preferred to one that is nearer by less than this. Well above
// the noise of a resting part (1 nm), below any depth that matters. Assumed.
constexpr double kStickiness_m = 1e-6;

constexpr std::uint64_t kEmpty = ~std::uint64_t{0};

// Two measures are needed. The gap at the end of free motion finds the points that are about to touch. But
// contact changes that motion: a light part on a stiff coupling, turned by its contacts against the
// coupling's pull, sank 25 um at points that free motion would have lifted. So the gap now counts equally.
enum class Measure { Now, EndOfStep };

double urgency(const Candidate& c, Measure measure) {
  return (measure == Measure::Now ? c.distance_m : c.predicted_m) - (c.was_contact ? kStickiness_m : 0);
}

double urgency(const Candidate& c) {
  return std::min(urgency(c, Measure::Now), urgency(c, Measure::EndOfStep));
}

bool isMoreUrgent(const Candidate& a, const Candidate& b, Measure measure) {
  const double ua = urgency(a, measure), ub = urgency(b, measure);
  return ua != ub ? ua < ub : a.key() < b.key();
}

// The cell of a direction, among 6 x 2 x 2 cells of a cube's surface.
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

// Marks the most urgent candidates of each cell, by both measures. A small open-addressed table from cell to
// its best candidate so far needs one pass; sorting 5000 candidates took five times as long. If the table is
// full, further candidates are kept.
void markMostUrgent(const std::vector<Candidate>& candidates, const Vec3& origin, double cell_m,
                    std::vector<std::uint8_t>& is_kept) {
  constexpr std::size_t kSlots = 4096, kProbes = 16;
  struct Slot {
    std::uint64_t cell = kEmpty;
    std::uint32_t now = 0, end_of_step = 0;
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
    if (c.was_contact || probe == kProbes) is_kept[i] = 1;
    if (probe == kProbes) continue;
    Slot& slot = slots[at];
    if (slot.cell == kEmpty) slot = {cell, i, i};
    if (isMoreUrgent(c, candidates[slot.now], Measure::Now)) slot.now = i;
    if (isMoreUrgent(c, candidates[slot.end_of_step], Measure::EndOfStep)) slot.end_of_step = i;
  }
  for (const Slot& slot : slots)
    if (slot.cell != kEmpty) is_kept[slot.now] = is_kept[slot.end_of_step] = 1;
}

// Candidates as reduceBySpread() weighs them: in columns of floats, so that a pass over all is fast.
struct Spread {
  Eigen::Array<float, Eigen::Dynamic, 6> place;  // by candidate: position in units of length, and normal
  Eigen::ArrayXf nearest2;                       // squared distance to the nearest selected one; selected: -1
  Eigen::ArrayXf urgency;                        // -1 to 1, in contact margins
  Eigen::Index size = 0;                         // entries in use

  void assign(const std::vector<Candidate>& candidates, double length_m, double contact_margin_m) {
    const auto count = static_cast<Eigen::Index>(candidates.size());
    if (place.rows() < count) place.resize(count, 6);
    if (urgency.size() < count) urgency.resize(count);
    if (nearest2.size() < count) nearest2.resize(count);
    nearest2.head(count).setConstant(std::numeric_limits<float>::infinity());
    size = count;
    // Relative to the first: floats are too coarse for positions far from the world's origin.
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

  // Selects i, and updates the distances of the others.
  void select(std::size_t i) {
    const auto at = static_cast<Eigen::Index>(i);
    nearest2[at] = -1;
    const Eigen::Array<float, 1, 6> selected = place.row(at);
    const auto off2 = [&](int k) { return (place.col(k).head(size) - selected[k]).square(); };
    nearest2.head(size) = nearest2.head(size).min(off2(0) + off2(1) + off2(2) + off2(3) + off2(4) + off2(5));
  }

  [[nodiscard]] bool isSelected(std::size_t i) const { return nearest2[static_cast<Eigen::Index>(i)] < 0; }

  // Extent is weighed against the gap: a gap of one contact margin costs as much as one body length of spread
  // is worth.
  [[nodiscard]] std::size_t best() const {
    Eigen::Index best = size;
    float best_worth = -std::numeric_limits<float>::infinity();
    for (Eigen::Index i = 0; i < size; ++i) {
      if (nearest2[i] < 0) continue;
      const float wanted = best_worth + urgency[i];  // skips the root where it cannot matter
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

void reduceByCell(std::vector<Candidate>& candidates, double cell_m) {
  if (candidates.empty()) return;
  Vec3 origin = candidates.front().p_W;
  for (const Candidate& c : candidates) origin = origin.cwiseMin(c.p_W);
  // The grid is fixed in the world, so that the cells of a resting part do not shift with its first point.
  origin = (origin / cell_m).array().floor().matrix() * cell_m;

  thread_local std::vector<std::uint8_t> is_kept;
  is_kept.assign(candidates.size(), 0);
  markMostUrgent(candidates, origin, cell_m, is_kept);
  thread_local std::vector<Candidate> kept;
  kept.clear();
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (is_kept[i]) kept.push_back(candidates[i]);
  candidates.swap(kept);
}

void reduceBySpread(std::vector<Candidate>& candidates, std::size_t limit, double length_m,
                    double contact_margin_m) {
  const std::size_t count = candidates.size();
  if (count > limit) {
    thread_local Spread spread;
    spread.assign(candidates, length_m, contact_margin_m);
    thread_local std::vector<Candidate> selected;
    selected.clear();
    const auto select = [&](std::size_t i) {
      selected.push_back(candidates[i]);
      spread.select(i);
    };
    // Those that carried load in the last step, since dropping one causes a jolt; at most half of the limit,
    // so that new ones are selected too.
    for (std::size_t i = 0; i < count && selected.size() < limit / 2; ++i)
      if (candidates[i].impulse_Ns > 0) select(i);
    // The most urgent.
    for (const Measure measure : {Measure::Now, Measure::EndOfStep}) {
      std::size_t first = 0;
      for (std::size_t i = 1; i < count; ++i)
        if (isMoreUrgent(candidates[i], candidates[first], measure)) first = i;
      if (!spread.isSelected(first)) select(first);
    }
    while (selected.size() < limit) select(spread.best());
    candidates.swap(selected);
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.key() < b.key(); });
}

}  // namespace vps::bullet::inline v0
