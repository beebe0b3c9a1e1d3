// SPDX-License-Identifier: BSD-3-Clause
#include "boundaries/include_graph.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string_view>

namespace vps::boundaries {

namespace fs = std::filesystem;

namespace {

bool isSource(const fs::path& path) {
  const fs::path kind = path.extension();
  return kind == ".h" || kind == ".cpp" || kind == ".inc";
}

bool startsWithAny(std::string_view text, const std::vector<std::string>& starts) {
  return std::ranges::any_of(starts, [&](const std::string& start) { return text.starts_with(start); });
}

std::string describe(const Include& include) {
  return include.file + ":" + std::to_string(include.line) + " includes " + include.target;
}

/// Headers that only some files may include.
struct Rule {
  std::string why;
  std::vector<std::string> headers;  ///< beginnings of the include's target
  std::vector<std::string> allowed;  ///< beginnings of the paths of files that may include these headers
};

std::vector<Rule> rules() {
  return {
      {"plugin is below all other folders; only device, bridge, scenes and viewer use each other's headers",
       {"vps_bullet/"},
       {"bullet_bridge/", "scenes/", "viewer/", "device/examples/"}},
      {"bullet_bridge and device do not know each other", {"vps_device/"}, {"device/", "scenes/", "viewer/"}},
      {"scenes is above plugin, bullet_bridge and device",
       {"vps_scenes/"},
       {"scenes/", "viewer/", "bullet_bridge/examples/"}},
      {"viewer is above all other folders", {"vps_viewer/"}, {"viewer/"}},
      {"Bullet is used in bullet_bridge and in the simulation only",
       {"bt", "Bullet", "LinearMath"},
       {"bullet_bridge/", "scenes/run/src/simulation/", "device/examples/"}},
      {"OpenGL is used in viewer only", {"epoxy/", "EGL/", "GL/"}, {"viewer/"}},
      {"window libraries are used in the window only",
       {"GLFW/", "imgui", "backends/imgui"},
       {"viewer/window/src/glfw/"}},
      {"OpenXR and Xlib are used in the headset only", {"openxr/", "X11/"}, {"viewer/window/src/openxr/"}},
      {"Boost.Beast is used in the web server only",
       {"boost/beast", "boost/asio"},
       {"viewer/web/src/beast/"}},
      {"OpenVDB is used in the .vdb reader and writer only", {"openvdb/", "nanovdb/"}, {"plugin/src/vdb/"}},
      {"libspnav and SDL are used in their drivers only", {"spnav", "SDL"}, {"device/src/drivers/"}},
      {"Cyclone DDS is used in the link over UDP only", {"dds/"}, {"scenes/network/src/dds/"}},
      {"CAD libraries are used in the importers only",
       {"assimp/", "Inventor/", "TopoDS", "STEPCAF", "IGESCAF", "XCAFDoc"},
       {"scenes/cad/src/", "scenes/bearing_block/generate.cpp"}},
  };
}

/// Groups of public headers that have neither a source of their own name nor a sub-folder.
const std::map<std::string, std::string>& groupOfHeader() {
  static const std::map<std::string, std::string> groups = {{"vps/box.h", "core"},
                                                            {"vps_device/coupling_port.h", "loop"},
                                                            {"vps_device/detail/entry_ring.h", "recording"}};
  return groups;
}

/// The groups of one folder, and which group each header that other files may name belongs to.
class Groups {
 public:
  Groups(const fs::path& root, const std::string& folder) {
    std::vector<Place> headers;
    std::map<std::string, std::string> group_of_noun;  // by the source's folder and name
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
      if (!entry.is_regular_file() || !isSource(entry.path())) continue;
      const std::optional<Place> place = placeOf(root / folder, entry.path());
      if (!place) continue;
      if (place->is_public) {
        headers.push_back(*place);
        continue;
      }
      if (place->group.empty()) continue;
      add(root, *place, place->wing + place->group);
      if (entry.path().extension() == ".cpp")
        group_of_noun[place->wing + entry.path().stem().string()] = place->wing + place->group;
      names_.insert(place->wing + place->group);
    }
    for (const Place& place : headers) {
      const auto noun = group_of_noun.find(place.wing + place.file.stem().string());
      const auto named = groupOfHeader().find(place.target);
      std::string group = place.target;
      if (names_.contains(place.wing + place.group))
        group = place.wing + place.group;
      else if (noun != group_of_noun.end())
        group = noun->second;
      else if (named != groupOfHeader().end())
        group = named->second;
      add(root, place, group);
    }
  }

  [[nodiscard]] std::optional<std::string> ofFile(const std::string& file) const {
    return find(of_file_, file);
  }
  [[nodiscard]] std::optional<std::string> ofTarget(const std::string& target) const {
    return find(of_target_, target);
  }

 private:
  /// The place of a file in its folder: <wing>/src/<group>/, <wing>/include/<namespace>/<group>/, each with
  /// or without a wing, or in the program's folder cli/<group>/.
  struct Place {
    fs::path file;
    std::string wing;    ///< "fits/"; empty in a folder without wings
    std::string group;   ///< empty where the file lies in no group
    std::string target;  ///< as an include names it
    bool is_public = false;
  };
  static std::optional<Place> placeOf(const fs::path& folder, const fs::path& file) {
    std::vector<std::string> parts;
    for (const fs::path& part : fs::relative(file, folder)) parts.push_back(part.string());
    const auto root_at = std::ranges::find_if(
        parts, [](const std::string& part) { return part == "src" || part == "include" || part == "cli"; });
    const auto depth = static_cast<std::size_t>(root_at - parts.begin());
    if (depth > 1 || depth + 1 >= parts.size()) return std::nullopt;
    Place place;
    place.file = file;
    place.is_public = parts[depth] == "include";
    if (depth == 1 || parts[0] == "cli") place.wing = parts[0] + "/";
    // A public header's first folder is the namespace, and its second the wing.
    const std::size_t above = depth + (place.is_public ? 2 + depth : 1);
    if (above + 1 < parts.size()) place.group = parts[above];
    for (std::size_t i = depth + 1; i < parts.size(); ++i)
      place.target += (place.target.empty() ? "" : "/") + parts[i];
    return place;
  }
  void add(const fs::path& root, const Place& place, const std::string& group) {
    of_target_[place.target] = group;
    of_file_[fs::relative(place.file, root).generic_string()] = group;
  }
  static std::optional<std::string> find(const std::map<std::string, std::string>& map,
                                         const std::string& key) {
    const auto found = map.find(key);
    if (found == map.end()) return std::nullopt;
    return found->second;
  }

  std::set<std::string> names_;
  std::map<std::string, std::string> of_target_, of_file_;
};

/// Dependencies from group to group, each with one include that causes it.
using Arrows = std::map<std::string, std::map<std::string, Include>>;

/// Depth-first search for circles; each is reported once, from the first of its groups that the search
/// visits.
class CircleSearch {
 public:
  explicit CircleSearch(const Arrows& arrows) : arrows_(arrows) {}

  std::vector<std::string> run() {
    for (const auto& [group, targets] : arrows_) visit(group);
    return messages_;
  }

 private:
  void visit(const std::string& group) {
    const auto on_path = std::ranges::find(path_, group);
    if (on_path != path_.end()) return report(on_path);
    if (!visited_.insert(group).second) return;
    path_.push_back(group);
    if (const auto found = arrows_.find(group); found != arrows_.end())
      for (const auto& [target, include] : found->second) visit(target);
    path_.pop_back();
  }

  void report(std::vector<std::string>::const_iterator first) {
    std::string names, lines;
    for (auto at = first; at != path_.end(); ++at) {
      const std::string& next = at + 1 == path_.end() ? *first : *(at + 1);
      names += *at + " -> ";
      lines += "\n  " + describe(arrows_.at(*at).at(next));
    }
    messages_.push_back("groups include each other in a circle: " + names + *first + lines);
  }

  const Arrows& arrows_;
  std::vector<std::string> path_, messages_;
  std::set<std::string> visited_;
};

}  // namespace

std::vector<Include> includesBelow(const fs::path& root, const std::string& folder) {
  std::vector<Include> includes;
  if (!fs::exists(root / folder)) return includes;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
    if (!entry.is_regular_file() || !isSource(entry.path())) continue;
    const std::string file = fs::relative(entry.path(), root).generic_string();
    std::ifstream stream(entry.path());
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
      const std::size_t hash = line.find_first_not_of(" \t");
      if (hash == std::string::npos || line[hash] != '#') continue;
      const std::size_t word = line.find_first_not_of(" \t", hash + 1);
      if (word == std::string::npos || line.compare(word, 7, "include") != 0) continue;
      const std::size_t open = line.find_first_of("\"<", word + 7);
      if (open == std::string::npos) continue;
      const std::size_t close = line.find_first_of("\">", open + 1);
      if (close == std::string::npos) continue;
      includes.push_back({file, number, line.substr(open + 1, close - open - 1), line[open] == '<'});
    }
  }
  std::ranges::sort(includes, {}, [](const Include& i) { return std::pair(i.file, i.line); });
  return includes;
}

std::vector<std::string> folderViolations(const fs::path& root) {
  std::vector<std::string> messages;
  for (const std::string folder : {"plugin", "bullet_bridge", "device", "scenes", "viewer"})
    for (const Include& include : includesBelow(root, folder))
      for (const Rule& rule : rules())
        if (startsWithAny(include.target, rule.headers) && !startsWithAny(include.file, rule.allowed))
          messages.push_back(describe(include) + ": " + rule.why);
  return messages;
}

std::vector<std::string> groupCircles(const fs::path& root, const std::string& folder) {
  const Groups groups(root, folder);
  Arrows arrows;
  for (const Include& include : includesBelow(root, folder)) {
    const std::optional<std::string> from = groups.ofFile(include.file), to = groups.ofTarget(include.target);
    if (from && to && *from != *to) arrows[*from].emplace(*to, include);
  }
  return CircleSearch(arrows).run();
}

}  // namespace vps::boundaries
