// SPDX-License-Identifier: BSD-3-Clause
// The parts of an assembly, prepared and in place, and work on them on all cores.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

#include "surface/part_surface.h"
#include "vps/errors.h"
#include "vps_scenes/fits/check_types.h"

namespace vps::scenes {

struct PlacedSurface {
  std::string name;
  std::shared_ptr<const PartSurface> surface;  ///< parts of equal geometry share it
  Pose X_WP;
  const DrawnPart* drawn = nullptr;  ///< for what the scene says of it
  Box box_W;                         ///< of the vertices themselves
};

/// On all cores; they point to the parts. Throws LoadError; see checkAssembly().
/// @param prepared  surfaces of earlier parts, which are taken again where the geometry is equal
std::vector<PlacedSurface> placedSurfaces(const std::vector<DrawnPart>& parts, const Progress& progress,
                                          std::span<const PlacedSurface> prepared = {});

/// The part of this name, which is among them.
const PlacedSurface& named(const std::vector<PlacedSurface>& parts, const std::string& name);

/// Pairs of parts whose boxes are nearer than near_m, in ascending order.
std::vector<std::pair<std::size_t, std::size_t>> nearPairs(const std::vector<PlacedSurface>& parts,
                                                           double near_m);

/// Does `work(i)` for 0 to count - 1, and tells the progress on the caller's thread only. What either throws
/// ends it.
template <class Work>
void forEachOnCores(std::size_t count, const Progress& progress, const char* doing, Work work) {
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<std::size_t> done = 0;
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    work(i);
    ++done;
    if (progress && std::this_thread::get_id() == caller)
      progress(doing, static_cast<double>(done) / static_cast<double>(count));
  });
}

}  // namespace vps::scenes
