// SPDX-License-Identifier: BSD-3-Clause
#include "import/part_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include "core/valid_text.h"

namespace vps::scenes::import {

namespace {

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}
bool isLetter(char c) {
  // A byte beyond ASCII belongs to a letter of another script.
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80;
}

/// The name without an instance's number: digits in brackets, behind a separator, or at the end.
std::string withoutNumber(std::string name) {
  const auto endsIn = [&](std::string_view set) {
    return !name.empty() && set.find(name.back()) != std::string_view::npos;
  };
  while (endsIn(" )>]")) name.pop_back();
  while (!name.empty() && isDigit(name.back())) name.pop_back();
  while (endsIn(" _-:.#(<[")) name.pop_back();
  return name;
}

std::string wordOf(const std::string& name) {
  std::string lower = withoutNumber(withoutNumber(name));  // "Component1:1"
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

/// Whether the name is a word that exporters and CAD kernels write in place of an unknown name.
bool isOfExporter(const std::string& name) {
  const std::string word = wordOf(name);
  constexpr std::array<std::string_view, 10> kWords = {"nauo",
                                                       "solid",
                                                       "compound",
                                                       "shell",
                                                       "shape",
                                                       "face",
                                                       "label",
                                                       "default",
                                                       "manifold_solid_brep",
                                                       "next_assembly_usage_occurrence"};
  return std::ranges::find(kWords, word) != kWords.end() ||
         word.starts_with("open cascade step translator") || word.starts_with("=>[");
}

/// Whether the name has control characters or replacement characters, or consists mostly of punctuation, as
/// from an exporter that cannot write some characters.
bool isGarbled(const std::string& name) {
  const auto letters =
      std::ranges::count_if(name, [](char c) { return isLetter(c) || isDigit(c) || c == ' '; });
  return printable(name) != name || name.find("\xEF\xBF\xBD") != std::string::npos ||
         name.find("??") != std::string::npos || 2 * letters < std::ssize(name);
}

/// Whether the name is one long word that changes between capitals, small letters and digits at more than
/// every other place, and at least twice from a small letter to a capital, as in identifiers of instances:
/// "MqXw0GXkVJeNj9w4". Designations such as "DIN912M8x20A2K" and "LH_Arm_V2_01" do not count as random.
bool isRandom(const std::string& name) {
  constexpr std::ptrdiff_t kLeast = 12;
  enum Kind { Separator, Digit, Capital, Small, Sign };
  const auto kindOf = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return c == '_' || c == '-' || c == '.' ? Separator
           : std::isdigit(byte) != 0        ? Digit
           : std::isupper(byte) != 0        ? Capital
           : std::islower(byte) != 0        ? Small
                                            : Sign;
  };
  if (name.find(' ') != std::string::npos) return false;
  std::ptrdiff_t length = 0, changes = 0, capitals_within = 0;
  Kind before = Separator;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const Kind kind = kindOf(name[i]), last = std::exchange(before, kind);
    if (kind == Separator) continue;
    ++length;
    const bool begins_word =
        last == Capital && kind == Small && i + 1 < name.size() && kindOf(name[i + 1]) == Small;
    changes += last != Separator && kind != last && !begins_word ? 1 : 0;
    capitals_within += last == Small && kind == Capital ? 1 : 0;
  }
  return length >= kLeast && 2 * changes > length && capitals_within >= 2;
}

/// Whether the name is a word that any part could have.
bool isGeneric(const std::string& name) {
  constexpr std::array<std::string_view, 12> kWords = {"part",       "body",    "component", "product",
                                                       "unnamed",    "no name", "group",     "instance",
                                                       "occurrence", "item",    "object",    "element"};
  return std::ranges::find(kWords, wordOf(name)) != kWords.end();
}

/// Whether the name is long and consists of hexadecimal digits and separators, with several decimal digits.
bool isIdentifier(const std::string& name) {
  constexpr std::ptrdiff_t kLeast = 16, kLeastDigits = 4;
  const auto hex = std::ranges::count_if(
      name, [](unsigned char c) { return std::isxdigit(c) != 0 || c == '-' || c == '{' || c == '}'; });
  return hex == std::ssize(name) && hex >= kLeast && std::ranges::count_if(name, isDigit) >= kLeastDigits;
}

/// How meaningful a name is. 0: not at all, 1: a word that any part could have, or a garbled or random name,
/// 2: a real name.
int meaningOf(const std::string& name) {
  if (!std::ranges::any_of(name, isLetter) || isOfExporter(name) || isIdentifier(name)) return 0;
  return isGeneric(name) || isGarbled(name) || isRandom(name) ? 1 : 2;
}

}  // namespace

std::string bestName(const std::string& instance, const std::string& product) {
  const int of_instance = meaningOf(instance), of_product = meaningOf(product);
  if (std::max(of_instance, of_product) == 0) return "";
  if (of_instance != of_product) return of_instance > of_product ? instance : product;
  if (of_product == 1) return product;
  // CAD systems count instances as "bolt:3" and "bolt<3>"; a person may have chosen "bolt_3".
  const bool is_counted = instance.starts_with(product) && withoutNumber(instance) == product &&
                          instance.find_first_of(":<#", product.size()) == product.size();
  return is_counted ? product : instance;
}

bool matchesPattern(std::string_view name, std::string_view pattern) {
  // After a mismatch, the last * takes one more letter; earlier ones never need to take more.
  std::size_t n = 0, p = 0, star = std::string_view::npos, after_star = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      after_star = n;
    } else if (p < pattern.size() && pattern[p] == name[n]) {
      ++p;
      ++n;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      n = ++after_star;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

}  // namespace vps::scenes::import
