#include "marey/net/certificate.h"

#include <array>
#include <cstdint>

#include <fmt/format.h>
#include <openssl/ec.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>

#include "marey/core/error.h"
#include "marey/net/socket.h"

namespace marey::net {
namespace {

constexpr long kValid = 30L * 24 * 3600;  // s
constexpr long kBefore = 24L * 3600;      // s that the phone's clock may be late
constexpr long kVersion3 = 2;

void need(bool done) {
  if (!done) throw Error("no certificate can be made (OpenSSL refuses)");
}

/// "DNS:localhost,IP:127.0.0.1,IP:192.168.1.5".
std::string names_of_own_hosts() {
  std::string names = "DNS:localhost";
  for (const std::uint32_t host : own_hosts()) names += ",IP:" + host_text(host);
  return names;
}

void add_extension(X509* certificate, int kind, const std::string& value) {
  const std::unique_ptr<X509_EXTENSION, OpensslDeleter<X509_EXTENSION_free>> extension(
      X509V3_EXT_conf_nid(nullptr, nullptr, kind, value.c_str()));
  need(extension != nullptr && X509_add_ext(certificate, extension.get(), -1) == 1);
}

std::string fingerprint_of(const X509* certificate) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  need(X509_digest(certificate, EVP_sha256(), digest.data(), &size) == 1);
  return fmt::format("{:02X}", fmt::join(digest.begin(), digest.begin() + size, ":"));
}

}  // namespace

Certificate new_certificate() {
  Certificate made;
  made.key.reset(EVP_EC_gen("P-256"));
  made.certificate.reset(X509_new());
  need(made.key != nullptr && made.certificate != nullptr);
  X509* certificate = made.certificate.get();
  std::uint32_t serial = 0;
  need(RAND_bytes(reinterpret_cast<unsigned char*>(&serial), sizeof serial) == 1);
  need(X509_set_version(certificate, kVersion3) == 1);
  need(ASN1_INTEGER_set(X509_get_serialNumber(certificate), static_cast<long>(serial >> 1)) == 1);
  need(X509_gmtime_adj(X509_getm_notBefore(certificate), -kBefore) != nullptr);
  need(X509_gmtime_adj(X509_getm_notAfter(certificate), kValid) != nullptr);
  need(X509_set_pubkey(certificate, made.key.get()) == 1);
  X509_NAME* name = X509_get_subject_name(certificate);
  const std::string own = "Marey on this computer";
  need(X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_UTF8, reinterpret_cast<const unsigned char*>(own.data()),
                                  static_cast<int>(own.size()), -1, 0) == 1);
  need(X509_set_issuer_name(certificate, name) == 1);
  add_extension(certificate, NID_subject_alt_name, names_of_own_hosts());
  add_extension(certificate, NID_ext_key_usage, "serverAuth");
  need(X509_sign(certificate, made.key.get(), EVP_sha256()) != 0);
  made.fingerprint = fingerprint_of(certificate);
  return made;
}

}  // namespace marey::net
