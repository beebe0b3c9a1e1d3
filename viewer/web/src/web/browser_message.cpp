// SPDX-License-Identifier: BSD-3-Clause
#include "web/browser_message.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace vps::viewer {

namespace {

constexpr double kLargest = 1e9;

std::optional<double> numberOf(const nlohmann::json& value) {
  if (!value.is_number()) return {};
  const double number = value.get<double>();
  return std::abs(number) <= kLargest ? std::optional(number) : std::nullopt;
}

std::optional<Vec3> vectorOf(const nlohmann::json& value) {
  if (!value.is_array() || value.size() != 3) return {};
  Vec3 vector;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<double> component = numberOf(value[i]);
    if (!component) return {};
    vector[static_cast<Eigen::Index>(i)] = *component;
  }
  return vector;
}

constexpr std::array<std::pair<const char*, BrowserWord>, 5> kWithNumber = {{{"ack", BrowserWord::Ack},
                                                                             {"ping", BrowserWord::Ping},
                                                                             {"sound", BrowserWord::Sound},
                                                                             {"play", BrowserWord::Play},
                                                                             {"seek", BrowserWord::Seek}}};
constexpr std::array<std::pair<const char*, BrowserWord>, 4> kWithVector = {{{"point", BrowserWord::Point},
                                                                             {"grab", BrowserWord::Grab},
                                                                             {"move", BrowserWord::Move},
                                                                             {"turn", BrowserWord::Turn}}};
constexpr std::array<std::pair<const char*, BrowserWord>, 4> kAlone = {{{"point", BrowserWord::Point},
                                                                        {"take", BrowserWord::Take},
                                                                        {"leave", BrowserWord::Leave},
                                                                        {"drop", BrowserWord::Drop}}};

}  // namespace

std::optional<BrowserMessage> readBrowserMessage(std::string_view text) noexcept {
  try {
    if (text.size() > kLongestBrowserMessage) return {};
    constexpr int kDeepest = 2;  // nesting: the object, and a vector in it
    const auto shallow = [](int depth, nlohmann::json::parse_event_t, nlohmann::json&) {
      return depth <= kDeepest;
    };
    const nlohmann::json json = nlohmann::json::parse(text, shallow, false);
    if (!json.is_object() || json.size() != 1) return {};
    const std::string key = json.begin().key();
    const nlohmann::json& value = json.begin().value();
    if (value.is_null())
      for (const auto& [name, word] : kAlone)
        if (key == name) return BrowserMessage{word, 0, {}};
    if (const std::optional<double> number = numberOf(value))
      for (const auto& [name, word] : kWithNumber)
        if (key == name) return BrowserMessage{word, *number, {}};
    if (const std::optional<Vec3> vector = vectorOf(value))
      for (const auto& [name, word] : kWithVector)
        if (key == name) return BrowserMessage{word, 0, vector};
    return {};
  } catch (const std::exception&) {  // out of memory
    return {};
  }
}

}  // namespace vps::viewer
