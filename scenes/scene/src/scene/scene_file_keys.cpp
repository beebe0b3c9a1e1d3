// SPDX-License-Identifier: BSD-3-Clause
#include "scene/scene_file_keys.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <numeric>
#include <sstream>

#include "vps/errors.h"
#include "vps_scenes/cad/import.h"

namespace vps::scenes {

namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;

/// Number of insertions, deletions and replacements from a to b (Levenshtein 1966), row by row.
std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

std::string shortNumber(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

std::string describe(const toml::node& node) {
  if (const auto text = node.value<std::string_view>(); node.is_string() && text)
    return "the text '" + std::string(*text) + "'";
  if (node.is_boolean()) return *node.value<bool>() ? "true" : "false";
  if (node.is_number()) return shortNumber(*node.value<double>());
  if (const auto* array = node.as_array()) return "a list of " + std::to_string(array->size());
  if (node.is_table()) return "a table";
  return "a date or time";
}

std::string wanted(Range range) {
  const bool has_max = range.max < kAny.max;
  if (range.min <= kAny.min) return has_max ? "at most " + shortNumber(range.max) : "a number";
  const std::string low = (range.is_open_min ? "more than " : "at least ") + shortNumber(range.min);
  return has_max ? low + " and at most " + shortNumber(range.max) : low;
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

struct Renamed {
  std::string_view place, old_name, new_name;
};
constexpr Renamed kRenamedKeys[] = {{"[device]", "ratchet", "indexing"}};
/// Renamed values of keys; `place` is the key.
constexpr Renamed kRenamedWords[] = {{"contact", "rigid", "constraint"}, {"contact", "compliant", "penalty"}};

/// The new name of a renamed key or value; empty for every other name.
template <std::size_t N>
std::string_view newName(const Renamed (&table)[N], std::string_view place, std::string_view name) {
  const auto* const found = std::find_if(std::begin(table), std::end(table), [&](const Renamed& entry) {
    return entry.place == place && entry.old_name == name;
  });
  return found == std::end(table) ? std::string_view() : found->new_name;
}

}  // namespace

std::string readTomlText(const std::string& file, const std::string& what, const std::string& example) {
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw LoadError(file, "", "no such file; name a " + what + " (" + example + ")");
  if (std::filesystem::is_directory(file, error))
    throw LoadError(file, "", "is a folder; name the " + what + " in it (" + example + ")");
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw LoadError(file, "", "cannot be read; check its permissions");
  return text.str();
}

toml::table parseToml(const std::string& text, const std::string& file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    std::string words(error.description());
    // Control characters become blanks, so that the message stays on one line.
    std::replace_if(
        words.begin(), words.end(), [](unsigned char c) { return c < 0x20; }, ' ');
    throw LoadError(file + ":" + std::to_string(error.source().begin.line), "", "not valid TOML: " + words);
  }
}

std::string nearestWord(std::string_view word, const std::vector<std::string>& known) {
  std::string nearest;
  // assumed: up to a third of the letters may be wrong.
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const std::size_t distance = editDistance(word, candidate);
    if (distance < least) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string didYouMean(const std::string& name, const std::vector<std::string>& names) {
  const std::string nearest = nearestWord(name, names);
  if (!nearest.empty()) return "; did you mean '" + nearest + "'?";
  constexpr std::size_t kShown = 12;
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i)
    list += (i ? ", " : "; the names are: ") + names[i];
  return list + (names.size() > kShown ? ", ..." : "");
}

SceneKeys::SceneKeys(const toml::table& table, const SceneFileContext& context, std::string place,
                     const std::vector<std::string_view>& known)
    : table_(table), context_(context), place_(std::move(place)) {
  for (const auto& [key, value] : table_) {
    if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
    if (const auto renamed = newName(kRenamedKeys, place_, key.str()); !renamed.empty())
      fail(key.str(), "was renamed; write '" + std::string(renamed) + "'");
    const std::vector<std::string> words(known.begin(), known.end());
    const std::string nearest = nearestWord(key.str(), words);
    fail(key.str(), nearest.empty() ? "is unknown; " + (place_.empty() ? "the top of the file" : place_) +
                                          " may have " + joined(words)
                                    : "is unknown; did you mean '" + nearest + "'?");
  }
}

bool SceneKeys::flag(std::string_view key, bool& out) const {
  const toml::node* found = node(key);
  if (!found) return false;
  if (!found->is_boolean()) fail(key, "is " + describe(*found) + "; expected true or false");
  out = *found->value<bool>();
  return true;
}

bool SceneKeys::text(std::string_view key, std::string& out) const {
  const toml::node* found = node(key);
  if (!found) return false;
  const auto value = found->value<std::string>();
  if (!found->is_string() || !value) fail(key, "is " + describe(*found) + "; expected text in quotes");
  if (value->empty()) fail(key, "is empty");
  if (value->find('\0') != std::string::npos) fail(key, "has a zero character");
  out = *value;
  return true;
}

bool SceneKeys::texts(std::string_view key, std::vector<std::string>& out) const {
  const toml::node* found = node(key);
  if (!found) return false;
  if (!found->is_array()) fail(key, "is " + describe(*found) + "; expected a list of texts in []");
  for (const toml::node& element : *found->as_array()) {
    if (!element.is_string()) fail(key, "has " + describe(element) + " in it; expected texts only");
    out.push_back(*element.value<std::string>());
  }
  return true;
}

bool SceneKeys::number(std::string_view key, double& out, Range range) const {
  const toml::node* found = node(key);
  if (!found) return false;
  out = requireNumber(key, *found, range);
  return true;
}

bool SceneKeys::integer(std::string_view key, std::int64_t& out, Range range) const {
  const toml::node* found = node(key);
  if (!found) return false;
  if (!found->is_integer()) fail(key, "is " + describe(*found) + "; expected a whole number");
  const std::int64_t value = *found->value<std::int64_t>();
  require(key, static_cast<double>(value), range, std::to_string(value));
  out = value;
  return true;
}

bool SceneKeys::numbers(std::string_view key, std::size_t count, double* out, Range range) const {
  const toml::node* found = node(key);
  if (!found) return false;
  for (const toml::node& element : requireArray(key, *found, count, "numbers"))
    *out++ = requireNumber(key, element, range);
  return true;
}

bool SceneKeys::length(std::string_view key, double& out_m, Range range) const {
  const toml::node* found = node(key);
  if (!found) return false;
  out_m = requireLength(key, *found, range);
  return true;
}

bool SceneKeys::angle(std::string_view key, double& out_rad, Range range) const {
  double angle_deg = 0;
  if (!number(key, angle_deg, range)) return false;
  out_rad = angle_deg * kRadPerDeg;
  return true;
}

bool SceneKeys::position(std::string_view key, Vec3& out_m) const {
  const toml::node* found = node(key);
  if (!found) return false;
  Eigen::Index axis = 0;
  for (const toml::node& element : requireArray(key, *found, 3, "lengths"))
    out_m[axis++] = requireLength(key, element, kAny);
  return true;
}

bool SceneKeys::pose(std::string_view key, Pose& out) const {
  const toml::node* found = node(key);
  if (!found) return false;
  out = requirePose(key, *found, out);
  return true;
}

bool SceneKeys::poses(std::string_view key, const Pose& from, std::vector<Pose>& out) const {
  const toml::node* found = node(key);
  if (!found) return false;
  if (!found->is_array()) fail(key, "is " + describe(*found) + "; expected a list of poses");
  for (const toml::node& element : *found->as_array()) out.push_back(requirePose(key, element, from));
  return true;
}

bool SceneKeys::word(std::string_view key, const std::vector<std::string>& words, std::size_t& out) const {
  std::string value;
  if (!text(key, value)) return false;
  if (const auto renamed = newName(kRenamedWords, key, value); !renamed.empty())
    fail(key, "is '" + value + "', which was renamed; write '" + std::string(renamed) + "'");
  const auto match = std::find(words.begin(), words.end(), value);
  if (match == words.end()) fail(key, "is '" + value + "'; expected one of: " + joined(words));
  out = static_cast<std::size_t>(match - words.begin());
  return true;
}

const toml::table* SceneKeys::table(std::string_view key) const {
  const toml::node* found = node(key);
  if (!found) return nullptr;
  if (!found->is_table()) fail(key, "is " + describe(*found) + "; expected a table");
  return found->as_table();
}

std::vector<const toml::table*> SceneKeys::tables(std::string_view key) const {
  std::vector<const toml::table*> out;
  const toml::node* found = node(key);
  if (!found) return out;
  const toml::array* array = found->as_array();
  if (!array) fail(key, "is " + describe(*found) + "; write [[" + std::string(key) + "]], once for each");
  for (const toml::node& element : *array) {
    if (!element.is_table()) fail(key, "has " + describe(element) + " in it; expected tables only");
    out.push_back(element.as_table());
  }
  return out;
}

std::string SceneKeys::placeOf(std::string_view key) const {
  // The line of the key and not of its value, since a list may begin on the line after the key.
  const auto entry = table_.find(key);
  const auto line = entry == table_.end() ? table_.source().begin.line : entry->first.source().begin.line;
  return context_.file + ":" + std::to_string(line);
}

void SceneKeys::fail(std::string_view key, const std::string& found_and_remedy) const {
  throw LoadError(placeOf(key), "", "key '" + std::string(key) + "' " + found_and_remedy);
}

void SceneKeys::failWhole(const std::string& found_and_remedy) const {
  failAt(&table_, (place_.empty() ? "the scene" : place_) + " " + found_and_remedy);
}

void SceneKeys::failAt(const toml::node* where, const std::string& message) const {
  throw LoadError(
      context_.file + ":" + std::to_string(std::max<std::uint32_t>(1, where->source().begin.line)), "",
      message);
}

void SceneKeys::require(std::string_view key, double value, Range range,
                        const std::string& as_written) const {
  if (!range.contains(value)) fail(key, "is " + as_written + "; expected " + wanted(range));
}

double SceneKeys::requireNumber(std::string_view key, const toml::node& node, Range range) const {
  const auto value = node.value<double>();
  if (!node.is_number() || !value) fail(key, "is " + describe(node) + "; expected a number");
  if (!std::isfinite(*value)) fail(key, "is " + shortNumber(*value) + "; expected a finite number");
  require(key, *value, range, shortNumber(*value));
  return *value;
}

double SceneKeys::requireLength(std::string_view key, const toml::node& node, Range range) const {
  if (node.is_string()) {
    double length_m = 0;
    try {
      length_m = lengthFromText(*node.value<std::string>(), "the length");
    } catch (const LoadError& error) {
      fail(key, "is " + describe(node) + ": " + error.what());
    }
    if (!std::isfinite(length_m)) fail(key, "is " + describe(node) + "; expected a finite length");
    require(key, length_m, range, describe(node));
    return length_m;
  }
  if (!node.is_number())
    fail(key, "is " + describe(node) + R"(; expected a length: a number, or text like "0.2mm")");
  const double value = requireNumber(key, node, range);
  // Zero is zero in any unit.
  if (!context_.unit_m && value != 0)
    fail(key, "is " + shortNumber(value) +
                  R"( without a unit; put unit = "mm" at the top of the file, or write ")" +
                  shortNumber(value) + R"(mm")");
  return value * context_.unit_m.value_or(1);
}

const toml::array& SceneKeys::requireArray(std::string_view key, const toml::node& node, std::size_t count,
                                           const std::string& of) const {
  const toml::array* array = node.as_array();
  if (!array || array->size() != count)
    fail(key, "is " + describe(node) + "; expected " + std::to_string(count) + " " + of + " in []");
  return *array;
}

Pose SceneKeys::requirePose(std::string_view key, const toml::node& node, Pose from) const {
  if (!node.is_table())
    fail(key, "is " + describe(node) + "; expected {position = [x, y, z], rotation_xyzw = [x, y, z, w]}");
  const std::string place = place_.empty() ? std::string(key) : place_ + " " + std::string(key);
  const SceneKeys keys(*node.as_table(), context_, place, {"position", "rotation_xyzw", "rpy_deg"});
  keys.position("position", from.p);
  double q[4], rpy_deg[3];
  if (keys.numbers("rotation_xyzw", 4, q)) {
    if (keys.has("rpy_deg"))
      keys.fail("rpy_deg", "cannot be combined with 'rotation_xyzw'; give one of the two keys");
    const Quat rotation(q[3], q[0], q[1], q[2]);
    // Files state quaternions with four digits or more, so a larger deviation is a mistake and not rounding.
    if (std::abs(rotation.norm() - 1) > 1e-3)
      keys.fail("rotation_xyzw",
                "has the length " + shortNumber(rotation.norm()) + "; a rotation needs the length 1");
    from = Pose(rotation, from.p);
  } else if (keys.numbers("rpy_deg", 3, rpy_deg)) {
    // Rotations about fixed axes: first roll about x, then pitch about y, then yaw about z.
    from.R = (Eigen::AngleAxisd(rpy_deg[2] * kRadPerDeg, Vec3::UnitZ()) *
              Eigen::AngleAxisd(rpy_deg[1] * kRadPerDeg, Vec3::UnitY()) *
              Eigen::AngleAxisd(rpy_deg[0] * kRadPerDeg, Vec3::UnitX()))
                 .toRotationMatrix();
  }
  return from;
}

}  // namespace vps::scenes
