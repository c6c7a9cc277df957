#include "marey/stream/sender.h"

#include <algorithm>
#include <utility>

namespace marey::stream {

UdpProtocol::UdpProtocol(const Target& target, StreamOptions options)
    : ProtocolSink(target.protocol, std::move(options)), to_(target.address(target.protocol)) {
  net::Address any{.host = to_.is_loopback() ? net::kLoopback : 0, .port = 0};
  socket_ = datagrams_at(any, target.protocol);
}

void UdpProtocol::put_out(const std::vector<std::string>& datagrams) {
  const bool all =
      std::all_of(datagrams.begin(), datagrams.end(), [&](const std::string& each) { return send_to(socket_, to_, each); });
  ++(all ? sent_ : dropped_);
}

void UdpProtocol::fill(StreamReport& report) const {
  report.listens = false;
  report.sent = sent_;
  report.dropped = dropped_;
}

}  // namespace marey::stream
