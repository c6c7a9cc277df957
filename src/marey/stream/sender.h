#pragma once

#include <string>
#include <vector>

#include "marey/stream/protocols.h"

namespace marey::stream {

/// A wire that sends datagrams to one address, whether a client is there or not.
class UdpProtocol : public ProtocolSink {
 public:
  /// Throws Error, which begins with the wire's name, where there is no such host.
  UdpProtocol(const Target& target, StreamOptions options);
  ~UdpProtocol() override { loop().stop(); }

  std::string where() const override { return to_string(to_); }

 protected:
  void start() override {}
  /// Each to be sent alone. An instant counts as sent where all of it was taken.
  void put_out(const std::vector<std::string>& datagrams);
  void fill(StreamReport& report) const override;

 private:
  net::Address to_;
  net::Descriptor socket_;
  std::int64_t sent_ = 0, dropped_ = 0;
};

}  // namespace marey::stream
