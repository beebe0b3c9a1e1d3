// SPDX-License-Identifier: BSD-3-Clause
// The rows of a table for other programs: tests/core_table.sh joins those of all programs into one.
#pragma once

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <string>

namespace vps::test {

/// Verdict of a row. tests/core_table.sh counts every other word as a failure.
inline constexpr const char* kMet = "met";
inline constexpr const char* kFailed = "FAILED";
inline constexpr const char* kExpected = "expected";  ///< fails as it is known to
inline constexpr const char* kReported = "-";         ///< not judged

/// Writes one line for each row: row, bound, value, verdict, processor time [s], separated by tabs. Each line
/// is in the file as soon as it is added, so that a program that crashes leaves those before.
class TableRows {
 public:
  TableRows() = default;
  TableRows(const TableRows&) = delete;
  TableRows& operator=(const TableRows&) = delete;
  ~TableRows() {
    if (file_) std::fclose(file_);
  }

  /// @return false if the file cannot be written. Without a call, rows go nowhere.
  [[nodiscard]] bool open(const std::string& path) {
    file_ = std::fopen(path.c_str(), "w");
    return file_ != nullptr;
  }
  /// The processor time of the row is that since the row before, or since the program began.
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
