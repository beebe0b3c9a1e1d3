// SPDX-License-Identifier: BSD-3-Clause
// The table: a case, the mode that ran it, each figure beside its bar.
#pragma once

#include <string>
#include <vector>

namespace vps::bench {

struct Figure {
  std::string text;  ///< what was measured, with its unit
  std::string bar;   ///< what it should be; empty: reported, not judged
  bool is_met = true;
};

struct Row {
  std::string name, mode;
  std::vector<Figure> figures;
  std::string note;  ///< printed below the row
  [[nodiscard]] bool isMet() const;
};

/// A figure that must not exceed its bar. `scale` and `unit` are for print only: 1e6 and "um".
Figure atMost(const std::string& what, double value, double bar, double scale, const std::string& unit);
/// A figure that must be within `tolerance` of `wanted`.
Figure within(const std::string& what, double value, double wanted, double tolerance, double scale,
              const std::string& unit);
/// A claim that holds or does not.
Figure holds(const std::string& claim, bool is_met);
/// A figure without a bar.
Figure reported(const std::string& what, double value, double scale, const std::string& unit);

/// printf into a string.
std::string text(const char* format, ...) __attribute__((format(printf, 1, 2)));

class Table {
 public:
  /// Prints the row as it comes, so that a long run shows how far it is.
  void add(Row row);
  /// A row of someone else: shown, not judged.
  void addRival(Row row);
  /// One line for each row. A case is met when one mode meets all its figures.
  /// @return how many cases are not met
  int print() const;

 private:
  struct Entry {
    Row row;
    bool is_judged;
  };
  std::vector<Entry> rows_;
};

}  // namespace vps::bench
