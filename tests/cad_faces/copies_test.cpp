// SPDX-License-Identifier: BSD-3-Clause
// Shapes that are rigid copies of each other are triangulated once. Different shapes are triangulated in
// parallel, in copies of the process.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include <unistd.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Builder.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Writer.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Ax2.hxx>

#include "import/child_processes.h"
#include "occt/tessellate_all.h"
#include "vps_scenes/cad/import.h"

namespace vps::scenes {
namespace {

/// A plate with a hole that is not in its middle, in millimetres, so that only the identity maps it to
/// itself.
TopoDS_Shape plate(double hole_radius) {
  return BRepAlgoAPI_Cut(
             BRepPrimAPI_MakeBox(30, 20, 4).Shape(),
             BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(9, 6, -1), gp_Dir(0, 0, 1)), hole_radius, 6).Shape())
      .Shape();
}

gp_Trsf someMotion(int i) {
  gp_Trsf turn, shift;
  turn.SetRotation(gp_Ax1(gp_Pnt(1, 2, 3), gp_Dir(1, 2, 0.5 + i)), 0.7 * i);
  shift.SetTranslation(gp_Vec(40 * i, -17 * i, 5));
  return shift * turn;
}

/// A moved copy of the shape with its own geometry, as in a file without instances.
TopoDS_Shape copied(const TopoDS_Shape& shape, const gp_Trsf& motion) {
  return BRepBuilderAPI_Transform(shape, motion, true).Shape();
}

gp_Trsf mirrored() {
  gp_Trsf mirror;
  mirror.SetMirror(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)));
  return mirror;
}

ImportSettings tenMicrometres() {
  ImportSettings settings;
  settings.deflection_m = 1e-5;
  return settings;
}

/// The greatest distance between corresponding vertices of two meshes, which have their vertices in the same
/// order.
double farthest_m(const ImportedPart& a, const ImportedPart& b) {
  double farthest_m = 0;
  for (std::size_t i = 0; i < a.mesh.vertices.size(); ++i) {
    double nearest_m = 1e300;
    for (const Vec3& q : b.mesh.vertices)
      nearest_m = std::min(nearest_m, (a.X_WP * a.mesh.vertices[i] - b.X_WP * q).norm());
    farthest_m = std::max(farthest_m, nearest_m);
  }
  return farthest_m;
}

class Copies : public testing::Test {
 protected:
  void SetUp() override { Message::DefaultMessenger()->ChangePrinters().Clear(); }
  void TearDown() override { std::filesystem::remove(file_); }

  ImportedCad imported(const std::vector<TopoDS_Shape>& solids, const ImportSettings& settings) {
    TopoDS_Compound all;
    const BRep_Builder builder;
    builder.MakeCompound(all);
    for (const TopoDS_Shape& solid : solids) builder.Add(all, solid);
    STEPControl_Writer writer;
    writer.Transfer(all, STEPControl_AsIs);
    EXPECT_EQ(writer.Write(file_.c_str()), IFSelect_RetDone);
    return importCad(file_.string(), settings);
  }

  std::filesystem::path file_ =
      std::filesystem::temp_directory_path() /
      ("vps_copies_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".step");
};

TEST_F(Copies, HaveTheSameTrianglesAndEachItsPlace) {
  std::vector<TopoDS_Shape> solids;
  for (int i = 0; i < 5; ++i) solids.push_back(copied(plate(3), someMotion(i)));
  const ImportedCad cad = imported(solids, tenMicrometres());
  ASSERT_EQ(cad.parts.size(), 5U);
  for (std::size_t i = 1; i < 5; ++i) {
    EXPECT_EQ(cad.parts[i].mesh.vertices, cad.parts[0].mesh.vertices);
    EXPECT_EQ(cad.parts[i].mesh.triangles, cad.parts[0].mesh.triangles);
    // The position to which someMotion() moves a corner of the plate; the file has 15 digits.
    const gp_Pnt corner = gp_Pnt(30, 20, 4).Transformed(someMotion(int(i)));
    const gp_Pnt first = gp_Pnt(30, 20, 4).Transformed(someMotion(0));
    const Vec3 wanted_m = 1e-3 * Vec3(corner.X(), corner.Y(), corner.Z()),
               p_PC = cad.parts[0].X_WP.inverse() * Vec3(1e-3 * Vec3(first.X(), first.Y(), first.Z()));
    EXPECT_LT((cad.parts[i].X_WP * p_PC - wanted_m).norm(), 1e-12);
  }
}

TEST_F(Copies, AreNoneOfAMirrorImageOrOfAnotherSize) {
  const std::vector<TopoDS_Shape> solids = {plate(3), copied(plate(3), mirrored()),
                                            copied(plate(3.001), someMotion(1)),
                                            copied(plate(3), someMotion(2))};
  const auto number = [&](std::size_t i) {
    return import::tessellateAll(solids, tenMicrometres(), 1000, {}).shapes[i].number;
  };
  EXPECT_EQ(number(0), 0U);
  EXPECT_EQ(number(1), 1U);  // a mirror image has a number of its own
  EXPECT_EQ(number(2), 2U);  // so has a plate whose hole is 2 um wider
  EXPECT_EQ(number(3), 0U);
}

TEST_F(Copies, InOtherProcessesHaveTheBitsOfThoseMadeHere) {
  std::vector<TopoDS_Shape> solids;
  for (int i = 0; i < 6; ++i) solids.push_back(copied(plate(3 + 0.2 * i), someMotion(i)));
  ImportSettings settings = tenMicrometres();
  const ImportedCad one = imported(solids, settings);
  settings.in_own_process = false;
  const ImportedCad other = imported(solids, settings);
  ASSERT_EQ(one.parts.size(), 6U);
  ASSERT_EQ(other.parts.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(one.parts[i].mesh.vertices, other.parts[i].mesh.vertices);
    EXPECT_EQ(one.parts[i].mesh.triangles, other.parts[i].mesh.triangles);
    EXPECT_EQ(one.parts[i].deflection_m, other.parts[i].deflection_m);
    EXPECT_LT(farthest_m(one.parts[i], other.parts[i]), 1e-15);
  }
}

constexpr std::size_t kCopies = 3;  // number of worker processes, on a machine with one core too

std::vector<std::size_t> upTo(std::size_t n) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  return order;
}

TEST(ForkedWorkers, ReturnEachResultAtItsIndex) {
  std::vector<std::size_t> order = upTo(40);
  std::ranges::reverse(order);
  int count = 0;
  const std::vector<std::string> results = import::madeInCopies(
      order, [](std::size_t i) { return std::string(i * 5000, char('a' + i % 26)); }, [&] { ++count; },
      kCopies);
  ASSERT_EQ(results.size(), 40U);
  for (std::size_t i = 0; i < 40; ++i) EXPECT_EQ(results[i], std::string(i * 5000, char('a' + i % 26))) << i;
  EXPECT_EQ(count, 40);
}

TEST(ForkedWorkers, AreOtherProcesses) {
  if (!import::mayFork()) GTEST_SKIP() << "AddressSanitizer in a program with threads";
  for (const std::string& id : import::madeInCopies(
           upTo(4), [](std::size_t) { return std::to_string(::getpid()); }, {}, kCopies))
    EXPECT_NE(id, std::to_string(::getpid()));
}

TEST(ForkedWorkers, ThatEndEarlyLoseNothing) {
  const pid_t here = ::getpid();
  const auto make = [&](std::size_t i) {
    if (i % 7 == 3 && ::getpid() != here) ::_exit(3);  // simulates a crash
    return std::to_string(i);
  };
  const std::vector<std::string> results = import::madeInCopies(upTo(30), make, {}, kCopies);
  ASSERT_EQ(results.size(), 30U);
  for (std::size_t i = 0; i < 30; ++i) EXPECT_EQ(results[i], std::to_string(i));
}

TEST(ForkedWorkers, ThatThrowLetThisProcessThrowTheSame) {
  const auto make = [](std::size_t i) -> std::string {
    if (i == 4) throw std::runtime_error("no fifth");
    return "x";
  };
  EXPECT_THROW(import::madeInCopies(upTo(8), make, {}, kCopies), std::runtime_error);
}

}  // namespace
}  // namespace vps::scenes
