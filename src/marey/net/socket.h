// Sockets of this host, and what goes wrong with them as sentences. IPv4: every protocol here is spoken over it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace marey::net {

/// A file descriptor that is closed when it goes.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { reset(); }
  Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  int get() const { return number_; }
  explicit operator bool() const { return number_ >= 0; }
  int release();
  void reset();

 private:
  int number_ = -1;
};

/// An address and a port, in this machine's byte order: 127.0.0.1 is 0x7f000001.
struct Address {
  std::uint32_t host = 0;
  std::uint16_t port = 0;

  bool is_loopback() const { return host >> 24 == 127; }
  bool is_multicast() const { return host >> 28 == 14; }
  auto operator<=>(const Address&) const = default;
};

inline constexpr std::uint32_t kLoopback = 0x7f000001;

/// "127.0.0.1:22223".
std::string to_string(const Address& address);
std::string host_text(std::uint32_t host);
/// Of "127.0.0.1" or of a name that the system knows. `what` begins the sentence of the Error for an unknown address.
std::uint32_t host_named(const std::string& name, const std::string& what);
/// Those of this host's interfaces, loopback's too.
std::vector<std::uint32_t> own_hosts();

/// Listening, not waiting, closed on exec; `address.port` becomes the one it got where it was 0. Throws Error, which begins with
/// `what`, where the port is in use or may not be had.
Descriptor listen_at(Address& address, const std::string& what);
/// Of IPv4 or IPv6, at an address in digits. Nothing if the text is not an address, or with the system's reason in errno if it
/// cannot be had.
std::optional<Descriptor> listen_at_digits(const std::string& address, int& port);
/// The next client, whose socket does not block; none with errno set. `peer` is 0.0.0.0 for a client of IPv6.
Descriptor accept_from(const Descriptor& listener, Address& peer);
/// Of UDP, likewise bound. `shared`: other programs of this host may bind the port too, as discovery by multicast needs it.
Descriptor datagrams_at(Address& address, const std::string& what, bool shared = false);
/// Sends to groups go out of the interface of that address, are received on this host, and pass one hop. Throws Error if the
/// interface has no multicast.
void send_groups_from(const Descriptor& socket, std::uint32_t host, const std::string& what);
/// Whether the group is received on the interface of that address from now on.
bool join_group(const Descriptor& socket, std::uint32_t group, std::uint32_t host);

/// A datagram that came, cut off at `most` bytes; nothing if none waits.
struct Datagram {
  std::string bytes;
  Address from;
};
std::optional<Datagram> receive(const Descriptor& socket, std::size_t maximum);
/// Whether the system took it whole. It never waits.
bool send_to(const Descriptor& socket, const Address& to, std::string_view bytes);

/// What a datagram carries at most.
inline constexpr std::size_t kMaxDatagram = 65'507;

}  // namespace marey::net
