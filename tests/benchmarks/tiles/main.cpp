// SPDX-License-Identifier: BSD-3-Clause
// vps_bench_tiles: the number of exact distances that are needed to find the deepest point of every tile of
// two surfaces in contact, by the bound of the field's error. Exits 2 for an unknown option, 1 if --check
// finds a tile closed by another point than its deepest.
#include <cstdio>
#include <cstring>
#include <map>
#include <utility>

#include "tiles.h"

namespace vps::bench {

namespace {

constexpr double kMargin_m = 20e-6, kTolerance_m = 1e-6;  // margin of contacts; tolerance of overlap

struct Tile {
  std::string name;
  double size_m;
};

std::vector<Tile> tilesFor(const Model (&model)[2]) {
  double radius_m = 1e300;
  for (const Model& part : model) {
    Box box;
    for (const Vec3& p : part->mesh->vertices) box.add(p);
    radius_m = std::min(radius_m, 0.5 * box.size().norm());
  }
  return {{"r/16", radius_m / 16}, {"r/8", radius_m / 8}, {"1 mm", 1e-3}, {"2 mm", 2e-3}, {"4 mm", 4e-3}};
}

/// One pair of parts at one size of voxels.
class Measurement {
 public:
  Measurement(const Fit& fit, double voxel_m)
      : fit_(fit),
        voxel_m_(voxel_m),
        model_{modelOf(fit.mesh[0], voxel_m, fit.spacing_m), modelOf(fit.mesh[1], voxel_m, fit.spacing_m)},
        error_{FieldError(model_[0]), FieldError(model_[1])} {
    const double near_m = kMargin_m + 0.6 * voxel_m;
    for (const Pose& X : fit.X_01) {
      const Pose X_01 = touching(fit, X, model_);
      for (int i = 0; i < 2; ++i)
        readings_.push_back(
            readPoints(*model_[i], *model_[1 - i], error_[1 - i], i == 0 ? X_01.inverse() : X_01, near_m));
    }
  }

  void print() const {
    for (const Tile& tile : tilesFor(model_)) {
      std::printf("| %s | %.2f | %s, %.2f | %.0f, %.0f |", fit_.name.c_str(), 1e3 * voxel_m_,
                  tile.name.c_str(), 1e3 * tile.size_m, count(tile.size_m, Bound::ShellLeaf, kMargin_m).tiles,
                  count(tile.size_m, Bound::ShellLeaf, -kTolerance_m).tiles);
      for (const Bound bound : kBounds) printCounts(tile.size_m, bound);
      std::printf("\n");
      std::fflush(stdout);
    }
  }

  /// Mean count of distances per pose, for both surfaces.
  [[nodiscard]] Count count(double tile_m, Bound bound, double reach_m) const {
    Count sum;
    for (const std::vector<Reading>& surface : readings_)
      sum.add(closeTiles(surface, tile_m, bound, reach_m));
    const auto poses = static_cast<double>(fit_.X_01.size());
    for (double* value : {&sum.tiles, &sum.exact, &sum.beside_edges, &sum.broken}) *value /= poses;
    return sum;
  }

 private:
  void printCounts(double tile_m, Bound bound) const {
    const Count near = count(tile_m, bound, kMargin_m), deep = count(tile_m, bound, -kTolerance_m);
    const double beside = deep.exact > 0 ? 100 * deep.beside_edges / deep.exact : 0;
    std::printf(" %.0f; %.0f (%.0f, %.0f %%%s) |", near.exact, deep.exact, deep.most, beside,
                deep.broken > 0 ? text(deep.broken).c_str() : "");
  }
  static std::string text(double broken) {
    char words[32];
    std::snprintf(words, sizeof words, ", %.1f broken", broken);
    return words;
  }

  const Fit& fit_;
  double voxel_m_;
  Model model_[2];
  FieldError error_[2];
  std::vector<std::vector<Reading>> readings_;  // by pose and surface
};

// True if tiles that are closed by bounds have at least as many measured points as tiles whose error is
// known: a tile with fewer was closed too early.
bool check() {
  bool is_right = true;
  for (const Fit& fit : allFits(true)) {
    Measurement m(fit, fit.fine_m);
    const Count known = m.count(1e-3, Bound::ShellLeaf, kMargin_m),
                all = m.count(1e-3, Bound::Everywhere, kMargin_m);
    is_right = is_right && known.broken == 0 && known.tiles > 0 && known.tiles <= known.exact &&
               all.exact >= known.tiles;
  }
  return is_right;
}

void printAll(bool is_short) {
  std::printf(
      "Exact distances per pose, of both surfaces, that close all tiles with a point nearer than 20 um; "
      "distances\nthat close the tiles which may overlap by 1 um (most in a tile, share near edges, points "
      "whose bound is broken).\n\n"
      "| fit | voxel/mm | tile, mm | tiles | 0.5 voxel everywhere | near edges | per 8^3 voxels | per voxel "
      "| "
      "per leaf of points |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const Fit& fit : allFits(is_short))
    for (const double voxel_m : {fit.fine_m, fit.coarse_m}) Measurement(fit, voxel_m).print();
}

}  // namespace

}  // namespace vps::bench

int main(int argc, char** argv) {
  const bool is_check = argc == 2 && std::strcmp(argv[1], "--check") == 0;
  const bool is_short = argc == 2 && std::strcmp(argv[1], "--short") == 0;
  if (argc > 1 && !is_check && !is_short) {
    std::printf("usage: vps_bench_tiles [--short|--check]\n");
    return 2;
  }
  if (is_check) return vps::bench::check() ? 0 : 1;
  vps::bench::printAll(is_short);
  return 0;
}
