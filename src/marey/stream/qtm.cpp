// Qualisys' real-time protocol: what QTM's clients speak (qtm-rt, qualisys_cpp_sdk, ROS drivers). TCP on the little-endian port,
// and frames over UDP where a client asks for them; found by those that search for servers.
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/stream/bytes.h"
#include "marey/stream/protocols.h"
#include "marey/stream/qtm_session.h"

namespace marey::stream {
namespace {

constexpr std::uint16_t kLittleEndianPort = 22'223, kDiscoveryPort = 22'226;

class QtmProtocol : public ProtocolSink {
 public:
  QtmProtocol(const Target& target, StreamOptions options)
      : ProtocolSink("qtm", std::move(options)),
        server_(loop(), target.address("qtm"), "qtm", {.max_clients = 10, .max_bytes = kQtmMaxBytes},
                [this](const net::Address& client) { return std::make_unique<QtmSession>(state_, client); }) {
    net::Address any{.host = server_.address().host, .port = 0};
    datagrams_ = datagrams_at(any, "qtm");
    state_.header = &header();
    state_.channel_layout = &channel_layout();
    state_.allow_control = this->options().allow_control;
    state_.record = this->options().record;
    if (server_.address().port == kLittleEndianPort) listen_for_searches();
  }
  ~QtmProtocol() override { loop().stop(); }

  std::string where() const override { return to_string(server_.address()); }

 protected:
  void start() override {
    loop().on_tick([this] { server_.tick(); });
  }

  void labels_grew() override {
    if (!begun_) return;
    server_.each([](net::Session& session, net::Outbox& out) {
      if (static_cast<QtmSession&>(session).streaming()) out.answer(qtm_event_packet(QtmEvent::settings_changed));
    });
  }

  void send(const Instant& instant, FrameTimes) override {
    if (!state_.newest) state_.newest.emplace();
    state_.newest->index = instant.index;
    state_.newest->time = instant.time;
    state_.newest->samples = instant.samples;
    state_.newest->bodies = instant.bodies;
    channel_layout().location(instant, scene_);
    packets_.clear();
    server_.each([&](net::Session& session, net::Outbox& out) {
      auto& client = static_cast<QtmSession&>(session);
      if (!client.is_due(instant)) return;
      const auto packet = packet_of(client.streaming()->components, instant);
      const auto to = client.datagrams_to();
      if (!to) return out.frame({.body = packet});
      (packet->size() <= net::kMaxDatagram && send_to(datagrams_, *to, *packet) ? udp_sent_ : udp_dropped_) += 1;
    });
    begun_ = true;
  }

  void report_goodbye() override {
    server_.each([](net::Session& session, net::Outbox& out) {
      if (static_cast<QtmSession&>(session).streaming()) out.answer(qtm_packet(QtmPacket::no_more_data, {}));
      out.answer(qtm_event_packet(QtmEvent::shutting_down));
      out.end();
    });
  }

  void drain() override { server_.drain(kDrainMs); }

  void fill(StreamReport& report) const override {
    take_counts(report, server_.counts());
    report.sent += udp_sent_;
    report.dropped += udp_dropped_;
    if (!note_.empty()) report.notes.push_back(note_);
  }

 private:
  /// Clients mostly ask for the same: a packet is made once for all of them.
  std::shared_ptr<const std::string> packet_of(const QtmComponents& components, const Instant& instant) {
    auto& packet = packets_[{components.required, components.global_skeletons}];
    if (packet == nullptr)
      packet = std::make_shared<const std::string>(qtm_data_packet(channel_layout(), scene_, instant, components));
    return packet;
  }

  /// Other programs may hold that port; then this server is not found by searching, and serves all the same.
  void listen_for_searches() {
    net::Address at{.host = server_.address().host, .port = kDiscoveryPort};
    try {
      searches_ = datagrams_at(at, "qtm", true);
    } catch (const Error& error) {
      note_ = fmt::format("{}; clients that search for servers do not find this one", error.what());
      return;
    }
    loop().watch(searches_.get(), [this] {
      while (const auto search = receive(searches_, 64)) answer_search(*search);
      return true;
    });
  }

  void answer_search(const net::Datagram& search) {
    const auto size = number_at<std::uint32_t>(search.bytes, 0), type = number_at<std::uint32_t>(search.bytes, 4);
    const auto port = number_at<std::uint16_t, std::endian::big>(search.bytes, 8);
    if (size != 10u || type != static_cast<std::uint32_t>(QtmPacket::discover) || !port || *port == 0) return;
    std::string body = "Marey, QTM 2.17, 1 cameras";
    body += '\0';
    const auto base = bytes_of<std::endian::big>(static_cast<std::uint16_t>(server_.address().port - 1));
    body.append(base.data(), base.size());
    send_to(searches_, {.host = search.from.host, .port = *port}, qtm_packet(QtmPacket::command, body));
  }

  QtmState state_;
  net::Server server_;
  net::Descriptor datagrams_, searches_;
  ChannelLayout::Scene scene_;
  std::map<std::pair<std::vector<QtmComponent>, bool>, std::shared_ptr<const std::string>> packets_;  // of this instant
  std::int64_t udp_sent_ = 0, udp_dropped_ = 0;
  std::string note_;
  bool begun_ = false;
};

}  // namespace

StreamProtocol qtm_protocol() {
  return {.name = "qtm",
          .title = "Qualisys RT 1.25 (TCP, UDP)",
          .port = kLittleEndianPort,
          .detail = "labelled and other points (3D, 3DRes, 3DNoLabels), bodies (6D, 6DEuler), skeletons; mm, z up; lost is NaN",
          .open = [](const Target& target, const StreamOptions& options) -> std::unique_ptr<ProtocolSink> {
            return std::make_unique<QtmProtocol>(target, options);
          }};
}

}  // namespace marey::stream
