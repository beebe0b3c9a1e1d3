// SPDX-License-Identifier: BSD-3-Clause
#include "occt/file_faults.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <map>
#include <vector>

#include "occt/step_text.h"

namespace vps::scenes::import {
namespace {

constexpr std::uint64_t kGreatest = 2'000'000'000;  // below 2^31
constexpr std::uint64_t kTooLong = ~std::uint64_t{0};

struct Number {
  std::uint64_t value = 0;  ///< kTooLong: more than 64 bits
  std::size_t from = 0, end = 0;
  std::size_t equals = 0;  ///< position of the '=' after an entity's own number; 0: the number is a reference
};

/// Calls f(Number) for each "#12" outside of strings and comments. Begins at the first byte, since the header
/// has strings as well.
template <class F>
void forEachNumber(std::string_view text, F f) {
  std::size_t at = 0;
  while ((at = text.find_first_of("#'/", at)) < text.size()) {
    if (text[at] == '\'') {
      at = after(text, at + 1, "'");
    } else if (text[at] == '/') {
      at = text.substr(at).starts_with("/*") ? after(text, at + 2, "*/") : at + 1;
    } else {
      Number number;
      number.from = at++;
      const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), number.value);
      if (error == std::errc::invalid_argument) continue;
      if (error != std::errc()) number.value = kTooLong;
      at = number.end = static_cast<std::size_t>(end - text.data());
      const std::size_t next = afterBlanksAndComments(text, at);
      if (next < text.size() && text[next] == '=') number.equals = at = next;
      f(number);
    }
  }
}

/// The sorted numbers of a file's entities; gives out unused numbers from the greatest down.
class EntityNumbers {
 public:
  explicit EntityNumbers(std::string_view text) {
    forEachNumber(text, [&](const Number& number) {
      if (number.equals != 0) own_.push_back(number.value);
    });
    std::ranges::sort(own_);
    lost_ = unused();
    for (const std::uint64_t number : own_)
      if (number > kGreatest && number != kTooLong) smaller_.try_emplace(number, 0);
    for (auto& [number, other] : smaller_) other = unused();
  }
  /// The number to write for a number of the file. A reference to an entity that is not in the file gets the
  /// number of no entity.
  std::uint64_t readable(const Number& number) {
    if (number.value == kTooLong) return number.equals != 0 ? unused() : lost_;
    if (!std::ranges::binary_search(own_, number.value)) return lost_;
    return number.value > kGreatest ? smaller_.at(number.value) : number.value;
  }

 private:
  std::uint64_t unused() {
    while (std::ranges::binary_search(own_, next_)) --next_;
    return next_--;
  }

  std::vector<std::uint64_t> own_;
  std::map<std::uint64_t, std::uint64_t> smaller_;
  std::uint64_t next_ = kGreatest, lost_ = 0;
};

}  // namespace

std::optional<std::string> withReadableNumbers(std::string_view text) {
  EntityNumbers numbers(text);
  std::string out;
  std::size_t copied = 0;
  forEachNumber(text, [&](const Number& number) {
    const std::uint64_t readable = numbers.readable(number);
    const bool has_comment =
        number.equals != 0 &&
        text.substr(number.end, number.equals - number.end).find('/') != std::string_view::npos;
    if (readable == number.value && !has_comment) return;
    out.append(text.substr(copied, number.from - copied)).append("#").append(std::to_string(readable));
    copied = has_comment ? number.equals : number.end;
  });
  if (copied == 0) return std::nullopt;
  return out.append(text.substr(copied));
}

bool capitalizeExponents(std::string& text) {
  const auto isIn = [&](std::size_t at, std::string_view set) {
    return at < text.size() && set.find(text[at]) != std::string_view::npos;
  };
  constexpr std::string_view kDigits = "0123456789";
  bool is_changed = false;
  std::size_t at = 0;
  while ((at = text.find_first_of("e'/", at)) < text.size()) {
    if (text[at] == '\'') {
      at = after(text, at + 1, "'");
    } else if (text[at] == '/') {
      at = std::string_view(text).substr(at).starts_with("/*") ? after(text, at + 2, "*/") : at + 1;
    } else {
      const bool is_behind_digit = at > 0 && (isIn(at - 1, kDigits) || text[at - 1] == '.');
      if (is_behind_digit && isIn(isIn(at + 1, "+-") ? at + 2 : at + 1, kDigits)) {
        text[at] = 'E';
        is_changed = true;
      }
      ++at;
    }
  }
  return is_changed;
}

}  // namespace vps::scenes::import
