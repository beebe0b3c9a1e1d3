// SPDX-License-Identifier: BSD-3-Clause
#include "assimp/mesh_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include "import/readers.h"
#include "vps/box.h"

namespace vps::scenes::import {

namespace {

constexpr std::string_view kWord = "vps_object_";
constexpr std::string_view kBlank = " \t\r\f\v";

/// The bytes of a file without its byte order mark, which assimp would take for a part of the first word.
std::string bytesOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(in), {});
  if (bytes.starts_with(kByteOrderMark)) bytes.erase(0, kByteOrderMark.size());
  return bytes;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t from = text.find_first_not_of(kBlank);
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(kBlank) - from + 1);
}

/// The rest of a line after its keyword; empty if the line has another keyword.
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

/// Appends a line with a zero before each decimal point that begins a number, as in ".5" and "-.5":
/// assimp 5.2.5 does not count such numbers, and skips the vertex.
void appendWithZeros(std::string_view line, std::string& out) {
  for (std::size_t point = line.find('.'); point != std::string_view::npos; point = line.find('.')) {
    const bool has_digit = point > 0 && line[point - 1] >= '0' && line[point - 1] <= '9';
    out.append(line.substr(0, point)).append(has_digit ? "." : "0.");
    line.remove_prefix(point + 1);
  }
  out += line;
}

/// The keyword of a line.
std::string_view keywordOf(std::string_view line) {
  const std::string_view text = trimmed(line);
  return text.substr(0, text.find_first_of(kBlank));
}

/// Whether a line with this keyword has numbers alone, so that a '#' in it begins a comment.
bool hasNumbersAlone(std::string_view keyword) {
  constexpr std::array<std::string_view, 6> kNumbers = {"v", "vn", "vt", "f", "l", "p"};
  return std::ranges::find(kNumbers, keyword) != kNumbers.end();
}

/// The text of an OBJ file without comments behind numbers, which assimp 5.2.5 takes for more numbers.
std::string withoutCommentsBehindNumbers(std::string bytes) {
  for (std::size_t at = bytes.find('#'); at != std::string::npos; at = bytes.find('#', at)) {
    const std::size_t before = bytes.find_last_of("\r\n", at),
                      from = before == std::string::npos ? 0 : before + 1;
    const std::size_t end = std::min(bytes.find_first_of("\r\n", at), bytes.size());
    if (hasNumbersAlone(keywordOf(std::string_view(bytes).substr(from, at - from))))
      std::fill(bytes.begin() + std::ptrdiff_t(at), bytes.begin() + std::ptrdiff_t(end), ' ');
    at = end;
  }
  return bytes;
}

/// The text of an STL file with its keywords in small letters, as assimp 5.2.5 needs them, and without blanks
/// before the first one. Names of solids keep their letters.
std::string withSmallKeywords(std::string bytes) {
  bytes.erase(0, std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
  if (bytes.starts_with("solid") && bytes.find("facet") != std::string::npos) return bytes;
  std::size_t at = 0;
  while (at < bytes.size()) {
    const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
    const std::string_view keyword = keywordOf(std::string_view(bytes).substr(at, end - at));
    const bool is_named = keyword == "SOLID" || keyword == "solid" || keyword == "Solid" ||
                          keyword == "ENDSOLID" || keyword == "endsolid" || keyword == "EndSolid";
    const std::size_t last = is_named ? std::size_t(keyword.data() - bytes.data()) + keyword.size() : end;
    std::transform(bytes.begin() + std::ptrdiff_t(at), bytes.begin() + std::ptrdiff_t(last),
                   bytes.begin() + std::ptrdiff_t(at), [](unsigned char c) { return char(std::tolower(c)); });
    at = end + 1;
  }
  return bytes;
}

/// Whether assimp 5.2.5 would misread the line as a face, line or point because of its first letter, as with
/// "lod" and "parm".
bool isTakenForElement(std::string_view keyword) {
  constexpr std::array<std::string_view, 4> kElements = {"f", "fo", "l", "p"};
  return !keyword.empty() && std::string_view("flp").find(keyword.front()) != std::string_view::npos &&
         std::ranges::find(kElements, keyword) == kElements.end();
}

template <class F>
void forEachLine(std::string_view bytes, F f) {
  while (!bytes.empty()) {
    const std::size_t end = std::min(bytes.find('\n'), bytes.size() - 1);
    f(bytes.substr(0, end + 1));
    bytes.remove_prefix(end + 1);
  }
}

/// The centre of the vertices, if they are so far from the origin in proportion to their extent that the
/// shift gains at least two of the 24 bits of a float. The shift is zero otherwise, and if a vertex cannot be
/// read, has a weight, or continues on the next line.
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

/// Writes the vertices minus the shift, and all other lines as f(line, out) writes them.
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

/// The '"' that ends a string of JSON which begins before `at`; the text's size if it is cut.
std::size_t endOfString(std::string_view json, std::size_t at) {
  while ((at = json.find_first_of("\"\\", at)) != std::string_view::npos && json[at] == '\\') at += 2;
  return std::min(at, json.size());
}

}  // namespace

std::string MeshText::nameIn(const std::string& word) const {
  if (!word.starts_with(kWord)) return word;
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(word.data() + kWord.size(), word.data() + word.size(), number);
  return error == std::errc() && number < names.size() ? names[number] : word;
}

MeshText objText(const std::string& file) {
  std::string group;  // the active group; assimp begins no new object where the group is named again
  std::size_t group_word = 0;
  bool is_continued = false,
       is_dropped = false;  // the line before ends in '\\'; the line before was left out
  return rewritten(
      withoutCommentsBehindNumbers(bytesOf(file)), "v", [&](std::string_view line, MeshText& out) {
        const std::string_view text = line.substr(0, line.find('\n'));
        if (std::exchange(is_continued, trimmed(text).ends_with('\\'))) {
          if (!is_dropped) out.bytes += line;  // a blank that begins the line separates two numbers
          return;
        }
        const std::string_view keyword = keywordOf(text);
        out.surface_count += keyword == "surf" ? 1 : 0;
        is_dropped = isTakenForElement(keyword);
        if (is_dropped) return;
        const auto object = afterKeyword(text, "o"), faces = afterKeyword(text, "g");
        const bool is_one_line = text.find('\r') >= text.size() - 1;  // otherwise lines end in '\r' alone
        if ((!object && !faces) || !is_one_line) {
          // assimp skips a line that begins with a blank.
          const std::string_view rest = line.substr(std::min(line.find_first_not_of(" \t"), line.size()));
          if (keyword == "vt" && trimmed(rest.substr(2)).find_first_of(kBlank) == std::string_view::npos &&
              is_one_line) {
            out.bytes.append(trimmed(text))
                .append(" 0\n");  // assimp needs two numbers; OBJ asks for one to three
            return;
          }
          if (rest.starts_with('v')) return appendWithZeros(rest, out.bytes);
          out.bytes += rest;
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
  std::array<char, 256> first{};
  std::ifstream in(file, std::ios::binary);
  in.read(first.data(), first.size());
  std::string head(withoutByteOrderMark({first.data(), static_cast<std::size_t>(in.gcount())}));
  head.erase(0, std::min(head.find_first_not_of(" \t\r\n"), head.size()));
  if (!std::ranges::equal(head.substr(0, kSolid.size()), kSolid, {},
                          [](unsigned char c) { return std::tolower(c); }))
    return std::nullopt;
  const std::string bytes = bytesOf(file);
  // A binary STL file may begin with the word "solid" as well.
  if (bytes.find('\0') != std::string::npos) return std::nullopt;
  constexpr std::size_t kLongestName = 500;  // assimp 5.2.5 refuses names of 1024 bytes
  return rewritten(withSmallKeywords(bytes), "vertex", [](std::string_view line, MeshText& out) {
    out.bytes += line.substr(0, kLongestName);
    if (line.size() > kLongestName) out.bytes += '\n';
  });
}

std::vector<std::string> requiredExtensions(std::string_view json) {
  constexpr std::string_view kKey = "extensionsRequired";
  std::vector<std::string> names;
  bool is_key_last = false, is_in_list = false;  // the last string is kKey; the list of kKey is open
  std::size_t depth = 0;
  for (std::size_t at = 0; (at = json.find_first_of("\"{}[]", at)) < json.size(); ++at) {
    const char c = json[at];
    if (c == '"') {
      const std::size_t from = at + 1;
      at = endOfString(json, from);
      const std::string_view text = json.substr(from, at - from);
      if (is_in_list) names.emplace_back(text);
      is_key_last = depth == 1 && text == kKey;
    } else if (c == '{' || c == '[') {
      is_in_list = is_key_last && c == '[';
      is_key_last = false;
      ++depth;
    } else {
      is_in_list = false;
      depth -= depth > 0 ? 1 : 0;
    }
  }
  return names;
}

void hideOtherExtras(std::string& json, std::size_t from) {
  constexpr std::string_view kKey = "\"extras\"";
  for (std::size_t at = json.find(kKey, from); at != std::string::npos; at = json.find(kKey, at + 1)) {
    const std::size_t colon = json.find_first_not_of(" \t\r\n", at + kKey.size());
    if (colon == std::string::npos || json[colon] != ':') continue;
    const std::size_t value = json.find_first_not_of(" \t\r\n", colon + 1);
    if (value != std::string::npos && json[value] != '{') json[at + 1] = '_';
  }
}

std::string percentDecoded(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size(); ++at) {
    unsigned char byte = 0;
    const char *const from = text.data() + at + 1, *const end = text.data() + std::min(at + 3, text.size());
    if (text[at] == '%' && end - from == 2 && std::from_chars(from, end, byte, 16).ptr == end) {
      out += static_cast<char>(byte);
      at += 2;
    } else {
      out += text[at];
    }
  }
  return out;
}

std::string unreadExtension(const std::vector<std::string>& names) {
  constexpr std::array<std::string_view, 6> kNoGeometry = {"_materials_", "_texture_",   "_lights_",
                                                           "_xmp",        "_animation_", "_image_"};
  const auto found = std::ranges::find_if(names, [&](const std::string& name) {
    return name != "KHR_draco_mesh_compression" &&
           std::ranges::none_of(kNoGeometry,
                                [&](std::string_view word) { return name.find(word) != std::string::npos; });
  });
  return found == names.end() ? "" : *found;
}

}  // namespace vps::scenes::import
