// SPDX-License-Identifier: BSD-3-Clause
// Finds groups of parts in a CAD file that are one body.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "import/part_names.h"
#include "vps/errors.h"
#include "vps_scenes/cad/import.h"

namespace vps::scenes {

namespace {

using Members = std::vector<std::size_t>;

/// Disjoint sets of the numbers 0 to count - 1 (union-find).
class Unions {
 public:
  explicit Unions(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t rootOf(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    parent_[std::max(rootOf(a), rootOf(b))] = std::min(rootOf(a), rootOf(b));
  }

 private:
  std::vector<std::size_t> parent_;
};

/// Numbers the corners of all parts; corners within 1 um of each other have one number.
class Corners {
 public:
  std::uint32_t numberOf(const Vec3& p_W) {
    const Cell cell = cellOf(p_W);
    for (int k = 0; k < 27; ++k) {
      const auto known = at_.find({cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1});
      if (known == at_.end()) continue;
      for (const auto& [p, number] : known->second)
        if ((p - p_W).norm() < kSame_m) return number;
    }
    at_[cell].emplace_back(p_W, count_);
    return count_++;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  static constexpr double kSame_m = 1e-6;  // exporters round coordinates to 1 um
  static Cell cellOf(const Vec3& p) {
    return {std::llround(p.x() / kSame_m), std::llround(p.y() / kSame_m), std::llround(p.z() / kSame_m)};
  }
  std::map<Cell, std::vector<std::pair<Vec3, std::uint32_t>>> at_;
  std::uint32_t count_ = 0;
};

/// Edges that belong to one triangle only.
std::vector<std::array<std::uint32_t, 2>> openEdges(const Mesh& mesh) {
  std::map<std::array<std::uint32_t, 2>, int> count;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
      ++count[{a, b}];
    }
  std::vector<std::array<std::uint32_t, 2>> open;
  for (const auto& [edge, triangles] : count)
    if (triangles == 1) open.push_back(edge);
  return open;
}

/// Sets of open surfaces that share open edges.
std::vector<Members> surfacesThatMeet(const std::vector<ImportedPart>& parts) {
  Corners corners;
  std::map<std::array<std::uint32_t, 2>, std::size_t> first;  // the first part that has the edge
  Unions unions(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!parts[i].within.empty()) continue;
    for (const auto& edge : openEdges(parts[i].mesh)) {
      const auto [a, b] = std::minmax(corners.numberOf(parts[i].X_WP * parts[i].mesh.vertices[edge[0]]),
                                      corners.numberOf(parts[i].X_WP * parts[i].mesh.vertices[edge[1]]));
      const auto [known, is_new] = first.try_emplace({a, b}, i);
      if (!is_new) unions.join(known->second, i);
    }
  }
  std::map<std::size_t, Members> by_root;
  for (std::size_t i = 0; i < parts.size(); ++i) by_root[unions.rootOf(i)].push_back(i);
  std::vector<Members> out;
  for (auto& [root, members] : by_root)
    if (members.size() > 1) out.push_back(std::move(members));
  return out;
}

class Grouping {
 public:
  explicit Grouping(ImportedCad& cad) : cad_(cad), is_taken_(cad.parts.size()) {}

  void addWished(const std::string& name) {
    Members members;
    std::string reason = "asked for";
    for (std::size_t i = 0; i < cad_.parts.size(); ++i)
      if (std::ranges::find(cad_.parts[i].within, name) != cad_.parts[i].within.end()) members.push_back(i);
    if (members.empty())
      for (std::size_t i = 0; i < cad_.parts.size(); ++i)
        if (import::matchesPattern(cad_.parts[i].name, name)) members.push_back(i);
    if (members.size() < 2)
      throw LoadError(cad_.file, "",
                      "--group '" + name + "' names " + (members.empty() ? "no part" : "one part") +
                          "; name an assembly or a product of several parts, or a pattern like 'plug*'" +
                          assembliesInWords());
    for (const std::size_t i : members)
      if (is_taken_[i])
        throw LoadError(cad_.file, cad_.parts[i].name,
                        "is in two groups, the second of which is --group '" + name + "'");
    add(name.find('*') == std::string::npos ? name : cad_.parts[members.front()].name, members, reason);
  }

  void addProposed() {
    std::map<std::string, Members> of_product;
    for (std::size_t i = 0; i < cad_.parts.size(); ++i)
      if (!cad_.parts[i].within.empty() && !is_taken_[i])
        of_product[cad_.parts[i].within.back()].push_back(i);
    if (groups_.empty() && of_product.size() == 1 && of_product.begin()->second.size() == cad_.parts.size()) {
      if (cad_.parts.size() > 1)
        cad_.warnings.push_back("all " + std::to_string(cad_.parts.size()) + " parts are of one product, '" +
                                of_product.begin()->first + "', and are taken for an assembly; --group '" +
                                of_product.begin()->first + "' makes them one body");
      return;
    }
    for (const auto& [product, members] : of_product)
      if (members.size() > 1) add(product, members, "one product");
    const std::vector<Members> meeting = surfacesThatMeet(cad_.parts);
    for (const Members& members : meeting) {
      const bool is_free = std::ranges::none_of(members, [&](std::size_t i) { return is_taken_[i]; });
      if (is_free && members.size() < cad_.parts.size())
        add(cad_.parts[members.front()].name, members, "open surfaces that meet along edges");
    }
  }

  [[nodiscard]] std::vector<PartGroup> take() { return std::move(groups_); }

 private:
  void add(const std::string& name, const Members& members, const std::string& reason) {
    PartGroup group{name, {}, reason};
    for (const std::size_t i : members) {
      group.parts.push_back(cad_.parts[i].name);
      is_taken_[i] = true;
    }
    // A name of the group's own members is free, since they are no parts of the scene any more.
    const auto isUsed = [&](const std::string& word) {
      return std::ranges::any_of(groups_, [&](const PartGroup& other) { return other.name == word; }) ||
             std::ranges::any_of(cad_.parts, [&](const ImportedPart& part) {
               return part.name == word && std::ranges::find(group.parts, word) == group.parts.end();
             });
    };
    for (int n = 2; isUsed(group.name); ++n) group.name = name + "_" + std::to_string(n);
    groups_.push_back(std::move(group));
  }

  [[nodiscard]] std::string assembliesInWords() const {
    std::map<std::string, int> parts_of;
    for (const ImportedPart& part : cad_.parts)
      for (const std::string& name : part.within) ++parts_of[name];
    std::erase_if(parts_of, [](const auto& one) { return one.second < 2; });
    std::string out;
    constexpr int kShown = 12;
    int shown = 0;
    for (const auto& [name, count] : parts_of)
      if (++shown <= kShown) out += (out.empty() ? "; there are: '" : ", '") + name + "'";
    return out;
  }

  ImportedCad& cad_;
  std::vector<bool> is_taken_;
  std::vector<PartGroup> groups_;
};

}  // namespace

std::vector<PartGroup> partGroups(ImportedCad& cad, const GroupWishes& wishes) {
  Grouping grouping(cad);
  for (const std::string& name : wishes.names) grouping.addWished(name);
  if (wishes.is_proposed) grouping.addProposed();
  return grouping.take();
}

}  // namespace vps::scenes
