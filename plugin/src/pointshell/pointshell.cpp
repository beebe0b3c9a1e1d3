// SPDX-License-Identifier: BSD-3-Clause
#include "vps/pointshell.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pointshell/shell_hierarchy.h"
#include "pointshell/shell_samples.h"
#include "vps/errors.h"
#include "vps/solid.h"
#include "vps/stoppable.h"

namespace vps {
namespace {

/// Face points per square of spacing (measured 1.25), rounded up for the estimate.
constexpr double kDensity = 1.3;
/// The largest number of points. Assumed: about 1.5 GB of shell.
constexpr double kMaxPoints = 16e6;

}  // namespace

double fittingSpacing_m(const Mesh& mesh, double spacing_m) {
  // A needle has little area; the edges of its bounding box stand for its own edges.
  const double by_area = kDensity * area(mesh) / (spacing_m * spacing_m);
  const double by_length = bounds(mesh).size().sum() / spacing_m;
  constexpr double kRounding = 1 + 1e-9;
  if (!(std::max(by_area, by_length) > kMaxPoints)) return spacing_m;
  return kRounding * spacing_m * std::max(std::sqrt(by_area / kMaxPoints), by_length / kMaxPoints);
}

namespace {

void requireSettings(const Mesh& mesh, const PointShellSettings& settings, const std::string& part) {
  const auto microns = [](double length_m) { return std::to_string(std::lround(length_m * 1e6)) + " um"; };
  if (!(std::isfinite(settings.spacing_m) && settings.spacing_m > 0))
    throw LoadError(
        "", part,
        "the point spacing must be a positive length, not " + std::to_string(settings.spacing_m) + " m");
  if (!(settings.edge_angle_rad > 0 && settings.edge_angle_rad <= std::numbers::pi))
    throw LoadError(
        "", part, "the edge angle must lie between 0 and pi, not " + std::to_string(settings.edge_angle_rad));
  if (const double enough_m = fittingSpacing_m(mesh, settings.spacing_m); enough_m > settings.spacing_m)
    throw LoadError("", part,
                    "a point spacing of " + microns(settings.spacing_m) + " gives too many points; " +
                        microns(std::ceil(enough_m * 1e6) * 1e-6) + " is fine enough, or check the units");
}

PointShell laidOut(const std::vector<ShellSample>& samples, double spacing_m) {
  std::vector<Vec3> unsorted;
  unsorted.reserve(samples.size());
  for (const ShellSample& s : samples) unsorted.push_back(s.p);

  PointShell shell;
  shell.spacing_m = spacing_m;
  shell.points.reserve(samples.size());
  shell.inward.reserve(samples.size());
  shell.area_m2.reserve(samples.size());
  for (const std::uint32_t i : sortedOrder(unsorted)) {
    shell.points.push_back(samples[i].p);
    shell.inward.push_back(-samples[i].outward);
    shell.area_m2.push_back(samples[i].area_m2);
  }
  shell.nodes = sphereHierarchy(shell.points);
  layOutBlocks(shell);
  shell.order = progressiveOrder(shell.points);
  return shell;
}

/// One root node over all shells, then the nodes of each shell. Points keep their order, so that ids are
/// consecutive.
std::vector<ShellNode> joinedNodes(const std::vector<const PointShell*>& shells,
                                   const std::vector<Pose>& X_MPs, std::size_t point_count) {
  std::vector<ShellNode> nodes(1);
  std::uint32_t first_point = 0;
  Box centers;
  for (std::size_t s = 0; s < shells.size(); ++s) {
    const auto first_node = static_cast<std::uint32_t>(nodes.size());
    for (ShellNode node : shells[s]->nodes) {
      node.center = X_MPs[s] * node.center;
      node.radius_m *= 1 + 1e-12;  // points and centre were rounded independently
      node.first += first_point;
      node.skip += first_node;
      nodes.push_back(node);
    }
    if (nodes.size() > first_node) centers.add(nodes[first_node].center);
    first_point += static_cast<std::uint32_t>(shells[s]->size());
  }
  ShellNode& root = nodes.front();
  root.center = centers.center();
  root.count = static_cast<std::uint32_t>(point_count);
  root.skip = static_cast<std::uint32_t>(nodes.size());
  for (std::uint32_t i = 1; i < nodes.size(); i = nodes[i].skip)
    root.radius_m =
        std::max(root.radius_m, ((nodes[i].center - root.center).norm() + nodes[i].radius_m) * (1 + 1e-12));
  return nodes;
}

/// The shell of a mesh with shared vertices.
/// @param is_sheet  other parts touch the surface from both sides, and at its border
PointShell sampled(const Mesh& mesh, const PointShellSettings& settings, const Progress& progress,
                   bool is_sheet = false) {
  StoppableWork work(progress);
  const auto report = [&work](double share) { work.report("sampling points", share); };
  report(0);
  const std::vector<Vec3> normals = triangleNormals(mesh);
  std::vector<ShellSample> samples =
      sampleFeatures(mesh, normals, kEdgeStep * settings.spacing_m, kEdgeTolerance * settings.spacing_m,
                     settings.edge_angle_rad);
  report(0.1);
  sampleFaces(mesh, normals, settings.spacing_m, samples);
  if (is_sheet) addOtherSides(mesh, kEdgeStep * settings.spacing_m, samples);
  report(0.8);
  PointShell shell = laidOut(samples, settings.spacing_m);
  report(1);
  return shell;
}

}  // namespace

std::size_t PointShell::memoryBytes() const noexcept {
  return sizeof(PointShell) + points.capacity() * sizeof(Vec3) + inward.capacity() * sizeof(Vec3) +
         area_m2.capacity() * sizeof(double) + order.capacity() * sizeof(std::uint32_t) +
         nodes.capacity() * sizeof(ShellNode) + blocks.capacity() * sizeof(ShellBlock);
}

PointShell buildPointShell(const Mesh& mesh, const PointShellSettings& settings, const std::string& part,
                           const Progress& progress) {
  requireUsable(mesh, "", part);
  requireSettings(mesh, settings, part);
  const StoppableWork work(progress, "sampling points");
  return sampled(welded(mesh), settings,
                 progress);  // unwelded, every edge would be open, and therefore sharp
}

PointShell buildPointShell(const Solid& solid, const PointShellSettings& settings, const std::string& part,
                           const Progress& progress) {
  requireSettings(solid.mesh(), settings, part);
  return sampled(solid.mesh(), settings, progress, solid.isSheet());
}

PointShell mergedShells(const std::vector<const PointShell*>& shells, const std::vector<Pose>& X_MPs) {
  VPS_ASSERT(shells.size() == X_MPs.size());
  PointShell merged;
  std::size_t count = 0;
  for (const PointShell* shell : shells) count += shell->size();
  if (count == 0) return merged;
  merged.points.reserve(count);
  merged.inward.reserve(count);
  merged.area_m2.reserve(count);
  for (std::size_t s = 0; s < shells.size(); ++s) {
    for (const Vec3& p : shells[s]->points) merged.points.push_back(X_MPs[s] * p);
    for (const Vec3& n : shells[s]->inward) merged.inward.push_back(X_MPs[s].R * n);
    merged.area_m2.insert(merged.area_m2.end(), shells[s]->area_m2.begin(), shells[s]->area_m2.end());
    merged.spacing_m = std::max(merged.spacing_m, shells[s]->spacing_m);
  }
  merged.nodes = joinedNodes(shells, X_MPs, count);
  layOutBlocks(merged);
  merged.order = progressiveOrder(merged.points);
  return merged;
}

namespace {

/// The number of kept entries before each index, and the total.
std::vector<std::uint32_t> keptBefore(const std::vector<std::uint8_t>& is_kept) {
  std::vector<std::uint32_t> before(is_kept.size() + 1, 0);
  for (std::size_t i = 0; i < is_kept.size(); ++i) before[i + 1] = before[i] + is_kept[i];
  return before;
}

std::vector<std::uint8_t> pointsWithin(const PointShell& shell, const std::vector<Box>& boxes) {
  std::vector<std::uint8_t> is_kept(shell.size());
  for (std::size_t i = 0; i < is_kept.size(); ++i)
    is_kept[i] = std::ranges::any_of(boxes, [&](const Box& box) { return isWithin(shell.points[i], box); });
  return is_kept;
}

/// The nodes that still have a point. Their spheres do not change, because a leaf's points are stored as
/// offsets from its centre and must be rounded as before.
std::vector<ShellNode> keptNodes(const PointShell& shell, const std::vector<std::uint32_t>& points_before) {
  const auto countOf = [&](const ShellNode& node) {
    return points_before[node.first + node.count] - points_before[node.first];
  };
  std::vector<std::uint8_t> is_kept(shell.nodes.size());
  for (std::size_t i = 0; i < is_kept.size(); ++i) is_kept[i] = countOf(shell.nodes[i]) > 0;
  const std::vector<std::uint32_t> nodes_before = keptBefore(is_kept);
  std::vector<ShellNode> nodes;
  nodes.reserve(nodes_before.back());
  for (std::size_t i = 0; i < is_kept.size(); ++i) {
    if (is_kept[i] == 0) continue;
    ShellNode node = shell.nodes[i];
    node.count = countOf(node);
    node.first = points_before[node.first];
    node.skip = nodes_before[node.skip];
    nodes.push_back(node);
  }
  return nodes;
}

}  // namespace

PointShell croppedShell(const PointShell& shell, const std::vector<Box>& boxes_P) {
  const std::vector<std::uint8_t> is_kept = pointsWithin(shell, boxes_P);
  const std::vector<std::uint32_t> before = keptBefore(is_kept);
  PointShell out;
  out.spacing_m = shell.spacing_m;
  out.points.reserve(before.back());
  out.inward.reserve(before.back());
  out.area_m2.reserve(before.back());
  out.order.reserve(before.back());
  for (std::size_t i = 0; i < is_kept.size(); ++i) {
    if (is_kept[i] == 0) continue;
    out.points.push_back(shell.points[i]);
    out.inward.push_back(shell.inward[i]);
    out.area_m2.push_back(shell.area_m2[i]);
  }
  for (const std::uint32_t i : shell.order)
    if (is_kept[i] != 0) out.order.push_back(before[i]);
  if (before.back() == 0) return out;
  out.nodes = keptNodes(shell, before);
  layOutBlocks(out);
  return out;
}

}  // namespace vps
