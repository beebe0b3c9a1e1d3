// SPDX-License-Identifier: BSD-3-Clause
#include "web/access.h"

#include <algorithm>
#include <cctype>
#include <random>

namespace vps::viewer {

namespace {

constexpr std::string_view kQuery = "/?token=";

/// Compares texts in a time that depends only on their length, so that the time reveals nothing about the
/// token.
bool isEqual(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

/// The value of a cookie in a header "a=1; b=2".
std::string_view valueOf(std::string_view cookies, std::string_view name) {
  while (!cookies.empty()) {
    const std::size_t end = std::min(cookies.find(';'), cookies.size());
    std::string_view one = cookies.substr(0, end);
    while (one.starts_with(' ')) one.remove_prefix(1);
    if (one.starts_with(name) && one.size() > name.size() && one[name.size()] == '=')
      return one.substr(name.size() + 1);
    cookies.remove_prefix(std::min(end + 1, cookies.size()));
  }
  return {};
}

}  // namespace

WebAccess::WebAccess(std::string host, std::string token, bool is_encrypted)
    : host_(std::move(host)), token_(std::move(token)), is_encrypted_(is_encrypted) {
  port_ = host_.substr(host_.rfind(':') + 1);
}

bool WebAccess::isOwnHost(std::string_view host) const {
  if (host == host_) return true;
  const std::string_view name = std::string_view(host_).substr(0, host_.rfind(':'));
  return isLoopbackAddress(name) && (host == "localhost:" + port_ || host == "127.0.0.1:" + port_);
}

// The name has the port, since browsers share cookies between the ports of a host.
std::string WebAccess::cookieName() const {
  return "vps_" + port_;
}

WebAnswer WebAccess::judge(const WebRequest& request) const {
  if (request.method != "GET") return WebAnswer::BadMethod;
  if (!isOwnHost(request.host)) return WebAnswer::BadHost;
  // A browser always sends the origin of the page that opens a WebSocket. Other programs may omit it; they do
  // not act for a user who is logged in.
  const bool names_origin = !request.origin.empty();
  if (names_origin ? request.origin != scheme() + std::string(request.host) : request.is_upgrade)
    return WebAnswer::BadOrigin;
  if (token_.empty() || isEqual(valueOf(request.cookie, cookieName()), token_)) return WebAnswer::Good;
  if (!request.is_upgrade && request.target.starts_with(kQuery) &&
      isEqual(request.target.substr(kQuery.size()), token_))
    return WebAnswer::SetCookie;
  return WebAnswer::Unauthenticated;
}

std::string WebAccess::setCookie() const {
  return cookieName() + "=" + token_ + "; Path=/; HttpOnly; SameSite=Strict" +
         (is_encrypted_ ? "; Secure" : "");
}

std::string WebAccess::address() const {
  return scheme() + host_ + (token_.empty() ? "/" : std::string(kQuery) + token_);
}

std::string newToken() {
  std::random_device random;
  std::string token;
  for (int i = 0; i < 4; ++i)
    for (unsigned bits = random(), digit = 0; digit < 8; ++digit, bits >>= 4U)
      token += "0123456789abcdef"[bits & 15U];
  return token;
}

bool isGoodToken(std::string_view token) {
  return token.size() >= kShortestToken && std::all_of(token.begin(), token.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '-' || c == '_';
         });
}

bool isLoopbackAddress(std::string_view address) {
  return address.starts_with("127.") || address == "::1" || address == "[::1]" || address == "localhost";
}

bool RateLimit::take(double now_s) {
  if (has_time_) left_ = std::min(burst_, left_ + per_s_ * std::max(0.0, now_s - last_s_));
  has_time_ = true;
  last_s_ = now_s;
  if (left_ < 1) return false;
  left_ -= 1;
  return true;
}

}  // namespace vps::viewer
