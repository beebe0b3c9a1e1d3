// SPDX-License-Identifier: BSD-3-Clause
#include "import/mesh_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include "vps/box.h"

namespace vps::scenes::inline v0::import {

namespace {

constexpr std::string_view kWord = "vps_object_";
constexpr std::string_view kBlank = " \t\r\f\v";

std::string bytesOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string_view trimmed(std::string_view text) {
  const std::size_t from = text.find_first_not_of(kBlank);
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(kBlank) - from + 1);
}

/// What follows the keyword of a line; empty optional: the line has another keyword.
std::optional<std::string_view> afterKeyword(std::string_view line, std::string_view keyword) {
  const std::size_t from = line.find_first_not_of(kBlank);
  if (from == std::string_view::npos || !line.substr(from).starts_with(keyword)) return std::nullopt;
  const std::string_view rest = line.substr(from + keyword.size());
  if (!rest.empty() && kBlank.find(rest.front()) == std::string_view::npos) return std::nullopt;
  return rest;
}

/// Three numbers, and the text after them.
struct Vertex {
  Vec3 p = Vec3::Zero();
  std::string_view rest;
};
std::optional<Vertex> vertexOf(std::string_view text) {
  Vertex out;
  for (int axis = 0; axis < 3; ++axis) {
    text.remove_prefix(std::min(text.find_first_not_of(kBlank), text.size()));
    const bool has_plus = text.starts_with('+');
    const char *from = text.data() + has_plus, *end = text.data() + text.size();
    const auto [next, error] = std::from_chars(from, end, out.p[axis]);
    if (error != std::errc()) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(next - text.data()));
  }
  out.rest = text;
  return out;
}

template <class F>
void forEachLine(std::string_view bytes, F f) {
  while (!bytes.empty()) {
    const std::size_t end = std::min(bytes.find('\n'), bytes.size() - 1);
    f(bytes.substr(0, end + 1));
    bytes.remove_prefix(end + 1);
  }
}

/// The middle of the vertices, where they are far from the origin beside their size, so that at least two of
/// the 24 bits of a float are won; else zero. Zero too where a vertex cannot be read, or has a weight, or
/// goes on in the next line.
Vec3 shiftOf(std::string_view bytes, std::string_view keyword) {
  constexpr double kFar = 4;
  Box box;
  bool is_plain = true;
  forEachLine(bytes, [&](std::string_view line) {
    const auto numbers = afterKeyword(line.substr(0, line.find('\n')), keyword);
    if (!numbers) return;
    const std::optional<Vertex> vertex = vertexOf(*numbers);
    const std::string_view rest = vertex ? trimmed(vertex->rest) : "";
    is_plain = is_plain && vertex && vertex->p.allFinite() &&
               (rest.empty() || (rest.find(' ') != std::string_view::npos && rest.back() != '\\'));
    if (is_plain) box.add(vertex->p);
  });
  if (!is_plain || box.isEmpty()) return Vec3::Zero();
  const double farthest = box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
  return farthest > kFar * box.size().norm() ? Vec3(box.center()) : Vec3::Zero();
}

void appendVertex(std::string_view keyword, const Vertex& vertex, const Vec3& shift, std::string& out) {
  out += keyword;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<char, 32> number;
    const auto [end, error] =
        std::to_chars(number.data(), number.data() + number.size(), vertex.p[axis] - shift[axis]);
    out += ' ';
    out.append(number.data(), end);
  }
  out += vertex.rest;
}

/// Writes the vertices without the shift, and all other lines as f gives them.
template <class F>
MeshText rewritten(const std::string& bytes, std::string_view keyword, F f) {
  MeshText out;
  out.shift = shiftOf(bytes, keyword);
  out.bytes.reserve(bytes.size() + bytes.size() / 8);
  const bool is_shifted = !out.shift.isZero(0);
  forEachLine(bytes, [&](std::string_view line) {
    const auto numbers = is_shifted ? afterKeyword(line, keyword) : std::nullopt;
    if (!numbers) return f(line, out);
    appendVertex(keyword, *vertexOf(*numbers), out.shift, out.bytes);
  });
  return out;
}

}  // namespace

std::string MeshText::nameIn(const std::string& word) const {
  if (!word.starts_with(kWord)) return word;
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(word.data() + kWord.size(), word.data() + word.size(), number);
  return error == std::errc() && number < names.size() ? names[number] : word;
}

MeshText objText(const std::string& file) {
  std::string group;  // that is active; assimp begins no new object where it is named again
  std::size_t group_word = 0;
  bool is_continued = false;  // the line before ends in '\\'
  return rewritten(bytesOf(file), "v", [&](std::string_view line, MeshText& out) {
    const std::string_view text = line.substr(0, line.find('\n'));
    if (std::exchange(is_continued, trimmed(text).ends_with('\\'))) {
      out.bytes += line;  // a blank at its beginning parts two numbers
      return;
    }
    const auto object = afterKeyword(text, "o"), faces = afterKeyword(text, "g");
    const bool is_one_line = text.find('\r') >= text.size() - 1;  // else line ends are '\r' alone
    if ((!object && !faces) || !is_one_line) {
      // assimp skips a line that begins with a blank.
      out.bytes += line.substr(std::min(line.find_first_not_of(" \t"), line.size()));
      return;
    }
    const std::string name(trimmed(object ? *object : *faces));
    const bool is_known = faces && name == group && !out.names.empty() && group_word < out.names.size() &&
                          out.names[group_word] == name;
    const std::size_t word = is_known ? group_word : out.names.size();
    if (!is_known) out.names.push_back(name);
    if (faces) {
      group = name;
      group_word = word;
    }
    out.bytes += std::string(object ? "o " : "g ").append(kWord) + std::to_string(word) + "\n";
  });
}

std::optional<MeshText> stlText(const std::string& file) {
  constexpr std::string_view kSolid = "solid";
  std::array<char, kSolid.size()> first{};
  std::ifstream in(file, std::ios::binary);
  if (!in.read(first.data(), first.size()) || std::string_view(first.data(), first.size()) != kSolid)
    return std::nullopt;
  const std::string bytes = bytesOf(file);
  // A binary file may begin with the same word.
  if (bytes.find('\0') != std::string::npos) return std::nullopt;
  return rewritten(bytes, "vertex", [](std::string_view line, MeshText& out) { out.bytes += line; });
}

}  // namespace vps::scenes::inline v0::import
