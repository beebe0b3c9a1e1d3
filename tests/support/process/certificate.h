// SPDX-License-Identifier: BSD-3-Clause
// Makes a certificate of a server on this machine for a test.
#pragma once

#include <openssl/ec.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rsa.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>

#include <memory>
#include <string>

namespace vps::test {

/// Writes NAME.pem and NAME.key into a folder: self-signed, for localhost and 127.0.0.1, valid between two
/// times relative to now [s]. If `rsa_bits` is 0, the key is on an elliptic curve.
inline void writeCertificate(const std::string& folder, const std::string& name, long from_s = -3600,
                             long to_s = 3600, unsigned rsa_bits = 0) {
  const std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)> key(
      rsa_bits > 0 ? EVP_RSA_gen(rsa_bits) : EVP_EC_gen("P-256"), EVP_PKEY_free);
  const std::unique_ptr<X509, decltype(&X509_free)> made(X509_new(), X509_free);
  X509_set_version(made.get(), X509_VERSION_3);
  ASN1_INTEGER_set(X509_get_serialNumber(made.get()), 1);
  X509_gmtime_adj(X509_getm_notBefore(made.get()), from_s);
  X509_gmtime_adj(X509_getm_notAfter(made.get()), to_s);
  X509_set_pubkey(made.get(), key.get());
  X509_NAME* subject = X509_get_subject_name(made.get());
  const auto* words = reinterpret_cast<const unsigned char*>("localhost");
  X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC, words, -1, -1, 0);
  X509_set_issuer_name(made.get(), subject);
  const std::unique_ptr<X509_EXTENSION, decltype(&X509_EXTENSION_free)> names(
      X509V3_EXT_conf_nid(nullptr, nullptr, NID_subject_alt_name, "DNS:localhost,IP:127.0.0.1"),
      X509_EXTENSION_free);
  X509_add_ext(made.get(), names.get(), -1);
  X509_sign(made.get(), key.get(), EVP_sha256());
  const auto write = [&](const std::string& end, const auto& put) {
    const std::unique_ptr<BIO, decltype(&BIO_free)> file(
        BIO_new_file((folder + "/" + name + end).c_str(), "w"), BIO_free);
    put(file.get());
  };
  write(".pem", [&](BIO* file) { PEM_write_bio_X509(file, made.get()); });
  write(".key",
        [&](BIO* file) { PEM_write_bio_PrivateKey(file, key.get(), nullptr, nullptr, 0, nullptr, nullptr); });
}

}  // namespace vps::test
