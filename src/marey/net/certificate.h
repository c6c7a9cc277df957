// A certificate that this machine makes for itself.
#pragma once

#include <memory>
#include <string>

#include <openssl/evp.h>
#include <openssl/x509.h>

namespace marey::net {

/// For a std::unique_ptr to what OpenSSL frees by `Free`.
template <auto Free>
struct OpensslDeleter {
  template <typename T>
  void operator()(T* object) const {
    Free(object);
  }
};

struct Certificate {
  std::unique_ptr<EVP_PKEY, OpensslDeleter<EVP_PKEY_free>> key;
  std::unique_ptr<X509, OpensslDeleter<X509_free>> certificate;
  std::string fingerprint;  ///< SHA-256, "AB:CD:…"
};

/// Of an elliptic curve (P-256), for localhost and all addresses of this machine's interfaces, for 30 days. Throws Error if OpenSSL
/// cannot.
Certificate new_certificate();

}  // namespace marey::net
