// SPDX-License-Identifier: BSD-3-Clause
// The web server without sockets: access, messages to browsers, and messages from browsers.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "run/blow_sounds.h"
#include "viewer/web/web_run.h"
#include "vps_device/detail/bytes.h"
#include "web/access.h"
#include "web/browser_message.h"
#include "web/hub.h"
#include "web/snapshot_coder.h"
#include "web/web_files.h"

namespace vps::viewer {
namespace {

using device::ByteReader;
using nlohmann::json;
using test::FakeRun;

constexpr const char* kHost = "192.168.1.20:8080";
constexpr const char* kToken = "0123456789abcdef";

WebRequest request(std::string_view target) {
  WebRequest r;
  r.method = "GET";
  r.target = target;
  r.host = kHost;
  return r;
}

TEST(WebAccess, WithoutATokenNothingIsGiven) {
  const WebAccess access(kHost, kToken);
  EXPECT_EQ(access.judge(request("/")), WebAnswer::Unauthenticated);
  EXPECT_EQ(access.judge(request("/part/1/0/fine.glb")), WebAnswer::Unauthenticated);
  EXPECT_EQ(access.judge(request("/?token=0123456789abcdee")), WebAnswer::Unauthenticated);
  EXPECT_EQ(access.judge(request("/?token=")), WebAnswer::Unauthenticated);
  WebRequest socket = request("/run");
  socket.is_upgrade = true;
  socket.origin = "http://192.168.1.20:8080";
  EXPECT_EQ(access.judge(socket), WebAnswer::Unauthenticated);
  socket.target = "/?token=0123456789abcdef";  // only the page may be opened with a token in its address
  EXPECT_EQ(access.judge(socket), WebAnswer::Unauthenticated);
}

TEST(WebAccess, TheTokenGivesACookieAndTheCookieGivesAll) {
  const WebAccess access(kHost, kToken);
  EXPECT_EQ(access.judge(request("/?token=0123456789abcdef")), WebAnswer::SetCookie);
  EXPECT_EQ(access.setCookie(), "vps_8080=0123456789abcdef; Path=/; HttpOnly; SameSite=Strict");
  WebRequest with = request("/page.js");
  with.cookie = "other=1; vps_8080=0123456789abcdef";
  EXPECT_EQ(access.judge(with), WebAnswer::Good);
  with.cookie = "vps_8081=0123456789abcdef";  // cookie of another server of this machine
  EXPECT_EQ(access.judge(with), WebAnswer::Unauthenticated);
  with.cookie = "vps_8080=0123456789abcdef0";
  EXPECT_EQ(access.judge(with), WebAnswer::Unauthenticated);
  EXPECT_EQ(access.address(), "http://192.168.1.20:8080/?token=0123456789abcdef");
}

TEST(WebAccess, OtherPagesAndOtherNamesOfTheServerAreRefused) {
  const WebAccess access("127.0.0.1:8080", "");
  WebRequest r = request("/run");
  r.host = "127.0.0.1:8080";
  r.is_upgrade = true;
  EXPECT_EQ(access.judge(r), WebAnswer::BadOrigin);  // a browser sends the origin of its page
  r.origin = "http://evil.example";
  EXPECT_EQ(access.judge(r), WebAnswer::BadOrigin);
  r.origin = "http://127.0.0.1:8081";
  EXPECT_EQ(access.judge(r), WebAnswer::BadOrigin);
  r.origin = "http://127.0.0.1:8080";
  EXPECT_EQ(access.judge(r), WebAnswer::Good);
  r.host = "evil.example:8080";  // a foreign name that resolves to this machine
  r.origin = "http://evil.example:8080";
  EXPECT_EQ(access.judge(r), WebAnswer::BadHost);
  r.host = "localhost:8080";
  r.origin = "http://localhost:8080";
  EXPECT_EQ(access.judge(r), WebAnswer::Good);
  r.method = "POST";
  EXPECT_EQ(access.judge(r), WebAnswer::BadMethod);
}

TEST(WebAccess, AnEncryptedPageIsOfHttpsAndSoIsItsCookie) {
  const WebAccess access(kHost, kToken, true);
  EXPECT_TRUE(access.address().starts_with("https://")) << access.address();
  EXPECT_NE(access.setCookie().find("; Secure"), std::string::npos);
  EXPECT_EQ(WebAccess(kHost, kToken).setCookie().find("Secure"), std::string::npos);
  const std::string plain = std::string("http://") + kHost, encrypted = std::string("https://") + kHost;
  const WebAccess open(kHost, "", true);
  EXPECT_EQ(open.judge({"GET", "/run", kHost, encrypted, "", true}), WebAnswer::Good);
  EXPECT_EQ(open.judge({"GET", "/run", kHost, plain, "", true}), WebAnswer::BadOrigin);
}

TEST(WebAccess, NewTokensDifferAndShortOnesAreNotTaken) {
  EXPECT_EQ(newToken().size(), 32u);
  EXPECT_NE(newToken(), newToken());
  EXPECT_TRUE(isGoodToken(newToken()));
  EXPECT_FALSE(isGoodToken("0123456789abcde"));
  EXPECT_FALSE(isGoodToken("0123456789abcde;"));
}

TEST(WebAccess, ARateIsHeldAfterABurst) {
  RateLimit limit(10, 5);
  int taken = 0;
  for (int i = 0; i < 100; ++i) taken += limit.take(0);
  EXPECT_EQ(taken, 5);
  for (int i = 1; i <= 1000; ++i) taken += limit.take(0.01 * i);
  EXPECT_NEAR(taken, 5 + 10 * 10, 1);
}

TEST(PartGlb, HasThePartInMetresAsTheStandardAsks) {
  const Mesh mesh = makeBox(Vec3(0.01, 0.02, 0.03));
  const std::string file = partGlb(buildShadingMesh(mesh), 1000);
  ByteReader reader(file);
  EXPECT_EQ(reader.take(4), "glTF");
  EXPECT_EQ(reader.get<std::uint32_t>(), 2u);
  EXPECT_EQ(reader.get<std::uint32_t>(), file.size());
  const auto json_size = reader.get<std::uint32_t>();
  EXPECT_EQ(json_size % 4, 0u);
  EXPECT_EQ(reader.take(4), "JSON");
  const json head = json::parse(reader.take(json_size));
  const auto size = reader.get<std::uint32_t>();
  EXPECT_EQ(reader.take(4), std::string_view("BIN\0", 4));
  EXPECT_EQ(reader.left(), size);
  EXPECT_EQ(head["buffers"][0]["byteLength"], size);
  const json& primitives = head["meshes"][0]["primitives"];
  ASSERT_EQ(primitives.size(), 2u);
  EXPECT_EQ(primitives[0]["mode"], 4);
  EXPECT_EQ(primitives[1]["mode"], 1);
  const json& place = head["accessors"][primitives[0]["attributes"]["POSITION"].get<int>()];
  // A box has six faces of four corners and two triangles, and 12 edges.
  EXPECT_EQ(place["count"], 24);
  EXPECT_EQ(head["accessors"][primitives[0]["indices"].get<int>()]["count"], 36);
  EXPECT_EQ(head["accessors"][primitives[1]["attributes"]["POSITION"].get<int>()]["count"], 24);
  const Box box = bounds(mesh);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    const double middle = head["nodes"][0]["translation"][k];
    EXPECT_NEAR(middle + place["max"][k].get<double>(), box.max[axis], 1e-8);  // rounding of floats
    EXPECT_NEAR(middle + place["min"][k].get<double>(), box.min[axis], 1e-8);
  }
}

TEST(PartGlb, HasTheColorsOfFaces) {
  const Mesh mesh = makeBox(Vec3(0.01, 0.02, 0.03));
  scenes::FaceColors colors{{{1, 0, 0}, {0, 0.5f, 1}}, {}};
  for (std::uint32_t i = 0; i < 12; ++i) colors.of_triangle.push_back(i < 4 ? 1 : 0);
  const std::string file = partGlb(buildShadingMesh(mesh, kCreaseAngle_rad, &colors), 1000);
  ByteReader reader(file);
  reader.take(12);
  const auto json_size = reader.get<std::uint32_t>();
  reader.take(4);
  const json head = json::parse(reader.take(json_size));
  const json& attributes = head["meshes"][0]["primitives"][0]["attributes"];
  ASSERT_TRUE(attributes.contains("COLOR_0"));
  const json& of = head["accessors"][attributes["COLOR_0"].get<int>()];
  ASSERT_EQ(of["count"], 24);
  reader.take(8 + head["bufferViews"][of["bufferView"].get<int>()]["byteOffset"].get<std::size_t>());
  std::map<std::array<float, 3>, int> vertices;
  for (int i = 0; i < 24; ++i) {
    std::array<float, 3> color{};
    for (float& channel : color) channel = reader.getFloat();
    ++vertices[color];
  }
  // Two of the six faces have a colour of their own, with four corners each, and four faces have the other
  // colour.
  EXPECT_EQ(vertices, (std::map<std::array<float, 3>, int>{{{0, 0.5f, 1}, 8}, {{1, 0, 0}, 16}}));
}

/// State of a browser after some messages, decoded as in page.js.
struct Decoded {
  std::uint32_t number = 0;
  double time_s = 0;
  int step = -1;
  std::map<int, std::pair<int, Vec3>> bodies;  ///< role and position, by part
  Vec3 force = Vec3::Zero();
  std::size_t contacts = 0, bodies_in_message = 0;

  void read(const std::string& bytes) {
    ByteReader r(bytes);
    EXPECT_EQ(r.get<std::uint8_t>(), kShotKind);
    number = r.get<std::uint32_t>();
    time_s = r.getDouble();
    r.getDouble();
    step = static_cast<std::int16_t>(r.get<std::uint16_t>());
    const auto flags = r.get<std::uint8_t>();
    if ((flags & 4) != 0) bodies.clear();
    bodies_in_message = r.get<std::uint16_t>();
    for (std::size_t i = 0; i < bodies_in_message; ++i) {
      const int part = r.get<std::uint16_t>(), role = r.get<std::uint8_t>();
      const Vec3 p = pose(r);
      if (role == 255)
        bodies.erase(part);
      else
        bodies[part] = {role, p};
    }
    if ((flags & 1) != 0) r.get<std::uint16_t>(), pose(r);
    if ((flags & 2) != 0) pose(r), force = vector(r), vector(r);
    contacts = r.get<std::uint16_t>();
    r.take(contacts * (12 + 3 + 8));
    EXPECT_TRUE(r.isGood());
    EXPECT_EQ(r.left(), 0u);
  }
  static Vec3 vector(ByteReader& r) {
    const float x = r.getFloat(), y = r.getFloat(), z = r.getFloat();
    return {x, y, z};
  }
  static Vec3 pose(ByteReader& r) {
    const Vec3 p = vector(r);
    r.take(16);
    return p;
  }
};

WatchedShot shotOf(const std::vector<scenes::BodySnapshot>& bodies) {
  WatchedShot shot;
  shot.snapshot.bodies = bodies;
  shot.snapshot.time_s = 0.5;
  shot.snapshot.step = 3;
  return shot;
}

TEST(SnapshotCoder, ABrowserThatReadsAllKnowsEveryBody) {
  const Vec3 center(1, 2, 3);
  SnapshotCoder coder(center);
  Decoded browser;
  std::vector<scenes::BodySnapshot> bodies;
  for (std::size_t i = 0; i < 20; ++i)
    bodies.push_back({i, Pose::translation(Vec3(1.1, 2, 3)), scenes::BodyRole::Mounted});
  browser.read(coder.encode(shotOf(bodies)));
  EXPECT_EQ(browser.bodies_in_message, 20u);
  EXPECT_EQ(browser.step, 3);
  bodies[7].X_WP.p.z() += 1e-3;
  browser.read(coder.encode(shotOf(bodies)));
  EXPECT_EQ(browser.bodies_in_message, 1u);
  bodies.erase(bodies.begin() + 4);
  browser.read(coder.encode(shotOf(bodies)));
  EXPECT_EQ(browser.bodies_in_message, 1u);
  EXPECT_EQ(browser.number, 3u);
  ASSERT_EQ(browser.bodies.size(), bodies.size());
  for (const scenes::BodySnapshot& body : bodies) {
    const auto& [role, p] = browser.bodies.at(static_cast<int>(body.part));
    EXPECT_EQ(role, static_cast<int>(body.role));
    EXPECT_LT((center + p - body.X_WP.p).norm(), 0.11 * 1.2e-7);  // rounding of 0.1 m to floats
  }
}

TEST(SnapshotCoder, ABodyThatRestsCostsNothing) {
  SnapshotCoder coder(Vec3::Zero());
  std::vector<scenes::BodySnapshot> bodies;
  for (std::size_t i = 0; i < 100; ++i) bodies.push_back({i, {}, scenes::BodyRole::Mounted});
  const std::size_t whole = coder.encode(shotOf(bodies)).size();
  const std::size_t still = coder.encode(shotOf(bodies)).size();
  EXPECT_EQ(whole - still, 100u * (2 + 1 + 28));
  EXPECT_EQ(still, 28u);
}

TEST(BrowserMessage, WhatIsSaidIsReadAndAllElseIsRefused) {
  const auto moved = readBrowserMessage(R"({"move":[0.001,0,-2e-3]})");
  ASSERT_TRUE(moved.has_value());
  EXPECT_EQ(moved->word, BrowserWord::Move);
  EXPECT_EQ(*moved->vector, Vec3(0.001, 0, -0.002));
  EXPECT_EQ(readBrowserMessage(R"({"ack":12})")->number, 12);
  EXPECT_EQ(readBrowserMessage(R"({"point":null})")->word, BrowserWord::Point);
  EXPECT_FALSE(readBrowserMessage(R"({"point":null})")->vector.has_value());
  for (const char* bad :
       {"", "{", "[]", "12", "null", R"({"move":null})", R"({"move":[1,2]})", R"({"move":[1,2,"3"]})",
        R"({"move":[1,2,1e999]})", R"({"move":[1,2,1e10]})", R"({"ack":"1"})", R"({"ack":1,"ping":2})",
        R"({"fly":[1,2,3]})", R"({"move":[[1],[2],[3]]})", R"({"take":true})", "{\"move\":[1,2,\xff]}"})
    EXPECT_FALSE(readBrowserMessage(bad).has_value()) << bad;
  EXPECT_FALSE(readBrowserMessage(R"({"ack":)" + std::string(600, '1') + "}").has_value());
}

/// A message that is cut or has a changed byte is read or refused, without other effects.
TEST(BrowserMessage, ChangedBytesDoNoHarm) {
  const std::string good = R"({"grab":[0.1,-2.5e-3,3]})";
  for (std::size_t i = 0; i < good.size(); ++i) {
    readBrowserMessage(good.substr(0, i));
    for (int c = 0; c < 256; ++c) {
      std::string changed = good;
      changed[i] = static_cast<char>(c);
      const auto read = readBrowserMessage(changed);
      EXPECT_TRUE(!read || !read->vector || read->vector->allFinite());
    }
  }
}

/// A browser that is connected to the hub.
class FakeBrowser final : public BrowserEnd {
 public:
  void sendText(std::string text) override { texts.push_back(json::parse(text)); }
  void sendBytes(std::string bytes) override {
    if (bytes[0] == static_cast<char>(kShotKind)) {
      known.read(bytes);
      ++shots;
    } else {
      ++sounds;
    }
  }
  [[nodiscard]] bool isFree() const override { return is_free; }

  /// The last message with a key; null: there is none.
  [[nodiscard]] json last(const char* key) const {
    for (std::size_t i = texts.size(); i-- > 0;)
      if (texts[i].contains(key)) return texts[i][key];
    return nullptr;
  }

  std::vector<json> texts;
  Decoded known;
  int shots = 0, sounds = 0;
  bool is_free = true;
};

/// A hub at 60 Hz, with a simulated clock.
class WebHubTest : public testing::Test {
 protected:
  void turn(double z_m, bool has_contact = false) {
    run_.show(z_m, has_contact);
    now_s_ += 1.0 / 60;
    hub_.poll(now_s_);
  }
  bool say(int browser, const std::string& text) { return hub_.hear(browser, text, now_s_); }
  void ack(int browser, const FakeBrowser& end) {
    say(browser, R"({"ack":)" + std::to_string(end.known.number) + "}");
  }

  double now_s_ = 1;
  FakeRun run_{true};
  WebHub hub_{run_, 60};
  FakeBrowser a_, b_;
};

TEST_F(WebHubTest, EachBrowserLearnsTheSceneAndWhatHappenedBefore) {
  run_.news = {{0.25, "step 'peg' fits", {}}};
  turn(0.05);
  const int a = hub_.join(a_);
  EXPECT_EQ(a_.last("hello")["you"], a);
  EXPECT_EQ(a_.last("hello")["run"], 1);
  EXPECT_EQ(a_.last("hello")["parts"][1]["name"], "peg <1>");
  EXPECT_EQ(a_.last("hello")["steps"][0]["part"], 1);
  EXPECT_EQ(a_.last("news")["text"], "step 'peg' fits");
  turn(0.04);
  EXPECT_EQ(a_.shots, 1);
  EXPECT_EQ(a_.known.bodies.at(1).first, static_cast<int>(scenes::BodyRole::InHand));
  run_.run_number = 2;  // another scene
  turn(0.03);
  EXPECT_EQ(a_.last("hello")["run"], 2);
  EXPECT_EQ(a_.known.number, 1u);
}

// The number of snapshots that a browser has not drawn is bounded. The browser misses older snapshots, but
// not the newest.
TEST_F(WebHubTest, ASlowBrowserGetsFewerSnapshotsAndTheOthersAll) {
  hub_.join(a_);
  const int b = hub_.join(b_);
  for (int i = 0; i < 300; ++i) {
    turn(0.05 - 1e-4 * i);
    ack(b, b_);
  }
  EXPECT_EQ(a_.shots, static_cast<int>(kMostUnseen));
  EXPECT_EQ(b_.shots, 300);
  ack(1, a_);
  turn(0.001);
  EXPECT_EQ(a_.known.bodies.at(1).second.z(), b_.known.bodies.at(1).second.z());
  b_.is_free = false;  // the socket of browser b is full
  turn(0.002);
  EXPECT_EQ(b_.shots, 301);
}

TEST_F(WebHubTest, SnapshotsAreNotSentFasterThanTheRate) {
  const int a = hub_.join(a_);
  for (int i = 0; i < 1000; ++i) {
    run_.show(1e-5 * i);
    hub_.poll(now_s_ += 0.001);
    ack(a, a_);
  }
  EXPECT_NEAR(a_.shots, 60, 1);
}

TEST_F(WebHubTest, APointerIsSeenByAllAndGoesWithItsBrowser) {
  hub_.join(a_);
  const int b = hub_.join(b_);
  turn(0.05);
  EXPECT_TRUE(say(b, R"({"point":[0.01,0.02,0.03]})"));
  EXPECT_EQ(a_.last("pointer"), json::parse(R"({"who":2,"p":[0.01,0.02,0.03]})"));
  FakeBrowser late;
  hub_.join(late);
  EXPECT_EQ(late.last("pointer")["who"], 2);
  hub_.leave(b);
  EXPECT_EQ(a_.last("pointer"), json::parse(R"({"who":2,"p":null})"));
  EXPECT_EQ(a_.last("watchers"), 2);
}

TEST_F(WebHubTest, PointersGoToThoseWhoWatchElsewhereAndComeFromThem) {
  hub_.join(a_);
  const int b = hub_.join(b_);
  turn(0.05);
  say(b, R"({"point":[0.01,0.02,0.03]})");
  hub_.leave(b);
  ASSERT_EQ(run_.pointed.size(), 2u);
  EXPECT_EQ(run_.pointed[0].who, b);
  EXPECT_EQ(run_.pointed[0].p_W, Vec3(0.01, 0.02, 0.03));
  EXPECT_FALSE(run_.pointed[1].p_W);
  run_.elsewhere = {{2001, Vec3(0.5, 0, 0)}};
  turn(0.05);
  EXPECT_EQ(a_.last("pointer"), json::parse(R"({"who":2001,"p":[0.5,0.0,0.0]})"));
  FakeBrowser late;
  hub_.join(late);
  EXPECT_EQ(late.last("pointer")["who"], 2001);
  run_.elsewhere = {{2001, {}}};
  turn(0.05);
  EXPECT_EQ(a_.last("pointer"), json::parse(R"({"who":2001,"p":null})"));
}

TEST_F(WebHubTest, OneBrowserAtATimeHasTheHand) {
  const int a = hub_.join(a_), b = hub_.join(b_);
  turn(0.05);
  EXPECT_EQ(a_.last("hand"), json::parse(R"({"may_take":true,"holder":0})"));
  say(a, R"({"take":null})");
  say(b, R"({"take":null})");
  EXPECT_EQ(b_.last("hand")["holder"], a);
  const auto wish = run_.drag()->wish();
  say(b, R"({"grab":[0,0,0.05]})");
  say(b, R"({"move":[0,0,-0.01]})");
  EXPECT_FALSE(run_.drag()->isGrabbed());
  say(a, R"({"move":[0,0,-0.01]})");  // nothing is grabbed
  EXPECT_EQ(wish->read().p, Vec3::Zero());
  say(a, R"({"grab":[0,0,0.05]})");
  EXPECT_TRUE(run_.drag()->isGrabbed());
  say(a, R"({"move":[0,0,-0.01]})");
  EXPECT_EQ(wish->read().p, Vec3(0, 0, -0.01));
  say(a, R"({"turn":[0,0,0.5]})");
  EXPECT_NEAR(rotationVector(wish->read().R).z(), 0.5, 1e-12);
  say(a, R"({"move":[0,0,-1e6]})");  // far beyond the scene
  EXPECT_EQ(wish->read().p, Vec3(0, 0, -0.01));
  hub_.leave(a);
  EXPECT_FALSE(run_.drag()->isGrabbed());
  EXPECT_EQ(b_.last("hand")["holder"], 0);
  say(b, R"({"take":null})");
  EXPECT_EQ(b_.last("hand")["holder"], b);
}

TEST(WebHub, WithoutTheRightNobodyTakesTheHand) {
  FakeRun run(false);
  WebHub hub(run, 60);
  FakeBrowser a;
  const int number = hub.join(a);
  run.show(0.05);
  hub.poll(1);
  EXPECT_TRUE(hub.hear(number, R"({"take":null})", 1));
  EXPECT_EQ(a.last("hand"), json::parse(R"({"may_take":false,"holder":0})"));
}

TEST(WebHub, ARecordingIsPlayedByAllWhoWatchAndLateOnesSeeItsState) {
  FakeRun run(false);
  run.playing = Playback{1, 9, true};
  WebHub hub(run, 60);
  FakeBrowser a, late;
  const int number = hub.join(a);
  run.show(0.05);
  hub.poll(1);
  EXPECT_EQ(a.last("playback"), json::parse(R"({"begin_s":1.0,"end_s":9.0,"is_playing":true})"));
  EXPECT_TRUE(hub.hear(number, R"({"play":0})", 1));
  EXPECT_TRUE(hub.hear(number, R"({"seek":4.5})", 1));
  EXPECT_EQ(run.sought_s, 4.5);
  hub.poll(1.1);
  EXPECT_EQ(a.last("playback")["is_playing"], false);
  hub.join(late);
  EXPECT_EQ(late.last("playback"), a.last("playback"));
}

TEST_F(WebHubTest, AFloodAndGarbageEndTheConnection) {
  const int a = hub_.join(a_), b = hub_.join(b_);
  int heard = 0;
  while (heard < 10000 && say(a, R"({"ping":1})")) ++heard;
  EXPECT_EQ(heard, 400);  // capacity of the rate limit
  heard = 0;
  while (heard < 10000 && say(b, "garbage")) ++heard;
  EXPECT_EQ(heard, 10);
  EXPECT_FALSE(hub_.hear(77, R"({"ping":1})", now_s_));  // there is no such browser
}

TEST_F(WebHubTest, AnAckOfWhatWasNotSentIsIgnored) {
  const int a = hub_.join(a_);
  say(a, R"({"ack":1e9})");
  for (int i = 0; i < 10; ++i) turn(1e-3 * i);
  EXPECT_EQ(a_.shots, static_cast<int>(kMostUnseen));
}

TEST_F(WebHubTest, PartsAreFilesAndNothingElseIs) {
  turn(0.05);
  ASSERT_NE(hub_.partFile("/part/1/0/fine.glb"), nullptr);
  EXPECT_EQ(hub_.partFile("/part/1/1/coarse.glb")->substr(0, 4), "glTF");
  for (const char* bad :
       {"/part/1/2/fine.glb", "/part/2/0/fine.glb", "/part/1/-1/fine.glb", "/part/1/0/fine",
        "/part/1/0/../0/fine.glb", "/part/1", "/part/", "/part/1/99999999999999999999/fine.glb"})
    EXPECT_EQ(hub_.partFile(bad), nullptr) << bad;
}

TEST_F(WebHubTest, AnImpactIsHeardByThoseWhoListen) {
  const int a = hub_.join(a_);
  hub_.join(b_);
  say(a, R"({"sound":1})");
  turn(0.05);
  for (int i = 1; i <= 5; ++i) turn(0.05 - 1e-3 * i);
  turn(0.045, true);  // the part arrives at 60 mm/s and stops
  for (int i = 0; i < 1000 && a_.sounds == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    turn(0.045, true);
    ack(a, a_);
  }
  EXPECT_EQ(a_.sounds, 1);
  EXPECT_EQ(b_.sounds, 0);
}

TEST(BlowSense, AnImpactIsTheMassTimesTheSpeedThatContactTakesAway) {
  BlowSense sense({0, 0.2});
  FakeRun run;
  const auto hear = [&](double z_m, bool has_contact) {
    run.show(z_m, has_contact);
    return sense.hear(run.next->snapshot);
  };
  EXPECT_FALSE(hear(0.050, false));
  EXPECT_FALSE(hear(0.049, false));
  const std::optional<Blow> blow = hear(0.049, true);
  ASSERT_TRUE(blow.has_value());
  EXPECT_EQ(blow->part, 1u);
  EXPECT_NEAR(blow->impulse_Ns, 0.2 * 1e-3 * 60, 1e-9);
  EXPECT_FALSE(hear(0.048, true));  // the part slides on
}

}  // namespace
}  // namespace vps::viewer
