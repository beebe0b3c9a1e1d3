// SPDX-License-Identifier: BSD-3-Clause
// A web browser without a display, which a test controls by the protocol of Chromium's developer tools.
#pragma once

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "support/process/child_process.h"

namespace vps::test {

/// One page in a browser of its own.
class Chromium {
 public:
  static constexpr const char* kProgram = "/usr/bin/chromium";
  static bool isThere() { return std::filesystem::exists(kProgram); }

  /// @param script  run in the page before its own; may be empty
  Chromium(const std::string& folder, int width, int height, const std::string& address,
           const std::string& script = "")
      : folder_(folder) {
    std::filesystem::create_directories(folder);
    process_ =
        ChildProcess({kProgram, "--headless=new", "--no-sandbox", "--use-angle=swiftshader",
                      "--enable-unsafe-swiftshader", "--hide-scrollbars", "--remote-debugging-port=0",
                      "--autoplay-policy=no-user-gesture-required", "--user-data-dir=" + folder + "/profile",
                      "--window-size=" + std::to_string(width) + "," + std::to_string(height), "about:blank"},
                     folder + "/chromium.txt");
    connect();
    call("Runtime.enable");
    call("Log.enable");
    call("Page.enable");
    call("Emulation.setDeviceMetricsOverride",
         {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
    if (!script.empty()) call("Page.addScriptToEvaluateOnNewDocument", {{"source", script}});
    call("Page.navigate", {{"url", address}});
  }

  /// The value of an expression in the page; null if the expression throws.
  nlohmann::json evaluate(const std::string& expression) {
    const nlohmann::json reply = call(
        "Runtime.evaluate", {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
    return reply.contains("result") ? reply["result"].value("value", nlohmann::json()) : nlohmann::json();
  }
  /// Waits until the expression is true. Returns false at the limit.
  bool waitFor(const std::string& expression, double limit_s = 60) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(limit_s);
    while (evaluate("Boolean(" + expression + ")") != true) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return true;
  }
  /// Sends "mousePressed", "mouseMoved" or "mouseReleased", with the left button.
  void mouse(const std::string& what, double x, double y) {
    call("Input.dispatchMouseEvent", {{"type", what},
                                      {"x", x},
                                      {"y", y},
                                      {"button", "left"},
                                      {"buttons", what == "mouseReleased" ? 0 : 1},
                                      {"clickCount", 1}});
  }
  /// Sends "touchStart", "touchMove" or "touchEnd", of one finger.
  void touch(const std::string& what, double x, double y) {
    nlohmann::json points = nlohmann::json::array();
    if (what != "touchEnd") points.push_back({{"x", x}, {"y", y}});
    call("Input.dispatchTouchEvent", {{"type", what}, {"touchPoints", points}});
  }
  /// Writes a picture of the page as PNG.
  void screenshot(const std::string& file) {
    const std::string text = call("Page.captureScreenshot")["data"];
    std::ofstream(file, std::ios::binary) << decoded(text);
  }
  /// The lines that the page printed on its console, and errors of the browser about the page.
  [[nodiscard]] const std::vector<std::string>& console() const { return console_; }

 private:
  using Json = nlohmann::json;

  void connect() {
    namespace beast = boost::beast;
    using boost::asio::ip::tcp;
    std::string port;
    for (int i = 0; i < 600 && port.empty(); ++i) {
      std::ifstream(folder_ + "/profile/DevToolsActivePort") >> port;
      if (port.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    const auto end = tcp::endpoint(boost::asio::ip::address_v4::loopback(),
                                   static_cast<unsigned short>(std::atoi(port.c_str())));
    std::string target;
    for (int i = 0; i < 100 && target.empty(); ++i) {
      tcp::socket socket(io_);
      socket.connect(end);
      beast::http::request<beast::http::empty_body> request(beast::http::verb::get, "/json/list", 11);
      request.set(beast::http::field::host, "127.0.0.1:" + port);
      beast::http::write(socket, request);
      beast::flat_buffer buffer;
      beast::http::response<beast::http::string_body> response;
      beast::http::read(socket, buffer, response);
      for (const Json& page : Json::parse(response.body()))
        if (page["type"] == "page") target = "/devtools/page/" + page["id"].get<std::string>();
      if (target.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    socket_.next_layer().connect(end);
    socket_.read_message_max(64U << 20U);
    socket_.handshake("127.0.0.1:" + port, target);
  }
  Json call(const std::string& method, const Json& parameters = Json::object()) {
    const int id = ++last_;
    socket_.write(boost::asio::buffer(Json{{"id", id}, {"method", method}, {"params", parameters}}.dump()));
    for (;;) {
      boost::beast::flat_buffer buffer;
      socket_.read(buffer);
      const Json message = Json::parse(boost::beast::buffers_to_string(buffer.data()));
      if (message.value("id", 0) == id) return message.value("result", Json::object());
      const std::string event = message.value("method", "");
      if (event == "Runtime.consoleAPICalled")
        console_.push_back(message["params"]["args"].dump());
      else if (event == "Runtime.exceptionThrown")
        console_.push_back(message["params"]["exceptionDetails"].dump());
      else if (event == "Log.entryAdded")
        console_.push_back(message["params"]["entry"]["text"]);
    }
  }
  static std::string decoded(const std::string& base64) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned bits = 0, count = 0;
    for (const char c : base64) {
      const std::size_t digit = digits.find(c);
      if (digit == std::string::npos) break;
      bits = bits << 6U | static_cast<unsigned>(digit);
      count += 6;
      if (count < 8) continue;
      count -= 8;
      bytes += static_cast<char>(bits >> count & 255U);
    }
    return bytes;
  }

  std::string folder_;
  ChildProcess process_;
  boost::asio::io_context io_;
  boost::beast::websocket::stream<boost::asio::ip::tcp::socket> socket_{io_};
  int last_ = 0;
  std::vector<std::string> console_;
};

}  // namespace vps::test
