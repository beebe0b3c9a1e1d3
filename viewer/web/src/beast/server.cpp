// SPDX-License-Identifier: BSD-3-Clause
#include "beast/server.h"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "beast/connection.h"
#include "vps/errors.h"

namespace vps::viewer {

namespace {

namespace asio = boost::asio;
namespace ssl = boost::asio::ssl;
using asio::ip::tcp;
using ErrorCode = boost::system::error_code;

// A browser opens up to six connections for the files of a page.
constexpr std::size_t kConnectionsPerBrowser = 8;

std::string hostText(const tcp::endpoint& end) {
  const std::string address = end.address().to_string();
  return (end.address().is_v6() ? "[" + address + "]" : address) + ":" + std::to_string(end.port());
}

asio::ip::address addressOf(const std::string& text) {
  ErrorCode failed;
  const asio::ip::address address = asio::ip::make_address(text == "localhost" ? "127.0.0.1" : text, failed);
  if (failed || address.is_unspecified() || address.is_multicast())
    throw LoadError("", "",
                    "--listen " + text +
                        ": name one address of this machine, such as 192.168.1.20; `ip addr` "
                        "lists the addresses");
  return address;
}

std::string remedyFor(const ErrorCode& failed) {
  if (failed == boost::system::errc::address_not_available)
    return "--listen takes an address of this machine; `ip addr` lists the addresses";
  if (failed == boost::system::errc::permission_denied) return "choose a port above 1023";
  return "choose another port";
}

std::string tokenOf(const WebOptions& options, bool is_loopback) {
  if (options.token.empty()) return is_loopback ? std::string() : newToken();
  if (isGoodToken(options.token)) return options.token;
  throw LoadError("", "",
                  "the token is too easy to guess; use at least " + std::to_string(kShortestToken) +
                      " letters, digits, - and _");
}

constexpr const char* kHowToMake =
    "; to make a certificate for trials: openssl req -x509 -newkey rsa:2048 -nodes -days 30 -subj "
    "/CN=localhost "
    "-keyout key.pem -out cert.pem";

void requireReadable(const std::string& file) {
  std::ifstream stream(file);
  if (stream && stream.peek() != std::ifstream::traits_type::eof()) return;
  const std::string why =
      stream ? std::string("is empty") : "cannot be read: " + std::string(std::strerror(errno));
  throw LoadError(file, "", "(--tls) " + why + kHowToMake);
}

bool isTooWeak(const ErrorCode& failed) {
  const auto code = static_cast<unsigned long>(failed.value());
  if (!failed || ERR_GET_LIB(code) != ERR_LIB_SSL) return false;
  const int reason = ERR_GET_REASON(code);
  return reason == SSL_R_EE_KEY_TOO_SMALL || reason == SSL_R_CA_KEY_TOO_SMALL ||
         reason == SSL_R_CA_MD_TOO_WEAK;
}

void requireInTime(ssl::context& context, const std::string& file) {
  const X509* certificate = SSL_CTX_get0_certificate(context.native_handle());
  if (certificate == nullptr) return;
  if (X509_cmp_current_time(X509_get0_notAfter(certificate)) < 0)
    throw LoadError(file, "", "(--tls) has expired, and browsers refuse it; get a new certificate");
  if (X509_cmp_current_time(X509_get0_notBefore(certificate)) > 0)
    throw LoadError(file, "", "(--tls) is not valid yet; check the clock of this machine");
}

/// Context for TLS 1.2 and later with a certificate, the rest of its chain, and its key. Both files are in
/// PEM form, the key without a passphrase. Throws LoadError if a file is missing or has other contents, if
/// the key is not the certificate's, or if the certificate is not valid today.
std::unique_ptr<ssl::context> tlsContext(const std::string& certificate_file, const std::string& key_file) {
  requireReadable(certificate_file);
  requireReadable(key_file);
  auto context = std::make_unique<ssl::context>(ssl::context::tls_server);
  SSL_CTX_set_min_proto_version(context->native_handle(), TLS1_2_VERSION);
  ErrorCode failed;
  // Without this callback OpenSSL asks for the passphrase on the terminal.
  context->set_password_callback([](std::size_t, ssl::context::password_purpose) { return std::string(); },
                                 failed);
  context->use_certificate_chain_file(certificate_file, failed);
  if (isTooWeak(failed))
    throw LoadError(
        certificate_file, "",
        "(--tls) has a key or a signature that is too weak for OpenSSL; make a key of 2048 bits or more");
  if (failed) throw LoadError(certificate_file, "", "(--tls) holds no certificate in PEM form");
  requireInTime(*context, certificate_file);
  // This call also compares the key with the certificate, and fails if the key is of another kind.
  context->use_private_key_file(key_file, ssl::context::pem, failed);
  const bool is_other = failed && ERR_GET_LIB(static_cast<unsigned long>(failed.value())) == ERR_LIB_X509;
  if (is_other || (!failed && SSL_CTX_check_private_key(context->native_handle()) != 1))
    throw LoadError(key_file, "",
                    "(--tls) is not the key of " + certificate_file +
                        "; use a certificate and a key that belong together");
  if (failed)
    throw LoadError(key_file, "",
                    "(--tls) holds no private key in PEM form without a passphrase; `openssl pkey -in FILE` "
                    "removes a passphrase");
  return context;
}

}  // namespace

struct WebServer::Impl {
  Impl(WatchedRun& run, const WebOptions& given)
      : options(given), hub(run, given.rate_hz), acceptor(io), timer(io) {
    if (!page.missing().empty()) throw LoadError("", "", page.missing());
    const asio::ip::address address = addressOf(options.address);
    if (!given.tls_certificate.empty()) tls = tlsContext(given.tls_certificate, given.tls_key);
    const std::string token = tokenOf(options, address.is_loopback());
    ErrorCode failed;
    const tcp::endpoint end(address, options.port);
    acceptor.open(end.protocol(), failed);
    acceptor.set_option(asio::socket_base::reuse_address(true), failed);
    acceptor.bind(end, failed);
    if (!failed) acceptor.listen(asio::socket_base::max_listen_connections, failed);
    if (failed)
      throw LoadError(
          "", "", "cannot listen at " + hostText(end) + ": " + failed.message() + "; " + remedyFor(failed));
    access.emplace(hostText(acceptor.local_endpoint()), token, tls != nullptr);
    shared.emplace(WebShared{hub, page, *access, options.most_browsers, tls.get()});
    hub.poll(webClock_s());  // so that the first request finds the parts
    accept();
    wait();
  }
  ~Impl() { shared->is_over = true; }

  void accept() {
    acceptor.async_accept([this](ErrorCode failed, tcp::socket socket) {
      if (failed == asio::error::operation_aborted) return;
      const bool has_room = shared->connections < kConnectionsPerBrowser * options.most_browsers;
      if (!failed && has_room) serveConnection(std::move(socket), *shared);
      accept();
    });
  }
  void wait() {
    const auto period = std::chrono::duration<double>(0.5 / options.rate_hz);
    timer.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(period));
    timer.async_wait([this](ErrorCode failed) {
      if (failed) return;
      if (options.stop != nullptr && options.stop->load()) return io.stop();
      hub.poll(webClock_s());
      wait();
    });
  }

  WebOptions options;
  WebPage page;
  WebHub hub;
  std::unique_ptr<asio::ssl::context> tls;  ///< null: without encryption
  std::optional<WebAccess> access;
  std::optional<WebShared> shared;
  asio::io_context io{1};  // destroyed before the members that its handlers use
  tcp::acceptor acceptor;
  asio::steady_timer timer;
};

WebServer::WebServer(WatchedRun& run, const WebOptions& options)
    : impl_(std::make_unique<Impl>(run, options)) {}
WebServer::~WebServer() = default;

std::string WebServer::address() const {
  return impl_->access->address();
}
std::uint16_t WebServer::port() const {
  return impl_->acceptor.local_endpoint().port();
}
void WebServer::serve() {
  impl_->io.run();
}

std::string missingForWeb() {
  return WebPage().missing();
}

namespace {

void serveRun(WatchedRun& run, const WebOptions& options) {
  WebServer server(run, options);
  if (options.say) options.say("open " + server.address());
  server.serve();
}

}  // namespace

void serveSession(const WebOptions& options) {
  serveRun(*watchedSession(options), options);
}
void serveScene(const scenes::Scene& scene, const WebOptions& options) {
  serveRun(*watchedScene(scene, options), options);
}
void serveRecording(const device::RecordedRun& run, const WebOptions& options) {
  serveRun(*watchedRecording(run), options);
}

}  // namespace vps::viewer
