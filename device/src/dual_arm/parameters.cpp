// SPDX-License-Identifier: BSD-3-Clause
// Reads data/dual_arm.toml and the user's parameter files into DualArmParameters.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <variant>

#include "vps/errors.h"
#include "vps_device/dual_arm/kinematics.h"

// toml++ 3.3 asserts that a table header holds a key, so that "[=]" in a user's file would abort. Without the
// assertion toml++ reports the mistake.
#define TOML_ASSERT(expr) static_assert(true)
#pragma push_macro("NDEBUG")
#undef NDEBUG
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

namespace vps::device {
namespace {

using P = DualArmParameters;

// Joins without +, since GCC 12 reports "text" + std::string as an overflow (its bugs 105329 and 105651).
std::string joined(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) text.append(part);
  return text;
}

// Range of a value. The upper ends are far beyond any haptic device, and catch wrong units.
struct Span {
  double min, max;
  bool is_open = false;  // min itself is not allowed
};
constexpr Span kLength{0, 10, true}, kOffset{-1, 1}, kAngle{0, 3.1, true}, kMass{0, 100, true};
constexpr Span kNone{0, 1e4}, kStiff{0, 1e9, true}, kEffort{0, 1e4, true}, kTime{0, 1e4, true},
    kStep{0, 0.1, true};

struct Field {
  std::string_view section, key;
  std::variant<double P::*, Vec3 P::*> member;
  Span span;
};

const std::array kFields = {
    Field{"workspace", "size_m", &P::workspace_m, kLength},
    Field{"handle", "length_m", &P::handle_m, kLength},
    Field{"handle", "centre_of_mass_m", &P::p_EH, kOffset},
    Field{"handle", "mass_kg", &P::handle_kg, kMass},
    Field{"handle", "inertia_kgm2", &P::handle_kgm2, kMass},
    Field{"bases", "distance_m", &P::base_m, kLength},
    Field{"bases", "right_shift_m", &P::right_shift_m, kOffset},
    Field{"bases", "right_turn_rad", &P::right_turn_rad, kOffset},
    Field{"joints", "slide_min_m", &P::reach_min_m, kLength},
    Field{"joints", "slide_max_m", &P::reach_max_m, kLength},
    Field{"joints", "plate_max_rad", &P::plate_max_rad, {0, 1.5, true}},
    Field{"joints", "q2_max_rad", &P::q2_max_rad, {0, 1.57, true}},
    Field{"joints", "q3_max_rad", &P::q3_max_rad, kAngle},
    Field{"joints", "link_radius_m", &P::link_radius_m, {0, 1}},
    Field{"inertia", "plate_kgm2", &P::plate_kgm2, kMass},
    Field{"inertia", "link_kg", &P::link_kg, kMass},
    Field{"inertia", "rotor_kgm2", &P::rotor_kgm2, kMass},
    Field{"inertia", "motor_share", &P::motor_share, {0.01, 0.99}},
    Field{"friction", "plate_damping_Nms", &P::plate_damping_Nms, kNone},
    Field{"friction", "link_damping_Ns_per_m", &P::link_damping_Ns_per_m, kNone},
    Field{"friction", "rotor_damping_Nms", &P::rotor_damping_Nms, kNone},
    Field{"friction", "plate_coulomb_Nm", &P::plate_coulomb_Nm, kNone},
    Field{"friction", "link_coulomb_N", &P::link_coulomb_N, kNone},
    Field{"friction", "rotor_coulomb_Nm", &P::rotor_coulomb_Nm, kNone},
    Field{"structure", "plate_Nm_per_rad", &P::plate_Nm_per_rad, kStiff},
    Field{"structure", "link_N_per_m", &P::link_N_per_m, kStiff},
    Field{"structure", "gimbal_N_per_m", &P::gimbal_N_per_m, kStiff},
    Field{"structure", "rotor_Nm_per_rad", &P::rotor_Nm_per_rad, kStiff},
    Field{"structure", "damping_s", &P::structure_damping_s, {0, 1}},
    Field{"stops", "plate_Nm_per_rad", &P::plate_stop_Nm_per_rad, kStiff},
    Field{"stops", "link_N_per_m", &P::link_stop_N_per_m, kStiff},
    Field{"stops", "gimbal_Nm_per_rad", &P::gimbal_stop_Nm_per_rad, kStiff},
    Field{"stops", "damping_s", &P::stop_damping_s, {0, 1}},
    Field{"encoders", "plate_step_rad", &P::plate_step_rad, kStep},
    Field{"encoders", "link_step_m", &P::link_step_m, kStep},
    Field{"encoders", "rotor_step_rad", &P::rotor_step_rad, kStep},
    Field{"encoders", "noise_steps", &P::noise_steps, {0, 100}},
    Field{"encoders", "resolution_m", &P::resolution_m, kStep},
    Field{"encoders", "resolution_rad", &P::resolution_rad, kStep},
    Field{"motors", "plate_Nm", &P::plate_torque_Nm, kEffort},
    Field{"motors", "plate_peak_Nm", &P::plate_peak_Nm, kEffort},
    Field{"motors", "link_N", &P::link_force_N, kEffort},
    Field{"motors", "link_peak_N", &P::link_peak_N, kEffort},
    Field{"motors", "rotor_Nm", &P::rotor_torque_Nm, kEffort},
    Field{"motors", "rotor_peak_Nm", &P::rotor_peak_Nm, kEffort},
    Field{"motors", "thermal_s", &P::thermal_s, kTime},
    Field{"limits", "force_N", &P::force_N, kEffort},
    Field{"limits", "force_peak_N", &P::force_peak_N, kEffort},
    Field{"limits", "torque_Nm", &P::torque_Nm, kEffort},
    Field{"limits", "torque_peak_Nm", &P::torque_peak_Nm, kEffort},
    Field{"protection", "speed_m_s", &P::speed_m_s, kEffort},
    Field{"protection", "turn_rad_s", &P::turn_rad_s, kEffort},
    Field{"protection", "jump_m", &P::jump_m, kLength},
    Field{"protection", "apart_m", &P::apart_m, kLength},
    Field{"protection", "watchdog_s", &P::watchdog_s, kTime},
    Field{"timing", "delay_ticks", &P::delay_ticks, {0, 8}},
    Field{"timing", "velocity_filter_s", &P::velocity_filter_s, {0, 1}},
};

// Two values of which `low` must not exceed `high`.
struct Order {
  double P::*low;
  double P::*high;
};
constexpr std::array kOrders = {
    Order{&P::reach_min_m, &P::reach_max_m},  Order{&P::plate_torque_Nm, &P::plate_peak_Nm},
    Order{&P::link_force_N, &P::link_peak_N}, Order{&P::rotor_torque_Nm, &P::rotor_peak_Nm},
    Order{&P::force_N, &P::force_peak_N},     Order{&P::torque_Nm, &P::torque_peak_Nm},
};

std::string text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

std::string expected(Span span) {
  return (span.is_open ? "more than " : "at least ") + text(span.min) + " and at most " + text(span.max);
}

const Field& fieldOf(double P::*member) {
  return *std::find_if(kFields.begin(), kFields.end(), [&](const Field& field) {
    const auto* number = std::get_if<double P::*>(&field.member);
    return number != nullptr && *number == member;
  });
}

/// The keys of one section for a message; without a section, the names of all sections.
std::string known(std::string_view section) {
  std::string out;
  std::string_view last;
  for (const Field& field : kFields) {
    if (!section.empty() && field.section != section) continue;
    const std::string_view word = section.empty() ? field.section : field.key;
    if (word != last) out.append(out.empty() ? "" : ", ").append(word);
    last = word;
  }
  return out;
}

std::string slurp(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw LoadError(file, "", "no such file; name a device's .toml file");
  if (std::filesystem::is_directory(file, error))
    throw LoadError(file, "", "is a folder; name the device's .toml file in it");
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  if (!in) throw LoadError(file, "", "cannot be read; check its permissions");
  return out.str();
}

}  // namespace

/// Reads one file. The values of the file replace earlier values.
struct DualArmFileReader {
  static DualArmParameters unset() { return DualArmParameters(DualArmParameters::Unset{}); }

  DualArmFileReader(const std::string& name, DualArmFile start) : name(name), out(std::move(start)) {}

  DualArmFile read(const std::string& toml_text, bool must_be_whole) {
    const toml::table root = parse(toml_text);
    for (const auto& [section, node] : root) {
      const std::string name(section.str());
      if (known(name).empty()) fail(node, joined({"section [", name, "] is unknown; there are ", known("")}));
      if (!node.is_table())
        fail(node, joined({"'", name, "' is not a section; write [", name, "] on a line of its own"}));
      for (const auto& [key, value] : *node.as_table()) requireKnown(section.str(), key.str(), value);
    }
    for (std::size_t i = 0; i < kFields.size(); ++i) {
      const Field& field = kFields[i];
      const toml::node_view<const toml::node> node = root[field.section][field.key];
      if (node)
        readField(field, *node.node(), out.notes[i]);
      else if (must_be_whole)
        throw LoadError(name, "", "lacks [" + std::string(field.section) + "] " + std::string(field.key));
    }
    check(root);
    return std::move(out);
  }

  [[nodiscard]] toml::table parse(const std::string& toml_text) const {
    try {
      return toml::parse(toml_text, name);
    } catch (const toml::parse_error& error) {
      std::string words(error.description());
      std::replace_if(
          words.begin(), words.end(), [](unsigned char c) { return c < 0x20; }, ' ');
      throw LoadError(name + ":" + std::to_string(error.source().begin.line), "", "not valid TOML: " + words);
    }
  }

  [[noreturn]] void fail(const toml::node& node, const std::string& words) const {
    throw LoadError(name + ":" + std::to_string(node.source().begin.line), "", words);
  }
  [[noreturn]] void fail(const Field& field, const toml::node& node, const std::string& words) const {
    fail(node, "[" + std::string(field.section) + "] " + std::string(field.key) + " " + words);
  }

  void requireKnown(std::string_view section, std::string_view key, const toml::node& node) const {
    for (const Field& field : kFields)
      if (field.section == section && field.key == key) return;
    fail(node, joined({"[", section, "] has no '", key, "'; it may have ", known(section)}));
  }

  /// A plain value, or {value = ..., sourced or assumed = "..."}.
  void readField(const Field& field, const toml::node& node, ParameterNote& note) {
    note.section = field.section;
    note.key = field.key;
    note.words.clear();
    note.is_sourced = false;
    const toml::node* value = &node;
    if (const toml::table* table = node.as_table()) {
      for (const auto& [key, member] : *table) {
        if (key == "value") continue;
        if (key != "sourced" && key != "assumed")
          fail(field, member,
               "has '" + std::string(key.str()) + "'; next to value it may have sourced or assumed");
        if (!member.is_string() || !note.words.empty())
          fail(field, member, "must have either sourced or assumed, as text in quotes");
        note.words = *member.value<std::string>();
        note.is_sourced = key == "sourced";
      }
      value = table->get("value");
      if (value == nullptr) fail(field, node, "has no value; write value = NUMBER");
    }
    note.value = numbers(field, *value);
    if (const auto* number = std::get_if<double P::*>(&field.member))
      out.parameters.*(*number) = note.value[0];
    else
      out.parameters.*std::get<Vec3 P::*>(field.member) = Vec3(note.value[0], note.value[1], note.value[2]);
  }

  [[nodiscard]] std::vector<double> numbers(const Field& field, const toml::node& node) const {
    if (std::holds_alternative<double P::*>(field.member)) return {number(field, node)};
    const toml::array* list = node.as_array();
    if (list == nullptr || list->size() != 3) fail(field, node, "must be three numbers, [x, y, z]");
    std::vector<double> out;
    for (const toml::node& item : *list) out.push_back(number(field, item));
    return out;
  }

  [[nodiscard]] double number(const Field& field, const toml::node& node) const {
    if (!node.is_number()) fail(field, node, "is not a number; expected " + expected(field.span));
    const double value = *node.value<double>();
    const Span span = field.span;
    if (!(value >= span.min && value <= span.max) || (span.is_open && value == span.min))
      fail(field, node, "is " + text(value) + "; expected " + expected(span));
    return value;
  }

  void check(const toml::table& root) const {
    const P& p = out.parameters;
    for (const Order& order : kOrders) {
      if (p.*order.low <= p.*order.high) continue;
      const Field &low = fieldOf(order.low), &high = fieldOf(order.high);
      throw LoadError(place(root, low, high), "",
                      "[" + std::string(low.section) + "] " + std::string(low.key) + " is " +
                          text(p.*order.low) + ", more than " + std::string(high.key) + " " +
                          text(p.*order.high) + "; swap or change them");
    }
    if (p.delay_ticks != std::round(p.delay_ticks))
      throw LoadError(place(root, fieldOf(&P::delay_ticks), fieldOf(&P::delay_ticks)), "",
                      "[timing] delay_ticks is " + text(p.delay_ticks) + "; expected a whole number");
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 sign((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1);
      if (!isReachable(p, Pose::translation(0.5 * p.workspace_m.cwiseProduct(sign))))
        throw LoadError(
            name, "",
            "the arms do not reach a corner of [workspace] size_m; make it smaller, or [joints] wider");
    }
  }

  /// File and line for a message about two keys: the line of the first key that the file has.
  [[nodiscard]] std::string place(const toml::table& root, const Field& a, const Field& b) const {
    for (const Field* field : {&a, &b})
      if (const auto node = root[field->section][field->key])
        return name + ":" + std::to_string(node.node()->source().begin.line);
    return name;
  }

  std::string name;
  DualArmFile out;
};

const DualArmFile& builtInDualArm() {
  static const DualArmFile built_in =
      DualArmFileReader("dual_arm.toml (built in)",
                        {DualArmFileReader::unset(), std::vector<ParameterNote>(kFields.size())})
          .read(kDualArmToml, true);
  return built_in;
}

DualArmParameters::DualArmParameters() : DualArmParameters(builtInDualArm().parameters) {}

DualArmFile parseDualArm(const std::string& text, const std::string& name) {
  return DualArmFileReader(name, builtInDualArm()).read(text, false);
}

DualArmFile loadDualArm(const std::string& file) {
  return parseDualArm(slurp(file), file);
}

}  // namespace vps::device
