// SPDX-License-Identifier: BSD-3-Clause
#include "recording/log_fields.h"

#include <bit>
#include <charconv>
#include <cstring>
#include <utility>

#include "vps_device/detail/bytes.h"

namespace vps::device::log {

namespace {

constexpr std::string_view kLittleEndianCdr{"\0\1\0\0", 4};
constexpr const char* kAxes[3] = {"x", "y", "z"};

template <typename T>
constexpr bool kIsByte = std::is_enum_v<T> || std::is_same_v<T, std::uint8_t>;

using Text = decltype(RunEvent::text);

/// Names and bytes of a field's scalars, in the order of the message.
template <typename Field, typename Visit>
void scalars(const std::string& name, Field& field, Visit&& visit) {
  using T = std::remove_const_t<Field>;
  if constexpr (std::is_same_v<T, Vec3>) {
    for (int i = 0; i < 3; ++i) visit(name + "." + kAxes[i], field[i]);
  } else if constexpr (std::is_same_v<T, Mat3>) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) visit(name + "." + kAxes[i] + kAxes[j], field(i, j));
  } else {
    visit(name, field);
  }
}

struct SchemaText {
  std::string out;
  template <typename Field>
  void operator()(const char* name, const Field&) {
    if constexpr (std::is_same_v<Field, Vec3>)
      out += "float64[3] ";
    else if constexpr (std::is_same_v<Field, Mat3>)
      out += "float64[9] ";
    else if constexpr (std::is_same_v<Field, double>)
      out += "float64 ";
    else if constexpr (std::is_same_v<Field, std::int32_t>)
      out += "int32 ";
    else if constexpr (std::is_same_v<Field, Text>)
      out += "string ";
    else
      out += "uint8 ";
    out += std::string(name) + "\n";
  }
};

/// CDR aligns a value to its size, counted from the end of the four bytes that give the byte order.
class CdrWriter {
 public:
  CdrWriter() : out_(kLittleEndianCdr) {}
  template <typename Field>
  void operator()(const char* name, const Field& field) {
    scalars(name, field, [this](const std::string&, const auto& x) { this->put(x); });
  }
  std::string out_;

 private:
  template <typename T>
  void put(const T& x) {
    ByteWriter w(out_);
    if constexpr (std::is_same_v<T, Text>) {
      align(4);
      const std::size_t length = ::strnlen(x.data(), x.size());
      w.put(static_cast<std::uint32_t>(length + 1));  // the length includes the terminating zero
      w.bytes({x.data(), length});
      w.put(std::uint8_t{0});
    } else if constexpr (kIsByte<T>) {
      w.put(static_cast<std::uint8_t>(x));
    } else {
      align(sizeof x);
      w.put(x);
    }
  }
  void align(std::size_t size) {
    while ((out_.size() - kLittleEndianCdr.size()) % size != 0) out_.push_back(0);
  }
};

class CdrReader {
 public:
  explicit CdrReader(std::string_view bytes) : in_(bytes), size_(bytes.size()) {
    is_good_ = in_.take(kLittleEndianCdr.size()) == kLittleEndianCdr;
  }
  template <typename Field>
  void operator()(const char* name, Field& field) {
    scalars(name, field, [this](const std::string&, auto& x) { this->get(x); });
  }
  [[nodiscard]] bool isAllRead() const { return is_good_ && in_.isGood() && in_.left() == 0; }

 private:
  template <typename T>
  void get(T& x) {
    if constexpr (std::is_same_v<T, Text>) {
      align(4);
      const std::string_view text = in_.text();
      x.fill(0);
      is_good_ = is_good_ && !text.empty() && text.size() <= x.size() && text.back() == 0;
      if (is_good_) std::copy(text.begin(), text.end(), x.begin());
    } else if constexpr (kIsByte<T>) {
      x = static_cast<T>(in_.get<std::uint8_t>());
    } else if constexpr (std::is_same_v<T, double>) {
      align(8);
      x = in_.getDouble();
    } else {
      align(4);
      x = in_.getInt();
    }
  }
  void align(std::size_t size) {
    while (in_.isGood() && (size_ - in_.left() - kLittleEndianCdr.size()) % size != 0) in_.take(1);
  }
  ByteReader in_;
  std::size_t size_;
  bool is_good_ = true;
};

std::string shown(double x) {
  return number(x);
}
std::string shown(std::int32_t x) {
  return std::to_string(x);
}
std::string shown(const Text& x) {
  // One CSV cell, quoted, with inner quotes doubled.
  std::string out = "\"";
  for (const char c : std::string_view(x.data(), ::strnlen(x.data(), x.size())))
    out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}
template <typename T>
requires kIsByte<T> std::string shown(T x) {
  return std::to_string(static_cast<int>(x));
}

/// Name and text of every scalar of an entry.
std::vector<std::pair<std::string, std::string>> cells(const LogEntry& entry) {
  std::vector<std::pair<std::string, std::string>> out;
  std::visit(
      [&](const auto& e) {
        fields(e, [&](const char* name, const auto& field) {
          scalars(name, field, [&](const std::string& n, const auto& x) { out.emplace_back(n, shown(x)); });
        });
      },
      entry);
  return out;
}

}  // namespace

std::string number(double x) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, x).ptr};
}

LogEntry blank(std::size_t kind) {
  switch (kind) {
    case 0:
      return DeviceSample{};
    case 1:
      return WrittenWrench{};
    case 2:
      return RunEvent{};
    case 3:
      return RunTrace{};
    default:
      return SyncEvent{};
  }
}

std::string schema(std::size_t kind) {
  SchemaText text;
  text.out = std::string(kAbout[kind]) + "\n";
  std::visit([&](const auto& e) { fields(e, text); }, blank(kind));
  return text.out;
}

std::string encoded(const LogEntry& entry) {
  CdrWriter writer;
  std::visit([&](const auto& e) { fields(e, writer); }, entry);
  return std::move(writer.out_);
}

bool decode(std::string_view bytes, LogEntry& entry) {
  CdrReader reader(bytes);
  std::visit([&](auto& e) { fields(e, reader); }, entry);
  return reader.isAllRead();
}

std::string csvHeader(std::size_t kind) {
  std::string out;
  for (const auto& [name, value] : cells(blank(kind))) out += (out.empty() ? "" : ",") + name;
  return out + "\n";
}

std::string csvRow(const LogEntry& entry) {
  std::string out;
  for (const auto& [name, value] : cells(entry)) out += (out.empty() ? "" : ",") + value;
  return out + "\n";
}

std::string difference(const LogEntry& recorded, const LogEntry& now) {
  if (encoded(recorded) == encoded(now)) return "";
  const auto was = cells(recorded), is = cells(now);
  for (std::size_t i = 0; i < was.size(); ++i)
    if (was[i].second != is[i].second)
      return was[i].first + " was " + was[i].second + " and is " + is[i].second;
  return "the payload of a NaN";  // prints alike, but differs in bits
}

}  // namespace vps::device::log
