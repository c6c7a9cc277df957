#include "marey/net/socket.h"

#include <cerrno>
#include <cstring>
#include <memory>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "marey/core/error.h"

namespace marey::net {
namespace {

sockaddr_in system_address(const Address& address) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(address.port);
  to.sin_addr.s_addr = htonl(address.host);
  return to;
}

void set_on(const Descriptor& socket, int level, int option) {
  const int on = 1;
  setsockopt(socket.get(), level, option, &on, sizeof on);
}

[[noreturn]] void refuse_bind(const Address& address, const std::string& what) {
  const int reason = errno;
  if (reason == EADDRINUSE)
    throw Error("{}: port {} of {} is in use by another program; stop that, or name another port", what, address.port,
                host_text(address.host));
  if (reason == EACCES)
    throw Error("{}: port {} may not be had without rights of the system; name one above 1023", what, address.port);
  if (reason == EADDRNOTAVAIL)
    throw Error("{}: {} is not an address of this host; name one of its own, or 0.0.0.0 for all", what, host_text(address.host));
  throw Error("{}: {} cannot be had ({})", what, to_string(address), std::strerror(reason));
}

/// Bound; the port that it got stands in `address`.
void bind_to(const Descriptor& socket, Address& address, const std::string& what) {
  sockaddr_in at = system_address(address);
  socklen_t size = sizeof at;
  if (bind(socket.get(), reinterpret_cast<sockaddr*>(&at), size) != 0) refuse_bind(address, what);
  if (getsockname(socket.get(), reinterpret_cast<sockaddr*>(&at), &size) == 0) address.port = ntohs(at.sin_port);
}

Descriptor socket_of(int type, const std::string& what) {
  Descriptor made(::socket(AF_INET, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!made) throw Error("{}: no socket can be had ({})", what, std::strerror(errno));
  return made;
}

}  // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  if (this != &other) {
    reset();
    number_ = other.release();
  }
  return *this;
}

int Descriptor::release() {
  const int number = number_;
  number_ = -1;
  return number;
}

void Descriptor::reset() {
  if (number_ >= 0) close(number_);
  number_ = -1;
}

std::string host_text(std::uint32_t host) {
  return fmt::format("{}.{}.{}.{}", host >> 24, host >> 16 & 255, host >> 8 & 255, host & 255);
}

std::string to_string(const Address& address) {
  return fmt::format("{}:{}", host_text(address.host), address.port);
}

std::uint32_t host_named(const std::string& name, const std::string& what) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(name.c_str(), nullptr, &hints, &found) != 0 || found == nullptr)
    throw Error("{}: no host is called \"{}\"; give an address, as 192.168.0.9", what, name);
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> keep(found, freeaddrinfo);
  return ntohl(reinterpret_cast<const sockaddr_in*>(found->ai_addr)->sin_addr.s_addr);
}

std::vector<std::uint32_t> own_hosts() {
  std::vector<std::uint32_t> hosts;
  ifaddrs* found = nullptr;
  if (getifaddrs(&found) != 0) return {kLoopback};
  for (const ifaddrs* each = found; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET) continue;
    hosts.push_back(ntohl(reinterpret_cast<const sockaddr_in*>(each->ifa_addr)->sin_addr.s_addr));
  }
  freeifaddrs(found);
  return hosts;
}

Descriptor listen_at(Address& address, const std::string& what) {
  Descriptor made = socket_of(SOCK_STREAM, what);
  set_on(made, SOL_SOCKET, SO_REUSEADDR);  // a port whose last connections are still being closed
  bind_to(made, address, what);
  if (listen(made.get(), 64) != 0) refuse_bind(address, what);
  return made;
}

std::optional<Descriptor> listen_at_digits(const std::string& address, int& port) {
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST | AI_PASSIVE;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(address.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) return std::nullopt;
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> keep(found, freeaddrinfo);
  Descriptor made(::socket(found->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!made) return made;
  set_on(made, SOL_SOCKET, SO_REUSEADDR);
  sockaddr_storage at{};
  socklen_t size = sizeof at;
  if (bind(made.get(), found->ai_addr, found->ai_addrlen) != 0 || listen(made.get(), SOMAXCONN) != 0 ||
      getsockname(made.get(), reinterpret_cast<sockaddr*>(&at), &size) != 0)
    return Descriptor();
  // The port stands at the same place in both kinds of address.
  port = ntohs(reinterpret_cast<const sockaddr_in*>(&at)->sin_port);
  return made;
}

Descriptor accept_from(const Descriptor& listener, Address& peer) {
  sockaddr_storage from{};
  socklen_t size = sizeof from;
  Descriptor socket(accept4(listener.get(), reinterpret_cast<sockaddr*>(&from), &size, SOCK_NONBLOCK | SOCK_CLOEXEC));
  peer = {};
  if (!socket || from.ss_family != AF_INET) return socket;
  const auto* at = reinterpret_cast<const sockaddr_in*>(&from);
  peer = {.host = ntohl(at->sin_addr.s_addr), .port = ntohs(at->sin_port)};
  return socket;
}

Descriptor datagrams_at(Address& address, const std::string& what, bool shared) {
  Descriptor made = socket_of(SOCK_DGRAM, what);
  if (shared) set_on(made, SOL_SOCKET, SO_REUSEADDR);
  bind_to(made, address, what);
  return made;
}

void send_groups_from(const Descriptor& socket, std::uint32_t host, const std::string& what) {
  const in_addr from{htonl(host)};
  const unsigned char hops = 1;
  setsockopt(socket.get(), IPPROTO_IP, IP_MULTICAST_TTL, &hops, sizeof hops);
  const unsigned char received = 1;
  setsockopt(socket.get(), IPPROTO_IP, IP_MULTICAST_LOOP, &received, sizeof received);
  if (host != 0 && setsockopt(socket.get(), IPPROTO_IP, IP_MULTICAST_IF, &from, sizeof from) != 0)
    throw Error("{}: the interface of {} takes no multicast ({}); name another address, or send to each client by itself", what,
                host_text(host), std::strerror(errno));
}

bool join_group(const Descriptor& socket, std::uint32_t group, std::uint32_t host) {
  ip_mreq required{};
  required.imr_multiaddr.s_addr = htonl(group);
  required.imr_interface.s_addr = htonl(host);
  return setsockopt(socket.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &required, sizeof required) == 0;
}

std::optional<Datagram> receive(const Descriptor& socket, std::size_t maximum) {
  Datagram came;
  came.bytes.resize(maximum);
  sockaddr_in from{};
  socklen_t size = sizeof from;
  const ssize_t got = recvfrom(socket.get(), came.bytes.data(), maximum, 0, reinterpret_cast<sockaddr*>(&from), &size);
  if (got < 0) return std::nullopt;
  came.bytes.resize(static_cast<std::size_t>(got));
  came.from = {.host = ntohl(from.sin_addr.s_addr), .port = ntohs(from.sin_port)};
  return came;
}

bool send_to(const Descriptor& socket, const Address& to, std::string_view bytes) {
  const sockaddr_in there = system_address(to);
  return sendto(socket.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&there), sizeof there) ==
         static_cast<ssize_t>(bytes.size());
}

}  // namespace marey::net
