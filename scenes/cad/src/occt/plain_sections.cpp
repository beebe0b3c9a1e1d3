// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "occt/file_faults.h"
#include "occt/step_text.h"

namespace vps::scenes::import {
namespace {

/// The position after the ';' that ends the statement at `at`.
std::size_t afterStatement(std::string_view text, std::size_t at) {
  while ((at = std::min(text.find_first_of(";'/", at), text.size())) < text.size() && text[at] != ';') {
    if (text[at] == '\'')
      at = after(text, at + 1, "'");
    else
      at = text.substr(at).starts_with("/*") ? after(text, at + 2, "*/") : at + 1;
  }
  return std::min(at + 1, text.size());
}

/// The word that begins a statement: a keyword of a section or an entity of the header. Empty for "#1=...".
std::string_view wordOf(std::string_view statement) {
  const std::size_t from = afterBlanksAndComments(statement, 0);
  const std::size_t end = statement.find_first_of(" \t\r\n;(/=#", from);
  return statement.substr(from, std::min(end, statement.size()) - from);
}

/// Whether the file has one header and one data section, which begin and end as Open CASCADE expects.
bool isPlain(std::string_view text) {
  int ends = 0;
  for (std::size_t at = text.find("ENDSEC;"); at != std::string_view::npos; at = text.find("ENDSEC;", at + 1))
    ++ends;
  return ends == 2 && text.find("DATA;") != std::string_view::npos;
}

}  // namespace

std::optional<std::string> withPlainSections(std::string_view text) {
  if (isPlain(text)) return std::nullopt;
  constexpr std::string_view kEnd = "END-ISO-10303-21";
  constexpr std::array<std::string_view, 2> kBegins = {"ISO-10303-21", "HEADER"},
                                            kOthers = {"ANCHOR", "REFERENCE"};
  std::string out;
  out.reserve(text.size());
  bool has_data = false, is_in_data = false, is_in_other = false;
  for (std::size_t at = 0, end = 0; at < text.size(); at = end) {
    end = afterStatement(text, at);
    const std::string_view statement = text.substr(at, end - at), word = wordOf(statement);
    if (word == kEnd) break;
    if (word == "DATA") {
      if (!has_data) out += "DATA;\n";
      has_data = is_in_data = true;
    } else if (word == "ENDSEC") {
      if (!is_in_data && !is_in_other) out += "ENDSEC;\n";
      is_in_data = is_in_other = false;
    } else if (std::ranges::find(kOthers, word) != kOthers.end()) {
      is_in_other = true;
    } else if (std::ranges::find(kBegins, word) != kBegins.end()) {
      out.append(word).append(";\n");
    } else if (!is_in_other) {
      out += statement;
    }
  }
  return out.append(has_data ? "\nENDSEC;\n" : "\n").append(kEnd).append(";\n");
}

}  // namespace vps::scenes::import
