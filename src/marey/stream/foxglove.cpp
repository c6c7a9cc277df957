// The Foxglove WebSocket: what the Foxglove app and Lichtblick open. Topics as in MCAP files (format/mcap). Both names of the
// protocol are accepted: they are one protocol, and clients ask for the one or the other.
#include <array>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/mcap/foxglove_messages.h"
#include "marey/net/server.h"
#include "marey/stream/foxglove_requests.h"
#include "marey/stream/protocols.h"
#include "marey/stream/web_access.h"

namespace marey::stream {
namespace {

constexpr int kStatusTicks = 10;  // a second between two sentences
constexpr std::size_t kMaxSubscriptions = 64;

class FoxgloveSession : public net::Session {
 public:
  explicit FoxgloveSession(const std::string& session) : session_(session) {}

  net::HttpAnswer requested(const net::HttpRequest& request) override {
    return answer_to_upgrade(request, {"foxglove.sdk.v1", "foxglove.websocket.v1"});
  }

  void opened(net::Outbox& out) override {
    announce(foxglove_server_info("Marey", session_), out);
    announce(foxglove_advertisement(), out);
  }

  void message(std::string_view text, net::Kind, net::Outbox& out) override {
    const auto request = foxglove_request(text);
    if (!request) return;
    for (const auto& [id, channel] : request->subscribe) {
      if (channel < 1 || channel > format::mcap::topics().size() || topic_of_.size() >= kMaxSubscriptions) {
        announce(foxglove_status(1, fmt::format("there is no channel {} to subscribe to", channel)), out);
        continue;
      }
      topic_of_[id] = channel - 1;
    }
    for (const std::uint32_t id : request->unsubscribe) topic_of_.erase(id);
  }

  void tick(net::Outbox& out) override {
    if (++ticks_ % kStatusTicks != 0) return;
    const std::int64_t lost = out.frames_dropped() - reported_;
    if (lost <= 0) return;
    reported_ = out.frames_dropped();
    announce(foxglove_status(1, fmt::format("{} messages were dropped, because this client is too slow for them", lost)), out);
  }

  /// `message_of` makes a topic's message where a client has subscribed to it.
  template <typename MessageOf>
  void frame(std::uint64_t time_ns, const MessageOf& message_of, net::Outbox& out) const {
    for (const auto& [id, topic] : topic_of_) {
      const std::shared_ptr<const std::string>& message = message_of(topic);
      if (message->empty()) continue;
      out.frame({.head = foxglove_data_head(id, time_ns), .body = message});
    }
  }

 private:
  static void announce(const std::string& text, net::Outbox& out) { out.answer(text, net::Kind::text); }

  const std::string& session_;
  std::map<std::uint32_t, std::size_t> topic_of_;  // of a subscription
  int ticks_ = 0;
  std::int64_t reported_ = 0;
};

class FoxgloveProtocol : public ProtocolSink {
 public:
  FoxgloveProtocol(const Target& target, StreamOptions options)
      : ProtocolSink("foxglove", std::move(options)),
        session_(fmt::format("{}", wall_now_ns())),
        server_(loop(), target.address("foxglove"), "foxglove", {.protocol = net::Protocol::web},
                [this](const net::Address&) { return std::make_unique<FoxgloveSession>(session_); }) {}
  ~FoxgloveProtocol() override { loop().stop(); }

  std::string where() const override { return to_string(server_.address()); }

 protected:
  void start() override {
    messages_.begin(header());
    loop().on_tick([this] { server_.tick(); });
  }

  void send(const Instant& instant, FrameTimes times) override {
    messages_.add(instant.named);
    const std::int64_t wall = wall_now_ns() - steady_now_ns();
    const format::mcap::MessageTimes stamps{
        .stamp = times.capture + wall, .capture = times.capture, .solve = times.solve, .send = times.send};
    std::array<std::shared_ptr<const std::string>, 4> made;
    const auto message_of = [&](std::size_t topic) -> const std::shared_ptr<const std::string>& {
      if (made[topic] == nullptr) made[topic] = std::make_shared<const std::string>(messages_.message(topic, instant, stamps));
      return made[topic];
    };
    server_.each([&](net::Session& session, net::Outbox& out) {
      static_cast<FoxgloveSession&>(session).frame(static_cast<std::uint64_t>(stamps.stamp), message_of, out);
    });
  }

  void drain() override { server_.drain(kDrainMs); }
  void fill(StreamReport& report) const override { take_counts(report, server_.counts()); }

 private:
  std::string session_;
  format::mcap::FoxgloveMessages messages_;
  net::Server server_;
};

}  // namespace

StreamProtocol foxglove_protocol() {
  return {.name = "foxglove",
          .title = "Foxglove WebSocket",
          .port = 8765,
          .detail =
              "`/marey/points` (PointCloud), `/tf` (FrameTransforms), `/marey/scene` (SceneUpdate), protobuf; `/marey/times` "
              "(JSON); m, z up",
          .open = [](const Target& target, const StreamOptions& options) -> std::unique_ptr<ProtocolSink> {
            return std::make_unique<FoxgloveProtocol>(target, options);
          }};
}

}  // namespace marey::stream
