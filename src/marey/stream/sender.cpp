#include "marey/stream/sender.h"

#include <algorithm>
#include <utility>

namespace marey::stream {

DatagramWire::DatagramWire(const Target& target, StreamOptions options)
    : WireSink(target.wire, std::move(options)), to_(target.address(target.wire)) {
  net::Address any{.host = to_.is_loopback() ? net::kLoopback : 0, .port = 0};
  socket_ = datagrams_at(any, target.wire);
}

void DatagramWire::put_out(const std::vector<std::string>& datagrams) {
  const bool all =
      std::all_of(datagrams.begin(), datagrams.end(), [&](const std::string& each) { return send_to(socket_, to_, each); });
  ++(all ? sent_ : dropped_);
}

void DatagramWire::fill(WireReport& report) const {
  report.listens = false;
  report.sent = sent_;
  report.dropped = dropped_;
}

}  // namespace marey::stream
