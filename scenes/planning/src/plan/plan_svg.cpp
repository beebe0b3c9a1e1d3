// SPDX-License-Identifier: BSD-3-Clause
// The precedence graph as a picture: each step is placed right of all steps that come before it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "order/take_apart.h"
#include "vps_scenes/planning/plan.h"

namespace vps::scenes {

namespace {

constexpr double kHeight = 26, kRow = 40, kBetween = 70, kMargin = 24, kTitle = 34;
constexpr double kLetter =
    7.6;  // assumed width of a letter in a sans-serif font of 13 px, enough for most names

std::string xmlText(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out;
}

/// Number of characters in UTF-8 text.
std::size_t lettersOf(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

struct Node {
  std::string label, color = "#444";
  bool is_bold = false;
  std::size_t column = 0;
  double row = 0;
  double x = 0, y = 0, width = 0;
};
struct Edge {
  std::size_t from = 0, to = 0;
  std::string style;
};

/// Places the nodes of an assembly in columns.
class Drawing {
 public:
  explicit Drawing(const PlannedAssembly& assembly) {
    std::map<std::string, std::size_t> index;
    const auto add = [&](const std::string& name, Node node) {
      node.width = kLetter * static_cast<double>(lettersOf(node.label)) + 20;
      index.try_emplace(name, nodes_.size());
      nodes_.push_back(std::move(node));
    };
    for (const std::string& name : assembly.fixed) {
      const bool is_blocked =
          std::ranges::find(assembly.blocked, name, &BlockedPart::name) != assembly.blocked.end();
      add(name, {.label = name, .color = is_blocked ? "#c00" : "#000", .is_bold = !is_blocked});
    }
    for (std::size_t i = 0; i < assembly.steps.size(); ++i)
      add(assembly.steps[i].name, {.label = std::to_string(i + 1) + " " + assembly.steps[i].name});
    const std::vector<PlannedOrder> order = reducedOrder(assembly.order);
    for (const PlannedOrder& one : order)
      edges_.push_back({index.at(one.before), index.at(one.after),
                        one.reason == OrderReason::Carries ? " stroke-dasharray='5 4'" : ""});
    if (!assembly.fixed.empty())
      for (const PlannedStep& step : assembly.steps)
        if (std::ranges::find(order, step.name, &PlannedOrder::after) == order.end())
          edges_.push_back({0, index.at(step.name), " class='free'"});
    place();
  }

  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const { return height_; }

  [[nodiscard]] std::string svg(double top) const {
    std::string out;
    char text[320];
    for (const Edge& edge : edges_) {
      const Node &a = nodes_[edge.from], &b = nodes_[edge.to];
      const double x0 = a.x + a.width, y0 = top + a.y, x1 = b.x - 2, y1 = top + b.y, bend = 0.5 * (x1 - x0);
      std::snprintf(text, sizeof text,
                    "<path d='M%.0f %.0fC%.0f %.0f %.0f %.0f %.0f %.0f' marker-end='url(#a)'%s/>\n", x0, y0,
                    x0 + bend, y0, x1 - bend, y1, x1, y1, edge.style.c_str());
      out += text;
    }
    for (const Node& node : nodes_) {
      std::snprintf(text, sizeof text,
                    "<rect x='%.0f' y='%.0f' width='%.0f' height='%.0f' stroke='%s' stroke-width='%d'/>"
                    "<text x='%.0f' y='%.0f'>",
                    node.x, top + node.y - 0.5 * kHeight, node.width, kHeight, node.color.c_str(),
                    node.is_bold ? 2 : 1, node.x + 0.5 * node.width, top + node.y + 4.5);
      out += text + xmlText(node.label) + "</text>\n";
    }
    return out;
  }

 private:
  /// The column is the length of the longest chain before a node. Within a column, nodes are sorted by the
  /// mean row of their predecessors, so that lines cross less, and then by step.
  void place() {
    // Steps are sorted after their predecessors, so one pass is enough.
    for (std::size_t to = 0; to < nodes_.size(); ++to)
      for (const Edge& edge : edges_)
        if (edge.to == to) nodes_[to].column = std::max(nodes_[to].column, nodes_[edge.from].column + 1);
    std::map<std::size_t, std::vector<std::size_t>> columns;
    for (std::size_t i = 0; i < nodes_.size(); ++i) columns[nodes_[i].column].push_back(i);
    std::size_t most = 0;
    for (const auto& [column, members] : columns) most = std::max(most, members.size());
    double x = kMargin;
    for (auto& [column, members] : columns) {
      std::map<std::size_t, double> middle;
      for (const std::size_t i : members) middle[i] = middleBefore(i);
      std::ranges::stable_sort(members, {}, [&](std::size_t i) { return middle[i]; });
      double widest = 0;
      for (std::size_t k = 0; k < members.size(); ++k) {
        Node& node = nodes_[members[k]];
        node.row = static_cast<double>(k) + 0.5 * static_cast<double>(most - members.size());
        node.x = x;
        node.y = kTitle + (node.row + 0.5) * kRow;
        widest = std::max(widest, node.width);
      }
      x += widest + kBetween;
    }
    width_ = x - kBetween + kMargin;
    height_ = kTitle + static_cast<double>(most) * kRow;
  }

  [[nodiscard]] double middleBefore(std::size_t node) const {
    double sum = 0;
    int count = 0;
    for (const Edge& edge : edges_)
      if (edge.to == node) {
        sum += nodes_[edge.from].row;
        ++count;
      }
    return count > 0 ? sum / count : 0;
  }

  std::vector<Node> nodes_;
  std::vector<Edge> edges_;
  double width_ = 0, height_ = 0;
};

}  // namespace

std::string planSvg(const PlanResult& plan) {
  double width = 400, height = 0;
  std::string body;
  for (const PlannedAssembly& assembly : plan.assemblies) {
    const Drawing drawing(assembly);
    body += "<text class='title' x='" + std::to_string(static_cast<int>(kMargin)) + "' y='" +
            std::to_string(static_cast<int>(height + 0.6 * kTitle)) + "'>" + xmlText(assembly.name) +
            "</text>\n" + drawing.svg(height);
    width = std::max(width, drawing.width());
    height += drawing.height() + kMargin;
  }
  const double legend = height + 0.5 * kRow;
  char text[240];
  std::snprintf(text, sizeof text, "<text class='note' x='%.0f' y='%.0f'>", kMargin, legend);
  body += text +
          std::string(
              "line: has to come first, or its path is blocked; dashed: carries the later part; grey: free; "
              "bold: base; red: blocked</text>\n");
  height += kRow;
  width = std::max(width, 720.0);
  std::snprintf(
      text, sizeof text,
      "<svg xmlns='http://www.w3.org/2000/svg' width='%.0f' height='%.0f' viewBox='0 0 %.0f %.0f'>\n", width,
      height, width, height);
  return text + std::string(R"(<style>
text { font: 13px sans-serif; text-anchor: middle }
.title { font-weight: bold; text-anchor: start }
.note { font-size: 11px; fill: #666; text-anchor: start }
rect { fill: #fff; rx: 4px }
path { fill: none; stroke: #444 }
.free { stroke: #bbb }
</style>
<defs><marker id='a' markerWidth='8' markerHeight='8' refX='7' refY='4' orient='auto'><path d='M1 1L7 4L1 7' /></marker></defs>
<rect width='100%' height='100%'/>
)") + body +
         "</svg>\n";
}

}  // namespace vps::scenes
