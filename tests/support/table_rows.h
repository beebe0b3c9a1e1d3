// SPDX-License-Identifier: BSD-3-Clause
// Writes the rows of a table to a file. tests/core_table.sh joins the rows of all programs into one table.
#pragma once

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <string>

namespace vps::test {

/// Verdict of a row. tests/core_table.sh counts every other word as a failure.
inline constexpr const char* kMet = "met";
inline constexpr const char* kFailed = "FAILED";
inline constexpr const char* kExpected = "expected";  ///< fails, as expected
inline constexpr const char* kReported = "-";         ///< not judged

/// Writes one line for each row: row, bound, value, verdict, processor time [s], separated by tabs. Each line
/// is written to the file at once, so that the rows before a crash are kept.
class TableRows {
 public:
  TableRows() = default;
  TableRows(const TableRows&) = delete;
  TableRows& operator=(const TableRows&) = delete;
  ~TableRows() {
    if (file_) std::fclose(file_);
  }

  /// @return false if the file cannot be written. Without a call, rows are not written.
  [[nodiscard]] bool open(const std::string& path) {
    file_ = std::fopen(path.c_str(), "w");
    return file_ != nullptr;
  }
  /// The processor time of the row is the time since the row before, or since the program began.
  void add(const std::string& row, const std::string& bound, const std::string& value, const char* verdict) {
    const std::clock_t now = std::clock();
    add(row, bound, value, verdict, static_cast<double>(now - last_) / CLOCKS_PER_SEC);
    last_ = now;
  }
  void add(const std::string& row, const std::string& bound, const std::string& value, const char* verdict,
           double cpu_s) {
    if (!file_) return;
    std::fprintf(file_, "%s\t%s\t%s\t%s\t%.1f\n", inOneLine(row).c_str(), inOneLine(bound).c_str(),
                 inOneLine(value).c_str(), verdict, cpu_s);
    std::fflush(file_);
  }

 private:
  static std::string inOneLine(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '\t' || c == '\n'; }, ' ');
    return text;
  }
  std::FILE* file_ = nullptr;
  std::clock_t last_ = 0;
};

}  // namespace vps::test
