// SPDX-License-Identifier: BSD-3-Clause
#include "output/table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace vps::viewer {

namespace {

/// Width of the text: its number of UTF-8 code points.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](unsigned char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

Table::Table(std::vector<std::string> heads) {
  for (std::string& head : heads) {
    is_left_.push_back(head.starts_with('<'));
    if (is_left_.back()) head.erase(0, 1);
  }
  rows_.push_back(std::move(heads));
}

void Table::add(std::vector<std::string> cells) {
  cells.resize(is_left_.size());
  rows_.push_back(std::move(cells));
}

std::string Table::text() const {
  std::vector<std::size_t> widths(is_left_.size(), 0);
  for (const auto& row : rows_)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
  std::string out;
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - width(row[i]), ' ');
      if (i) line += "  ";
      line += is_left_[i] ? row[i] + padding : padding + row[i];
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  return out;
}

std::string fixed(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  // A number that rounds to zero is printed without a sign.
  const bool is_zero = std::string(text).find_first_of("123456789") == std::string::npos;
  return is_zero && text[0] == '-' ? text + 1 : text;
}

}  // namespace vps::viewer
