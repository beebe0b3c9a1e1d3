// SPDX-License-Identifier: BSD-3-Clause
// The web page's server with sockets, and in a browser.
#include "beast/server.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "run/presentation.h"
#include "support/process/chromium.h"
#include "viewer/web/web_run.h"
#include "vps/errors.h"
#include "vps_viewer/draw/image.h"

namespace vps::viewer {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::asio::ip::tcp;
using nlohmann::json;
using test::FakeRun;
using vps::test::Chromium;

/// A run whose peg moves up and down without end, with 60 snapshots a second.
class MovingRun final : public WatchedRun {
 public:
  explicit MovingRun(bool allows_hand) : run_(allows_hand) {}
  void poll() override {
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return;
    next_ = std::max(next_ + std::chrono::microseconds(16667), now);
    const double height_m = is_still ? 0.05 : 0.05 + 0.01 * std::sin(6 * run_.time_s);
    run_.show(height_m, true);
    run_.next->taken_ns =
        std::chrono::duration_cast<std::chrono::nanoseconds>(now.time_since_epoch()).count();
  }
  [[nodiscard]] const scenes::Scene* scene() const override { return run_.scene(); }
  [[nodiscard]] int number() const override { return run_.number(); }
  [[nodiscard]] std::string doing() const override { return {}; }
  std::optional<WatchedShot> takeShot() override { return run_.takeShot(); }
  std::vector<WatchedNews> takeNews() override { return run_.takeNews(); }
  [[nodiscard]] HandDrag* drag() override { return run_.drag(); }

  std::atomic<bool> is_still{false};

 private:
  FakeRun run_;
  std::chrono::steady_clock::time_point next_;
};

class WebServerTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!missingForWeb().empty()) GTEST_SKIP() << missingForWeb();
  }
  void TearDown() override { end(); }

  void begin(WebOptions options = {}, bool allows_hand = false) {
    run_ = std::make_unique<MovingRun>(allows_hand);
    options.port = 0;
    options.stop = &stop_;
    server_ = std::make_unique<WebServer>(*run_, options);
    host_ = "127.0.0.1:" + std::to_string(server_->port());
    thread_ = std::thread([this] { server_->serve(); });
  }
  void end() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    server_.reset();
  }
  [[nodiscard]] tcp::endpoint endpoint() const {
    return {boost::asio::ip::address_v4::loopback(), server_->port()};
  }

  struct Answer {
    unsigned status = 0;
    std::string body, policy, cookie, location;
  };
  Answer get(const std::string& target, const std::string& host = "", const std::string& cookie = "",
             http::verb verb = http::verb::get) {
    tcp::socket socket(io_);
    socket.connect(endpoint());
    http::request<http::empty_body> request(verb, target, 11);
    request.set(http::field::host, host.empty() ? host_ : host);
    if (!cookie.empty()) request.set(http::field::cookie, cookie);
    http::write(socket, request);
    beast::flat_buffer buffer;
    http::response_parser<http::string_body> parser;
    parser.body_limit(64U << 20U);
    http::read(socket, buffer, parser);
    const auto& response = parser.get();
    return {response.result_int(), response.body(), std::string(response["Content-Security-Policy"]),
            std::string(response[http::field::set_cookie]), std::string(response[http::field::location])};
  }

  /// The WebSocket of a browser. Throws if the server refuses it.
  struct Socket {
    Socket(boost::asio::io_context& io, const tcp::endpoint& end, const std::string& host,
           const std::string& origin)
        : stream(io) {
      stream.next_layer().connect(end);
      stream.set_option(websocket::stream_base::decorator([origin](websocket::request_type& request) {
        if (!origin.empty()) request.set(http::field::origin, origin);
      }));
      stream.handshake(host, "/run");
    }
    std::string read() {
      beast::flat_buffer buffer;
      stream.read(buffer);
      return beast::buffers_to_string(buffer.data());
    }
    void say(const std::string& text) {
      stream.text(true);
      stream.write(boost::asio::buffer(text));
    }
    /// Receives and acknowledges the next snapshot. Returns the snapshot's number.
    std::uint32_t nextShot() {
      for (;;) {
        const std::string bytes = read();
        if (stream.got_text()) continue;
        std::uint32_t number = 0;
        for (std::size_t i = 0; i < 4; ++i)
          number |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[1 + i])) << (8 * i);
        say(R"({"ack":)" + std::to_string(number) + "}");
        return number;
      }
    }
    websocket::stream<tcp::socket> stream;
  };
  std::unique_ptr<Socket> open() {
    return std::make_unique<Socket>(io_, endpoint(), host_, "http://" + host_);
  }

  boost::asio::io_context io_;
  std::atomic<bool> stop_{false};
  std::unique_ptr<MovingRun> run_;
  std::unique_ptr<WebServer> server_;
  std::string host_;
  std::thread thread_;
};

TEST_F(WebServerTest, ServesThePageItsScriptsAndTheParts) {
  begin();
  const Answer page = get("/");
  EXPECT_EQ(page.status, 200u);
  EXPECT_NE(page.body.find("<canvas"), std::string::npos);
  EXPECT_NE(page.policy.find("default-src 'none'; script-src 'self'"), std::string::npos) << page.policy;
  for (const char* target : {"/page.js", "/page.css", "/three.js", "/orbit_controls.js", "/gltf_loader.js"})
    EXPECT_EQ(get(target).status, 200u) << target;
  EXPECT_EQ(get("/part/1/0/fine.glb").body.substr(0, 4), "glTF");
  for (const char* target : {"/page.html", "/../etc/passwd", "//", "/part/1/9/fine.glb", "*"})
    EXPECT_EQ(get(target).status, 404u) << target;
}

TEST_F(WebServerTest, RefusesOtherNamesOtherMethodsAndOtherOrigins) {
  begin();
  EXPECT_EQ(get("/", "evil.example").status, 403u);
  EXPECT_EQ(get("/", "", "", http::verb::post).status, 405u);
  EXPECT_THROW(Socket(io_, endpoint(), host_, ""), boost::system::system_error);
  EXPECT_THROW(Socket(io_, endpoint(), host_, "http://evil.example"), boost::system::system_error);
  EXPECT_NO_THROW(open());
}

TEST_F(WebServerTest, WithATokenOnlyThoseWhoKnowItReadOrMoveAnything) {
  WebOptions options;
  options.token = "0123456789abcdef";
  begin(options, true);
  for (const char* target : {"/", "/page.js", "/part/1/0/fine.glb", "/?token=0123456789abcdee"})
    EXPECT_EQ(get(target).status, 401u) << target;
  EXPECT_THROW(open(), boost::system::system_error);
  const Answer answer = get("/?token=0123456789abcdef");
  EXPECT_EQ(answer.status, 303u);
  EXPECT_EQ(answer.location, "/");
  const std::string cookie = answer.cookie.substr(0, answer.cookie.find(';'));
  EXPECT_EQ(get("/part/1/0/fine.glb", "", cookie).status, 200u);
}

TEST_F(WebServerTest, AddressesThatOthersReachNeedATokenAndGetOne) {
  MovingRun run(false);
  WebOptions options;
  options.port = 0;
  options.address = "127.0.0.1";
  EXPECT_EQ(WebServer(run, options).address().find("token"), std::string::npos);
  options.token = "short";
  EXPECT_THROW(WebServer(run, options), LoadError);
  options.token.clear();
  for (const char* address : {"0.0.0.0", "::", "nonsense", "203.0.113.7"}) {
    options.address = address;
    try {
      const WebServer server(run, options);
      FAIL() << address;
    } catch (const LoadError& refused) {
      EXPECT_NE(std::string(refused.what()).find("`ip addr` lists the addresses"), std::string::npos)
          << refused.what();
    }
  }
}

TEST_F(WebServerTest, GarbageAndHugeRequestsCloseTheirConnectionOnly) {
  begin();
  const std::unique_ptr<Socket> good = open();
  for (const std::string& bytes :
       {std::string("\x16\x03\x01\x02garbage\r\n\r\n"), "GET / HTTP/1.1\r\nx: " + std::string(20000, 'a'),
        "GET /run HTTP/1.1\r\nHost: " + host_ + "\r\nContent-Length: 9999999999\r\n\r\n"}) {
    tcp::socket socket(io_);
    socket.connect(endpoint());
    boost::system::error_code failed;
    boost::asio::write(socket, boost::asio::buffer(bytes), failed);
    char rest[64];
    while (!failed) socket.read_some(boost::asio::buffer(rest), failed);
    EXPECT_TRUE(failed);
  }
  const std::unique_ptr<Socket> flood = open();
  EXPECT_THROW(
      {
        for (int i = 0; i < 100000; ++i) flood->say(R"({"ping":1})");
        for (;;) flood->read();
      },
      boost::system::system_error);
  const std::unique_ptr<Socket> big = open();
  EXPECT_THROW(
      {
        big->say(std::string(100000, ' '));
        for (;;) big->read();
      },
      boost::system::system_error);
  EXPECT_GT(good->nextShot(), 0u);
}

// Ten browsers never read, and one reads.
TEST_F(WebServerTest, BrowsersThatDoNotReadSlowNobodyDown) {
  begin();
  std::vector<std::unique_ptr<Socket>> idle;
  for (int i = 0; i < 10; ++i) idle.push_back(open());
  const std::unique_ptr<Socket> good = open();
  good->nextShot();
  const auto start = std::chrono::steady_clock::now();
  int shots = 0;
  while (std::chrono::steady_clock::now() - start < std::chrono::seconds(2)) {
    good->nextShot();
    ++shots;
  }
  RecordProperty("shots_per_s", shots / 2);
  EXPECT_GE(shots, 60);  // at least 30 a second; an idle machine receives 120
}

TEST_F(WebServerTest, MoreBrowsersThanAllowedAreRefused) {
  WebOptions options;
  options.most_browsers = 2;
  begin(options);
  const auto a = open(), b = open();
  a->read();
  b->read();
  EXPECT_THROW(open(), boost::system::system_error);
}

class WebInBrowser : public WebServerTest {
 protected:
  void SetUp() override {
    WebServerTest::SetUp();
    if (!Chromium::isThere()) GTEST_SKIP() << "chromium is not installed";
  }
  [[nodiscard]] std::string page() const { return "http://" + host_ + "/"; }
};

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// Number of pixels with the blue of the part in hand.
int bluePixels(const std::string& file) {
  const Image image = loadPng(file);
  int blue = 0;
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3)
    blue += image.rgb[i + 2] > image.rgb[i] + 50 && image.rgb[i + 2] > 100;
  return blue;
}

TEST_F(WebInBrowser, ARunIsDrawnAndTwoBrowsersSeeEachOthersPointer) {
  begin();
  const std::string folder = test::freshFolder("web_page");
  Chromium a(folder + "/a", 1000, 700, page()), b(folder + "/b", 1000, 700, page());
  for (Chromium* browser : {&a, &b})
    ASSERT_TRUE(browser->waitFor("vps.drawn > 20 && vps.hand")) << joined(browser->console());
  a.screenshot(folder + "/a.png");
  EXPECT_GT(bluePixels(folder + "/a.png"), 1000);
  EXPECT_EQ(a.evaluate("document.getElementById('name').textContent"), "peg & <hole>");
  EXPECT_EQ(a.evaluate("document.getElementById('take').hidden"), true);
  a.evaluate("document.getElementById('point').click()");
  const std::string a_number = a.evaluate("String(vps.you)");
  bool is_seen = false;
  for (int i = 0; i < 3 && !is_seen; ++i) {  // a slow browser may need some time to show the shape
    a.mouse("mousePressed", 500, 350);
    a.mouse("mouseReleased", 500, 350);
    is_seen = b.waitFor("vps.pointers[" + a_number + "]", 20);
  }
  EXPECT_TRUE(is_seen) << joined(b.console());
  b.screenshot(folder + "/b.png");
  EXPECT_EQ(joined(a.console()) + joined(b.console()), "");
  const double before = a.evaluate("vps.drawn");
  std::this_thread::sleep_for(std::chrono::seconds(2));
  const double after = a.evaluate("vps.drawn");
  const auto age_ms = [](Chromium& browser, double share) {
    return browser
        .evaluate("vps.ages_ms.slice().sort((x, y) => x - y)[Math.floor(" + std::to_string(share) +
                  " * (vps.ages_ms.length - 1))]")
        .get<double>();
  };
  std::printf(
      "%.1f pictures a second in Chromium (of two); from physics to picture %.0f and %.0f ms (median), "
      "%.0f and %.0f (p90)\n",
      (after - before) / 2, age_ms(a, 0.5), age_ms(b, 0.5), age_ms(a, 0.9), age_ms(b, 0.9));
  std::vector<double> apart_ms;  // time between both browsers showing the same snapshot
  const auto shown_a = a.evaluate("JSON.stringify(vps.shown)"),
             shown_b = b.evaluate("JSON.stringify(vps.shown)");
  std::map<double, double> of_a;
  for (const auto& one : nlohmann::json::parse(shown_a.get<std::string>())) of_a[one[0]] = one[1];
  for (const auto& one : nlohmann::json::parse(shown_b.get<std::string>()))
    if (const auto found = of_a.find(one[0]); found != of_a.end())
      apart_ms.push_back(std::abs(found->second - one[1].get<double>()));
  ASSERT_FALSE(apart_ms.empty());
  std::sort(apart_ms.begin(), apart_ms.end());
  std::printf("both show %zu snapshots, apart by %.0f ms (median), %.0f (p90)\n", apart_ms.size(),
              apart_ms[apart_ms.size() / 2], apart_ms[apart_ms.size() * 9 / 10]);
  // Neither browser shows a snapshot before it is due.
  const double present_ms = 1e-6 * static_cast<double>(kPresentAfter_ns);
  for (Chromium* browser : {&a, &b})
    EXPECT_GE(age_ms(*browser, 0), present_ms - 1);  // the browsers' clocks have a resolution of 1 ms
}

// The page acknowledges snapshots without drawing, since the server limits the number of unacknowledged
// snapshots.
TEST_F(WebInBrowser, ARunInWhichNothingMovesIsNotDrawnAgain) {
  begin();
  run_->is_still = true;
  Chromium browser(test::freshFolder("web_still") + "/a", 800, 600, page());
  ASSERT_TRUE(browser.waitFor("vps.snapshots > 5 && vps.bodies[1]")) << joined(browser.console());
  std::this_thread::sleep_for(std::chrono::seconds(2));  // until parts and their level of detail have arrived
  const auto count = [&](const char* what) { return browser.evaluate(what).get<int>(); };
  const int drawn = count("vps.drawn"), snapshots = count("vps.snapshots");
  std::this_thread::sleep_for(std::chrono::seconds(1));
  EXPECT_EQ(count("vps.drawn"), drawn);
  EXPECT_GE(count("vps.snapshots"), snapshots + 10);
}

TEST_F(WebInBrowser, ThePartIsTakenByMouseAndByFinger) {
  begin({}, true);
  run_->is_still = true;
  const std::string folder = test::freshFolder("web_hand");
  Chromium browser(folder, 1000, 700, page());
  ASSERT_TRUE(browser.waitFor("vps.snapshots > 5 && vps.hand && vps.hand.may_take"))
      << joined(browser.console());
  browser.evaluate("document.getElementById('take').click()");
  ASSERT_TRUE(browser.waitFor("vps.hand.holder === vps.you"));
  browser.evaluate(
      "const looks = document.getElementById('looks'); looks.value = 'front';"
      "looks.dispatchEvent(new Event('change'))");
  ASSERT_TRUE(browser.waitFor("vps.placeOf(1)", 20));
  const json at = browser.evaluate("vps.placeOf(1)");
  const double x = at[0], y = at[1];
  const auto wish = run_->drag()->wish();
  browser.mouse("mousePressed", x, y);
  for (int i = 1; i <= 10; ++i) browser.mouse("mouseMoved", x + 5 * i, y);
  browser.evaluate("new Promise(done => setTimeout(done, 300))");
  const Vec3 by_mouse = wish->read().p;
  EXPECT_GT(by_mouse.x(), 1e-4);
  EXPECT_LT(std::abs(by_mouse.y()), 1e-9);  // the view is from the front, so y is across the screen
  browser.screenshot(folder + "/hand.png");
  browser.mouse("mouseReleased", x + 50, y);
  browser.evaluate("new Promise(done => setTimeout(done, 300))");
  const Vec3 rest = wish->read().p;
  browser.touch("touchStart", x, y);
  for (int i = 1; i <= 10; ++i) browser.touch("touchMove", x, y - 5 * i);
  browser.evaluate("new Promise(done => setTimeout(done, 300))");
  EXPECT_GT(wish->read().p.z(), rest.z() + 1e-4);
  browser.touch("touchEnd", 0, 0);
  EXPECT_EQ(joined(browser.console()), "");
}

// An emulated headset with two views side by side.
constexpr const char* kHeadset = R"js(
class FakeLayer { constructor(session, gl) { this.framebuffer = null; this.gl = gl; }
  getViewport(view) { const w = this.gl.drawingBufferWidth / 2, h = this.gl.drawingBufferHeight;
    return { x: view.eye === "left" ? 0 : w, y: 0, width: w, height: h }; } }
window.XRWebGLLayer = FakeLayer;
class FakeSession extends EventTarget {
  constructor() { super(); this.renderState = {}; this.inputSources = []; this.frames = 0; }
  updateRenderState(state) { Object.assign(this.renderState, state); }
  requestReferenceSpace() { return Promise.resolve({}); }
  requestAnimationFrame(then) {
    return window.requestAnimationFrame(time => { window.headsetFrames = ++this.frames; then(time, this); }); }
  cancelAnimationFrame(id) { window.cancelAnimationFrame(id); }
  getViewerPose() {
    const view = (eye, x) => ({ eye: eye, projectionMatrix: new Float32Array([1.2,0,0,0, 0,1,0,0, 0,0,-1.0002,-1, 0,0,-0.02,0]),
      transform: { inverse: { matrix: new Float32Array([1,0,0,0, 0,1,0,0, 0,0,1,0, -x,-1.2,0,1]) } } });
    return { views: [view("left", -0.032), view("right", 0.032)] }; }
  getPose() { return null; }
  end() { this.dispatchEvent(new Event("end")); return Promise.resolve(); }
}
Object.defineProperty(navigator, "xr", { value: {
  isSessionSupported: mode => Promise.resolve(mode === "immersive-vr"),
  requestSession: () => Promise.resolve(new FakeSession()), addEventListener() {} } });
)js";

TEST_F(WebInBrowser, AHeadsetShowsTheRunToBothEyes) {
  begin();
  const std::string folder = test::freshFolder("web_headset");
  Chromium browser(folder, 1000, 500, page(), kHeadset);
  ASSERT_TRUE(browser.waitFor("vps.drawn > 5 && !document.getElementById('headset').hidden"))
      << joined(browser.console());
  browser.evaluate("document.getElementById('headset').click()");
  ASSERT_TRUE(browser.waitFor("window.headsetFrames > 20", 30)) << joined(browser.console());
  browser.screenshot(folder + "/headset.png");
  const Image image = loadPng(folder + "/headset.png");
  int left = 0, right = 0;
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) {
      const std::uint8_t* p = &image.rgb[3 * static_cast<std::size_t>(row * image.width + column)];
      const bool is_blue = p[2] > p[0] + 50 && p[2] > 100 && row > 120 && row < 400;
      (column < image.width / 2 ? left : right) += is_blue;
    }
  EXPECT_GT(left, 100);
  EXPECT_GT(right, 100);
  browser.evaluate("document.getElementById('headset').click()");
  EXPECT_TRUE(browser.waitFor("document.getElementById('headset').textContent === 'Headset'"));
  for (const std::string& line : browser.console())  // three.js reports that it draws the eyes separately
    EXPECT_NE(line.find("OVR_multiview2"), std::string::npos) << line;
}

}  // namespace
}  // namespace vps::viewer
