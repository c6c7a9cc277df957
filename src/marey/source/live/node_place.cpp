#include <charconv>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/source/live/node.h"

namespace marey::source::live {

std::string NodeAddress::node() const {
  return fmt::format("node:{}:{}", host, port);
}

NodeAddress node_address(const Address& address) {
  AddressOptions(address).done();
  NodeAddress location;
  const std::size_t slash = address.location.find('/');
  location.host = address.location.substr(0, slash);
  if (slash != std::string::npos) location.camera = address.location.substr(slash + 1);
  const std::size_t colon = location.host.rfind(':');
  const bool has_port = colon != std::string::npos && location.host.find(']', colon) == std::string::npos;
  if (has_port) {
    const char *begin = location.host.data() + colon + 1, *end = location.host.data() + location.host.size();
    const auto [stop, error] = std::from_chars(begin, end, location.port);
    if (error != std::errc{} || stop != end || location.port < 1 || location.port > 65535)
      throw Error("{}: the port is not one; it is a whole number from 1 to 65535", address.text);
    location.host.resize(colon);
  }
  if (location.host.empty()) throw Error("{}: names no host; write node:HOST:{}/CAMERA", address.text, kNodePort);
  return location;
}

}  // namespace marey::source::live
