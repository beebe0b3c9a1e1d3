// SPDX-License-Identifier: BSD-3-Clause
#include "plots/gnuplot.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "files/external.h"
#include "vps/write_file.h"

namespace vps::viewer {
namespace {

constexpr const char* kMissing = "gnuplot is not installed (Debian: apt install gnuplot-nox)";

/// Runs gnuplot on a script. Returns nothing on success, and otherwise the reason of the failure.
std::string run(const std::string& script) {
  // gnuplot reads its standard input byte by byte, but a file that it opens itself in blocks.
  return runProgram({"gnuplot", "/dev/stdin"}, script, kMissing);
}

}  // namespace

bool hasGnuplot() {
  return hasProgram("gnuplot");
}

namespace gnuplot {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) continue;
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

std::string number(double value) {
  if (!std::isfinite(value)) return "NaN";
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string dataBlock(const std::string& name, const std::vector<std::vector<double>>& rows) {
  std::string out = std::string("$").append(name) + " << END_OF_DATA\n";
  for (const std::vector<double>& row : rows) {
    for (const double value : row) out += number(value) + ' ';
    out += '\n';
  }
  return out + "END_OF_DATA\n";
}

std::vector<std::pair<double, double>> thinned(const std::vector<std::pair<double, double>>& points,
                                               std::size_t bucket_count) {
  if (points.size() <= 2 * bucket_count) return points;
  std::vector<std::pair<double, double>> kept;
  for (std::size_t b = 0; b < bucket_count; ++b) {
    const auto begin = points.begin() + static_cast<std::ptrdiff_t>(b * points.size() / bucket_count);
    const auto end = points.begin() + static_cast<std::ptrdiff_t>((b + 1) * points.size() / bucket_count);
    auto [least, greatest] =
        std::minmax_element(begin, end, [](const auto& p, const auto& q) { return p.second < q.second; });
    if (least > greatest) std::swap(least, greatest);
    kept.push_back(*least);
    if (least != greatest) kept.push_back(*greatest);
  }
  return kept;
}

PlotOutcome draw(const std::string& body, const std::string& file, int width, int height) {
  namespace fs = std::filesystem;
  if (std::any_of(file.begin(), file.end(), [](unsigned char c) { return c < 0x20; }))
    return {false, "the plot's file name has control characters"};
  const std::string size = std::to_string(width) + "," + std::to_string(height);
  // gnuplot's pngcairo renders fonts at 72 dots per inch and svg at 96, hence the different point sizes.
  const std::pair<const char*, std::string> kinds[] = {
      {".png", "set terminal pngcairo size " + size + " font \"DejaVu Sans,11\" linewidth 1.2 noenhanced\n"},
      {".svg", "set terminal svg size " + size +
                   " font \"DejaVu Sans,13\" linewidth 1.2 background \"white\" noenhanced\n"}};
  std::error_code error;
  if (const fs::path folder = fs::path(file).parent_path(); !folder.empty())
    fs::create_directories(folder, error);
  for (const auto& [ending, terminal] : kinds) {
    WholeFile target(file + ending);
    const std::string failure_reason = run(terminal + "set output " + quoted(target.temporary().string()) +
                                           "\n" + body + "\nunset output\n");
    if (!failure_reason.empty()) return {false, failure_reason};
    if (const std::error_code failed = target.commit())
      return {false, file + ending + ": cannot be written: " + failed.message()};
  }
  return {true, {}};
}

}  // namespace gnuplot

namespace {

using gnuplot::number;

constexpr std::size_t kBuckets = 1500;  // about one bucket per pixel of the plot's width

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

PlotOutcome plotSeries(const Plot& plot, const std::string& file) {
  static constexpr std::array<const char*, 7> kColors = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                         "#E69F00", "#56B4E9", "#333333"};
  std::string script = plotStyle();
  if (plot.is_log_x) script += "set logscale x\n";
  if (plot.is_log_y) script += "set logscale y\n";
  if (!plot.title.empty())
    script += "set title " + gnuplot::quoted(plot.title) + " textcolor rgb \"#222222\"\n";
  script +=
      "set xlabel " + gnuplot::quoted(plot.x_label) + "\nset ylabel " + gnuplot::quoted(plot.y_label) + "\n";
  std::string commands;
  bool has_points = false;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const Series& s = plot.series[i];
    const std::string name = std::string("s").append(std::to_string(i));
    addPoints(script, name, s.points);
    has_points = has_points || !s.points.empty();
    commands += std::string("$").append(name) + " with " +
                (s.is_scatter    ? "points pt 7 ps 1.1"
                 : s.has_markers ? "linespoints pt 7 ps 0.8"
                                 : "lines") +
                " lw 1.6 lc rgb \"" + kColors[i % kColors.size()] + "\" title " + gnuplot::quoted(s.name) +
                ", \\\n  ";
  }
  if (!has_points) return {false, "no points to plot"};
  return gnuplot::draw(script + plotLines({}, commands), file, 1100, 620);
}

}  // namespace vps::viewer
