// SPDX-License-Identifier: BSD-3-Clause
// The parts of an assembly, prepared and in place, and work on them on all cores.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "surface/part_surface.h"
#include "vps/errors.h"
#include "vps/stoppable.h"
#include "vps_scenes/fits/check_types.h"

namespace vps::scenes {

/// A part of an assembly with its prepared surface and its pose.
struct PlacedSurface {
  std::string name;
  std::shared_ptr<const PartSurface> surface;  ///< shared by parts of equal geometry
  Pose X_WP;
  const DrawnPart* drawn = nullptr;  ///< the part as drawn, with the scene's settings
  Box box_W;                         ///< box of the vertices in the world
};

/// Prepares the parts on all cores. The results point to `parts`, which must outlive them. Throws LoadError,
/// as checkAssembly() does.
/// @param prepared surfaces of earlier parts, which are reused for equal geometry
std::vector<PlacedSurface> placedSurfaces(const std::vector<DrawnPart>& parts, const Progress& progress,
                                          std::span<const PlacedSurface> prepared = {});

/// Corner i of a box, 0 to 7: the bits of i choose the greater x, y and z.
inline Vec3 cornerOf(const Box& box, int i) {
  return {(i & 1) != 0 ? box.max.x() : box.min.x(), (i & 2) != 0 ? box.max.y() : box.min.y(),
          (i & 4) != 0 ? box.max.z() : box.min.z()};
}

/// The part with this name, which must exist.
const PlacedSurface& named(const std::vector<PlacedSurface>& parts, const std::string& name);

/// Pairs of parts whose boxes are at most near_m apart, in ascending order.
std::vector<std::pair<std::size_t, std::size_t>> nearPairs(const std::vector<PlacedSurface>& parts,
                                                           double near_m);

/// Calls `work(i)` for i = 0 to count - 1 on all cores. Reports progress after each call, and from pollStop()
/// within the calls, on one thread at a time. An exception from `work` or `progress` ends the loop.
template <class Work>
void forEachOnCores(std::size_t count, const Progress& progress, const char* doing, Work work) {
  StoppableWork all(progress, doing);
  std::atomic<std::size_t> done = 0;
  onAllCores(count, [&](std::size_t i) {
    work(i);
    all.report(doing, static_cast<double>(++done) / static_cast<double>(count));
  });
}

}  // namespace vps::scenes
