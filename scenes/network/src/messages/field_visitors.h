// SPDX-License-Identifier: BSD-3-Clause
// Writing and reading of message fields (message_fields.h, compact_fields.h) as bytes, with validation on
// reading.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

#include "messages/dense_state.h"
#include "messages/message_fields.h"
#include "messages/messages.h"
#include "vps_device/detail/bytes.h"

namespace vps::scenes::wire {

inline constexpr double kLargest = 1e12;  // limit of any number that a correct node sends
inline constexpr double kRotationError =
    1e-6;  // limit of a rotation's error; assumed: far above rounding, far below the threshold of touch
/// Limit of the bodies or contacts in a snapshot; further ones are left out.
inline constexpr std::uint32_t kLongestList = 1024;

/// Composes fields from numbers, for writing and reading.
template <typename Self>
class Visit {
 public:
  void operator()(Vec3& x) {
    for (double& component : x) self().number(component);
  }
  void operator()(Twist& x) { (*this)(x.w), (*this)(x.v); }
  void operator()(Wrench& x) { (*this)(x.tau), (*this)(x.f); }
  void operator()(Pose& x) {
    for (double& entry : x.R.reshaped()) self().number(entry);
    (*this)(x.p);
    self().checkRotation(x.R);
  }
  void operator()(bool& x) { self().flag(x); }
  void operator()(std::optional<double>& x) {
    bool has_value = x.has_value();
    double value = x.value_or(0);
    self().flag(has_value);
    self().number(value);
    if (!has_value && std::bit_cast<std::uint64_t>(value) != 0) self().refuse();
    x = has_value ? std::optional(value) : std::nullopt;
  }
  template <std::size_t N>
  void operator()(std::array<char, N>& text) {
    self().text(text.data(), N);
  }
  template <std::size_t N>
  void raw(std::array<char, N>& bytes) {
    self().put(bytes.data(), N);
  }
  template <typename T>
  requires std::is_arithmetic_v<T>
  void operator()(T& x) { self().number(x); }
  void notNegative(double& x) {
    self().number(x);
    if (x < 0) self().refuse();
  }
  void unchecked(bool on) { is_unchecked_ = on; }
  void alternative(device::LogEntry& entry) {
    std::uint8_t index = static_cast<std::uint8_t>(entry.index());
    choice(index, 5);
    self().become(entry, index);
    const auto visit = [this](auto& e) {
      using T = std::remove_reference_t<decltype(e)>;
      if constexpr (!std::is_same_v<T, device::RunEvent> && !std::is_same_v<T, device::RunTrace>)
        wire::fields(e, self());
    };
    std::visit(visit, entry);
  }
  template <typename Enum>
  void choice(Enum& e, unsigned count) {
    std::uint8_t byte = static_cast<std::uint8_t>(e);
    self().number(byte);
    if (byte >= count) return self().refuse();
    e = static_cast<Enum>(byte);
  }

 protected:
  bool is_unchecked_ = false;

 private:
  Self& self() { return static_cast<Self&>(*this); }
};

/// Composes fields in the compact form, for writing and reading.
template <typename Self>
class CompactVisit {
 public:
  void operator()(double& x) { self().number(x); }
  void operator()(Vec3& x) {
    for (double& component : x) self().number(component);
  }
  void operator()(Pose& x) {
    (*this)(x.p);
    self().rotation(x.R);
  }
  void operator()(std::optional<double>& x) {
    bool has_value = x.has_value();
    double value = x.value_or(0);
    exact(has_value);
    if (has_value) self().number(value);
    x = has_value ? std::optional(value) : std::nullopt;
  }
  void coarse(Twist& x) {
    for (Vec3* part : {&x.w, &x.v}) self().half(*part);
  }
  void coarse(Wrench& x) {
    for (Vec3* part : {&x.tau, &x.f}) self().half(*part);
  }
  void coarse(Vec3& x) { self().half(x); }
  void coarse(double& x) { self().half(x); }
  template <typename T>
  void exact(T& x) {
    if constexpr (std::is_same_v<T, bool>)
      self().flag(x);
    else
      self().whole(x);
  }
  template <typename Enum>
  void choice(Enum& e, unsigned count) {
    std::uint8_t byte = static_cast<std::uint8_t>(e);
    self().whole(byte);
    if (byte >= count) return self().refuse();
    e = static_cast<Enum>(byte);
  }

 private:
  Self& self() { return static_cast<Self&>(*this); }
};

class CompactPut : public CompactVisit<CompactPut> {
 public:
  explicit CompactPut(std::string& out) : writer_(out) {}
  void number(double x) { writer_.put(static_cast<float>(x)); }
  void half(double x) {
    const auto bounded = static_cast<float>(std::clamp(x, -kLargestHalf, kLargestHalf));
    writer_.put(std::bit_cast<std::uint16_t>(Eigen::half(bounded)));
  }
  void half(const Vec3& x) {
    for (const double component : x) half(component);
  }
  void rotation(const Mat3& R) { writer_.put(packedRotation(R)); }
  void flag(bool x) { writer_.put(static_cast<std::uint8_t>(x)); }
  template <typename T>
  void whole(T x) {
    writer_.put(x);
  }
  void refuse() {}
  template <typename List, typename Each>
  void list(List& items, const Each& each) {
    const std::size_t count = std::min<std::size_t>(items.size(), kLongestList);
    writer_.put(static_cast<std::uint16_t>(count));
    for (std::size_t i = 0; i < count; ++i) each(items[i]);
  }

 private:
  static constexpr double kLargestHalf = 65504;
  device::ByteWriter writer_;
};

class CompactGet : public CompactVisit<CompactGet> {
 public:
  explicit CompactGet(std::string_view bytes) : reader_(bytes) {}
  [[nodiscard]] bool isAllRead() const { return reader_.isGood() && reader_.left() == 0; }
  [[nodiscard]] bool isGood() const { return is_good_; }

  void number(double& x) { check(x = reader_.getFloat()); }
  void half(double& x) {
    check(x = static_cast<float>(std::bit_cast<Eigen::half>(reader_.get<std::uint16_t>())));
  }
  void half(Vec3& x) {
    for (double& component : x) half(component);
  }
  void rotation(Mat3& R) {
    const std::optional<Mat3> read = unpackedRotation(reader_.get<std::uint64_t>());
    if (!read) return refuse();
    R = *read;
  }
  void flag(bool& x) {
    const auto byte = reader_.get<std::uint8_t>();
    if (byte > 1) refuse();
    x = byte == 1;
  }
  void whole(double& x) { check(x = reader_.getDouble()); }
  void whole(std::int32_t& x) { x = reader_.getInt(); }
  template <std::unsigned_integral T>
  void whole(T& x) {
    x = reader_.get<T>();
  }
  void refuse() { is_good_ = false; }
  template <typename List, typename Each>
  void list(List& items, const Each& each) {
    const auto count = reader_.get<std::uint16_t>();
    items.clear();
    if (count > kLongestList) return refuse();
    for (std::uint32_t i = 0; i < count && reader_.isGood(); ++i) each(items.emplace_back());
  }

 private:
  void check(double x) {
    if (!(std::abs(x) <= kLargest)) refuse();
  }
  device::ByteReader reader_;
  bool is_good_ = true;
};

class Put : public Visit<Put> {
 public:
  explicit Put(std::string& out) : writer_(out) {}
  void number(double x) { writer_.put(x); }
  void number(std::int32_t x) { writer_.put(x); }
  void number(std::int64_t x) { writer_.put(static_cast<std::uint64_t>(x)); }
  template <std::unsigned_integral T>
  void number(T x) {
    writer_.put(x);
  }
  void flag(bool x) { writer_.put(static_cast<std::uint8_t>(x)); }
  void text(const char* bytes, std::size_t size) { writer_.bytes({bytes, size}); }
  void put(const char* bytes, std::size_t size) { writer_.bytes({bytes, size}); }
  void become(device::LogEntry&, std::uint8_t) {}
  void checkRotation(const Mat3&) {}
  void refuse() {}
  template <typename List, typename Each>
  void list(List& items, const Each& each) {
    const std::size_t count = std::min<std::size_t>(items.size(), kLongestList);
    writer_.put(static_cast<std::uint32_t>(count));
    for (std::size_t i = 0; i < count; ++i) each(items[i]);
  }

 private:
  device::ByteWriter writer_;
};

class Get : public Visit<Get> {
 public:
  explicit Get(std::string_view bytes) : reader_(bytes) {}
  [[nodiscard]] bool isAllRead() const { return reader_.isGood() && reader_.left() == 0; }
  [[nodiscard]] bool isGood() const { return is_good_; }

  void number(double& x) {
    x = reader_.getDouble();
    if (!is_unchecked_ && !(std::abs(x) <= kLargest)) refuse();
  }
  void number(std::int32_t& x) { x = reader_.getInt(); }
  void number(std::int64_t& x) { x = static_cast<std::int64_t>(reader_.get<std::uint64_t>()); }
  template <std::unsigned_integral T>
  void number(T& x) {
    x = reader_.get<T>();
  }
  void flag(bool& x) {
    const std::uint8_t byte = reader_.get<std::uint8_t>();
    if (byte > 1) refuse();
    x = byte == 1;
  }
  void text(char* bytes, std::size_t size) {
    const std::string_view read = reader_.take(size);
    std::copy(read.begin(), read.end(), bytes);
    if (read.find('\0') == std::string_view::npos) refuse();
  }
  void put(char* bytes, std::size_t size) {
    const std::string_view read = reader_.take(size);
    std::copy(read.begin(), read.end(), bytes);
  }
  void become(device::LogEntry& entry, std::uint8_t index) {
    if (index == 0)
      entry = device::DeviceSample{};
    else if (index == 1)
      entry = device::WrittenWrench{};
    else if (index == 4)
      entry = device::SyncEvent{};
    else
      refuse();
  }
  void checkRotation(const Mat3& R) {
    if (is_unchecked_) return;
    const bool is_rotation =
        (R * R.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() <= kRotationError && R.determinant() > 0;
    if (!is_rotation) refuse();
  }
  void refuse() { is_good_ = false; }
  template <typename List, typename Each>
  void list(List& items, const Each& each) {
    const auto count = reader_.get<std::uint32_t>();
    items.clear();
    if (count > kLongestList) return refuse();
    for (std::uint32_t i = 0; i < count && reader_.isGood(); ++i) each(items.emplace_back());
  }

 private:
  device::ByteReader reader_;
  bool is_good_ = true;
};

}  // namespace vps::scenes::wire
