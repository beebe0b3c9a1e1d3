// SPDX-License-Identifier: BSD-3-Clause
// Pointshells as PLY files (Turk 1994). Numbers are little-endian doubles, so that a shell is read back to
// the bit.
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <string>
#include <string_view>

#include "pointshell/shell_hierarchy.h"
#include "vps/errors.h"
#include "vps/pointshell.h"
#include "vps/write_file.h"

namespace vps {
namespace {

static_assert(std::endian::native == std::endian::little,
              "binary PLY is written and read as it lies in memory");

/// The properties of a point that files must have, in the order in which they are written.
constexpr std::array<std::string_view, 7> kNames = {"x", "y", "z", "nx", "ny", "nz", "area"};
using Row = std::array<double, kNames.size()>;
/// Comments that savePly() adds: the shell's spacing, and that the points are in the hierarchy's order.
constexpr std::string_view kSpacing = "comment vps spacing_m ", kSorted = "comment vps sorted";

enum class Type { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float, Double };

struct TypeName {
  std::string_view name;
  Type type;
  std::size_t bytes;
};
constexpr std::array<TypeName, 16> kTypes = {{
    {"char", Type::Int8, 1},
    {"int8", Type::Int8, 1},
    {"uchar", Type::Uint8, 1},
    {"uint8", Type::Uint8, 1},
    {"short", Type::Int16, 2},
    {"int16", Type::Int16, 2},
    {"ushort", Type::Uint16, 2},
    {"uint16", Type::Uint16, 2},
    {"int", Type::Int32, 4},
    {"int32", Type::Int32, 4},
    {"uint", Type::Uint32, 4},
    {"uint32", Type::Uint32, 4},
    {"float", Type::Float, 4},
    {"float32", Type::Float, 4},
    {"double", Type::Double, 8},
    {"float64", Type::Double, 8},
}};

struct Property {
  TypeName type;
  int column = -1;  ///< in a Row; -1: the property is not needed
};

struct Header {
  bool is_binary = false, is_sorted = false;
  std::size_t count = 0;
  std::vector<Property> properties;
  bool is_more_after = false;  ///< other elements follow the points
  double spacing_m = 0;
};

template <class T>
double as(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

double valueOf(Type type, const char* bytes) {
  switch (type) {
    case Type::Int8:
      return as<std::int8_t>(bytes);
    case Type::Uint8:
      return as<std::uint8_t>(bytes);
    case Type::Int16:
      return as<std::int16_t>(bytes);
    case Type::Uint16:
      return as<std::uint16_t>(bytes);
    case Type::Int32:
      return as<std::int32_t>(bytes);
    case Type::Uint32:
      return as<std::uint32_t>(bytes);
    case Type::Float:
      return as<float>(bytes);
    case Type::Double:
      return as<double>(bytes);
  }
  return 0;
}

class PlyReader {
 public:
  PlyReader(std::string_view content, const std::string& file) : rest_(content), file_(file) {}

  PointShell read() {
    readHeader();
    PointShell shell;
    shell.points.reserve(header_.count);
    shell.inward.reserve(header_.count);
    shell.area_m2.reserve(header_.count);
    double total_m2 = 0;
    for (std::size_t i = 0; i < header_.count; ++i) {
      const Row row = header_.is_binary ? binaryRow() : asciiRow(i);
      requireRow(row, i);
      shell.points.emplace_back(row[0], row[1], row[2]);
      shell.inward.push_back(unit({row[3], row[4], row[5]}));
      shell.area_m2.push_back(row[6]);
      total_m2 += row[6];
    }
    if (!header_.is_more_after && rest_.find_first_not_of(" \r\n") != std::string_view::npos)
      fail("the file has bytes after its last point; write it again");
    shell.spacing_m =
        header_.spacing_m > 0 ? header_.spacing_m : std::sqrt(total_m2 / static_cast<double>(header_.count));
    return shell;
  }

  [[nodiscard]] bool isSorted() const { return header_.is_sorted; }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw LoadError(file_, "", what); }

  /// The next line without its end. A line without an end means that the file is cut.
  std::string_view line() {
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos) fail("the file ends early, before its last point; write it again");
    std::string_view text = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    if (text.ends_with('\r')) text.remove_suffix(1);
    return text;
  }

  void readHeader() {
    if (line() != "ply") fail("the file is not a PLY file");
    bool has_format = false, is_in_vertex = false, has_vertex = false;
    for (std::string_view text = line(); text != "end_header"; text = line()) {
      std::istringstream words{std::string(text)};
      std::string word;
      words >> word;
      if (text.starts_with(kSpacing)) {
        header_.spacing_m = number(text.substr(kSpacing.size()));
      } else if (text == kSorted) {
        header_.is_sorted = true;
      } else if (word == "format") {
        readFormat(words);
        has_format = true;
      } else if (word == "element") {
        words >> word;
        if (word == "vertex" && has_vertex) fail("the file has two elements 'vertex'");
        if (word != "vertex" && !has_vertex)
          fail("the file must begin with the element 'vertex', not '" + word + "'");
        is_in_vertex = word == "vertex";
        header_.is_more_after = !is_in_vertex;
        if (is_in_vertex && !(words >> header_.count)) fail("the file does not state its number of points");
        has_vertex = true;
      } else if (word == "property" && is_in_vertex) {
        readProperty(words);
      }  // comments and other elements are ignored
    }
    if (!has_format) fail("the file does not state its format");
    if (header_.count == 0) fail("the file has no points");
    requireColumns();
    requireSize();
  }

  void readFormat(std::istream& words) {
    std::string format;
    words >> format;
    if (format != "ascii" && format != "binary_little_endian")
      fail("the file has format '" + format + "'; export it as ascii or binary_little_endian");
    header_.is_binary = format != "ascii";
  }

  void readProperty(std::istream& words) {
    std::string type, name;
    words >> type >> name;
    for (const TypeName& known : kTypes) {
      if (known.name != type) continue;
      Property property{known, -1};
      for (std::size_t c = 0; c < kNames.size(); ++c)
        if (kNames[c] == name) property.column = static_cast<int>(c);
      header_.properties.push_back(property);
      row_bytes_ += known.bytes;
      return;
    }
    fail("property '" + name + "' of a point has type '" + type + "', which is not a type of number");
  }

  void requireColumns() const {
    for (std::size_t c = 0; c < kNames.size(); ++c) {
      int times = 0;
      for (const Property& property : header_.properties) times += property.column == static_cast<int>(c);
      if (times != 1)
        fail("the file has property '" + std::string(kNames[c]) + "' " + std::to_string(times) +
             " times instead of once; a pointshell needs x y z nx ny nz area");
    }
  }

  /// The size is checked before memory is allocated, because the count in a damaged file can be any number.
  void requireSize() const {
    const std::size_t least_bytes = header_.is_binary ? row_bytes_ : 2 * header_.properties.size();
    if (header_.count > rest_.size() / least_bytes)
      fail("the file states " + std::to_string(header_.count) + " points but ends early; write it again");
    if (header_.count > std::numeric_limits<std::uint32_t>::max())
      fail("the file has more points than can be numbered with 32 bits");
  }

  Row binaryRow() {
    Row row{};
    for (const Property& property : header_.properties) {
      if (property.column >= 0)
        row[static_cast<std::size_t>(property.column)] = valueOf(property.type.type, rest_.data());
      rest_.remove_prefix(property.type.bytes);
    }
    return row;
  }

  Row asciiRow(std::size_t point) {
    Row row{};
    std::string_view text = line();
    for (const Property& property : header_.properties) {
      const std::size_t start = std::min(text.find_first_not_of(" \t"), text.size());
      const std::size_t end = std::min(text.find_first_of(" \t", start), text.size());
      if (start == end) fail("point " + std::to_string(point) + " has too few numbers");
      const double value = number(text.substr(start, end - start));
      if (property.column >= 0) row[static_cast<std::size_t>(property.column)] = value;
      text.remove_prefix(end);
    }
    if (text.find_first_not_of(" \t") != std::string_view::npos)
      fail("point " + std::to_string(point) + " has too many numbers");
    return row;
  }

  [[nodiscard]] double number(std::string_view text) const {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
      fail("the file holds a word that is not a number: " + std::string(text.substr(0, 40)));
    return value;
  }

  void requireRow(const Row& row, std::size_t point) const {
    const auto where = [point] { return "point " + std::to_string(point); };
    for (const double value : row)
      if (!std::isfinite(value)) fail(where() + " is not finite");
    if (row[6] < 0) fail(where() + " has a negative area");
    const double length = Vec3(row[3], row[4], row[5]).norm();
    if (std::abs(length - 1) > 1e-3)
      fail(where() + " has a normal of length " + std::to_string(length) + ", not 1");
  }

  /// Keeps the bits of a normal that has unit length up to rounding; normalises a normal that was written
  /// with few digits.
  static Vec3 unit(const Vec3& n) { return std::abs(n.squaredNorm() - 1) < 1e-14 ? n : n.normalized(); }

  std::string_view rest_;
  const std::string& file_;
  Header header_;
  std::size_t row_bytes_ = 0;
};

void sortPoints(PointShell& shell) {
  const PointShell unsorted = shell;
  const std::vector<std::uint32_t> order = sortedOrder(unsorted.points);
  for (std::size_t i = 0; i < order.size(); ++i) {
    shell.points[i] = unsorted.points[order[i]];
    shell.inward[i] = unsorted.inward[order[i]];
    shell.area_m2[i] = unsorted.area_m2[order[i]];
  }
}

}  // namespace

void savePly(const PointShell& shell, const std::string& file) {
  std::array<char, 32> spacing{};  // the shortest text that reads back to the same double
  std::to_chars(spacing.data(), spacing.data() + spacing.size() - 1, shell.spacing_m);
  std::string content = "ply\nformat binary_little_endian 1.0\n";
  content += std::string(kSpacing) + spacing.data() + "\n" + std::string(kSorted) + "\n";
  content += "element vertex " + std::to_string(shell.size()) + "\n";
  for (const std::string_view name : kNames) content += "property double " + std::string(name) + "\n";
  content += "end_header\n";
  for (std::size_t i = 0; i < shell.size(); ++i) {
    const Vec3 &p = shell.points[i], &n = shell.inward[i];
    const Row row = {p.x(), p.y(), p.z(), n.x(), n.y(), n.z(), shell.area_m2[i]};
    content.append(reinterpret_cast<const char*>(row.data()), sizeof row);
  }

  writeWholeFile(file, content);
}

PointShell loadPly(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw LoadError(file, "", "the file cannot be opened; check the name");
  const std::string content{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (in.bad()) throw LoadError(file, "", "the file cannot be read");
  PlyReader reader(content, file);
  PointShell shell = reader.read();
  if (!reader.isSorted()) sortPoints(shell);
  shell.nodes = sphereHierarchy(shell.points);
  layOutBlocks(shell);
  shell.order = progressiveOrder(shell.points);
  return shell;
}

}  // namespace vps
