// SPDX-License-Identifier: BSD-3-Clause
// The certificate with which the web server proves itself to browsers.
#pragma once

#include <boost/asio/ssl/context.hpp>
#include <memory>
#include <string>

namespace vps::viewer {

/// TLS 1.2 and later with a certificate, and those that follow it in the chain, and its key, both in PEM form
/// and the key without a passphrase. Throws LoadError where a file is missing or no such thing, the two do
/// not belong together, or the certificate is not valid today.
std::unique_ptr<boost::asio::ssl::context> tlsContext(const std::string& certificate_file,
                                                      const std::string& key_file);

}  // namespace vps::viewer
