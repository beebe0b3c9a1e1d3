// SPDX-License-Identifier: BSD-3-Clause
// First the choice, which reads spheres only; then what was chosen is read in the order of queryWrench(), so
// that an answer that leaves nothing out has its bits.
#include "vps/budget_query.h"

#include <algorithm>
#include <cmath>

#include "query/cluster_choice.h"
#include "query/cluster_samples.h"
#include "query/wrench_collector.h"

namespace vps {
namespace {

using Clock = Deadline::Clock;

/// Blocks with weights of their own, as long as a reader looks at them.
class ScaledBlocks {
 public:
  ShellBlock& next(const ShellBlock& block) noexcept {
    ShellBlock& copy = blocks_[next_++ % kBatch];
    copy = block;
    return copy;
  }

 private:
  ShellBlock blocks_[kBatch];
  unsigned next_ = 0;
};

/// What was left to samples.
struct Left {
  std::size_t clusters = 0;
  double area_m2 = 0;
  double area_depth = 0;  ///< of the bounds [m^2 voxels]
  int coarsest_level = 0;
  float depth = 0;                                       ///< bound over all [voxels]
  float least = std::numeric_limits<float>::infinity();  ///< no point that was not read reads less [voxels]
};

/// Reads the chosen clusters; samples where they answer for others.
class ChosenClusters {
 public:
  ChosenClusters(const ClusterChoice& choice, const Reading& points, const Reading& samples, const Pose& X_MP,
                 Gradient gradient, const Vec3& p_MO, const Deadline& deadline) noexcept
      : choice_(choice),
        points_(points, X_MP, gradient, p_MO),
        samples_(samples, X_MP, gradient, p_MO),
        point_reader_(points, Consume{&points_}),
        sample_reader_(samples, Consume{&samples_}),
        shell_(points.shell),
        sample_blocks_(samples.shell.blocks),
        deadline_(deadline) {}

  void read() noexcept {
    visitChild(static_cast<std::uint32_t>(shell_.blocks.size() - 1), 1);
    point_reader_.flush();
    sample_reader_.flush();
    points_.finish();
    samples_.finish();
  }

  [[nodiscard]] WrenchCollector& points() noexcept { return points_; }
  [[nodiscard]] WrenchCollector& samples() noexcept { return samples_; }
  [[nodiscard]] const Left& left() const noexcept { return left_; }
  [[nodiscard]] std::size_t pointsRead() const noexcept {
    return point_reader_.pointsRead() + sample_reader_.pointsRead();
  }
  [[nodiscard]] bool isOutOfTime() const noexcept { return is_out_of_time_; }

 private:
  struct Consume {
    WrenchCollector* collector;
    void operator()(const ReadLeaf& leaf) const noexcept { collector->take(leaf); }
  };

  /// A cluster's own answer, counting `weight`. As deep as the shell has levels: eight at most.
  void visit(std::uint32_t index, float weight) noexcept {
    const ShellBlock& block = shell_.blocks[index];
    if (block.is_leaf) return readLeaf(index, weight);
    if (deadline_.isOver()) is_out_of_time_ = true;
    float left[kLanes] = {};
    for (std::uint32_t i = 0; i < block.count; ++i) left[i] = visitChild(block.first + i, weight);
    readSamples(index, block.count, left);
  }

  /// What a child leaves to its sample of the weight.
  float visitChild(std::uint32_t child, float weight) noexcept {
    if (!(choice_.depth(child) > 0)) {
      left_.least = std::min(left_.least, -choice_.depth(child));
      return 0;
    }
    const float its_own = is_out_of_time_ ? 0 : choice_.weight(child);
    const float rest = weight * (1 - its_own);
    if (its_own > 0) visit(child, weight * its_own);
    if (rest > 0) leave(child, rest);
    return rest;
  }

  void leave(std::uint32_t index, float weight) noexcept {
    const double area_m2 = static_cast<double>(weight) * static_cast<double>(choice_.area_m2(index));
    ++left_.clusters;
    left_.area_m2 += area_m2;
    left_.area_depth += area_m2 * static_cast<double>(choice_.depth(index));
    left_.coarsest_level = std::max(left_.coarsest_level, 1 + choice_.level(index));
    left_.depth = std::max(left_.depth, choice_.depth(index));
    left_.least = std::min(left_.least, -choice_.depth(index));
  }

  void readLeaf(std::uint32_t index, float weight) noexcept {
    const ShellBlock& leaf = shell_.blocks[index];
    if (weight == 1) return point_reader_.add(leaf, index);
    ShellBlock& scaled = scaled_points_.next(leaf);
    for (float& area_m2 : scaled.weight) area_m2 *= weight;
    point_reader_.add(scaled, index);
  }

  void readSamples(std::uint32_t index, std::uint32_t count, const float left[kLanes]) noexcept {
    if (std::none_of(left, left + count, [](float share) { return share > 0; })) return;
    ShellBlock& scaled = scaled_samples_.next(sample_blocks_[index - shell_.leaf_blocks]);
    for (std::uint32_t i = 0; i < count; ++i) scaled.weight[i] *= left[i];
    sample_reader_.add(scaled, 0);  // one group of all samples
  }

  const ClusterChoice& choice_;
  WrenchCollector points_, samples_;
  LeafReader<Consume> point_reader_, sample_reader_;
  const PointShell& shell_;
  const std::vector<ShellBlock>& sample_blocks_;
  const Deadline& deadline_;
  ScaledBlocks scaled_points_, scaled_samples_;
  Left left_;
  bool is_out_of_time_ = false;
};

/// Less than none is none, as is what is no number; a month is as good as for ever.
double usOf(const QueryBudget& budget) noexcept {
  return budget.max_us > 0 ? std::min(budget.max_us, 2.6e12) : 0;
}

/// How far from O a point of the shell can be.
double reach(const PointShell& shell, const Pose& X_MP, const Vec3& p_MO) noexcept {
  const ShellBlock& root = shell.blocks.back();
  return (X_MP * Vec3(root.center[0], root.center[1], root.center[2]) - p_MO).norm() + root.radius_m;
}

}  // namespace

struct BudgetQuery::Rooms {
  Rooms(const VoxMap& its_map, const PointShell& its_shell)
      : map(its_map), shell(&its_shell), samples(clusterSamples(its_shell)), choice(its_shell, samples) {}

  [[nodiscard]] std::size_t pointsFor(const QueryBudget& budget) const noexcept {
    const double by_time = usOf(budget) / us_per_point;
    return by_time < static_cast<double>(budget.max_points) ? static_cast<std::size_t>(by_time)
                                                            : budget.max_points;
  }

  /// Slower at once, though a single late call does not count for much; quicker bit by bit.
  void noteRate(double time_us, std::size_t cost) noexcept {
    constexpr std::size_t kTelling = 512;  // below, it is the call itself that takes the time
    if (cost < kTelling) return;
    const double rate = time_us / static_cast<double>(cost);
    us_per_point = rate > us_per_point ? std::min(rate, kSlower * us_per_point)
                                       : us_per_point + kQuicker * (rate - us_per_point);
  }

  static constexpr double kSlower = 1.25, kQuicker = 1.0 / 16;  // assumed
  VoxMap map;                                                   // shares the map's data
  const PointShell* shell;
  ClusterSamples samples;
  ClusterChoice choice;
  double us_per_point = 0.01;  ///< assumed until calls have been timed
};

BudgetQuery::BudgetQuery(const VoxMap& map, const PointShell& shell)
    : rooms_(std::make_unique<Rooms>(map, shell)) {}
BudgetQuery::~BudgetQuery() = default;
BudgetQuery::BudgetQuery(BudgetQuery&&) noexcept = default;
BudgetQuery& BudgetQuery::operator=(BudgetQuery&&) noexcept = default;

std::size_t BudgetQuery::memoryBytes() const noexcept {
  return sizeof(Rooms) + rooms_->samples.points.memoryBytes() +
         rooms_->samples.spheres.capacity() * sizeof(ShellBlock) + rooms_->choice.memoryBytes();
}

namespace {

/// The choice may take half of the time; it takes about a fifth where time does not end it.
constexpr double kChoiceShare = 0.5;

void addCoarse(const TouchSummary& coarse, TouchSummary& out) noexcept {
  out.F_O_M += coarse.F_O_M;
  out.area_m2 += coarse.area_m2;
  out.volume_m3 += coarse.volume_m3;
  out.max_depth_m = std::max(out.max_depth_m, coarse.max_depth_m);
}

void reportLeft(const Left& left, double samples_m3, const Reading& reading, double k_N_per_m3,
                double reach_m, BudgetReport& report) noexcept {
  // Roundings of the kernels' floats, generously.
  constexpr double kRounding = 1 + 1e-5;
  const double voxel_m = reading.field.voxel_m;
  report.is_complete = left.clusters == 0;
  if (!report.is_complete) report.status = Status::Truncated;
  report.clusters_left = left.clusters;
  report.area_left_m2 = left.area_m2;
  report.coarsest_level = left.coarsest_level;
  // What they might add, and what their samples have added.
  report.force_error_N = k_N_per_m3 * (left.area_depth * voxel_m + samples_m3) * kRounding;
  report.torque_error_Nm = reach_m * report.force_error_N;
  report.depth_bound_m = static_cast<double>(left.depth) * voxel_m;
}

void reportDistance(float read_quanta, float left_voxels, const Reading& reading, double band_m,
                    BudgetReport& report) noexcept {
  const double read_m = reading.field.quantum_m * static_cast<double>(read_quanta);
  if (read_m < band_m) report.nearest_read_m = read_m;
  const double left_m = left_voxels < reading.field.band
                            ? std::max(reading.field.voxel_m * static_cast<double>(left_voxels), -band_m)
                            : band_m;
  report.least_distance_m = std::min({read_m, left_m, band_m});
}

}  // namespace

BudgetReport BudgetQuery::run(const Pose& X_MP, const QueryOptions& options, double k_N_per_m3,
                              const Vec3& p_MO, const QueryBudget& budget, TouchSummary& out) noexcept {
  const Clock::time_point start = Clock::now();
  out = TouchSummary();
  BudgetReport report;
  if (!X_MP.isFinite() || !p_MO.allFinite()) {
    report.status = Status::BadPose;
    return report;
  }
  Rooms& rooms = *rooms_;
  if (rooms.shell->blocks.empty()) {
    report.is_complete = true;
    report.least_distance_m = std::numeric_limits<double>::infinity();
    return report;
  }
  const bool is_timed = budget.max_us != std::numeric_limits<double>::infinity();
  const double us = usOf(budget);
  const Reading points(rooms.map, *rooms.shell, X_MP, options.simd);
  const Reading samples(rooms.map, rooms.samples.points, X_MP, options.simd);
  rooms.choice.choose(points, is_timed ? rooms.pointsFor(budget) : budget.max_points,
                      is_timed ? Deadline(start, kChoiceShare * us) : Deadline());
  const Deadline end = is_timed ? Deadline(start, us) : Deadline();
  ChosenClusters chosen(rooms.choice, points, samples, X_MP, options.gradient, p_MO, end);
  chosen.read();

  const Left& left = chosen.left();
  const float least = chosen.points().takeLeast(), least_sample = chosen.samples().takeLeast();
  out = chosen.points().summary(chosen.points().takeTotals(), least, k_N_per_m3);
  const TouchSummary coarse =
      chosen.samples().summary(chosen.samples().takeTotals(), least_sample, k_N_per_m3);
  if (left.clusters > 0) addCoarse(coarse, out);
  reportLeft(left, coarse.volume_m3, points, k_N_per_m3, reach(*rooms.shell, X_MP, p_MO), report);
  report.depth_bound_m = std::max(report.depth_bound_m, out.max_depth_m);
  reportDistance(std::min(least, least_sample), left.least, points, rooms.map.band_m(), report);
  report.is_out_of_time = !report.is_complete && (rooms.choice.wasCutByTime() || chosen.isOutOfTime());
  report.points_read = rooms.choice.spheresRead() + chosen.pointsRead();
  report.time_us = std::chrono::duration<double, std::micro>(Clock::now() - start).count();
  rooms.noteRate(report.time_us, rooms.choice.cost());
  return report;
}

}  // namespace vps
