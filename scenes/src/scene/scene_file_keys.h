// SPDX-License-Identifier: BSD-3-Clause
// Reads the keys of one TOML table of a scene file, and says what is wrong with them: file, line, key,
// remedy.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vps/pose.h"

// toml++ 3.3 asserts (under clang: assumes) that a table header holds a key, so "[=]" in a user's file would
// abort. With the assertion off its next lines report the mistake as they should.
#define TOML_ASSERT(expr) static_assert(true)
#pragma push_macro("NDEBUG")
#undef NDEBUG
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

namespace vps::scenes {

/// What all tables of one scene file share.
struct SceneFileContext {
  std::string file;              ///< as the user named it, for messages
  std::optional<double> unit_m;  ///< metres per plain number where a length is meant; empty: not stated
};

/// The values a number may take; both ends are included unless is_open_min.
struct Range {
  double min = -std::numeric_limits<double>::max();
  double max = std::numeric_limits<double>::max();
  bool is_open_min = false;
};
inline constexpr Range kAny{};
inline constexpr Range kPositive{.min = 0, .is_open_min = true};
inline constexpr Range kNotNegative{.min = 0};

/// The word of `known` that `word` was probably meant to be; empty when none is near.
std::string nearestWord(std::string_view word, const std::vector<std::string>& known);

/// One table. Each read leaves `out` as it is and returns false when the key is not there; throws LoadError
/// when it is there and is wrong (type, range, not finite).
class SceneKeys {
 public:
  /// @param place  what messages call the table: "[[part]]", "[device]"; "" at the top
  /// @param known  every key the table may have; another one throws at once, before a missing key is
  /// complained of
  SceneKeys(const toml::table& table, const SceneFileContext& context, std::string place,
            std::initializer_list<std::string_view> known);

  [[nodiscard]] bool has(std::string_view key) const { return table_.contains(key); }
  [[nodiscard]] bool isText(std::string_view key) const { return has(key) && node(key)->is_string(); }

  bool flag(std::string_view key, bool& out) const;
  bool text(std::string_view key, std::string& out) const;
  bool number(std::string_view key, double& out, Range range = kAny) const;
  bool integer(std::string_view key, std::int64_t& out, Range range = kAny) const;
  bool numbers(std::string_view key, std::size_t count, double* out, Range range = kAny) const;
  /// A number in the file's unit, or text with a unit ("20um"); metres.
  bool length(std::string_view key, double& out_m, Range range = kAny) const;
  /// Degrees in the file, radians out.
  bool angle(std::string_view key, double& out_rad, Range range = kAny) const;
  /// Three lengths.
  bool position(std::string_view key, Vec3& out_m) const;
  /// {position = [..], rotation_xyzw = [..] or rpy_deg = [..]}; what is left out stays as in `out`.
  bool pose(std::string_view key, Pose& out) const;
  /// A list of poses; each starts from `from`.
  bool poses(std::string_view key, const Pose& from, std::vector<Pose>& out) const;
  /// One of the words; index into them.
  bool word(std::string_view key, const std::vector<std::string>& words, std::size_t& out) const;

  /// The table or the tables under a key, for readers of their own; throws when it is neither.
  [[nodiscard]] const toml::table* table(std::string_view key) const;
  [[nodiscard]] std::vector<const toml::table*> tables(std::string_view key) const;

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
