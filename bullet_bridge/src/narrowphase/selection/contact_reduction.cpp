// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "narrowphase/candidates/contact_candidate.h"
#include "narrowphase/selection/contact_selection.h"
#include "vps/contact_tolerances.h"
#include "vps/representative_points.h"

namespace vps::bullet {

namespace {

constexpr std::uint64_t kEmpty = ~std::uint64_t{0};

// Two measures of urgency are needed. The gap at the end of free motion finds the points that are about to
// touch. But contact changes the free motion: a light part on a stiff coupling, turned by its contacts
// against the coupling's pull, sank 25 um at points that free motion would have lifted. The present gap
// therefore counts equally.
enum class Measure { Now, EndOfStep };

double urgency(const Candidate& c, Measure measure) {
  return (measure == Measure::Now ? c.distance_m : c.predicted_m) - (c.was_contact ? kSamePlace_m : 0);
}

double urgency(const Candidate& c) {
  return std::min(urgency(c, Measure::Now), urgency(c, Measure::EndOfStep));
}

bool isMoreUrgent(const Candidate& a, const Candidate& b, Measure measure) {
  const double ua = urgency(a, measure), ub = urgency(b, measure);
  return ua != ub ? ua < ub : a.key() < b.key();
}

/// The data of a candidate that the reduction needs. A Brief has half the size of a Candidate, so that each
/// pass reads less memory.
struct Brief {
  std::int32_t at[3];   // cell of the finest grid
  std::uint32_t kind;   // direction, side, crossing or point
  double urgency[2];    // by Measure
  std::uint64_t key;    // of the candidate
  std::uint32_t index;  // of the candidate
  bool was_contact;

  [[nodiscard]] bool isMoreUrgent(const Brief& other, Measure measure) const {
    const double own = urgency[static_cast<int>(measure)], theirs = other.urgency[static_cast<int>(measure)];
    return own != theirs ? own < theirs : key < other.key;
  }
  /// Cells of each level are twice as large as cells of the level before.
  [[nodiscard]] std::uint64_t cell(int level) const {
    const auto of = [&](int axis) {
      return static_cast<std::uint64_t>(static_cast<std::uint32_t>(at[axis] >> level) & 0xFFFF);
    };
    return (((of(0) << 16 | of(1)) << 16 | of(2)) << 8) | kind;
  }
};

Brief briefOf(const Candidate& c, double cell_m, const Pose& X_GW, std::uint32_t index) {
  Brief brief{{0, 0, 0},
              (directionCell(X_GW.R * c.n_W) << 2) | (c.isCrossing() ? 2U : 0U) | c.side,
              {urgency(c, Measure::Now), urgency(c, Measure::EndOfStep)},
              c.key(),
              index,
              c.was_contact};
  constexpr double kMost = 1e9;  // cells from the origin; positions beyond share one cell
  // Evenly spaced points and flat faces would lie on the borders of cells, where rounding decides; these
  // offsets, as shares of a cell, prevent that. The offsets are tested by the bridge's tests in single
  // precision.
  constexpr double kOffset[3] = {0.05, 0.079, 0.104};
  const Vec3 p_G = X_GW * c.p_W;
  for (int k = 0; k < 3; ++k)
    brief.at[k] =
        static_cast<std::int32_t>(std::floor(std::clamp(p_G[k] / cell_m + kOffset[k], -kMost, kMost)));
  return brief;
}

// Keeps the most urgent candidates of each cell, by both measures, and last step's contacts. A small
// open-addressing table from cell to best candidate needs one pass; sorting 5000 candidates took five times
// as long. The table is at most half full for fewer than 2048 candidates; a candidate that finds no slot in
// 16 probes is kept. The area of a dropped candidate goes to the most urgent one of its cell.
void keepMostUrgent(std::vector<Brief>& briefs, int level, std::vector<Candidate>& candidates) {
  constexpr std::size_t kFewestSlots = 64, kMostSlots = 4096, kProbes = 16;
  const std::size_t slot_count = std::clamp(std::bit_ceil(2 * briefs.size()), kFewestSlots, kMostSlots);
  const int unused_bits = 64 - std::countr_zero(slot_count);
  struct Slot {
    std::uint64_t cell = kEmpty;
    std::uint32_t now = 0, end_of_step = 0;
  };
  thread_local std::vector<Slot> slots;
  thread_local std::vector<std::uint8_t> is_kept;
  thread_local std::vector<std::size_t> slot_of;
  slots.assign(slot_count, Slot{});
  is_kept.assign(briefs.size(), 0);
  slot_of.resize(briefs.size());
  for (std::uint32_t i = 0; i < briefs.size(); ++i) {
    const Brief& brief = briefs[i];
    const std::uint64_t cell = brief.cell(level);
    std::size_t at = (cell * 0x9E3779B97F4A7C15ull) >> unused_bits;  // Fibonacci hashing
    std::size_t probe = 0;
    for (; probe < kProbes && slots[at].cell != cell && slots[at].cell != kEmpty; ++probe)
      at = (at + 1) % slot_count;
    slot_of[i] = at;
    if (brief.was_contact || probe == kProbes) is_kept[i] = 1;
    if (probe == kProbes) continue;
    Slot& slot = slots[at];
    if (slot.cell == kEmpty) slot = {cell, i, i};
    if (brief.isMoreUrgent(briefs[slot.now], Measure::Now)) slot.now = i;
    if (brief.isMoreUrgent(briefs[slot.end_of_step], Measure::EndOfStep)) slot.end_of_step = i;
  }
  for (const Slot& slot : slots)
    if (slot.cell != kEmpty) is_kept[slot.now] = is_kept[slot.end_of_step] = 1;
  for (std::size_t i = 0; i < briefs.size(); ++i)
    if (!is_kept[i]) addArea(candidates[briefs[i].index], candidates[briefs[slots[slot_of[i]].now].index]);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < briefs.size(); ++i)
    if (is_kept[i]) briefs[kept++] = briefs[i];
  briefs.resize(kept);
}

// Positions, normals and urgencies of the candidates for reduceBySpread(), in columns of floats, so that a
// pass over all candidates is fast.
struct Spread {
  Eigen::Array<float, Eigen::Dynamic, 6> place;  // per candidate: position in units of length_m, and normal
  Eigen::ArrayXf nearest2;  // squared distance to the nearest selected candidate; -1 for a selected one
  Eigen::ArrayXf urgency;   // -1 to 1, in contact margins
  Eigen::Index size = 0;    // entries in use

  void assign(const std::vector<Candidate>& candidates, double length_m, double contact_margin_m,
              const Mat3& R_GW) {
    const auto count = static_cast<Eigen::Index>(candidates.size());
    if (place.rows() < count) place.resize(count, 6);
    if (urgency.size() < count) urgency.resize(count);
    if (nearest2.size() < count) nearest2.resize(count);
    nearest2.head(count).setConstant(std::numeric_limits<float>::infinity());
    size = count;
    // Positions are relative to the first candidate, since floats are too coarse far from the world's origin.
    const Vec3 origin = candidates.front().p_W;
    for (Eigen::Index i = 0; i < count; ++i) {
      const Candidate& c = candidates[static_cast<std::size_t>(i)];
      const Vec3 p = R_GW * (c.p_W - origin) / length_m, n = R_GW * c.n_W;
      for (int k = 0; k < 3; ++k) {
        place(i, k) = static_cast<float>(p[k]);
        place(i, 3 + k) = static_cast<float>(n[k]);
      }
      urgency[i] = static_cast<float>(std::clamp(vps::bullet::urgency(c) / contact_margin_m, -1.0, 1.0));
    }
  }

  // Selects candidate i and updates the distances of the others.
  void select(std::size_t i) {
    const auto at = static_cast<Eigen::Index>(i);
    nearest2[at] = -1;
    const Eigen::Array<float, 1, 6> selected = place.row(at);
    const auto off2 = [&](int k) { return (place.col(k).head(size) - selected[k]).square(); };
    nearest2.head(size) = nearest2.head(size).min(off2(0) + off2(1) + off2(2) + off2(3) + off2(4) + off2(5));
  }

  [[nodiscard]] bool isSelected(std::size_t i) const { return nearest2[static_cast<Eigen::Index>(i)] < 0; }

  // Weighs extent against gap: one contact margin of gap counts as much as one body length of spread.
  [[nodiscard]] std::size_t best() const {
    Eigen::Index best = size;
    float best_worth = -std::numeric_limits<float>::infinity();
    for (Eigen::Index i = 0; i < size; ++i) {
      if (nearest2[i] < 0) continue;
      const float wanted = best_worth + urgency[i];  // skips the square root where the result cannot change
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

double reduceByCell(std::vector<Candidate>& candidates, std::size_t limit, double cell_m, double most_m,
                    const Pose& X_GW) {
  if (candidates.size() <= limit) return 0;
  thread_local std::vector<Brief> briefs;
  briefs.clear();
  for (std::uint32_t i = 0; i < candidates.size(); ++i)
    briefs.push_back(briefOf(candidates[i], cell_m, X_GW, i));
  double used_m = 0;
  double size_m = cell_m;
  for (int level = 0; briefs.size() > limit && size_m < most_m; ++level, size_m *= 2) {
    keepMostUrgent(briefs, level, candidates);
    used_m = size_m;
  }
  // The indices in `briefs` ascend. Each kept candidate therefore stays or moves towards the front, and none
  // is overwritten before it has moved.
  for (std::size_t i = 0; i < briefs.size(); ++i)
    if (briefs[i].index != i) candidates[i] = candidates[briefs[i].index];
  candidates.resize(briefs.size());
  return used_m;
}

void reduceBySpread(std::vector<Candidate>& candidates, std::size_t limit, double length_m,
                    double contact_margin_m, const Mat3& R_GW) {
  const std::size_t count = candidates.size();
  if (count > limit) {
    thread_local Spread spread;
    spread.assign(candidates, length_m, contact_margin_m, R_GW);
    thread_local std::vector<Candidate> selected;
    selected.clear();
    const auto select = [&](std::size_t i) {
      selected.push_back(candidates[i]);
      spread.select(i);
    };
    // First selects the contacts that carried load in the last step, since dropping one of them causes a
    // jolt; at most half of the limit, so that new contacts are selected too.
    for (std::size_t i = 0; i < count && selected.size() < limit / 2; ++i)
      if (candidates[i].impulse_Ns > 0) select(i);
    // Then selects the most urgent candidate by each measure.
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

}  // namespace vps::bullet
