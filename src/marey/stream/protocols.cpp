#include "marey/stream/protocols.h"

#include <algorithm>
#include <charconv>
#include <vector>

#include <fmt/format.h>

#include "marey/files/text_safety.h"

// One line a wire. Each stands at the end of its own file.
// clang-format off
#define MAREY_PROTOCOLS(row) \
  row(qtm) \
  row(natnet) \
  row(natnet_unicast) \
  row(vmc) \
  row(osc) \
  row(lsl) \
  row(foxglove) \
  row(json)
// clang-format on

namespace marey::stream {

#define MAREY_PROTOCOL_DECLARED(name) StreamProtocol name##_protocol();
MAREY_PROTOCOLS(MAREY_PROTOCOL_DECLARED)

std::span<const StreamProtocol> protocols() {
#define MAREY_PROTOCOL_CALLED(name) name##_protocol(),
  static const std::vector<StreamProtocol> all = {MAREY_PROTOCOLS(MAREY_PROTOCOL_CALLED)};
  return all;
}

std::string protocol_names(std::string_view between) {
  std::string names;
  for (const StreamProtocol& protocol : protocols()) names.append(names.empty() ? "" : between).append(protocol.name);
  return names;
}

Target parse_target(std::string_view text) {
  const auto refuse = [&](std::string_view why) {
    throw WrongTarget("\"{}\" {}; write WIRE, WIRE:HOST or WIRE:HOST:PORT, as qtm, vmc:192.168.0.9 or json:0.0.0.0:7000",
                      plain_text(text), why);
  };
  const std::size_t colon = std::min(text.find(':'), text.size());
  const auto protocol = std::find_if(protocols().begin(), protocols().end(),
                                     [&](const StreamProtocol& each) { return each.name == text.substr(0, colon); });
  if (protocol == protocols().end())
    throw WrongTarget("\"{}\" is not a wire; there are {}", plain_text(text.substr(0, colon)), protocol_names(", "));
  Target target{.protocol = std::string(protocol->name), .port = protocol->port};
  if (colon == text.size()) return target;
  std::string_view rest = text.substr(colon + 1);
  const std::size_t second = std::min(rest.find(':'), rest.size());
  const std::string_view host = rest.substr(0, second);
  if (host.size() > 255 || host.find_first_of(" /\\@[]") != std::string_view::npos) refuse("names no host of IPv4");
  if (!host.empty()) target.host = host;
  if (second == rest.size()) {
    if (host.empty()) refuse("names no host");
    return target;
  }
  const std::string_view port = rest.substr(second + 1);
  unsigned number = 0;
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (error != std::errc() || end != port.data() + port.size() || number > 65'535) refuse("names no port in [0, 65535]");
  if (number == 0 && !protocol->listens) refuse("names no port to send to");
  target.port = static_cast<std::uint16_t>(number);
  return target;
}

std::unique_ptr<ProtocolSink> open_protocol(const Target& target, const StreamOptions& options) {
  const auto protocol = std::find_if(protocols().begin(), protocols().end(),
                                     [&](const StreamProtocol& each) { return each.name == target.protocol; });
  if (protocol == protocols().end())
    throw WrongTarget("\"{}\" is not a wire; there are {}", plain_text(target.protocol), protocol_names(", "));
  return protocol->open(target, options);
}

std::string protocol_table() {
  std::string table = "| `--stream` | wire | port | HOST is | what goes over it |\n| --- | --- | --- | --- | --- |\n";
  for (const StreamProtocol& protocol : protocols()) {
    table += fmt::format("| `{}` | {} | {} | {} | {} |\n", protocol.name, protocol.title, protocol.port,
                         protocol.listens ? "where it listens" : "whom it sends to", protocol.detail);
  }
  return table;
}

void take_counts(StreamReport& report, const net::Server::Counts& counts) {
  report.clients = counts.clients;
  report.now = counts.now;
  report.sent = counts.sent;
  report.dropped = counts.dropped;
  report.refused = counts.refused;
  report.disconnected_clients = counts.disconnected;
  if (counts.disconnected > 0)
    report.notes.push_back(fmt::format("the last client that was disconnected: {}", plain_text(counts.last_complaint)));
}

}  // namespace marey::stream
