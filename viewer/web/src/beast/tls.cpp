// SPDX-License-Identifier: BSD-3-Clause
#include "beast/tls.h"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "vps/errors.h"

namespace vps::viewer {

namespace {

namespace ssl = boost::asio::ssl;
using ErrorCode = boost::system::error_code;

constexpr const char* kHowToMake =
    "; one for trials is made by: openssl req -x509 -newkey rsa:2048 -nodes -days 30 -subj /CN=localhost "
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

}  // namespace

std::unique_ptr<ssl::context> tlsContext(const std::string& certificate_file, const std::string& key_file) {
  requireReadable(certificate_file);
  requireReadable(key_file);
  auto context = std::make_unique<ssl::context>(ssl::context::tls_server);
  SSL_CTX_set_min_proto_version(context->native_handle(), TLS1_2_VERSION);
  ErrorCode failed;
  // Without this OpenSSL asks the terminal for the passphrase.
  context->set_password_callback([](std::size_t, ssl::context::password_purpose) { return std::string(); },
                                 failed);
  context->use_certificate_chain_file(certificate_file, failed);
  if (isTooWeak(failed))
    throw LoadError(
        certificate_file, "",
        "(--tls) has a key or a signature that is too weak for OpenSSL; make one of 2048 bits or more");
  if (failed) throw LoadError(certificate_file, "", "(--tls) holds no certificate in PEM form");
  requireInTime(*context, certificate_file);
  // OpenSSL compares the key with the certificate here, too; the kind of key may differ as well.
  context->use_private_key_file(key_file, ssl::context::pem, failed);
  const bool is_other = failed && ERR_GET_LIB(static_cast<unsigned long>(failed.value())) == ERR_LIB_X509;
  if (is_other || (!failed && SSL_CTX_check_private_key(context->native_handle()) != 1))
    throw LoadError(key_file, "",
                    "(--tls) is not the key of " + certificate_file + "; give the two that belong together");
  if (failed)
    throw LoadError(key_file, "",
                    "(--tls) holds no private key in PEM form without a passphrase; `openssl pkey -in FILE` "
                    "removes one");
  return context;
}

}  // namespace vps::viewer
