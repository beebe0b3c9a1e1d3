// SPDX-License-Identifier: BSD-3-Clause
// Who may use the web page, and how much. Nothing here knows sockets.
#pragma once

#include <string>
#include <string_view>

#include "vps_viewer/export.h"

namespace vps::viewer {

/// What a request says of itself. Empty: the header is missing.
struct WebRequest {
  std::string_view method, target, host, origin, cookie;
  bool is_upgrade = false;  ///< to a WebSocket
};

enum class WebAnswer {
  Good,
  SetCookie,       ///< the token was right: sets the cookie and sends the browser to "/"
  BadMethod,       ///< 405
  BadHost,         ///< 403: the name is not this server's, as after DNS rebinding
  BadOrigin,       ///< 403: the page of another server asks
  Unauthenticated  ///< 401
};

/// A browser proves that it knows the token by opening /?token=TOKEN once; after that by a cookie, which
/// scripts cannot read and which pages of other servers cannot send.
class VPS_VIEWER_API WebAccess {
 public:
  /// @param host   "127.0.0.1:8080", as a browser writes it
  /// @param token  empty: none is needed
  WebAccess(std::string host, std::string token, bool is_encrypted = false);

  [[nodiscard]] WebAnswer judge(const WebRequest& request) const;
  /// Of the header Set-Cookie, after SetCookie.
  [[nodiscard]] std::string setCookie() const;
  /// What a user opens.
  [[nodiscard]] std::string address() const;
  /// The page comes by https.
  [[nodiscard]] bool isEncrypted() const { return is_encrypted_; }

 private:
  [[nodiscard]] bool isOwnHost(std::string_view host) const;
  [[nodiscard]] std::string cookieName() const;

  [[nodiscard]] const char* scheme() const { return is_encrypted_ ? "https://" : "http://"; }

  std::string host_, port_, token_;
  bool is_encrypted_;
};

/// A number that nobody guesses: 128 bits as 32 hexadecimal digits.
VPS_VIEWER_API std::string newToken();

/// Own tokens must have at least this many characters, of letters, digits, '-' and '_'.
inline constexpr std::size_t kShortestToken = 16;
[[nodiscard]] VPS_VIEWER_API bool isGoodToken(std::string_view token);

/// True for addresses that other machines cannot reach.
[[nodiscard]] VPS_VIEWER_API bool isLoopbackAddress(std::string_view address);

/// How much of something may come: a bucket that fills steadily, and of which each use takes one.
class VPS_VIEWER_API RateLimit {
 public:
  RateLimit(double per_s, double burst) : per_s_(per_s), burst_(burst), left_(burst) {}
  /// False: too much.
  bool take(double now_s);

 private:
  double per_s_, burst_, left_;
  double last_s_ = 0;
  bool has_time_ = false;
};

}  // namespace vps::viewer
