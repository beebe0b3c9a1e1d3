// SPDX-License-Identifier: BSD-3-Clause
// The table: a case, its mode, and each figure with its bound.
#pragma once

#include <string>
#include <vector>

#include "support/table_rows.h"

namespace vps::bench {

struct Figure {
  std::string text;   ///< measured value with its unit
  std::string bound;  ///< bound of the value; empty: the value is reported, not judged
  bool is_met = true;
  std::string name = {};  ///< name of the measured quantity; empty: the bound names the quantity
};

struct Row {
  std::string name, mode;
  std::vector<Figure> figures;
  std::string note;  ///< printed below the row
  [[nodiscard]] bool isMet() const;
};

/// A figure that must not exceed its bound. `scale` and `unit` are for printing only: 1e6 and "um".
Figure atMost(const std::string& what, double value, double bound, double scale, const std::string& unit);
/// A figure that must be within `tolerance` of `wanted`.
Figure within(const std::string& what, double value, double wanted, double tolerance, double scale,
              const std::string& unit);
/// A claim that is true or false.
Figure holds(const std::string& claim, bool is_met);
/// A figure without a bound.
Figure reported(const std::string& what, double value, double scale, const std::string& unit);

/// Formats a text like printf.
std::string text(const char* format, ...) __attribute__((format(printf, 1, 2)));

class Table {
 public:
  /// Prints the row at once, so that a long run shows its progress.
  void add(Row row);
  /// Adds a row of another engine, which is reported and not judged.
  void addRival(Row row);
  /// Prints one line for each row. A case is met if one mode meets all its bounds.
  /// @return the number of cases that are not met
  int print();
  /// print() writes the figures of judged rows to this file as well.
  test::TableRows file;

 private:
  struct Entry {
    Row row;
    bool is_judged;
    double cpu_s;
  };
  void write(const Entry& entry, bool is_case_met);
  std::vector<Entry> rows_;
  std::clock_t last_ = 0;
};

}  // namespace vps::bench
