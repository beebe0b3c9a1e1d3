// SPDX-License-Identifier: BSD-3-Clause
// The wrench of all touching points without a list of them: what a haptic loop needs.
// wrench_collector.h has the order of summation.
#include <algorithm>
#include <atomic>
#include <limits>

#include "query/coherent_walk.h"
#include "query/wrench_collector.h"
#include "vps/query.h"

namespace vps {
namespace {

/// Group by group on several threads; each group's sums go to a place of their own and are added in order, as
/// one thread alone does.
class SharedWrench {
 public:
  SharedWrench(const Reading& reading, const Pose& X_MP, const QueryOptions& options, const Vec3& p_MO,
               QueryMemory* memory) noexcept
      : reading_(reading), X_MP_(X_MP), options_(options), p_MO_(p_MO), memory_(memory) {}

  void run() noexcept {
    using Walk = CoherentWalk<int>;
    if (memory_ != nullptr) Walk::begin(*memory_, 0, X_MP_);
    options_.team->run([](void* self, int) { static_cast<SharedWrench*>(self)->work(); }, this);
    if (memory_ != nullptr) Walk::end(*memory_, X_MP_);
    for (std::size_t g = 0; g < groupCount(reading_.shell); ++g) add(options_.team->share(g));
  }

  Totals totals;
  float least = std::numeric_limits<float>::infinity();
  double least_skipped = std::numeric_limits<double>::infinity();
  std::size_t points_read = 0;

 private:
  void work() noexcept {
    WrenchCollector collector(reading_, X_MP_, options_.gradient, p_MO_);
    const std::size_t groups = groupCount(reading_.shell);
    for (std::size_t g = next_++; g < groups; g = next_++) {
      std::size_t points = 0;
      const double skipped = readNearLeavesOf(g, reading_, X_MP_, options_, 0, memory_, points,
                                              [&](const ReadLeaf& leaf) { collector.take(leaf); });
      collector.finish();
      const Totals t = collector.takeTotals();
      options_.team->share(g) = {t.f.x(),   t.f.y(),
                                 t.f.z(),   t.tau.x(),
                                 t.tau.y(), t.tau.z(),
                                 t.area_m2, t.area_depth,
                                 t.count,   static_cast<double>(collector.takeLeast()),
                                 skipped,   static_cast<double>(points)};
    }
  }

  void add(const QueryTeam::GroupShare& s) noexcept {
    points_read += static_cast<std::size_t>(s[11]);
    least_skipped = std::min(least_skipped, s[10]);
    least = std::min(least, static_cast<float>(s[9]));
    if (s[8] > 0) totals.add({{s[0], s[1], s[2]}, {s[3], s[4], s[5]}, s[6], s[7], s[8]});
  }

  const Reading& reading_;
  const Pose& X_MP_;
  const QueryOptions& options_;
  const Vec3& p_MO_;
  QueryMemory* const memory_;
  std::atomic<std::size_t> next_ = 0;
};

}  // namespace

QueryResult queryWrench(const VoxMap& map, const PointShell& shell, const Pose& X_MP,
                        const QueryOptions& options, double k_N_per_m3, const Vec3& p_MO, TouchSummary& out,
                        QueryMemory* memory) noexcept {
  out = TouchSummary();
  QueryResult result;
  if (!X_MP.isFinite() || !p_MO.allFinite()) {
    result.status = Status::BadPose;
    return result;
  }
  const Reading reading(map, shell, X_MP, options.simd);
  QueryMemory* const own_memory = usable(memory, map, shell);
  WrenchCollector collector(reading, X_MP, options.gradient, p_MO);
  const std::size_t groups = groupCount(shell);
  if (options.team != nullptr && groups > 1 && groups <= QueryTeam::kMostGroups) {
    SharedWrench shared(reading, X_MP, options, p_MO, own_memory);
    shared.run();
    out = collector.summary(shared.totals, shared.least, k_N_per_m3);
    result.points_tested = shared.points_read;
    setDistance(map, reading, shared.least, shared.least_skipped, result);
    return result;
  }
  const double least_skipped = readNearLeaves(reading, X_MP, options, 0, own_memory, result.points_tested,
                                              [&](const ReadLeaf& leaf) { collector.take(leaf); });
  collector.finish();
  const float least = collector.takeLeast();
  out = collector.summary(collector.takeTotals(), least, k_N_per_m3);
  setDistance(map, reading, least, least_skipped, result);
  return result;
}

Wrench penaltyWrench(std::span<const Contact> contacts, double k_N_per_m3, const Vec3& p_MO) noexcept {
  Wrench F_O_M;
  for (const Contact& c :
       contacts) {  // in the order of ids: a sum that depends on anything else breaks replay
    if (!(c.distance_m < 0)) continue;
    const Vec3 f_M = k_N_per_m3 * c.area_m2 * -c.distance_m * c.n_M;
    F_O_M.f += f_M;
    F_O_M.tau += (c.p_M - p_MO).cross(f_M);
  }
  return F_O_M;
}

}  // namespace vps
