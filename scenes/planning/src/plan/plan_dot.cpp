// SPDX-License-Identifier: BSD-3-Clause
// The precedence graph in the DOT language of Graphviz.
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "order/take_apart.h"
#include "vps_scenes/planning/plan.h"

namespace vps::scenes {

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
