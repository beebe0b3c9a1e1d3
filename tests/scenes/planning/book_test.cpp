// SPDX-License-Identifier: BSD-3-Clause
// Instruction books of assemblies whose plan is known.
#include "vps_scenes/planning/book.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "scenes/assemblies_to_plan.h"

namespace vps::scenes {
namespace {

using PartNames = std::vector<std::string>;

/// A plate with two equal posts, and a lid on both posts.
Scene tableScene() {
  Scene scene = sceneOf({at("plate", makeBox({0.1, 0.1, 0.01}), {0, 0, 0}),
                         at("post_a", makeBox({0.01, 0.01, 0.02}), {-0.03, 0, 0.015}),
                         at("lid", makeBox({0.1, 0.1, 0.01}), {0, 0, 0.03}),
                         at("post_b", makeBox({0.01, 0.01, 0.02}), {0.03, 0, 0.015})});
  scene.parts.front().is_fixed = true;
  return scene;
}

PlannedStep stepDown(const std::string& name, double height_m) {
  PlannedStep step;
  step.name = name;
  step.parts = {name};
  step.before_W = {Pose::translation({0, 0, height_m})};
  step.insertion_W = -Vec3::UnitZ();
  step.is_carried = true;
  return step;
}

/// The plan of tableScene(), without its search.
PlanResult tablePlan() {
  PlanResult plan;
  plan.assembly = "table";
  PlannedAssembly whole;
  whole.name = "table";
  whole.fixed = {"plate"};
  whole.steps = {stepDown("post_b", 0.05), stepDown("post_a", 0.05), stepDown("lid", 0.04)};
  whole.order = {{"post_a", "lid", OrderReason::Carries}, {"post_b", "lid", OrderReason::Way}};
  plan.assemblies = {whole};
  plan.equal = {{{"post_a", "post_b"}}};
  plan.contacts.resize(3);
  plan.contacts[0].a = "plate";
  plan.contacts[0].b = "post_a";
  plan.contacts[1].a = "post_a";
  plan.contacts[1].b = "lid";
  plan.contacts[2].a = "plate";
  plan.contacts[2].b = "post_b";
  return plan;
}

const BookStep& bookStep(const Book& book, const std::string& name) {
  for (const BookChapter& chapter : book.chapters)
    for (const BookStep& step : chapter.steps)
      if (step.planned.name == name) return step;
  ADD_FAILURE() << "no step " << name;
  return book.chapters.front().steps.front();
}

void expectEachPartInOneItem(const Book& book, const PartNames& names) {
  std::multiset<std::string> listed;
  for (std::size_t i = 0; i < book.items.size(); ++i) {
    EXPECT_EQ(book.items[i].number, i + 1);
    for (const std::string& name : book.items[i].names) {
      listed.insert(name);
      EXPECT_EQ(book.parts.at(name).item, i) << name;
    }
  }
  EXPECT_EQ(listed, std::multiset<std::string>(names.begin(), names.end()));
}

TEST(Book, EqualPartsShareARowAndEveryPartIsInOneRow) {
  const Book book = makeBook(tableScene(), tablePlan(), {}, true);
  expectEachPartInOneItem(book, {"plate", "post_a", "post_b", "lid"});
  ASSERT_EQ(book.items.size(), 3U);
  EXPECT_EQ(book.items[0].names, PartNames{"plate"});
  EXPECT_EQ(book.items[1].names, (PartNames{"post_b", "post_a"})) << "in the order of assembly";
  EXPECT_LT((book.items[1].size_m - Vec3(0.01, 0.01, 0.02)).norm(), 1e-12);
  ASSERT_TRUE(book.items[1].mass_kg.has_value());
  EXPECT_NEAR(*book.items[1].mass_kg, 2e-6 * Material().density_kg_m3, 1e-9);
  EXPECT_FALSE(makeBook(tableScene(), tablePlan(), {}, false).items[1].mass_kg.has_value());
}

TEST(Book, StepsFollowThePlanAndNameWhatComesBefore) {
  const Book book = makeBook(tableScene(), tablePlan(), {}, true);
  ASSERT_EQ(book.chapters.size(), 1U);
  ASSERT_EQ(book.steps(), 3U);
  PartNames names;
  for (const BookStep& step : book.chapters.front().steps) {
    names.push_back(step.planned.name);
    EXPECT_EQ(step.number, names.size());
  }
  EXPECT_EQ(names, (PartNames{"post_b", "post_a", "lid"}));
  const BookStep& lid = bookStep(book, "lid");
  ASSERT_EQ(lid.needs.size(), 2U);
  EXPECT_EQ(lid.needs[0].before, "post_a");
  ASSERT_EQ(lid.legs.size(), 1U);
  EXPECT_LT((lid.legs[0].move_W - Vec3(0, 0, -0.04)).norm(), 1e-12);
  // The lid touches post_a as well, but is not in place when post_a is mounted.
  ASSERT_EQ(bookStep(book, "post_a").neighbours.size(), 1U);
  EXPECT_EQ(bookStep(book, "post_a").neighbours[0].name, "plate");
}

TEST(Book, FitsAndPlayAreThoseOfTheStepsPartWithPartsInPlace) {
  CheckResult checked;
  CheckedFit fit;
  fit.shaft = "post_a";
  fit.bore = "plate";
  checked.fits.push_back(fit);
  fit.bore = "lid";
  checked.fits.push_back(fit);
  CheckedPart part;
  part.name = "post_a";
  checked.parts.push_back(part);
  part.play.emplace();
  checked.parts.push_back(part);
  const Book book = makeBook(tableScene(), tablePlan(), checked, true);
  ASSERT_EQ(bookStep(book, "post_a").fits.size(), 1U);
  EXPECT_EQ(bookStep(book, "post_a").fits[0].bore, "plate");
  ASSERT_EQ(bookStep(book, "lid").fits.size(), 1U);
  EXPECT_EQ(bookStep(book, "post_a").measured.size(), 1U) << "only with a measured play";
  EXPECT_TRUE(bookStep(book, "post_b").fits.empty());
}

TEST(Book, PiecesOfATurnAreOneLeg) {
  PlanResult plan = tablePlan();
  PlannedStep& step = plan.assemblies.front().steps.back();
  step.before_W.clear();
  // The lid comes down, and is turned by three pieces of 30 degrees about z.
  const auto turned = [](double angle_rad, double height_m) {
    return Pose(rotationFromVector({0, 0, angle_rad}), {0, 0, height_m});
  };
  constexpr double kPiece_rad = std::numbers::pi / 6;
  step.before_W = {turned(-3 * kPiece_rad, 0.04), turned(-3 * kPiece_rad, 0), turned(-2 * kPiece_rad, 0),
                   turned(-kPiece_rad, 0)};
  const Book book = makeBook(tableScene(), plan, {}, true);
  const std::vector<BookLeg>& legs = bookStep(book, "lid").legs;
  ASSERT_EQ(legs.size(), 2U);
  EXPECT_LT((legs[0].move_W - Vec3(0, 0, -0.04)).norm(), 1e-9);
  EXPECT_LT(legs[0].turn_W.norm(), 1e-9);
  EXPECT_LT((legs[1].turn_W - Vec3(0, 0, std::numbers::pi / 2)).norm(), 1e-9);
}

TEST(Book, PartsOfTheExplodedViewAreApart) {
  const Book book = makeBook(tableScene(), tablePlan(), {}, true);
  std::vector<Box> boxes;
  for (const auto& [name, part] : book.parts) {
    const Box box = part.box_W(Pose::translation(part.apart_W));
    for (const Box& other : boxes) EXPECT_FALSE(overlap(box, other)) << name;
    boxes.push_back(box);
  }
  EXPECT_EQ(book.parts.at("plate").apart_W, Vec3(Vec3::Zero()));
  EXPECT_GT(book.parts.at("lid").apart_W.z(), book.parts.at("post_a").apart_W.z());
}

TEST(Book, ASubassemblyComesBeforeTheAssemblyThatMountsIt) {
  PlanResult plan = tablePlan();
  PlannedStep posts = stepDown("subassembly_1", 0.05);
  posts.parts = {"post_a", "post_b"};
  plan.assemblies.front().steps = {posts, stepDown("lid", 0.04)};
  PlannedAssembly sub;
  sub.name = "subassembly_1";
  sub.fixed = {"post_a"};
  PlannedStep across = stepDown("post_b", 0);
  across.before_W = {Pose::translation({0.05, 0, 0})};
  across.insertion_W = -Vec3::UnitX();
  sub.steps = {across};
  plan.assemblies.push_back(sub);
  const Book book = makeBook(tableScene(), plan, {}, true);
  ASSERT_EQ(book.chapters.size(), 2U);
  EXPECT_EQ(book.chapters[0].name, "subassembly_1");
  EXPECT_EQ(bookStep(book, "post_b").number, 1U);
  EXPECT_EQ(bookStep(book, "subassembly_1").number, 2U);
  expectEachPartInOneItem(book, {"plate", "post_a", "post_b", "lid"});
  EXPECT_GT(book.parts.at("post_b").apart_W.x(), 0);
  EXPECT_NEAR(book.parts.at("post_b").apart_W.z(), book.parts.at("post_a").apart_W.z(), 1e-12);
}

TEST(Book, PartsWithoutAPathAndPartsThatAreLeftOutAreTold) {
  PlanResult plan = tablePlan();
  PlannedAssembly& whole = plan.assemblies.front();
  whole.steps.pop_back();
  whole.fixed.push_back("lid");
  whole.blocked.emplace_back();
  whole.blocked.back().name = "lid";
  whole.blocked.back().by = {"post_a"};
  plan.choices.resize(1);
  plan.choices[0].left_out = "seal";
  plan.choices[0].words = "'seal' seems to be drawn undeformed";
  const Book book = makeBook(tableScene(), plan, {}, true);
  ASSERT_EQ(book.blocked.size(), 1U);
  EXPECT_EQ(book.blocked[0].name, "lid");
  ASSERT_EQ(book.left_out.size(), 1U);
  EXPECT_EQ(book.left_out[0].name, "seal");
  expectEachPartInOneItem(book, {"plate", "post_a", "post_b", "lid"});
}

TEST(Book, TheOrderIsThatOfARealPlan) {
  const Scene scene = tableScene();
  const PlanResult plan = planAssembly(scene);
  const Book book = makeBook(scene, plan, {}, false);
  expectEachPartInOneItem(book, {"plate", "post_a", "post_b", "lid"});
  ASSERT_EQ(book.steps(), plan.steps());
  EXPECT_EQ(book.chapters.back().steps.back().planned.name, "lid");
  EXPECT_EQ(book.items.size(), 2U) << "the posts are equal, and so are plate and lid";
}

}  // namespace
}  // namespace vps::scenes
