// SPDX-License-Identifier: BSD-3-Clause
#include "order/precedence.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "surface/on_cores.h"
#include "vps_scenes/planning/plan.h"

namespace vps::scenes {

std::vector<PlannedOrder> precedence(const PairMotions& motions, const Disassembly& apart,
                                     const std::vector<std::string>& names) {
  // By removal: what left before it is mounted after it.
  std::vector<std::vector<PlannedOrder>> found(apart.removals.size());
  const auto isAny = [](const Removal& a, const Removal& b, auto is) {
    return std::ranges::any_of(a.parts, [&](std::size_t i) {
      return std::ranges::any_of(b.parts, [&](std::size_t k) { return is(i, k); });
    });
  };
  forEachOnCores(apart.removals.size(), {}, "", [&](std::size_t i) {
    const Removal& part = apart.removals[i];
    for (std::size_t k = 0; k < i; ++k) {
      const Removal& later = apart.removals[k];
      const bool is_in_way = isAny(part, later, [&](std::size_t moving, std::size_t held) {
        return stopsWay(motions, held, moving, part.way);
      });
      const bool is_carrying = isAny(part, later, [&](std::size_t under, std::size_t over) {
        return std::ranges::binary_search(motions.carriedBy(under), over);
      });
      if (is_in_way)
        found[i].push_back({names[i], names[k], OrderReason::Way});
      else if (is_carrying)
        found[i].push_back({names[i], names[k], OrderReason::Carries});
    }
  });
  std::vector<PlannedOrder> out;
  for (std::size_t i = found.size(); i-- > 0;) {
    std::ranges::reverse(found[i]);
    out.insert(out.end(), found[i].begin(), found[i].end());
  }
  return out;
}

namespace {

std::string dotQuoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + "\"";
}

}  // namespace

std::vector<PlannedOrder> reducedOrder(const std::vector<PlannedOrder>& order) {
  std::map<std::string, std::set<std::string>> after;
  for (const PlannedOrder& one : order) after[one.before].insert(one.after);
  std::vector<PlannedOrder> out;
  for (const PlannedOrder& one : order) {
    // Whether another step that comes after the first leads to the second.
    std::vector<std::string> waiting;
    std::set<std::string> seen;
    for (const std::string& next : after[one.before])
      if (next != one.after && seen.insert(next).second) waiting.push_back(next);
    bool follows = false;
    while (!waiting.empty() && !follows) {
      const std::string here = waiting.back();
      waiting.pop_back();
      for (const std::string& next : after[here]) {
        if (next == one.after) follows = true;
        if (seen.insert(next).second) waiting.push_back(next);
      }
    }
    if (!follows) out.push_back(one);
  }
  return out;
}

std::string planDot(const PlanResult& plan) {
  std::string out = "digraph " + dotQuoted(plan.assembly) +
                    " {\n  rankdir = LR;\n  node [shape = box, fontname = \"sans-serif\"];\n";
  for (std::size_t a = 0; a < plan.assemblies.size(); ++a) {
    const PlannedAssembly& assembly = plan.assemblies[a];
    const std::string prefix = std::to_string(a) + "/";
    out +=
        "  subgraph \"cluster_" + std::to_string(a) + "\" {\n    label = " + dotQuoted(assembly.name) + ";\n";
    const auto node = [&](const std::string& name, const std::string& label, const std::string& style) {
      out += "    " + dotQuoted(prefix + name) + " [label = " + dotQuoted(label) + style + "];\n";
    };
    for (const std::string& name : assembly.fixed) {
      const bool is_blocked =
          std::ranges::find(assembly.blocked, name, &BlockedPart::name) != assembly.blocked.end();
      node(name, name, is_blocked ? ", color = red" : ", style = bold");
    }
    for (std::size_t i = 0; i < assembly.steps.size(); ++i)
      node(assembly.steps[i].name, std::to_string(i + 1) + " " + assembly.steps[i].name, "");
    const std::vector<PlannedOrder> order = reducedOrder(assembly.order);
    for (const PlannedOrder& one : order)
      out += "    " + dotQuoted(prefix + one.before) + " -> " + dotQuoted(prefix + one.after) +
             (one.reason == OrderReason::Carries ? " [style = dashed]" : "") + ";\n";
    if (!assembly.fixed.empty())
      for (const PlannedStep& step : assembly.steps)
        if (std::ranges::find(order, step.name, &PlannedOrder::after) == order.end())
          out += "    " + dotQuoted(prefix + assembly.fixed.front()) + " -> " +
                 dotQuoted(prefix + step.name) + " [color = gray];\n";
    out += "  }\n";
  }
  return out + "}\n";
}

}  // namespace vps::scenes
