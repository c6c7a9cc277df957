#include "marey/stream/wires.h"

#include <algorithm>
#include <charconv>
#include <vector>

#include <fmt/format.h>

#include "marey/core/text_safety.h"

// One line a wire. Each stands at the end of its own file.
// clang-format off
#define MAREY_WIRES(row) \
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

#define MAREY_WIRE_DECLARED(name) Wire name##_wire();
MAREY_WIRES(MAREY_WIRE_DECLARED)

std::span<const Wire> wires() {
#define MAREY_WIRE_CALLED(name) name##_wire(),
  static const std::vector<Wire> all = {MAREY_WIRES(MAREY_WIRE_CALLED)};
  return all;
}

std::string wire_names(std::string_view between) {
  std::string names;
  for (const Wire& wire : wires()) names.append(names.empty() ? "" : between).append(wire.name);
  return names;
}

Target parse_target(std::string_view text) {
  const auto refuse = [&](std::string_view why) {
    throw WrongTarget("\"{}\" {}; write WIRE, WIRE:HOST or WIRE:HOST:PORT, as qtm, vmc:192.168.0.9 or json:0.0.0.0:7000",
                      plain_text(text), why);
  };
  const std::size_t colon = std::min(text.find(':'), text.size());
  const auto wire =
      std::find_if(wires().begin(), wires().end(), [&](const Wire& each) { return each.name == text.substr(0, colon); });
  if (wire == wires().end())
    throw WrongTarget("\"{}\" is no wire; there are {}", plain_text(text.substr(0, colon)), wire_names(", "));
  Target target{.wire = std::string(wire->name), .port = wire->port};
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
  if (number == 0 && !wire->listens) refuse("names no port to send to");
  target.port = static_cast<std::uint16_t>(number);
  return target;
}

std::unique_ptr<WireSink> open_wire(const Target& target, const StreamOptions& options) {
  const auto wire = std::find_if(wires().begin(), wires().end(), [&](const Wire& each) { return each.name == target.wire; });
  if (wire == wires().end()) throw WrongTarget("\"{}\" is no wire; there are {}", plain_text(target.wire), wire_names(", "));
  return wire->open(target, options);
}

std::string wire_table() {
  std::string table = "| `--stream` | wire | port | HOST is | what goes over it |\n| --- | --- | --- | --- | --- |\n";
  for (const Wire& wire : wires()) {
    table += fmt::format("| `{}` | {} | {} | {} | {} |\n", wire.name, wire.title, wire.port,
                         wire.listens ? "where it listens" : "whom it sends to", wire.detail);
  }
  return table;
}

void take_counts(WireReport& report, const net::Server::Counts& counts) {
  report.clients = counts.clients;
  report.now = counts.now;
  report.sent = counts.sent;
  report.dropped = counts.dropped;
  report.refused = counts.refused;
  report.sent_off = counts.disconnected;
  if (counts.disconnected > 0)
    report.notes.push_back(fmt::format("the last client that was sent off: {}", plain_text(counts.last_complaint)));
}

}  // namespace marey::stream
