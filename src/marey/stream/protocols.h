// The register of wires: what `--stream` takes. A wire is one file, which ends with its row; the line that names it is in
// protocols.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "marey/core/error.h"
#include "marey/net/server.h"
#include "marey/net/socket.h"
#include "marey/stream/protocol_sink.h"

namespace marey::stream {

/// The request names no known wire, or no address: the command line is wrong.
class WrongTarget : public Error {
 public:
  using Error::Error;
};

/// Where a wire listens, or what it sends to.
struct Target {
  std::string protocol;
  std::string host = "127.0.0.1";
  std::uint16_t port = 0;

  /// Throws Error, which begins with `what`, where no host has that name.
  net::Address address(const std::string& what) const { return {.host = net::host_named(host, what), .port = port}; }
};

/// A row of the register.
struct StreamProtocol {
  std::string_view name;    ///< in `--stream`
  std::string_view title;   ///< for people
  std::uint16_t port = 0;   ///< where none is named
  bool listens = true;      ///< at its address; else it sends there
  std::string_view detail;  ///< for docs/streams.md: what goes over it, units, axes
  std::unique_ptr<ProtocolSink> (*open)(const Target& target, const StreamOptions& options) = nullptr;
};

std::span<const StreamProtocol> protocols();

/// "qtm", "vmc:192.168.0.9", "json:0.0.0.0:7000"; port 0 is any that is free. Throws WrongTarget, which lists the wires.
Target parse_target(std::string_view text);

/// Takes the wire's port. Throws Error if it cannot be had.
std::unique_ptr<ProtocolSink> open_protocol(const Target& target, const StreamOptions& options = {});

/// "qtm|natnet|…", for the help.
std::string protocol_names(std::string_view between = "|");

/// The table of docs/streams.md: Markdown, a row a wire.
std::string protocol_table();

/// How long clients are given at the end to take the data in transit to them, ms.
inline constexpr int kDrainMs = 500;
/// What a server counted, into a report.
void take_counts(StreamReport& report, const net::Server::Counts& counts);

}  // namespace marey::stream
