// SPDX-License-Identifier: BSD-3-Clause
#include "cases.h"
#include "support/units.h"

#include <memory>

namespace vps::bench {
namespace {

constexpr int kCheckedSteps = 12;

/// A row that steps through a motion. If `patch` > 0, the row uses only so many neighbouring points of the
/// shell.
struct StepRow {
  Pair pair = Pair::RingOnItself;
  SceneSize size;
  Motion motion;
  SubjectOptions options;
  bool with_rival = true;
  std::size_t patch = 0;
};

/// Models, and the case that refers to them. Only the last scene is kept, so a row builds its scene each
/// time.
struct Prepared {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const PointShell> patch;
  StepCase steps;
};

Prepared prepared(const StepRow& row) {
  Prepared p;
  p.scene = sceneOf(row.pair, row.size);
  p.steps.map = &p.scene->map;
  p.steps.shell = &p.scene->shell;
  if (row.patch > 0) {
    const std::size_t size = std::min(row.patch, p.scene->shell.size());
    const std::size_t first = (p.scene->shell.size() - size) / 3;
    p.patch = std::make_shared<PointShell>(patchOf(p.scene->shell, first, size));
    p.steps.shell = p.patch.get();
  }
  p.steps.field = row.with_rival ? p.scene->field.get() : nullptr;
  p.steps.motion = row.motion;
  p.steps.options = row.options;
  p.steps.with_nano = row.options.is_exhaustive;
  return p;
}

Case stepCase(const std::string& name, const std::string& words, Bar bar, double bar_value,
              const StepRow& row) {
  Case c{name, words, bar, bar_value, {}, {}};
  c.check = [=] {
    const Prepared p = prepared(row);
    requireAgreement(name, *p.steps.map, *p.steps.shell, row.options, row.motion, kCheckedSteps);
  };
  c.measure = [=](int repetition) {
    const OneThread one_thread;
    const Prepared p = prepared(row);
    return measureSteps(p.steps, repetition);
  };
  return c;
}

/// Builds the list of rows, with each step row once for every instruction path of the machine.
class Rows {
 public:
  explicit Rows(const SceneSize& size) : size_(size) {}

  void exhaustive(const std::string& name, const std::string& words, double bar_ratio, Pair pair,
                  const Motion& motion, std::size_t patch = 0) {
    StepRow row{pair, size_, motion, {.is_exhaustive = true}, true, patch};
    add(name, words, bar_ratio, row);
  }
  /// bar_ratio is the bar of the row; 0 means that the row has no bar.
  void culled(const std::string& name, const std::string& words, double bar_ratio, Pair pair,
              const Motion& motion) {
    add(name, words, bar_ratio, {pair, size_, motion, {}, true, 0});
  }
  /// A row with 5.4 times the points of the other rows: a million points where the other rows have the
  /// paper's load. Only our time is measured.
  void million(const std::string& name, const std::string& words, Pair pair, const Motion& motion) {
    SceneSize size = size_;
    size.points = size_.points * 1'000'000 / SceneSize{}.points;
    StepRow row{pair, size, motion, {}, false, 0};
    cases.push_back(stepCase(name, words, Bar::P99Below_us, 1000, row));
  }

  void setSize(const SceneSize& size) { size_ = size; }

  std::vector<Case> cases;

 private:
  void add(const std::string& name, const std::string& words, double bar_ratio, StepRow row) {
    for (const std::string& path : instructionPaths()) {
      row.options.path = path;
      const bool is_best = path == "best";
      cases.push_back(stepCase(name + "/" + path, is_best ? words : words + ", " + path,
                               is_best && bar_ratio > 0 ? Bar::RatioAtLeast : Bar::None, bar_ratio, row));
    }
  }
  SceneSize size_;
};

Case buildCase(int voxels, double bar_ratio, int coarser) {
  const auto mesh = std::make_shared<Mesh>();
  const auto voxel = [=] {
    if (mesh->triangles.empty()) *mesh = meshesOf(Pair::RingOnItself, coarser).first;
    return voxelFor(*mesh, voxels);
  };
  Case c{"build/" + std::to_string(voxels),
         "build, ring gear, " + std::to_string(voxels) + "^3 (CPU time)",
         Bar::RatioAtLeast,
         bar_ratio,
         {},
         {}};
  c.measure = [=](int repetition) {
    const double voxel_m = voxel();
    Counters counters = measureBuild(*mesh, voxel_m, repetition);
    if (repetition == 0) counters.merge(measureBuildErrors(*mesh, voxel_m, 50'000));
    return counters;
  };
  return c;
}

/// A rod's nut mounted on a plate.
Case mountCase(const SceneSize& size) {
  struct Parts {
    Mesh plate, nut;
    std::unique_ptr<Mounting> ours;
    std::unique_ptr<RivalField> plate_field, nut_field;
  };
  const auto parts = std::make_shared<Parts>();
  const auto make = [=] {
    if (parts->ours) return;
    parts->plate = meshesOf(Pair::PegInPlate, size.coarser).first;
    parts->nut = meshesOf(Pair::RodInNut, size.coarser).first;
    const double voxel_m = voxelFor(parts->plate, size.voxels);
    parts->ours = std::make_unique<Mounting>(parts->plate, parts->nut, VoxMapSettings{voxel_m, kBandVoxels});
    parts->plate_field = buildOpenVdb(parts->plate, {voxel_m, kBandVoxels, true});
    parts->nut_field = buildOpenVdb(parts->nut, {voxel_m, kBandVoxels, true});
  };
  Case c{"mount", "merge of a mounted part at any pose", Bar::TimeBelow_us, 10'000, {}, {}};
  c.measure = [=](int repetition) {
    make();
    const Pose X_BM(rotationFromVector({0.3, 0.2, 0.5}), {15 * kMm, 12 * kMm, 16 * kMm});
    return measureMounting(*parts->ours, *parts->plate_field, *parts->nut_field, X_BM, repetition);
  };
  return c;
}

Case memoryCase(const std::string& part, Pair pair, const SceneSize& size) {
  Case c{"memory/" + part.substr(0, part.find(' ')) + "/" + std::to_string(size.voxels),
         "memory of a voxmap, " + part,
         Bar::ShareAtMost,
         0.65,
         {},
         {}};
  c.measure = [=](int) {
    const auto scene = sceneOf(pair, size);
    const auto ours = static_cast<double>(scene->map.memoryBytes());
    const auto theirs = static_cast<double>(scene->field->memoryBytes());
    return Counters{{"ours_MB", ours / 1e6}, {"rival_MB", theirs / 1e6}, {"share", ours / theirs}};
  };
  return c;
}

}  // namespace

std::vector<Case> tableCases(const SceneSize& size) {
  Rows rows(size);
  const Motion tremble = trembleMotion(0.002 * kMm);
  rows.exhaustive("hot", "every point, hot patch of 4096", 30, Pair::RingOnItself, tremble, 4096);
  rows.exhaustive("surface", "every point, whole surface", 35, Pair::RingOnItself, tremble);
  rows.culled("itself", "same surface on itself (worst case)", 0, Pair::RingOnItself, tremble);
  rows.cases.push_back(memoryCase("ring gear 512^3", Pair::RingOnItself, size));
  rows.exhaustive("outside", "every point, mostly outside", 75, Pair::PlanetInRing, gearMotion(0.1 * kMm));
  rows.culled("gears/0.1mm", "gears in mesh, 0.1 mm a step", 1000, Pair::PlanetInRing, gearMotion(0.1 * kMm));
  rows.culled("gears/0.01mm", "gears in mesh, 0.01 mm a step", 0, Pair::PlanetInRing, gearMotion(0.01 * kMm));
  rows.culled("hover/0.1mm", "hovering at 0.5 to 4 mm, 0.1 mm a step", 0, Pair::PlanetInRing,
              hoverMotion(0.1 * kMm));
  rows.culled("free/0.1mm", "free motion, 0.1 mm a step", 0, Pair::PlanetInRing, freeMotion(0.1 * kMm));
  rows.culled("peg/0.1mm", "peg in hole, 0.1 mm a step", 150, Pair::PegInPlate, pegMotion(0.1 * kMm));
  rows.culled("peg/0.01mm", "peg in hole, 0.01 mm a step", 0, Pair::PegInPlate, pegMotion(0.01 * kMm));
  // A nut has much surface: its map at 256^3 is as large as the maps of the other parts at 512^3.
  SceneSize half = size;
  half.voxels /= 2;
  rows.setSize(half);
  rows.culled("screw/0.1mm", "bolt in nut, full thread, 256^3, 0.1 mm a step", 60, Pair::RodInNut,
              screwMotion(0.1 * kMm));
  rows.culled("screw/0.01mm", "bolt in nut, full thread, 256^3, 0.01 mm a step", 0, Pair::RodInNut,
              screwMotion(0.01 * kMm));
  rows.cases.push_back(memoryCase("nut 256^3", Pair::RodInNut, half));
  rows.million("million/screw", "1,000,000 points, full thread, 256^3", Pair::RodInNut,
               screwMotion(0.1 * kMm));
  rows.setSize(size);
  rows.culled("screw512/0.1mm", "bolt in nut, full thread, 512^3, 0.1 mm a step", 0, Pair::RodInNut,
              screwMotion(0.1 * kMm));
  rows.cases.push_back(memoryCase("nut 512^3", Pair::RodInNut, size));
  rows.million("million/gears", "1,000,000 points, gears", Pair::PlanetInRing, gearMotion(0.1 * kMm));
  rows.million("million/peg", "1,000,000 points, peg", Pair::PegInPlate, pegMotion(0.1 * kMm));
  rows.cases.push_back(buildCase(size.voxels / 2, 12, size.coarser));
  rows.cases.push_back(buildCase(size.voxels, 15, size.coarser));
  rows.cases.push_back(mountCase(size));
  return std::move(rows.cases);
}

}  // namespace vps::bench
