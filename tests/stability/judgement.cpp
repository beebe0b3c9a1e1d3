// SPDX-License-Identifier: BSD-3-Clause
#include "rows.h"

#include <cstdio>

namespace vps::stability {

namespace {

void join(std::string& list, const std::string& text) {
  list += list.empty() ? text : "; " + text;
}

}  // namespace

std::string toText(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

void Judgement::atMost(const std::string& what, double value, double bound, const char* unit) {
  const std::string text = what + " " + toText(value) + " of " + toText(bound) + " " + unit;
  if (!(value <= bound)) return join(broken_, text);
  const double share = bound > 0 ? value / bound : bound / value;  // for a negative bound the remaining share
  if (share > share_ || nearest_.empty()) {
    share_ = share;
    nearest_ = text;
  }
}

void Judgement::require(bool is_so, const std::string& otherwise) {
  if (!is_so) join(broken_, otherwise);
}

void Judgement::note(const std::string& text) {
  join(notes_, text);
}

std::string Judgement::text() const {
  std::string text = holds() ? nearest_ : broken_;
  if (!notes_.empty()) join(text, notes_);
  return text;
}

}  // namespace vps::stability
