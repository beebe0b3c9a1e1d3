// SPDX-License-Identifier: BSD-3-Clause
// Solids with curved faces, written as STEP and imported again: the triangles lie on the faces, and the
// volumes agree with formulas.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Writer.hxx>
#include <gp_Ax2.hxx>

#include "vps_scenes/cad/import.h"

namespace vps::scenes {
namespace {

constexpr double kPi = std::numbers::pi;

/// A solid in millimetres, with formulas in its own frame.
struct Solid {
  TopoDS_Shape shape;
  double volume_mm3 = 0;
  /// Distance from the nearest surface that bounds the solid.
  std::function<double(const Vec3&)> distance_mm;
};

double fromAxis(double a, double b, double radius) {
  return std::abs(std::hypot(a, b) - radius);
}

/// A shaft along z with a hole along x through its middle.
Solid crossDrilled(double R, double r) {
  const double length = 3 * R;
  Solid out;
  const gp_Ax2 along_x(gp_Pnt(-2 * R, 0, length / 2), gp_Dir(1, 0, 0));
  out.shape = BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(R, length).Shape(),
                              BRepPrimAPI_MakeCylinder(along_x, r, 4 * R).Shape())
                  .Shape();
  // Volume of the intersection of both cylinders, whose slices across y are rectangles. The substitution y =
  // r sin(t) makes the integrand smooth at the ends.
  constexpr int kSlices = 2000;
  double common = 0;
  for (int i = 0; i < kSlices; ++i) {
    const double t = kPi * ((i + 0.5) / kSlices - 0.5), y = r * std::sin(t);
    common += 4 * std::sqrt(R * R - y * y) * r * std::cos(t) * r * std::cos(t) * kPi / kSlices;
  }
  out.volume_mm3 = kPi * R * R * length - common;
  out.distance_mm = [=](const Vec3& p) {
    return std::min({fromAxis(p.x(), p.y(), R), fromAxis(p.y(), p.z() - length / 2, r), std::abs(p.z()),
                     std::abs(p.z() - length)});
  };
  return out;
}

/// A ring with a round groove around its outside, as the inner ring of a ball bearing.
Solid ballRace(double R, double groove) {
  const double bore = 0.6 * R, width = 3 * groove;
  Solid out;
  const TopoDS_Shape ring = BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(R, width).Shape(),
                                            BRepPrimAPI_MakeCylinder(bore, width).Shape())
                                .Shape();
  const gp_Ax2 middle(gp_Pnt(0, 0, width / 2), gp_Dir(0, 0, 1));
  out.shape = BRepAlgoAPI_Cut(ring, BRepPrimAPI_MakeTorus(middle, R, groove).Shape()).Shape();
  // The volume of half a disc that is swept around the axis, by Pappus's theorem.
  const double half_disc = kPi * groove * groove / 2, center = R - 4 * groove / (3 * kPi);
  out.volume_mm3 = kPi * (R * R - bore * bore) * width - 2 * kPi * center * half_disc;
  out.distance_mm = [=](const Vec3& p) {
    const double radius = std::hypot(p.x(), p.y());
    return std::min({std::abs(radius - R), std::abs(radius - bore), std::abs(p.z()), std::abs(p.z() - width),
                     fromAxis(radius - R, p.z() - width / 2, groove)});
  };
  return out;
}

/// A ball with a hole through its middle. The volume of the drilled ball is that of a whole ball whose
/// diameter is the length of the hole.
Solid drilledBall(double R, double r) {
  Solid out;
  const gp_Ax2 along_z(gp_Pnt(0, 0, -2 * R), gp_Dir(0, 0, 1));
  out.shape =
      BRepAlgoAPI_Cut(BRepPrimAPI_MakeSphere(R).Shape(), BRepPrimAPI_MakeCylinder(along_z, r, 4 * R).Shape())
          .Shape();
  const double length = 2 * std::sqrt(R * R - r * r);
  out.volume_mm3 = kPi / 6 * length * length * length;
  out.distance_mm = [=](const Vec3& p) {
    return std::min(std::abs(p.norm() - R), fromAxis(p.x(), p.y(), r));
  };
  return out;
}

class CadFaces : public testing::Test {
 protected:
  void SetUp() override { Message::DefaultMessenger()->ChangePrinters().Clear(); }
  void TearDown() override { std::filesystem::remove(file_); }

  /// Imports the solid at another pose and compares it with the formulas.
  void expectAsDrawn(const Solid& solid, double turn_rad, double deflection_mm) {
    gp_Trsf turn, shift;
    turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 2, 3)), turn_rad);
    shift.SetTranslation(gp_Vec(10, -20, 30));
    STEPControl_Writer writer;
    writer.Transfer(BRepBuilderAPI_Transform(solid.shape, shift * turn).Shape(), STEPControl_AsIs);
    ASSERT_EQ(writer.Write(file_.c_str()), IFSelect_RetDone);
    ImportSettings settings;
    settings.deflection_m = 1e-3 * deflection_mm;
    const ImportedCad cad = importCad(file_.string(), settings);
    ASSERT_EQ(cad.parts.size(), 1U);
    const ImportedPart& part = cad.parts.front();
    EXPECT_TRUE(part.note.empty()) << part.note;

    const gp_Trsf back = (shift * turn).Inverted();
    double worst_mm = 0;
    for (const auto& t : part.mesh.triangles) {
      Vec3 center_W = Vec3::Zero();
      for (const std::uint32_t i : t) center_W += part.X_WP * part.mesh.vertices[i] / 3;
      const gp_Pnt p = gp_Pnt(1e3 * center_W.x(), 1e3 * center_W.y(), 1e3 * center_W.z()).Transformed(back);
      worst_mm = std::max(worst_mm, solid.distance_mm({p.X(), p.Y(), p.Z()}));
    }
    // Open CASCADE checks the deflection only at some points; the import accepts three times the deflection.
    EXPECT_LE(worst_mm, 3 * deflection_mm + 1e-6);
    EXPECT_LE(worst_mm, 1e3 * *part.deflection_m + 1e-6);
    const double slack_m3 = 3e-3 * deflection_mm * area(part.mesh);
    EXPECT_NEAR(massProperties(part.mesh).volume_m3, 1e-9 * solid.volume_mm3, slack_m3);
  }

  std::filesystem::path file_ =
      std::filesystem::temp_directory_path() /
      ("vps_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".step");
};

// If Open CASCADE makes triangles without points inside faces, all of these shafts are wrong.
TEST_F(CadFaces, CrossDrilledShafts) {
  for (const double R : {2.0, 10.0})
    for (const double share : {0.1, 0.5, 0.95})
      for (const double turn_rad : {0.0, 0.8})
        for (const double deflection_mm : {1e-3, 0.02}) {
          SCOPED_TRACE(testing::Message() << R << " " << share << " " << turn_rad << " " << deflection_mm);
          expectAsDrawn(crossDrilled(R, share * R), turn_rad, deflection_mm);
        }
}

TEST_F(CadFaces, BallRaces) {
  for (const double R : {4.0, 25.0})
    for (const double share : {0.05, 0.2})
      for (const double turn_rad : {0.0, 0.8})
        for (const double deflection_mm : {2e-3, 0.05}) {
          SCOPED_TRACE(testing::Message() << R << " " << share << " " << turn_rad << " " << deflection_mm);
          expectAsDrawn(ballRace(R, share * R), turn_rad, deflection_mm);
        }
}

TEST_F(CadFaces, DrilledBalls) {
  for (const double R : {1.5, 12.0})
    for (const double share : {0.1, 0.6, 0.95})
      for (const double turn_rad : {0.0, 0.8}) {
        SCOPED_TRACE(testing::Message() << R << " " << share << " " << turn_rad);
        expectAsDrawn(drilledBall(R, share * R), turn_rad, 5e-3);
      }
}

}  // namespace
}  // namespace vps::scenes
