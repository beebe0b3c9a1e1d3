// SPDX-License-Identifier: BSD-3-Clause
// The table of fields of each log entry. The schema and the bytes of the messages, the columns of a CSV file
// and the description of a difference are made from it.
#pragma once

#include <string>

#include "vps_device/run_log.h"

namespace vps::device::log {

/// visit(name, field) for each field: double, Vec3, Mat3 (row by row), int32, uint8-sized enums and numbers,
/// and the event's text. Doubles come first, so that no byte of a message is padding.
template <typename Entry, typename Visit>
requires std::is_same_v<std::remove_const_t<Entry>, DeviceSample>
void fields(Entry& e, Visit&& visit) {
  auto& [X_DH, V_DH, time_s, status] = e;  // a new member that is missing here does not compile
  visit("time_s", time_s);
  visit("p_dh_m", X_DH.p);
  visit("r_dh", X_DH.R);
  visit("v_dh_m_s", V_DH.v);
  visit("w_dh_rad_s", V_DH.w);
  visit("status", status);
}

template <typename Entry, typename Visit>
requires std::is_same_v<std::remove_const_t<Entry>, WrittenWrench>
void fields(Entry& e, Visit&& visit) {
  visit("time_s", e.time_s);
  visit("force_n", e.F_Ho_D.f);
  visit("torque_nm", e.F_Ho_D.tau);
}

template <typename Entry, typename Visit>
requires std::is_same_v<std::remove_const_t<Entry>, RunEvent>
void fields(Entry& e, Visit&& visit) {
  visit("time_s", e.time_s);
  visit("step", e.step);
  visit("kind", e.kind);
  visit("phase", e.phase);
  visit("text", e.text);
}

template <typename Entry, typename Visit>
requires std::is_same_v<std::remove_const_t<Entry>, RunTrace>
void fields(Entry& e, Visit&& visit) {
  visit("time_s", e.time_s);
  visit("p_wp_m", e.X_WP.p);
  visit("r_wp", e.X_WP.R);
  visit("p_w_proxy_m", e.X_W_Proxy.p);
  visit("r_w_proxy", e.X_W_Proxy.R);
  visit("force_on_hand_n", e.F_hand_W.f);
  visit("torque_on_hand_nm", e.F_hand_W.tau);
  visit("depth_m", e.depth_m);
  visit("step", e.step);
  visit("contacts", e.contacts);
  visit("phase", e.phase);
}

template <typename Entry, typename Visit>
requires std::is_same_v<std::remove_const_t<Entry>, SyncEvent>
void fields(Entry& e, Visit&& visit) {
  auto& [time_s, tick, periods, snapshot, kind] = e;
  visit("time_s", time_s);
  visit("tick", tick);
  visit("periods", periods);
  visit("snapshot", snapshot);
  visit("kind", kind);
}

/// LogEntry::index() of a SyncEvent.
inline constexpr std::size_t kSyncKind = 4;
static_assert(std::is_same_v<std::variant_alternative_t<kSyncKind, LogEntry>, SyncEvent>);

/// Topics and types by LogEntry::index().
inline constexpr std::size_t kKinds = std::variant_size_v<LogEntry>;
inline constexpr const char* kTopics[kKinds] = {"/device/read", "/device/write", "/run/event", "/run/trace",
                                                "/run/sync_event"};
inline constexpr const char* kTypes[kKinds] = {"vps_msgs/msg/DeviceSample", "vps_msgs/msg/HandWrench",
                                               "vps_msgs/msg/RunEvent", "vps_msgs/msg/RunTrace",
                                               "vps_msgs/msg/SyncEvent"};
inline constexpr const char* kAbout[kKinds] = {
    "# The handle H in the device's base D; v and w of H's origin. status 0: use it.",
    "# On the hand about H's origin, in D, as it went to the device.",
    "# kind: 0 takes a part, 1 another phase, 2 lets go, 3 a note. phase: of the hand.",
    "# Part P and proxy in the world W. phase: 0 reach, 1 insert, 2 press, 3 rest.",
    ("# Loop and physics by the clock. kind: 0 a tick with that snapshot, 1 a step with that tick's proxy, "
     "...")};

/// The fewest digits that read back to the same value.
std::string number(double x);
/// An entry of a kind with default values.
LogEntry blank(std::size_t kind);
/// Schema of a kind of entry in ROS 2's interface language.
std::string schema(std::size_t kind);
/// Message of an entry in little-endian CDR, ROS 2's wire format.
std::string encoded(const LogEntry& entry);
/// False if the bytes are not exactly one message of that kind; the entry must not be used then.
bool decode(std::string_view bytes, LogEntry& entry);
/// "time_s,p_dh_m.x,...", and one row of values.
std::string csvHeader(std::size_t kind);
std::string csvRow(const LogEntry& entry);
/// Name and both values of the first field in which two entries of one kind differ; empty: equal bit for bit.
std::string difference(const LogEntry& recorded, const LogEntry& now);

}  // namespace vps::device::log
