// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/scene/scene_text.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>

#include "core/valid_text.h"
#include "vps_scenes/cad/colors.h"
#include "vps_scenes/scene/settings_fields.h"

namespace vps::scenes {

namespace {

std::string tomlNumber(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value == 0 ? 0.0 : value);
  return text;
}

std::string tomlValue(const FieldTraits&, bool value) {
  return value ? "true" : "false";
}
std::string tomlValue(const FieldTraits&, const std::string& value) {
  return tomlText(value);
}
std::string tomlValue(const FieldTraits& traits, double value) {
  constexpr int kExact = 17;
  constexpr int kNoted = 12;  // twelve digits hide the rounding of a unit's factor
  if (traits.quantity == Quantity::Angle) return tomlNumber(value * 180 / std::numbers::pi, kNoted);
  if (traits.quantity == Quantity::Megabytes) return tomlNumber(value / 1e6, kNoted);
  const std::string noted = tomlNumber(value, kNoted);
  return std::stod(noted) == value ? noted : tomlNumber(value, kExact);
}
std::string tomlValue(const FieldTraits& traits, const std::optional<double>& value) {
  return tomlValue(traits, value.value_or(0));
}
template <class T>
std::string tomlValue(const FieldTraits& traits, const T& value) {
  if (!traits.zero_word.empty() && value == T{}) return tomlText(std::string(traits.zero_word));
  if constexpr (std::is_enum_v<T>)
    return tomlText(toText(value));
  else
    return std::to_string(value);
}

template <class Struct>
void addLine(std::string&, const Struct&, const Struct&, const Key&) {}
template <class Struct, class Get>
void addLine(std::string& out, const Struct& of, const Struct& standard, const Field<Get>& row) {
  const auto& value = std::invoke(row.get, of);
  if (value == std::invoke(row.get, standard)) return;
  out += std::string(row.key) + " = " + tomlValue(row.traits, value) + "\n";
}
template <class Struct, class Get, class Rows>
void addLine(std::string& out, const Struct& of, const Struct& standard, const Group<Get, Rows>& group) {
  forEachRow(group.rows, [&](const auto& row) {
    addLine(out, std::invoke(group.get, of), std::invoke(group.get, standard), row);
  });
}

/// A line for each setting of a field table that differs from `standard`.
template <class Struct, class Rows>
std::string linesOf(const Struct& of, const Rows& rows, const Struct& standard = {}) {
  std::string out;
  forEachRow(rows, [&](const auto& row) { addLine(out, of, standard, row); });
  return out;
}

std::string tableOf(const std::string& name, const std::string& lines) {
  return lines.empty() ? "" : "[" + name + "]\n" + lines + "\n";
}

/// A colour in sRGB, as in a scene file.
std::string colorText(const std::array<float, 3>& linear) {
  std::string out = "\"#";
  for (const float c : linear) {
    char two[8];
    std::snprintf(two, sizeof two, "%02x", srgbByte(c));
    out += two;
  }
  return out + "\"";
}

std::string partText(const ScenePart& part, const std::string& file) {
  std::string out = "[[part]]\nname = " + tomlText(part.part.name) + "\nfile = " + tomlText(file) +
                    "\npose = " + tomlPose(part.X_WP) + "\n";
  if (part.part.color != Part().color && part.part.face_colors.isNone())
    out += "color = " + colorText(part.part.color) + "\n";
  const auto vector = [&](const char* key, const Vec3& v) {
    if (!v.isZero(0))
      out += std::string(key) + " = [" + tomlNumber(v.x(), 17) + ", " + tomlNumber(v.y(), 17) + ", " +
             tomlNumber(v.z(), 17) + "]\n";
  };
  vector("velocity_m_s", part.V_WP_W.v);
  vector("angular_velocity_rad_s", part.V_WP_W.w);
  return out + linesOf(part, kPartKeys) + "\n";
}

std::string stepText(const SceneStep& step, const ScenePart& part) {
  std::string out = "[[step]]\npart = " + tomlText(part.part.name) + "\n";
  if (tomlPose(step.X_WP_target) != tomlPose(part.X_WP))
    out += "target = " + tomlPose(step.X_WP_target) + "\n";
  out += "start = " + tomlPose(step.X_WP_start) + "\n";
  for (std::size_t i = 0; i < step.way_points.size(); ++i)
    out += (i == 0 ? "way_points = [\n  " : "  ") + tomlPose(step.way_points[i]) +
           (i + 1 == step.way_points.size() ? "]\n" : ",\n");
  return out + linesOf(step, kStepKeys) + "\n";
}

std::string deviceText(const DeviceSettings& device) {
  std::string lines = linesOf(device, kDeviceKeys);
  if (!device.data.empty())
    lines += "parameters = " + tomlText(std::filesystem::absolute(device.data).string()) + "\n";
  if (device.placement) lines += "placement = " + tomlPose(*device.placement) + "\n";
  return tableOf("device", lines);
}

std::string fidelityText(const Scene& scene) {
  std::string lines;
  if (scene.fidelity_wish) lines = "auto = true\n" + linesOf(*scene.fidelity_wish, kFidelityWishFields);
  return tableOf("fidelity", lines + linesOf(scene.fidelity, kFidelityFields, fidelityPreset("normal")));
}

}  // namespace

std::string tomlText(const std::string& text) {
  std::string out = "\"";
  for (const unsigned char c : validUtf8(text)) {
    char escape[8];
    if (c == '"' || c == '\\') {
      out += '\\';
      out += static_cast<char>(c);
    } else if (c < 0x20 || c == 0x7F) {
      std::snprintf(escape, sizeof escape, "\\u%04X", c);
      out += escape;
    } else {
      out += static_cast<char>(c);
    }
  }
  return out + "\"";
}

std::string tomlPose(const Pose& pose) {
  const Quat q = pose.quaternion();
  // Twelve digits resolve a picometre in a metre; further digits would only show rounding errors.
  const auto n = [](double value) { return tomlNumber(value, 12); };
  return "{position = [" + n(pose.p.x()) + ", " + n(pose.p.y()) + ", " + n(pose.p.z()) +
         "], rotation_xyzw = [" + n(q.x()) + ", " + n(q.y()) + ", " + n(q.z()) + ", " + n(q.w()) + "]}";
}

std::string groupText(const PartGroup& group) {
  constexpr std::size_t kWidth = 100;
  std::string out = "[[group]]";
  if (!group.reason.empty()) out += "  # " + group.reason;
  out += "\nname = " + tomlText(group.name) + "\nparts = [";
  std::size_t line = out.size() - out.rfind('\n');
  for (std::size_t i = 0; i < group.parts.size(); ++i) {
    const std::string part = tomlText(group.parts[i]) + (i + 1 < group.parts.size() ? "," : "]");
    if (line + part.size() + 1 > kWidth) {
      out += "\n  ";
      line = 2;
    } else if (i > 0) {
      out += " ";
    }
    out += part;
    line += part.size() + 1;
  }
  return out + "\n\n";
}

std::string sceneText(const Scene& scene, const std::vector<std::string>& files, const std::string& comment) {
  std::string out = "# " + comment + "\nname = " + tomlText(scene.name) + "\nunit = \"m\"\n";
  if (scene.gravity_W != Scene().gravity_W)
    out += "gravity = [" + tomlNumber(scene.gravity_W.x(), 17) + ", " + tomlNumber(scene.gravity_W.y(), 17) +
           ", " + tomlNumber(scene.gravity_W.z(), 17) + "]\n";
  if (!scene.missing.empty()) out += "missing = " + tomlText(scene.missing) + "\n";
  out += linesOf(scene, kSceneKeys) + "\n";
  for (std::size_t i = 0; i < scene.parts.size(); ++i) out += partText(scene.parts[i], files[i]);
  for (const SceneStep& step : scene.steps) out += stepText(step, scene.parts[step.part]);
  out += deviceText(scene.device) + tableOf("operator", linesOf(scene.hand, kOperatorFields)) +
         tableOf("coupling", linesOf(scene.coupling, kCouplingFields)) + fidelityText(scene) +
         tableOf("record", linesOf(scene.record, kRecordFields));
  out.pop_back();
  return out;
}

}  // namespace vps::scenes
