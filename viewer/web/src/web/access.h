// SPDX-License-Identifier: BSD-3-Clause
// Access to the web page: tokens, the checks of a request, and rate limits. Independent of sockets.
#pragma once

#include <string>
#include <string_view>

#include "vps_viewer/export.h"

namespace vps::viewer {

/// Headers of a request. Empty: the header is missing.
struct WebRequest {
  std::string_view method, target, host, origin, cookie;
  bool is_upgrade = false;  ///< asks to upgrade to a WebSocket
};

enum class WebAnswer {
  Good,
  SetCookie,       ///< the token was right: set the cookie and redirect the browser to "/"
  BadMethod,       ///< 405
  BadHost,         ///< 403: the host name is not this server's, for example after DNS rebinding
  BadOrigin,       ///< 403: the request comes from the page of another server
  Unauthenticated  ///< 401
};

/// Checks requests. A browser proves that it knows the token by opening /?token=TOKEN once, and afterwards by
/// a cookie, which scripts cannot read and pages of other servers cannot send.
class VPS_VIEWER_API WebAccess {
 public:
  /// @param host   host and port as a browser writes them: "127.0.0.1:8080"
  /// @param token  empty: no token is needed
  WebAccess(std::string host, std::string token, bool is_encrypted = false);

  [[nodiscard]] WebAnswer judge(const WebRequest& request) const;
  /// Value of the header Set-Cookie in the response to SetCookie.
  [[nodiscard]] std::string setCookie() const;
  /// The address that a user opens.
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

/// A random token: 128 bits as 32 hexadecimal digits.
VPS_VIEWER_API std::string newToken();

/// Least length of a user's own token, which may have letters, digits, '-' and '_'.
inline constexpr std::size_t kShortestToken = 16;
[[nodiscard]] VPS_VIEWER_API bool isGoodToken(std::string_view token);

/// Whether other machines cannot reach the address.
[[nodiscard]] VPS_VIEWER_API bool isLoopbackAddress(std::string_view address);

/// A rate limit (token bucket): the bucket fills at a constant rate up to its capacity, and each use takes
/// one.
class VPS_VIEWER_API RateLimit {
 public:
  RateLimit(double per_s, double burst) : per_s_(per_s), burst_(burst), left_(burst) {}
  /// Takes one. Returns false if the bucket is empty.
  bool take(double now_s);

 private:
  double per_s_, burst_, left_;
  double last_s_ = 0;
  bool has_time_ = false;
};

}  // namespace vps::viewer
