// HTTPS before a server that speaks plain HTTP: browsers open a camera for a secure page alone. Its certificate is made when it
// begins, for this machine's addresses, and no authority signed it: the browser asks its user once whether to trust it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "marey/net/socket.h"

namespace marey::net {

class TlsFront {
 public:
  /// Listens at `at` (port 0: any that is free) and passes what comes, decrypted, to 127.0.0.1:`to`, and its answers back. Throws
  /// Error, which begins with `what`, if the port cannot be had.
  TlsFront(Address at, std::uint16_t to, const std::string& what);
  ~TlsFront();
  TlsFront(const TlsFront&) = delete;
  TlsFront& operator=(const TlsFront&) = delete;

  /// With the port that it got.
  const Address& address() const;
  /// SHA-256 of the certificate, "AB:CD:…", as browsers show it.
  const std::string& fingerprint() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace marey::net
