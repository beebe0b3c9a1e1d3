// SPDX-License-Identifier: BSD-3-Clause
// Solid of meshes that have several faults at once: cracks, T-junctions, turned and repeated facets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

#include "support/faulty_meshes.h"
#include "vps/mesh_repair.h"
#include "vps/solid.h"

namespace vps::test {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Makes faults in a mesh; equal seeds make equal faults.
class Faults {
 public:
  Faults(const Mesh& mesh, unsigned seed) : mesh_(mesh), random_(seed) {}

  void unweld() { mesh_ = faulty::unwelded(mesh_, 0); }
  /// Moves some of the corners of an unconnected set of facets.
  void crack(double width_m) {
    unweld();
    const double share = uniform(0.1, 1);
    for (Vec3& p : mesh_.vertices)
      if (uniform(0, 1) < share) p += width_m * Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
  }
  void cutAtTJunction() {
    Triangle& t = any();
    std::rotate(t.begin(), t.begin() + static_cast<int>(uniform(0, 3)), t.end());
    const auto [a, b, c] = t;
    const auto middle = static_cast<std::uint32_t>(mesh_.vertices.size());
    const double at = uniform(0.3, 0.7);
    mesh_.vertices.push_back((1 - at) * mesh_.vertices[a] + at * mesh_.vertices[b]);
    t = {a, middle, c};
    mesh_.triangles.push_back({middle, b, c});
  }
  void turnOne() { faulty::turn(any()); }
  void turnShare(double share) {
    for (Triangle& t : mesh_.triangles)
      if (uniform(0, 1) < share) faulty::turn(t);
  }
  void turnAll() { mesh_ = faulty::turned(mesh_); }
  void repeatOne() {
    const Triangle t = any();
    mesh_.triangles.push_back(t);
  }
  void repeatOneTurned() {
    repeatOne();
    faulty::turn(mesh_.triangles.back());
  }

  [[nodiscard]] const Mesh& mesh() const { return mesh_; }

 private:
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967296.0;  // uses all 32 bits
  }
  Triangle& any() {
    return mesh_.triangles[static_cast<std::size_t>(uniform(0, static_cast<double>(mesh_.triangles.size())))];
  }

  Mesh mesh_;
  std::mt19937 random_;
};

/// Corners along a crack are moved by this much along each axis.
constexpr double kCrack_m = 0.5e-6;

struct Combination {
  const char* name;
  void (*make)(Faults& faults);
  /// Half of a cavity's facets may be turned; nothing then distinguishes the cavity from a solid within the
  /// solid.
  bool turns_many = false;
};

// The faults, in the order in which they are made.
constexpr Combination kCombinations[] = {
    {"CracksAndOneTurned", [](Faults& f) { f.crack(kCrack_m), f.turnOne(); }},
    {"CracksAndAThirdTurned", [](Faults& f) { f.crack(kCrack_m), f.turnShare(0.33); }, true},
    {"CracksRepeatedAndTurned", [](Faults& f) { f.crack(kCrack_m), f.repeatOne(), f.turnOne(); }},
    {"CracksBesideRepeatedTurned", [](Faults& f) { f.repeatOneTurned(), f.crack(kCrack_m); }},
    {"CracksBesideRepeatedAndTurned", [](Faults& f) { f.repeatOne(), f.crack(kCrack_m), f.turnOne(); }},
    {"WideCracksAndTurned", [](Faults& f) { f.crack(10e-6), f.turnShare(0.2); }, true},
    {"CracksAndAllTurned", [](Faults& f) { f.crack(kCrack_m), f.turnAll(); }},
    {"TJunctionsAndTurned",
     [](Faults& f) { f.cutAtTJunction(), f.cutAtTJunction(), f.cutAtTJunction(), f.turnOne(), f.turnOne(); }},
    {"TJunctionsCracksAndTurned",
     [](Faults& f) {
       for (int i = 0; i < 4; ++i) f.cutAtTJunction();
       f.crack(kCrack_m), f.turnShare(0.33);
     },
     true},
    {"TJunctionsInCracksAndAllTurned",
     [](Faults& f) { f.crack(kCrack_m), f.cutAtTJunction(), f.cutAtTJunction(), f.turnAll(), f.turnOne(); }},
    {"SoupHalfTurned", [](Faults& f) { f.unweld(), f.turnShare(0.5); }, true},
    {"RepeatedTurned", [](Faults& f) { f.repeatOneTurned(); }},
    {"RepeatedTurnedBesideTurned", [](Faults& f) { f.repeatOneTurned(), f.repeatOneTurned(), f.turnOne(); }},
    {"RepeatedTurnedAndAllTurned", [](Faults& f) { f.repeatOneTurned(), f.turnAll(); }},
    {"RepeatedTurnedBesideTJunctions",
     [](Faults& f) { f.repeatOneTurned(), f.cutAtTJunction(), f.cutAtTJunction(), f.cutAtTJunction(); }},
    {"RepeatedAndBothCut",
     [](Faults& f) {
       f.repeatOne();
       for (int i = 0; i < 5; ++i) f.cutAtTJunction();
     }},
    {"RepeatedCutAndTurned", [](Faults& f) { f.repeatOne(), f.turnOne(), f.cutAtTJunction(); }},

};

Mesh tetrahedron() {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {0.006, 0.001, 0}, {0.001, 0.005, 0}, {0.002, 0.002, 0.007}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return transformed(mesh, faulty::pose());
}

/// A block with a cavity in the form of a ball.
Mesh hollow() {
  return faulty::joined(faulty::block({0.012, 0.014, 0.016}),
                        faulty::turned(transformed(makeSphere(0.004, 1), faulty::pose())));
}

/// The number of seeds; VPS_FAULT_SEEDS=1000 takes minutes.
unsigned seedCount() {
  const char* given = std::getenv("VPS_FAULT_SEEDS");
  return given != nullptr ? static_cast<unsigned>(std::atoi(given)) : 20;
}

class SolidOfCombinedFaults : public testing::TestWithParam<Combination> {};

TEST_P(SolidOfCombinedFaults, HasTheSignOfTheClosedMesh) {
  const std::pair<const char*, Mesh> parts[] = {
      {"tetrahedron", tetrahedron()}, {"wedge", faulty::wedge()},
      {"bracket", faulty::bracket()}, {"tube", faulty::tube()},
      {"hollow block", hollow()},     {"thin plate", faulty::block({0.016, 0.012, 0.15e-3})}};
  const unsigned seeds = seedCount();
  for (const auto& [part, closed] : parts) {
    if (GetParam().turns_many && std::string(part) == "hollow block") continue;
    const MeshDistance truth(closed);
    const Box box = bounds(closed);
    for (unsigned seed = 0; seed < seeds; ++seed) {
      Faults faults(closed, seed);
      GetParam().make(faults);
      const Solid solid(faults.mesh(), part);
      RandomPoints random(seed);
      int wrong = 0;
      double worst_m = 0;
      for (int i = 0; i < 300; ++i) {
        const Vec3 p = box.center() + random.inBox(0.55 * box.size());
        const double truth_m = truth.signedDistance(p);
        // A facet's corners move by 10 um sqrt(3) at most.
        if (std::abs(truth_m) < 20e-6 || (solid.signedDistance(p) < 0) == (truth_m < 0)) continue;
        ++wrong;
        worst_m = std::max(worst_m, std::abs(truth_m));
      }
      EXPECT_EQ(wrong, 0) << part << ", seed " << seed << ": up to " << 1e6 * worst_m << " um deep; "
                          << describe(solid.report());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, SolidOfCombinedFaults, testing::ValuesIn(kCombinations),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace vps::test
