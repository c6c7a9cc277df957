// The wires of one run: opened together, forwarded as sinks, asked at the end the result.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "marey/stream/protocols.h"

namespace marey::stream {

class Streams {
 public:
  /// Takes all ports, so that one that is in use is reported before anything begins. Throws WrongTarget, Error.
  explicit Streams(const std::vector<std::string>& targets, StreamOptions options = {});

  bool empty() const { return protocols_.empty(); }
  /// A sink for each, to be owned by the one who runs; the wires live on with this.
  std::vector<std::unique_ptr<Sink>> sinks() const;
  /// When instants are captured, by the steady clock: to be set by who knows.
  CaptureClock& clock() const { return *clock_; }
  std::vector<StreamReport> reports() const;

 private:
  std::shared_ptr<CaptureClock> clock_;
  std::vector<std::shared_ptr<ProtocolSink>> protocols_;
};

/// "qtm at 127.0.0.1:22223: 2 clients, 1200 frames sent, 3 dropped; p50 0.05 ms, p99 0.21 ms".
std::string to_string(const StreamReport& report);

}  // namespace marey::stream
