// SPDX-License-Identifier: BSD-3-Clause
#include "budget.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "vps/budget_query.h"

namespace vps::bench {
namespace {

constexpr double kStiffness_N_per_m3 = 1e11;
constexpr int kStride = 7;  // steps between poses: not a divisor of anything in the motions

double medianOf(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

struct Reference {
  std::vector<Pose> X_MPs;
  std::vector<Wrench> F_Po_Ms;
  double force_rms_N = 0, torque_rms_Nm = 0;
};

/// The least time of three, in microseconds.
template <typename Call>
double timed(const Call& call) {
  double least_us = 1e30;
  for (int i = 0; i < 3; ++i) {
    const auto before = std::chrono::steady_clock::now();
    call();
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - before;
    least_us = std::min(least_us, took.count());
  }
  return least_us;
}

BudgetPoint ownPoint(const scenes::Scene& scene, const Motion& motion, int poses, Reference& reference) {
  BudgetPoint own;
  own.complete = 1;
  std::vector<double> times_us;
  for (int i = 0; i < poses; ++i) {
    const Pose X_MP = motion(kStride * i);
    TouchSummary sum;
    QueryResult result;
    times_us.push_back(timed(
        [&] { result = queryWrench(scene.map, scene.shell, X_MP, {}, kStiffness_N_per_m3, X_MP.p, sum); }));
    own.points += static_cast<double>(result.points_tested) / poses;
    reference.X_MPs.push_back(X_MP);
    reference.F_Po_Ms.push_back(sum.F_O_M);
    reference.force_rms_N += sum.F_O_M.f.squaredNorm() / poses;
    reference.torque_rms_Nm += sum.F_O_M.tau.squaredNorm() / poses;
  }
  own.median_us = medianOf(times_us);
  reference.force_rms_N = std::sqrt(reference.force_rms_N);
  reference.torque_rms_Nm = std::sqrt(reference.torque_rms_Nm);
  return own;
}

BudgetPoint pointOf(BudgetQuery& query, const Reference& reference, std::size_t max_points) {
  BudgetPoint point;
  point.max_points = max_points;
  const auto poses = static_cast<double>(reference.X_MPs.size());
  std::vector<double> times_us;
  for (std::size_t i = 0; i < reference.X_MPs.size(); ++i) {
    const Pose& X_MP = reference.X_MPs[i];
    TouchSummary sum;
    BudgetReport report;
    times_us.push_back(timed(
        [&] { report = query.run(X_MP, {}, kStiffness_N_per_m3, X_MP.p, {.max_points = max_points}, sum); }));
    const double f_N = (sum.F_O_M.f - reference.F_Po_Ms[i].f).norm() / reference.force_rms_N;
    const double tau_Nm = (sum.F_O_M.tau - reference.F_Po_Ms[i].tau).norm() / reference.torque_rms_Nm;
    point.force_rms += f_N * f_N / poses;
    point.force_most = std::max(point.force_most, f_N);
    point.torque_rms += tau_Nm * tau_Nm / poses;
    point.bound_rms += std::pow(report.force_error_N / reference.force_rms_N, 2) / poses;
    point.points += static_cast<double>(report.points_read) / poses;
    point.complete += report.is_complete ? 1 / poses : 0;
  }
  point.force_rms = std::sqrt(point.force_rms);
  point.torque_rms = std::sqrt(point.torque_rms);
  point.bound_rms = std::sqrt(point.bound_rms);
  point.median_us = medianOf(times_us);
  return point;
}

}  // namespace

std::vector<BudgetPoint> budgetStudy(const scenes::Scene& scene, const Motion& motion, int poses,
                                     const std::vector<std::size_t>& budgets) {
  Reference reference;
  const BudgetPoint own = ownPoint(scene, motion, poses, reference);
  BudgetQuery query(scene.map, scene.shell);
  std::vector<BudgetPoint> points;
  for (const std::size_t max_points : budgets) points.push_back(pointOf(query, reference, max_points));
  points.push_back(own);
  return points;
}

}  // namespace vps::bench
