#pragma once

#include <string>
#include <vector>

#include "marey/stream/wires.h"

namespace marey::stream {

/// A wire that sends datagrams to one address, whether anybody is there or not.
class DatagramWire : public WireSink {
 public:
  /// Throws Error, which begins with the wire's name, where there is no such host.
  DatagramWire(const Target& target, StreamOptions options);
  ~DatagramWire() override { loop().stop(); }

  std::string where() const override { return to_string(to_); }

 protected:
  void start() override {}
  /// Each to be sent alone. A moment counts as sent where all of it was taken.
  void put_out(const std::vector<std::string>& datagrams);
  void fill(WireReport& report) const override;

 private:
  net::Address to_;
  net::Descriptor socket_;
  std::int64_t sent_ = 0, dropped_ = 0;
};

}  // namespace marey::stream
