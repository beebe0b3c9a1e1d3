// SPDX-License-Identifier: BSD-3-Clause
// The key tables of scenes/scene/SCENE_FILE.md, scenes/fits/RULES.md and viewer/cli/JSON.md are made from the
// field tables. The command that writes them again after a change:
//   VPS_WRITE_DOCUMENTATION=1 build/release/tests/test_scenes --gtest_filter=Documentation.*
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <numbers>
#include <optional>
#include <string>

#include "scene/read_fields.h"
#include "support/temporary_folder.h"
#include "vps_scenes/cad/import.h"
#include "vps_scenes/fits/check_fields.h"
#include "vps_scenes/fits/revision_fields.h"
#include "vps_scenes/fits/rule_keys.h"
#include "vps_scenes/planning/plan_fields.h"
#include "vps_scenes/planning/study_fields.h"
#include "vps_scenes/planning/trade_fields.h"
#include "vps_scenes/scene/settings_fields.h"
#include "vps_scenes/uses/compare.h"
#include "vps_scenes/uses/ergonomics.h"

namespace vps::scenes {
namespace {

std::string number(double value, int digits = 6) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

// --- Settings: key, type, default, meaning

std::string typeOf(const bool&, Quantity) {
  return "bool";
}
std::string typeOf(const std::string&, Quantity) {
  return "text";
}
std::string typeOf(const double&, Quantity quantity) {
  return quantity == Quantity::Length ? "length" : quantity == Quantity::Angle ? "degrees" : "number";
}
std::string typeOf(const std::optional<double>&, Quantity quantity) {
  return typeOf(0.0, quantity);
}
template <class T>
std::string typeOf(const T&, Quantity) {
  if constexpr (std::is_enum_v<T>) {
    std::string words;
    for (const std::string& word : wordsOf<T>()) words += (words.empty() ? "`\"" : ", `\"") + word + "\"`";
    return words;
  } else {
    return "whole number";
  }
}

std::string defaultOf(bool value, Quantity) {
  return value ? "true" : "false";
}
std::string defaultOf(const std::string& value, Quantity) {
  return "`\"" + value + "\"`";
}
std::string defaultOf(double value, Quantity quantity) {
  if (quantity == Quantity::Length) return "`\"" + number(1e3 * value) + "mm\"`";
  if (quantity == Quantity::Angle) return number(value * 180 / std::numbers::pi, 3);
  return number(value);
}
std::string defaultOf(const std::optional<double>&, Quantity) {
  return "derived";
}
template <class T>
std::string defaultOf(const T& value, Quantity) {
  if constexpr (std::is_enum_v<T>)
    return "`\"" + std::string(toText(value)) + "\"`";
  else
    return std::to_string(value);
}

std::string line(std::string_view key, const std::string& type, const std::string& standard,
                 std::string_view meaning) {
  EXPECT_EQ(key.find(' '), std::string_view::npos) << "'" << key << "' is a description, not a key";
  const auto cell = [](std::string_view text) {
    return " " + std::string(text) + (text.empty() ? "|" : " |");
  };
  return "| `" + std::string(key) + "` |" + cell(type) + cell(standard) + cell(meaning) + "\n";
}

template <class Struct>
void addSetting(std::string& out, const Struct&, const Key& row) {
  if (row.meaning.empty()) return;
  out += line(row.key, std::string(row.type), std::string(row.default_text), row.meaning);
}
template <class Struct, class Get>
void addSetting(std::string& out, const Struct& of, const Field<Get>& row) {
  const auto& value = std::invoke(row.get, of);
  const FieldTraits& traits = row.traits;
  out +=
      line(row.key, traits.type.empty() ? typeOf(value, traits.quantity) : std::string(traits.type),
           traits.default_text.empty() ? defaultOf(value, traits.quantity) : std::string(traits.default_text),
           row.meaning);
}
template <class Struct, class Get, class Rows>
void addSetting(std::string& out, const Struct& of, const Group<Get, Rows>& group) {
  forEachRow(group.rows, [&](const auto& row) { addSetting(out, std::invoke(group.get, of), row); });
}

/// The lines of the key table of one table of a scene file.
template <class Struct, class Rows>
std::string settingLines(const Rows& rows) {
  std::string out;
  forEachRow(rows, [&](const auto& row) { addSetting(out, Struct(), row); });
  return out;
}

const char* const kSettingHead = "| key | type | default | meaning |\n|---|---|---|---|\n";

// --- Results: path of the key, meaning

void addResult(std::string& out, const std::string& prefix, std::string_view key, std::string_view meaning) {
  EXPECT_EQ(key.find(' '), std::string_view::npos) << "'" << key << "' is a description, not a key";
  out += "| `" + prefix + std::string(key) + "` | " + std::string(meaning) + " |\n";
}
template <class Get>
void addResult(std::string& out, const std::string& prefix, const Field<Get>& row) {
  addResult(out, prefix, siKey(row), row.meaning);
}
template <class Rows>
void addResults(std::string& out, const std::string& prefix, const Rows& rows);

template <class Row>
std::string keyOf(const Row& row) {
  if constexpr (requires { siKey(row); })
    return siKey(row);
  else
    return std::string(row.key);
}

template <class Get, class Rows>
void addResult(std::string& out, const std::string& prefix, const Group<Get, Rows>& group) {
  const std::string key(group.key);
  if (group.meaning.empty()) return addResults(out, key.empty() ? prefix : prefix + key + ".", group.rows);
  std::string keys;
  forEachRow(group.rows, [&](const auto& row) { keys += (keys.empty() ? " {`" : ", `") + keyOf(row) + "`"; });
  out += "| `" + prefix + key + "`" + keys + "} | " + std::string(group.meaning) + " |\n";
}
template <class Get, class Rows>
void addResult(std::string& out, const std::string& prefix, const List<Get, Rows>& list) {
  addResults(out, prefix + std::string(list.key) + "[].", list.rows);
}
template <class Get, class Rows>
void addResult(std::string& out, const std::string& prefix, const Columns<Get, Rows>& columns) {
  forEachRow(columns.rows, [&](const auto& row) { addResult(out, prefix, siKey(row) + "[]", row.meaning); });
}
template <class Rows>
void addResults(std::string& out, const std::string& prefix, const Rows& rows) {
  forEachRow(rows, [&](const auto& row) { addResult(out, prefix, row); });
}

template <class Rows>
std::string resultLines(const std::string& prefix, const Rows& rows) {
  std::string out;
  addResults(out, prefix, rows);
  return out;
}

const char* const kResultHead = "| key | meaning |\n|---|---|\n";

// --- The documents

/// Compares, or writes, the text between the markers "<!-- keys: name -->" and "<!-- end -->" of a document.
void checkSection(const std::string& readme, const std::string& name, const std::string& expected) {
  const std::string file = std::string(VPS_SOURCE_DIR) + "/" + readme;
  std::string text = test::bytesOf(file);
  const std::string begin = "<!-- keys: " + name + " -->\n";
  const std::size_t at = text.find(begin);
  ASSERT_NE(at, std::string::npos) << readme << " has no '" << begin << "'";
  const std::size_t from = at + begin.size(), until = text.find("<!-- end -->", from);
  ASSERT_NE(until, std::string::npos) << readme << ", " << name;
  if (std::getenv("VPS_WRITE_DOCUMENTATION") != nullptr) {
    text.replace(from, until - from, expected);
    std::ofstream(file, std::ios::binary) << text;
    return;
  }
  EXPECT_EQ(text.substr(from, until - from), expected)
      << readme << ", section '" << name
      << "' differs from the field tables; write it again as the comment at the "
      << "top of " << __FILE__ << " says";
}

TEST(Documentation, TheSceneFilesKeysAreThoseOfTheFieldTables) {
  const std::string readme = "scenes/scene/SCENE_FILE.md", head = kSettingHead;
  checkSection(readme, "top", head + settingLines<Scene>(kSceneKeys));
  checkSection(readme, "part", head + settingLines<ScenePart>(kPartKeys));
  checkSection(readme, "group", head + settingLines<PartGroup>(kGroupKeys));
  checkSection(readme, "step", head + settingLines<SceneStep>(kStepKeys));
  checkSection(readme, "device", head + settingLines<DeviceSettings>(kDeviceKeys));
  checkSection(readme, "operator", head + settingLines<OperatorSettings>(kOperatorFields));
  checkSection(readme, "coupling", head + settingLines<CouplingWishes>(kCouplingFields));
  checkSection(readme, "record", head + settingLines<RecordSettings>(kRecordFields));
  checkSection(readme, "fidelity",
               head + settingLines<Scene>(kFidelityChoiceKeys) +
                   settingLines<FidelityWish>(kFidelityWishFields) + settingLines<Fidelity>(kFidelityFields));
}

TEST(Documentation, TheKeysOfARuleAreThoseOfTheFieldTable) {
  checkSection("scenes/fits/RULES.md", "rule", kSettingHead + settingLines<CheckRule>(kRuleKeys));
  checkSection("scenes/fits/RULES.md", "overlap", kSettingHead + settingLines<OverlapRule>(kOverlapRuleKeys));
}

TEST(Documentation, TheResultsKeysAreThoseOfTheFieldTables) {
  const std::string readme = "viewer/cli/JSON.md", head = kResultHead;
  checkSection(readme, "assemble",
               head + resultLines("", kAssembleFields) + resultLines("wall.", kAssembleWallFields));
  checkSection(
      readme, "trade",
      head + resultLines("rows[].", kTradeRowFields) + resultLines("wall.rows[].", kTradeRowWallFields));
  checkSection(
      readme, "check",
      head + resultLines("pairs[].", kCheckedPairFields) + resultLines("fits[].", kCheckedFitFields) +
          resultLines("parts[].", kCheckedPartFields) + resultLines("left_out[].", kLeftOutPairFields) +
          resultLines("moves[].", kPartMoveFields) + resultLines("rules[].", kRuleOutcomeFields) +
          resultLines("rule_counts[].", kRuleCountFields) + resultLines("places.", kCheckedPlacesFields) +
          resultLines("places.moved[].", kMovedPartFields) +
          resultLines("places.groups[].", kCheckedGroupFields) + resultLines("against.", kRevisionFields) +
          resultLines("wall.", kCheckWallFields));
  checkSection(readme, "plan",
               head + resultLines("", kPlanFields) + resultLines("way_faults[].", kWayFaultFields) +
                   resultLines("wall.", kPlanWallFields));
  checkSection(readme, "margin", head + resultLines("steps[].", kStepMarginFields));
  checkSection(readme, "compare", head + resultLines("", kComparisonFields));
  checkSection(readme, "ergonomics", head + resultLines("steps[].", kStepErgonomicsFields));
  checkSection(readme, "study", head + resultLines("", kStudyFields));
  checkSection(readme, "choice", head + resultLines("", kChoiceFields));
}

}  // namespace
}  // namespace vps::scenes
