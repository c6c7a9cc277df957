// NatNet 4.1, which OptiTrack's clients speak: commands by UDP at its port, frames to the port above it of a multicast group, or to
// each client that connected. Clients of both kinds appear alike when they connect, so each kind is a wire of its own.
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "marey/stream/natnet_packets.h"
#include "marey/stream/protocols.h"

namespace marey::stream {
namespace {

constexpr std::uint16_t kCommandPort = 1510;
constexpr std::uint32_t kGroup = 0xefff2a63;  // 239.255.42.99
constexpr std::size_t kMaxClients = 10;
constexpr std::int64_t kForgottenNs = 30'000'000'000;  // a client that said nothing for this long is gone

class NatNetProtocol : public ProtocolSink {
 public:
  NatNetProtocol(const Target& target, StreamOptions options, bool multicast)
      : ProtocolSink(target.protocol, std::move(options)), at_(target.address(target.protocol)), multicast_(multicast) {
    commands_ = datagrams_at(at_, protocol());
    data_port_ = static_cast<std::uint16_t>(at_.port == 65'535 ? 1024 : at_.port + 1);
    if (multicast_) send_groups_from(commands_, at_.host, protocol());
    loop().watch(commands_.get(), [this] { return answer_all(); });
  }
  ~NatNetProtocol() override { loop().stop(); }

  std::string where() const override {
    return multicast_ ? fmt::format("{}, frames to {}:{}", to_string(at_), net::host_text(kGroup), data_port_) : to_string(at_);
  }

 protected:
  void start() override {
    loop().on_tick(
        [this] { std::erase_if(clients_, [](const auto& client) { return steady_now_ns() - client.second > kForgottenNs; }); });
  }

  void send(const Instant& instant, FrameTimes times) override {
    channel_layout().location(instant, scene_);
    newest_ = natnet_frame(channel_layout(), scene_, instant, times);
    if (newest_.empty()) {
      ++too_large_;
      return;
    }
    if (multicast_) count(send_to(commands_, {.host = kGroup, .port = data_port_}, newest_));
    if (!multicast_) {
      for (const auto& [client, received] : clients_) count(send_to(commands_, client, newest_));
    }
  }

  void fill(StreamReport& report) const override {
    report.clients = came_;
    report.now = std::ssize(clients_);
    report.sent = sent_;
    report.dropped = dropped_ + too_large_;
    report.refused = refused_;
    if (too_large_ > 0) report.notes.push_back(fmt::format("{} frames were larger than a datagram and were not sent", too_large_));
  }

 private:
  void count(bool sent) { ++(sent ? sent_ : dropped_); }

  bool answer_all() {
    for (int i = 0; i < 64; ++i) {  // then others' turn
      const auto came = receive(commands_, 2048);
      if (!came) break;
      if (const auto message = natnet_received(came->bytes)) answer(*message, came->from);
    }
    return true;
  }

  void answer(const NatNetReceived& message, const net::Address& from) {
    switch (message.message) {
      case NatNetMessage::connect:
        if (!listen(from)) return;
        send_to(commands_, from, natnet_server_info(data_port_, multicast_ ? std::optional(kGroup) : std::nullopt));
        return;
      case NatNetMessage::keep_alive:
        listen(from);
        return;
      case NatNetMessage::request:
        send_to(commands_, from, natnet_response(message.payload));
        return;
      case NatNetMessage::query_definitions:
        if (clients_.contains(from)) send_to(commands_, from, natnet_definitions(channel_layout()));
        return;
      case NatNetMessage::query_frame:
        if (clients_.contains(from)) send_to(commands_, from, newest_);
        return;
      case NatNetMessage::disconnect:
        clients_.erase(from);
        return;
      default:
        return;
    }
  }

  /// Who speaks is a client, unless there are too many.
  bool listen(const net::Address& from) {
    const auto known = clients_.find(from);
    if (known == clients_.end() && clients_.size() >= kMaxClients) {
      ++refused_;
      return false;
    }
    if (known == clients_.end()) ++came_;
    clients_[from] = steady_now_ns();
    return true;
  }

  net::Address at_;
  bool multicast_;
  net::Descriptor commands_;
  std::uint16_t data_port_ = 0;
  std::map<net::Address, std::int64_t> clients_;  // when they were received last
  ChannelLayout::Scene scene_;
  std::string newest_;
  std::int64_t came_ = 0, refused_ = 0, sent_ = 0, dropped_ = 0, too_large_ = 0;
};

template <bool multicast>
std::unique_ptr<ProtocolSink> open_natnet(const Target& target, const StreamOptions& options) {
  return std::make_unique<NatNetProtocol>(target, options, multicast);
}

}  // namespace

StreamProtocol natnet_protocol() {
  return {
      .name = "natnet",
      .title = "NatNet 4.1 by multicast",
      .port = kCommandPort,
      .detail = "labelled and other markers, rigid bodies, skeletons, definitions, ticks of capture, solution and sending; m, y up",
      .open = open_natnet<true>};
}

StreamProtocol natnet_unicast_protocol() {
  return {.name = "natnet-unicast",
          .title = "NatNet 4.1 to each client that connects",
          .port = kCommandPort,
          .detail = "the same",
          .open = open_natnet<false>};
}

}  // namespace marey::stream
