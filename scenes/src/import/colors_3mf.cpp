// SPDX-License-Identifier: BSD-3-Clause
#include "import/colors_3mf.h"

#include <algorithm>
#include <charconv>
#include <map>

#ifdef VPS_HAS_MINIZIP
#include <minizip/unzip.h>
#endif

#include "import/readers.h"

namespace vps::scenes::inline v0::import {
namespace {

/// One tag of XML: "<m:color color='#ff0000'/>" has the name "color".
struct Tag {
  std::string_view name;
  std::string_view attributes;
  bool is_end = false;

  [[nodiscard]] std::string_view value(std::string_view key) const {
    for (std::size_t at = attributes.find(key); at != std::string_view::npos;
         at = attributes.find(key, at + 1)) {
      const std::size_t quote = attributes.find_first_not_of(" \t\r\n=", at + key.size());
      const bool is_whole = at == 0 || attributes[at - 1] == ' ' || attributes[at - 1] == '\t' ||
                            attributes[at - 1] == '\n' || attributes[at - 1] == '\r';
      if (!is_whole || quote == std::string_view::npos || quote == at + key.size() ||
          (attributes[quote] != '"' && attributes[quote] != '\''))
        continue;
      const std::size_t end = attributes.find(attributes[quote], quote + 1);
      if (end != std::string_view::npos) return attributes.substr(quote + 1, end - quote - 1);
    }
    return {};
  }
  template <typename T>
  [[nodiscard]] std::optional<T> number(std::string_view key) const {
    const std::string_view text = value(key);
    T out{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    return error == std::errc() ? std::optional(out) : std::nullopt;
  }
};

/// Calls f(tag) for each tag; comments and declarations are none.
template <class F>
void forEachTag(std::string_view xml, F f) {
  for (std::size_t at = xml.find('<'); at != std::string_view::npos; at = xml.find('<', at)) {
    if (xml.substr(at).starts_with("<!--")) {
      at = xml.find("-->", at);
      if (at == std::string_view::npos) return;
      continue;
    }
    const std::size_t end = xml.find('>', at);
    if (end == std::string_view::npos) return;
    std::string_view text = xml.substr(at + 1, end - at - 1);
    at = end;
    Tag tag;
    tag.is_end = text.starts_with('/');
    if (tag.is_end) text.remove_prefix(1);
    const std::size_t stop = std::min(text.find_first_of(" \t\r\n/"), text.size());
    tag.name = text.substr(0, stop);
    if (const std::size_t colon = tag.name.find(':'); colon != std::string_view::npos)
      tag.name.remove_prefix(colon + 1);
    tag.attributes = text.substr(stop);
    f(tag);
  }
}

/// "#RRGGBB" or "#RRGGBBAA".
std::optional<Color> colorOf(std::string_view text) {
  if (text.size() < 7 || text[0] != '#') return std::nullopt;
  Color srgb{};
  for (std::size_t k = 0; k < 3; ++k) {
    int byte = 0;
    const char* from = text.data() + 1 + 2 * k;
    if (std::from_chars(from, from + 2, byte, 16).ptr != from + 2) return std::nullopt;
    srgb[k] = static_cast<float>(byte) / 255;
  }
  return linearFromSrgb(srgb);
}

using Groups = std::map<std::uint32_t, std::vector<Color>>;

std::optional<Color> find(const Groups& groups, std::optional<std::uint32_t> group,
                          std::optional<std::uint32_t> index) {
  if (!group || !index) return std::nullopt;
  const auto found = groups.find(*group);
  if (found == groups.end() || *index >= found->second.size()) return std::nullopt;
  return found->second[*index];
}

/// The mean of the colours that its corners have.
std::optional<Color> colorOf(const Tag& triangle, const Groups& groups,
                             std::optional<std::uint32_t> object_group) {
  const auto own = triangle.number<std::uint32_t>("pid");
  const auto group = own ? own : object_group;
  const std::optional<Color> first = find(groups, group, triangle.number<std::uint32_t>("p1"));
  if (!first) return std::nullopt;
  const Color second = find(groups, group, triangle.number<std::uint32_t>("p2")).value_or(*first),
              third = find(groups, group, triangle.number<std::uint32_t>("p3")).value_or(*first);
  if (second == *first && third == *first) return first;
  Color mean{};
  for (std::size_t k = 0; k < 3; ++k) mean[k] = ((*first)[k] + second[k] + third[k]) / 3;
  return mean;
}

}  // namespace

bool Mesh3mf::hasColors() const {
  return std::ranges::any_of(colors, [](const auto& color) { return color.has_value(); });
}

std::vector<Mesh3mf> meshes3mf(std::string_view model) {
  std::vector<Mesh3mf> meshes;
  Groups groups;
  std::vector<Color>* group = nullptr;
  std::optional<std::uint32_t> object_group;
  std::optional<Color> object_color;
  forEachTag(model, [&](const Tag& tag) {
    if (tag.is_end) return;
    if (tag.name == "basematerials" || tag.name == "colorgroup") {
      group = &groups[tag.number<std::uint32_t>("id").value_or(0)];
    } else if ((tag.name == "base" || tag.name == "color") && group != nullptr) {
      group->push_back(
          colorOf(tag.value(tag.name == "base" ? "displaycolor" : "color")).value_or(ImportedPart().color));
    } else if (tag.name == "object") {
      object_group = tag.number<std::uint32_t>("pid");
      object_color = find(groups, object_group, tag.number<std::uint32_t>("pindex"));
    } else if (tag.name == "mesh") {
      meshes.emplace_back();
    } else if (tag.name == "vertex" && !meshes.empty()) {
      meshes.back().vertices.emplace_back(tag.number<float>("x").value_or(0),
                                          tag.number<float>("y").value_or(0),
                                          tag.number<float>("z").value_or(0));
    } else if (tag.name == "triangle" && !meshes.empty()) {
      meshes.back().triangles.push_back({tag.number<std::uint32_t>("v1").value_or(0),
                                         tag.number<std::uint32_t>("v2").value_or(0),
                                         tag.number<std::uint32_t>("v3").value_or(0)});
      const std::optional<Color> own = colorOf(tag, groups, object_group);
      meshes.back().colors.push_back(own ? own : object_color);
    }
  });
  return meshes;
}

std::string model3mf(const std::string& file) {
  std::string text;
#ifdef VPS_HAS_MINIZIP
  unzFile archive = unzOpen(file.c_str());
  if (archive == nullptr) return text;
  constexpr int kAnyCase = 2;
  if (unzLocateFile(archive, "3D/3dmodel.model", kAnyCase) == UNZ_OK &&
      unzOpenCurrentFile(archive) == UNZ_OK) {
    constexpr std::size_t kMost_bytes = 1'000'000'000;  // assumed: a file that unpacks to more is damaged
    std::array<char, 65536> buffer;
    int count = 0;
    while (text.size() <= kMost_bytes &&
           (count = unzReadCurrentFile(archive, buffer.data(), buffer.size())) > 0)
      text.append(buffer.data(), static_cast<std::size_t>(count));
    const bool is_whole = unzCloseCurrentFile(archive) == UNZ_OK && count >= 0;  // its checksum is right
    if (!is_whole || text.size() > kMost_bytes) text = {};
  }
  unzClose(archive);
#else
  static_cast<void>(file);
#endif
  return text;
}

}  // namespace vps::scenes::inline v0::import
