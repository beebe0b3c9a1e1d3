// SPDX-License-Identifier: BSD-3-Clause
// How far bodies turn in a step, the warnings about it, and the number of substeps.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "bullet_bridge/world.h"
#include "vps_bullet/log.h"
#include "vps_bullet/turn.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::SolverKind;
using test::World;

/// Keeps the messages of its lifetime.
class Messages {
 public:
  Messages() {
    setLogHook([this](LogLevel, const std::string& words) { all_.push_back(words); });
  }
  ~Messages() { setLogHook({}); }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;
  [[nodiscard]] long count(const std::string& words) const {
    return std::count_if(all_.begin(), all_.end(),
                         [&](const std::string& each) { return each.find(words) != std::string::npos; });
  }

 private:
  std::vector<std::string> all_;
};

const Built& disc() {
  static const Built built = test::build(makeCylinder(0.01, 0.005, 48), 7850, 0.5e-3, 1e-3);
  return built;
}

/// A disc that turns about its axis, on a plate or away from everything.
struct SpinningDisc {
  World world;
  btRigidBody* body = nullptr;

  SpinningDisc(double w_rad_s, bool is_on_plate, const Settings& settings = {})
      : world(SolverKind::Constraint, settings) {
    static const Built ground = test::plate();
    world.add(ground, Pose::translation({0, 0, -0.005}), true, 0);
    body = &world.add(disc(), Pose::translation({0, 0, is_on_plate ? 0.0025 : 1.0}), false, 0);
    body->setAngularVelocity({0, 0, toBt(w_rad_s)});
  }
};

const char* const kClamped = "Bullet turns a body by less";
const char* const kInContact = "touch and turn against each other";

TEST(Turn, ABodyThatBulletTurnsLessThanItsSpeedIsReportedOnce) {
  for (const double turn_rad : {0.78, 0.79}) {  // pi / 4 is 0.785
    const Messages messages;
    SpinningDisc spinning(turn_rad / 1e-3, false);
    spinning.world.step(5);
    EXPECT_EQ(messages.count(kClamped), turn_rad > kBulletTurn_rad ? 1 : 0);
    EXPECT_EQ(messages.count(kInContact), 0);
  }
}

TEST(Turn, BodiesInContactThatTurnTooFarAreReportedOnceWithTheRateThatHoldsThem) {
  for (const double turn_rad : {0.099, 0.1013}) {
    const Messages messages;
    SpinningDisc spinning(turn_rad / 1e-3, true);
    spinning.world.step(5);
    EXPECT_EQ(messages.count(kInContact), turn_rad > kContactTurn_rad ? 1 : 0);
    // The float nearest to 101.3 rad/s is 3e-8 above it, so that in 1013 steps a second the disc turns by
    // more than the limit.
    const char* const rate = test::kIsDouble ? "1013 steps a second or more" : "1014 steps a second or more";
    EXPECT_EQ(messages.count(rate), turn_rad > kContactTurn_rad ? 1 : 0);
  }
}

TEST(Turn, NothingIsReportedWhereTheHostDoesNotWantIt) {
  Settings settings;
  settings.warns_of_turns = false;
  const Messages messages;
  SpinningDisc(2000, true, settings).world.step(3);
  EXPECT_EQ(messages.count("steps a second"), 0);
}

TEST(Turn, TheTurnOfABodyIsThatAgainstWhatItTouches) {
  for (const bool is_on_plate : {false, true}) {
    SpinningDisc spinning(200, is_on_plate);
    spinning.world.step(2);
    std::vector<BodyTurn> turns;
    findTurns(*spinning.world.world, turns);
    ASSERT_EQ(turns.size(), 1U);
    EXPECT_EQ(turns[0].body, spinning.body);
    EXPECT_EQ(turns[0].is_in_contact, is_on_plate);
    EXPECT_NEAR(turns[0].w_rad_s, 200, 1e-3);
    EXPECT_NEAR(turns[0].rate_hz(), is_on_plate ? 2000 : 200 / kBulletTurn_rad, 0.1);
  }
}

TEST(Turn, ATimeIsDividedByTheFastestBody) {
  const auto parts = [](double w_rad_s, bool is_on_plate) {
    SpinningDisc spinning(w_rad_s, is_on_plate);
    spinning.world.world->performDiscreteCollisionDetection();
    return substepsFor(*spinning.world.world, 1e-3, 1000);
  };
  EXPECT_EQ(parts(0, true), 1);
  EXPECT_EQ(parts(99, true), 1);
  EXPECT_EQ(parts(101, true), 2);
  EXPECT_EQ(parts(1047, true), 11);   // 10,000 rpm
  EXPECT_EQ(parts(1047, false), 2);   // 1.047 rad, at most 0.785 in a step
  EXPECT_EQ(parts(1e7, true), 1000);  // the most
}

// The limit applies from the step in which the body lands.
TEST(Turn, AStepIsDividedBeforeABodyLands) {
  for (const auto& [gap_m, expected] : {std::pair(0.9e-3, 11), std::pair(1.1e-3, 2)}) {
    SpinningDisc spinning(1047, true);
    spinning.body->translate(btVector3(0, 0, toBt(gap_m)));
    spinning.body->setLinearVelocity(btVector3(0, 0, -1));  // moves by 1.00 mm, and by 10 um more by weight
    spinning.world.world->performDiscreteCollisionDetection();
    EXPECT_EQ(substepsFor(*spinning.world.world, 1e-3, 1000), expected) << gap_m;
  }
}

// The plate's points beside the box come near the box's edges but not below them, so they are not contacts.
TEST(Turn, ABoxThatSpinsFlatIsHeldByItsFaceAlone) {
  static const Built ground = test::build(makeBox(Vec3(60e-3, 60e-3, 6e-3)), 7850, 0.25e-3, 0.5e-3);
  static const Built cube = test::build(makeBox(Vec3::Constant(10e-3)), 7850, 0.25e-3, 0.5e-3);
  const double w_rad_s = 400;
  Settings quiet;
  quiet.warns_of_turns = false;
  for (int k = 0; k < 8; ++k) {
    World world(SolverKind::Constraint, quiet);
    world.add(ground, Pose::translation({1e-3 * k, 0, -3e-3}), true, 0);
    btRigidBody& body = world.add(cube, Pose::translation({0, 0, 5e-3}), false, 0);
    body.setAngularVelocity({0, 0, toBt(w_rad_s)});
    world.step(10);
    EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 5e-3, 1e-6) << k;
    EXPECT_NEAR(body.getLinearVelocity().length(), 0, 1e-3) << k;
    EXPECT_NEAR(body.getAngularVelocity().z(), w_rad_s, 1e-6 * w_rad_s) << k;
  }
}

// A ball that rolls turns about the point that it touches.
TEST(Turn, ABallThatRollsIsNotReported) {
  const Messages messages;
  static const Built ground = test::plate(), ball = test::build(makeSphere(0.005, 3), 7850, 0.5e-3, 1e-3);
  World world;
  world.add(ground, Pose::translation({0, 0, -0.005}), true, 1);
  btRigidBody& body = world.add(ball, Pose::translation({-0.02, 0, 0.005}), false, 1);
  body.setAngularVelocity({0, toBt(150), 0});  // 0.15 rad in a step
  body.setLinearVelocity({toBt(150 * 0.005), 0, 0});
  world.step(20);
  EXPECT_GT(body.getAngularVelocity().y(), 110);
  EXPECT_EQ(messages.count(kInContact), 0);
}

TEST(Turn, OneStepIsNotReported) {
  const Messages messages;
  SpinningDisc spinning(200, true);
  spinning.world.step(kTurnsInRow - 1);
  spinning.body->setAngularVelocity({0, 0, 0});
  spinning.world.step(5);
  EXPECT_EQ(messages.count(kInContact), 0);
}

TEST(Turn, PairsThatDoNotCollideDivideNoStep) {
  SpinningDisc trigger(1047, true);
  trigger.body->setCollisionFlags(trigger.body->getCollisionFlags() |
                                  btCollisionObject::CF_NO_CONTACT_RESPONSE);
  trigger.world.world->performDiscreteCollisionDetection();
  EXPECT_EQ(substepsFor(*trigger.world.world, 1e-3, 1000), 2);
  std::vector<BodyTurn> turns;
  findTurns(*trigger.world.world, turns);
  ASSERT_EQ(turns.size(), 1U);
  EXPECT_FALSE(turns[0].is_in_contact);

  SpinningDisc linked(1047, true);
  linked.world.world->performDiscreteCollisionDetection();
  EXPECT_EQ(substepsFor(*linked.world.world, 1e-3, 1000), 11);
  linked.body->setIgnoreCollisionCheck(linked.world.bodies[0].get(), true);
  EXPECT_EQ(substepsFor(*linked.world.world, 1e-3, 1000), 2);
}

// Two bodies that turn together do not turn against each other.
TEST(Turn, BodiesThatTurnTogetherAreLimitedByBulletAlone) {
  World world;
  const double w_rad_s = 500;
  for (const int i : {0, 1}) {
    btRigidBody& body = world.add(disc(), Pose::translation({0, 0, 0.005 * i}), false, 0);
    body.setAngularVelocity({0, 0, toBt(w_rad_s)});
  }
  world.world->performDiscreteCollisionDetection();
  EXPECT_EQ(substepsFor(*world.world, 1e-3, 1000), 1);
}

}  // namespace
}  // namespace vps::bullet
