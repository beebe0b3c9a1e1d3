// SPDX-License-Identifier: BSD-3-Clause
// Reads TOML files and the keys of one of their tables; errors state file, line, key and remedy.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vps/pose.h"
#include "vps_scenes/scene/fields.h"

// toml++ 3.3 asserts (under clang: assumes) that a table header holds a key, so "[=]" in a user's file would
// abort. Without the assertion, the code after the assertion reports the user's mistake.
#define TOML_ASSERT(expr) static_assert(true)
#pragma push_macro("NDEBUG")
#undef NDEBUG
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

namespace vps::scenes {

/// The text of a TOML file. Throws LoadError if the file cannot be read.
/// @param what, example  for messages: "scene file", "scene.toml"
std::string readTomlText(const std::string& file, const std::string& what, const std::string& example);

/// Parses TOML. Throws LoadError with the line of an error of syntax.
/// @param file  for messages
toml::table parseToml(const std::string& text, const std::string& file);

/// Facts that all tables of one scene file share.
struct SceneFileContext {
  std::string file;              ///< path of the file as the user wrote it, for messages
  std::optional<double> unit_m;  ///< metres per plain number of a length; empty: no unit stated
};

/// The element of `known` with the least edit distance to `word`; empty when no element is similar.
std::string nearestWord(std::string_view word, const std::vector<std::string>& known);

/// The end of a message about an unknown name: "; did you mean 'shaft'?", or the first of the known names.
std::string didYouMean(const std::string& name, const std::vector<std::string>& names);

/// The keys of one table. Each reading function returns false and leaves `out` unchanged when the key is
/// absent, and throws LoadError when the key's value is wrong (type, range, not finite).
class SceneKeys {
 public:
  /// @param place  name of the table in messages: "[[part]]", "[device]"; "" at the top
  /// @param known  every key that the table may have. A key that is not in `known` throws LoadError at once;
  ///               the message has the new name of a renamed key.
  SceneKeys(const toml::table& table, const SceneFileContext& context, std::string place,
            const std::vector<std::string_view>& known);

  [[nodiscard]] bool has(std::string_view key) const { return table_.contains(key); }
  [[nodiscard]] bool isText(std::string_view key) const { return has(key) && node(key)->is_string(); }

  bool flag(std::string_view key, bool& out) const;
  bool text(std::string_view key, std::string& out) const;
  bool texts(std::string_view key, std::vector<std::string>& out) const;
  bool number(std::string_view key, double& out, Range range = kAny) const;
  bool integer(std::string_view key, std::int64_t& out, Range range = kAny) const;
  bool numbers(std::string_view key, std::size_t count, double* out, Range range = kAny) const;
  /// Reads a length in metres from a number in the file's unit, or from text with a unit ("20um").
  bool length(std::string_view key, double& out_m, Range range = kAny) const;
  /// Reads an angle that the file gives in degrees.
  bool angle(std::string_view key, double& out_rad, Range range = kAny) const;
  /// Reads three lengths.
  bool position(std::string_view key, Vec3& out_m) const;
  /// Reads {position = [..], rotation_xyzw = [..] or rpy_deg = [..]}; a position or rotation that is left out
  /// keeps its value in `out`.
  bool pose(std::string_view key, Pose& out) const;
  /// Reads a list of poses; a position or rotation that a pose leaves out is taken from `from`.
  bool poses(std::string_view key, const Pose& from, std::vector<Pose>& out) const;
  /// Reads one of `words`; `out` becomes the index of the word.
  bool word(std::string_view key, const std::vector<std::string>& words, std::size_t& out) const;

  /// The table, or the list of tables, under a key; throws LoadError when the value is of another type.
  [[nodiscard]] const toml::table* table(std::string_view key) const;
  [[nodiscard]] std::vector<const toml::table*> tables(std::string_view key) const;

  /// "file:line" of a key, or of the table when it has no such key.
  [[nodiscard]] std::string placeOf(std::string_view key) const;

  /// Throws LoadError "file:line: key 'key' <found_and_remedy>" for a key, and "file:line: [[part]] <..>" for
  /// the table as a whole.
  [[noreturn]] void fail(std::string_view key, const std::string& found_and_remedy) const;
  [[noreturn]] void failWhole(const std::string& found_and_remedy) const;

 private:
  [[nodiscard]] const toml::node* node(std::string_view key) const { return table_.get(key); }
  [[nodiscard]] double requireNumber(std::string_view key, const toml::node& node, Range range) const;
  [[nodiscard]] double requireLength(std::string_view key, const toml::node& node, Range range) const;
  [[nodiscard]] const toml::array& requireArray(std::string_view key, const toml::node& node,
                                                std::size_t count, const std::string& of) const;
  [[nodiscard]] Pose requirePose(std::string_view key, const toml::node& node, Pose from) const;
  void require(std::string_view key, double value, Range range, const std::string& as_written) const;
  [[noreturn]] void failAt(const toml::node* where, const std::string& message) const;

  const toml::table& table_;
  const SceneFileContext& context_;
  std::string place_;
};

}  // namespace vps::scenes
