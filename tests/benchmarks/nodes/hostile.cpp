// SPDX-License-Identifier: BSD-3-Clause
// A peer that sends invalid messages during a run over UDP whose nodes use no certificates.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "rows.h"
#include "support/process/node_processes.h"
#include "support/temporary_folder.h"

#if __has_include(<dds/dds.h>)
#include "dds/topics.h"
#endif

namespace vps::bench {

#if __has_include(<dds/dds.h>)

namespace {

using scenes::Delivery;

/// An intruder on one topic of a session, which can resend a message that the intruder has received.
class Intruder {
 public:
  Intruder(const scenes::DdsParticipant& participant, const std::string& name, Delivery delivery)
      : in_(std::in_place, participant, name, delivery, [this](std::string_view bytes) { hear(bytes); }),
        out_(participant, name, delivery, nullptr) {}

  void sendGarbage(std::mt19937& random) {
    std::string bytes(random() % 400, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    out_.write(bytes);
  }
  /// Sends the last message unchanged (`what` 0), with a foreign version (1), with one byte changed (2), or
  /// cut (3).
  void sendChanged(int what, std::mt19937& random) {
    std::string bytes;
    {
      const std::lock_guard lock(mutex_);
      bytes = heard_;
    }
    if (bytes.size() < 4) return;
    if (what == 1) bytes[2] = static_cast<char>(bytes[2] + 1);
    if (what == 2) bytes[random() % bytes.size()] ^= static_cast<char>(1U << random() % 8);
    if (what == 3) bytes.resize(random() % bytes.size());
    out_.write(bytes);
  }

 private:
  void hear(std::string_view bytes) {
    const std::lock_guard lock(mutex_);
    heard_ = bytes;
  }
  std::mutex mutex_;
  std::string heard_;
  std::optional<scenes::DdsTopic> in_;
  scenes::DdsTopic out_;
};

/// A line that contains these words, and the number of such lines.
std::string lineWith(const std::string& text, const std::string& words, int& count) {
  std::string found;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.find(words) == std::string::npos) continue;
    ++count;
    found = line;
  }
  return found;
}

}  // namespace

bool hostileRow(const std::string& scene) {
  const char* what =
      "garbage, foreign versions, replays, a flood and a second device, UDP on lo, no certificates";
  const char* bar = "counted, said once, survived";
  const test::TemporaryFolder folder;
  const std::string session = "bench/hostile/" + std::to_string(getpid());
  std::string name = session;
  std::replace(name.begin(), name.end(), '/', '-');
  test::NodeProcesses nodes(VPS_PROGRAM, scene, name, folder.path(), "lo");
  nodes.startWatch();
  nodes.startDevice();
  nodes.startRender();
  if (!nodes.join() || !nodes.waitForHold()) {
    printRow(what, bar, "the run did not begin: " + test::bytesOf(folder.path() / "render.txt"), false);
    return false;
  }
  test::ChildProcess second({VPS_PROGRAM, "device", "--session", name, "--network", "lo"},
                            (folder.path() / "second.txt").string());
  const int second_status = second.wait();
  const scenes::DdsParticipant participant("lo");
  std::vector<std::unique_ptr<Intruder>> topics;
  for (const char* topic : {"haptic", "physics", "snapshot", "beat"})
    topics.push_back(
        std::make_unique<Intruder>(participant, "vps/" + session + "/" + topic, Delivery::Newest));
  for (const char* topic : {"request", "reply", "log", "news"})
    topics.push_back(
        std::make_unique<Intruder>(participant, "vps/" + session + "/" + topic, Delivery::Reliable));
  std::mt19937 random(1);
  long sent = 0;
  constexpr double kFlood_s = 2;
  const auto begun = std::chrono::steady_clock::now();
  const auto since_s = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  };
  // The hostile peer first sends as much as the nodes themselves, then for a while as fast as possible, and
  // finally with pauses again.
  while (nodes.render.isRunning() && since_s() < 120) {
    for (const std::unique_ptr<Intruder>& topic : topics) {
      topic->sendGarbage(random);
      for (int change = 0; change < 4; ++change) topic->sendChanged(change, random);
      sent += 5;
    }
    const bool floods = since_s() > 1 && since_s() < 1 + kFlood_s;
    if (!floods) usleep(5000);
  }
  const double took_s = since_s();
  const bool has_ended = !nodes.render.isRunning();
  if (has_ended) nodes.render.wait();
  nodes.device.interrupt();
  const int device_status = nodes.device.wait();
  std::ifstream in(folder.path() / "run.json");
  const nlohmann::json run = nlohmann::json::parse(in, nullptr, false);
  int render_said = 0, device_said = 0;
  const std::string render_words =
                        lineWith(test::bytesOf(folder.path() / "render.txt"), "refused", render_said),
                    device_words =
                        lineWith(test::bytesOf(folder.path() / "device.txt"), "refused", device_said);
  char words[900];
  std::snprintf(words, sizeof words,
                "%ld messages in %.1f s; the run %s (%s); render said %d times: %s; device (exit status %d) "
                "said %d times: %s; "
                "second device: exit status %d, %s",
                sent, took_s, has_ended ? "ended" : "did not end",
                run.is_discarded() ? "no result" : run["verdict"].get<std::string>().c_str(), render_said,
                render_words.c_str(), device_status, device_said, device_words.c_str(), second_status,
                test::bytesOf(folder.path() / "second.txt").c_str());
  for (char& c : words)
    if (c == '\n') c = ' ';
  const bool is_good = has_ended && !run.is_discarded() && run["verdict"] == "fits" && render_said == 1 &&
                       device_said == 1 && second_status == 2;
  printRow(what, bar, words, is_good);
  return is_good;
}

#else

bool hostileRow(const std::string&) {
  printRow("garbage, foreign versions, replays, a flood, UDP", "", "this build has no network", false);
  return false;
}

#endif

}  // namespace vps::bench
