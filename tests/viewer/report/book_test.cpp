// SPDX-License-Identifier: BSD-3-Clause
// The page of an instruction book, and the balloons of its pictures; no test needs OpenGL.
#include "vps_viewer/report/book.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "pages/book_pictures.h"
#include "viewer/small_run.h"

namespace vps::viewer {
namespace {

using test::smallScene;

/// The peg of smallScene() comes straight down into the hole.
scenes::PlanResult pegPlan() {
  scenes::PlanResult plan;
  plan.assembly = "peg & <hole>";
  scenes::PlannedStep step;
  step.name = "peg <1>";
  step.parts = {"peg <1>"};
  step.before_W = {Pose::translation(Vec3(0, 0, 0.05))};
  step.insertion_W = -Vec3::UnitZ();
  step.is_carried = true;
  step.clearance_m = 35e-6;
  step.nearest = "hole";
  scenes::PlannedAssembly whole;
  whole.name = plan.assembly;
  whole.fixed = {"hole"};
  whole.steps = {step};
  whole.order = {{"hole", "peg <1>", scenes::OrderReason::Carries}};
  plan.assemblies = {whole};
  plan.contacts.resize(1);
  plan.contacts[0].a = "hole";
  plan.contacts[0].b = "peg <1>";
  return plan;
}

scenes::CheckResult pegCheck() {
  scenes::CheckResult checked;
  scenes::CheckedFit fit;
  fit.shaft = "peg <1>";
  fit.bore = "hole";
  fit.shaft_m = 0.02;
  fit.bore_m = 0.0202;
  fit.diametral_clearance_m = 0.2e-3;
  fit.length_m = 0.03;
  checked.fits = {fit};
  scenes::CheckedPart part;
  part.name = "peg <1>";
  part.play.emplace();
  part.play->m = {100e-6, 100e-6, 100e-6, 100e-6, std::numeric_limits<double>::infinity(), 0};
  checked.parts = {part};
  return checked;
}

scenes::Book pegBook(const scenes::PlanResult& plan) {
  return makeBook(smallScene(), plan, pegCheck(), true);
}

std::string joinedLines(const scenes::Book& book) {
  std::string out;
  for (const std::string& line : bookLines(book, book.chapters.back().steps.back())) out += line + "\n";
  return out;
}

std::string wordsOnly(const scenes::Book& book) {
  std::ostringstream out;
  EXPECT_EQ(writeBook(out, smallScene(), book, {.progress = {}, .has_pictures = false}), "");
  return out.str();
}

TEST(BookWords, AStraightStepHasDirectionDistanceFitAndPlay) {
  const std::string lines = joinedLines(pegBook(pegPlan()));
  for (const char* words : {"Move 'peg <1>' straight down (-z) by 50.00 mm.", "to carry it: 'hole'",
                            "clears 'hole' by only 35 µm", "20.000 mm in 20.200 mm, clearance 200.0 µm",
                            "along +x +100.0 / -100.0 µm", "along +z +free / -0.0 µm"})
    EXPECT_NE(lines.find(words), std::string::npos) << words << "\n" << lines;
  EXPECT_EQ(lines.find("Hold it"), std::string::npos) << lines;
  EXPECT_EQ(lines.find("Tighten"), std::string::npos) << lines;
}

TEST(BookWords, DirectionsAreThoseOfThePicture) {
  scenes::PlanResult plan = pegPlan();
  scenes::PlannedStep& step = plan.assemblies.front().steps.front();
  step.before_W = {Pose::translation(Vec3(0.03, 0, 0))};
  EXPECT_NE(joinedLines(pegBook(plan)).find("straight to the left (-x) by 30.00 mm"), std::string::npos);
  step.before_W = {Pose::translation(Vec3(0, -0.03, 0))};
  EXPECT_NE(joinedLines(pegBook(plan)).find("straight to the back (+y) by 30.00 mm"), std::string::npos);
  step.before_W = {Pose::translation(Vec3(0, -0.03, 0.04))};
  EXPECT_NE(joinedLines(pegBook(plan)).find("obliquely down and to the back (0.00, 0.60, -0.80) by 50.00 mm"),
            std::string::npos);
  // With gravity along +y, down is +y.
  scenes::Scene scene = smallScene();
  scene.gravity_W = Vec3(0, 9.81, 0);
  step.before_W = {Pose::translation(Vec3(0, -0.03, 0))};
  EXPECT_NE(joinedLines(makeBook(scene, plan, {}, true)).find("straight down (+y) by 30.00 mm"),
            std::string::npos);
}

TEST(BookWords, AScrewSaysItsTurnsAndItsTorque) {
  scenes::PlanResult plan = pegPlan();
  scenes::PlannedStep& step = plan.assemblies.front().steps.front();
  step.kind = scenes::WayKind::Screw;
  step.lead_m = 1.5e-3;
  step.is_carried = false;
  scenes::Scene scene = smallScene();
  scene.steps.front().torque_Nm = 2.5;
  scenes::CheckResult checked = pegCheck();
  checked.fits.front().kind = scenes::FitKind::Thread;
  const std::string lines = joinedLines(makeBook(scene, plan, checked, true));
  for (const char* words : {"240.0 degrees per mm (right-hand, lead 1.500 mm), clockwise",
                            "A thread of 30.00 mm takes about 20.0 turns", "Tighten it with 2.5 N m.",
                            "Hold it until the end of the step"})
    EXPECT_NE(lines.find(words), std::string::npos) << words << "\n" << lines;
  step.lead_m = -1.5e-3;
  EXPECT_NE(
      joinedLines(makeBook(scene, plan, checked, true)).find("left-hand, lead 1.500 mm), counter-clockwise"),
      std::string::npos);
}

TEST(BookWords, LegsAreNumberedAndATurnSaysItsDegreesPerMillimetre) {
  scenes::PlanResult plan = pegPlan();
  scenes::PlannedStep& step = plan.assemblies.front().steps.front();
  step.kind = scenes::WayKind::Legs;
  // Down by 40 mm, then 10 mm more during a quarter turn.
  const Mat3 quarter = rotationFromVector(Vec3(0, 0, -std::numbers::pi / 2));
  step.before_W = {Pose(quarter, Vec3(0, 0, 0.05)), Pose(quarter, Vec3(0, 0, 0.01))};
  const std::string lines = joinedLines(pegBook(plan));
  for (const char* words :
       {"has 2 legs: 1. move it straight down (-z) by 40.00 mm; 2. turn it 90.0 degrees counter-clockwise as "
        "seen from above (about +z)",
        "must be turned by 9.00 degrees per mm"})
    EXPECT_NE(lines.find(words), std::string::npos) << words << "\n" << lines;
}

TEST(BookPage, HasACoverASheetForEachStepAndAnEnd) {
  const std::string page = wordsOnly(pegBook(pegPlan()));
  std::size_t last = 0;
  for (const char* words :
       {"<section class=\"sheet\" id=\"cover\">", "Instruction book: peg &amp; &lt;hole&gt;", "peg &lt;1&gt;",
        "<section class=\"sheet step\" id=\"step_1\"><h2>Step 1 of 1: peg &lt;1&gt;</h2>",
        "Begin with &#39;hole&#39;", "<b>is mounted</b>", "is in place", "straight down (-z) by 50.00 mm",
        "id=\"rest\"", "A path was found for every part.", "</html>"}) {
    const std::size_t at = page.find(words, last);
    ASSERT_NE(at, std::string::npos) << words;
    last = at;
  }
  EXPECT_EQ(page.find("<hole>"), std::string::npos);
  EXPECT_EQ(page, wordsOnly(pegBook(pegPlan()))) << "the same input gives the same bytes";
}

TEST(BookPage, APartWithoutAPathIsTold) {
  scenes::PlanResult plan = pegPlan();
  scenes::PlannedAssembly& whole = plan.assemblies.front();
  whole.steps.clear();
  whole.fixed.emplace_back("peg <1>");
  whole.blocked.emplace_back();
  whole.blocked.back().name = "peg <1>";
  whole.blocked.back().by = {"hole"};
  whole.blocked.back().is_searched = false;
  const std::string page = wordsOnly(pegBook(plan));
  for (const char* words : {"No path was found for 1 part", "&#39;peg &lt;1&gt;&#39;: no path was found",
                            "stopped by &#39;hole&#39;", "ended at its limit"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
  EXPECT_EQ(page.find("A path was found for every part"), std::string::npos);
}

TEST(BookPicture, ShowsThePartAtItsStartAndNamesPartsThatExist) {
  const scenes::Scene scene = smallScene();
  const scenes::Book book = pegBook(pegPlan());
  const RenderScene drawn = bookMeshes(scene);
  const scenes::BookStep& step = book.chapters.front().steps.front();
  const BookPicture picture = stepPicture(drawn, book, {"hole"}, step, 1.5);
  ASSERT_EQ(picture.snapshot.bodies.size(), 2U);
  EXPECT_EQ(picture.snapshot.bodies[1].role, scenes::BodyRole::InHand);
  EXPECT_NEAR(picture.snapshot.bodies[1].X_WP.p.z() - book.parts.at("peg <1>").X_WP.p.z(), 0.05, 1e-12);
  ASSERT_EQ(picture.balloons.size(), 2U);
  for (const BookPicture& one : {picture, coverPicture(drawn, book, 1.5)})
    for (const BookBalloon& balloon : one.balloons) {
      ASSERT_TRUE(book.parts.contains(balloon.name)) << balloon.name;
      EXPECT_EQ(balloon.number, book.items[book.parts.at(balloon.name).item].number);
    }
  // The arrow leads from the start to the target, down in the picture.
  ASSERT_EQ(picture.arrows_W.size(), 1U);
  const auto from = picture.camera.project(picture.arrows_W[0].front(), 900, 600),
             to = picture.camera.project(picture.arrows_W[0].back(), 900, 600);
  EXPECT_NEAR(from[0], to[0], 1);
  EXPECT_LT(from[1] + 50, to[1]);
  for (const auto& at : {from, to}) {
    EXPECT_GT(at[1], 0);
    EXPECT_LT(at[1], 600);
  }
}

TEST(BookPicture, AScrewHasATurningArrow) {
  scenes::PlanResult plan = pegPlan();
  plan.assemblies.front().steps.front().kind = scenes::WayKind::Screw;
  plan.assemblies.front().steps.front().lead_m = 1e-3;
  const scenes::Book book = pegBook(plan);
  const BookPicture picture =
      stepPicture(bookMeshes(smallScene()), book, {"hole"}, book.chapters.front().steps.front(), 1.5);
  ASSERT_EQ(picture.arrows_W.size(), 2U);
  // A right-hand screw that goes down turns by the right-hand rule about -z.
  const std::vector<Vec3>& arc = picture.arrows_W[1];
  const Vec3 middle = picture.arrows_W[0].front();
  EXPECT_LT((arc[0] - middle).cross(arc[1] - middle).z(), 0);
}

TEST(BookPicture, BalloonsDoNotCoverEachOther) {
  BookPicture picture;
  picture.camera.eye_W = Vec3(0, -1, 0);
  for (std::size_t i = 0; i < 40; ++i)  // all lines lead to one place on the left
    picture.balloons.push_back({i + 1, "part " + std::to_string(i), Vec3(-0.05, 0, 0), false});
  const std::string svg = pictureSvg(picture, "", 900, 600);
  std::vector<double> ys;
  double radius_px = 0;
  const std::string begin = "<circle cx=\"";
  for (std::size_t at = svg.find(begin); at != std::string::npos; at = svg.find(begin, at + 1)) {
    const std::size_t y_at = svg.find("cy=\"", at) + 4, r_at = svg.find(" r=\"", at) + 4;
    if (svg.substr(r_at, 2) == "3\"") continue;  // the end of a line
    ys.push_back(std::stod(svg.substr(y_at)));
    radius_px = std::stod(svg.substr(r_at));
  }
  ASSERT_EQ(ys.size(), 40U);
  std::ranges::sort(ys);
  EXPECT_GE(ys.front(), radius_px);
  EXPECT_LE(ys.back(), 600 - radius_px);
  constexpr double kRounding_px = 0.2;  // coordinates have one decimal
  for (std::size_t i = 1; i < ys.size(); ++i) EXPECT_GE(ys[i] - ys[i - 1], 2 * radius_px - kRounding_px);
}

}  // namespace
}  // namespace vps::viewer
