// SPDX-License-Identifier: BSD-3-Clause
#include "plots/plot_style.h"

#include <cmath>

#include "plots/gnuplot.h"

namespace vps::viewer {
namespace {

using gnuplot::number;

constexpr std::size_t kBuckets = 1500;  // about one for each pixel of the plot's width

}  // namespace

std::string plotStyle() {
  return "set encoding utf8\n"
         "set border 3 lc rgb \"#666666\" lw 0.8\n"
         "set tics nomirror out scale 0.6 textcolor rgb \"#333333\"\n"
         "set grid lc rgb \"#D9D9D9\" lw 0.6 lt 1\n"
         "set key outside right top vertical Left reverse samplen 1.6 spacing 1.15 width 1 textcolor rgb "
         "\"#333333\"\n";
}

void addPoints(std::string& script, const std::string& name, const Curve& curve) {
  std::vector<std::vector<double>> rows;
  for (const auto& [x, y] : gnuplot::thinned(curve, kBuckets)) rows.push_back({x, y});
  if (rows.empty()) rows.push_back({std::nan(""), std::nan("")});  // gnuplot rejects an empty block
  script += gnuplot::dataBlock(name, rows);
}

std::string plotLines(const std::vector<Line>& lines, const std::string& more) {
  std::string out = "plot ";
  for (const Line& line : lines)
    out += std::string("$").append(line.name) + " with lines lw " + number(line.width) + " lc rgb \"" +
           line.color + "\" title " + gnuplot::quoted(line.title) + ", \\\n  ";
  out += more;
  while (out.back() == ' ' || out.back() == '\n' || out.back() == '\\' || out.back() == ',') out.pop_back();
  return out + "\n";
}

}  // namespace vps::viewer
