#include <charconv>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/source/live/node.h"

namespace marey::source::live {

std::string NodePlace::node() const {
  return fmt::format("node:{}:{}", host, port);
}

NodePlace node_place(const Address& address) {
  AddressOptions(address).done();
  NodePlace place;
  const std::size_t slash = address.place.find('/');
  place.host = address.place.substr(0, slash);
  if (slash != std::string::npos) place.camera = address.place.substr(slash + 1);
  const std::size_t colon = place.host.rfind(':');
  const bool has_port = colon != std::string::npos && place.host.find(']', colon) == std::string::npos;
  if (has_port) {
    const char *begin = place.host.data() + colon + 1, *end = place.host.data() + place.host.size();
    const auto [stop, error] = std::from_chars(begin, end, place.port);
    if (error != std::errc{} || stop != end || place.port < 1 || place.port > 65535)
      throw Error("{}: the port is none; it is a whole number from 1 to 65535", address.text);
    place.host.resize(colon);
  }
  if (place.host.empty()) throw Error("{}: names no host; write node:HOST:{}/CAMERA", address.text, kNodePort);
  return place;
}

}  // namespace marey::source::live
