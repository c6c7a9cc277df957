// JSON, one object a line: for scripts. A client that connects gets the header and then a frame a line; one that opens a WebSocket
// gets the same as messages.
#include <memory>
#include <utility>

#include "marey/net/server.h"
#include "marey/stream/json_text.h"
#include "marey/stream/protocols.h"
#include "marey/stream/web_access.h"

namespace marey::stream {
namespace {

/// Says nothing in the first moment: a browser speaks first, and would take our line for a broken answer.
class JsonSession : public net::Session {
 public:
  explicit JsonSession(const std::string& header) : header_(header) {}

  void joined(net::Outbox& out) override { greet(out); }
  /// Nothing is asked of a client, nothing heeded.
  std::size_t received(std::string_view bytes, net::Outbox&) override { return bytes.size(); }
  net::HttpAnswer requested(const net::HttpRequest& request) override { return answer_to_upgrade(request); }
  void opened(net::Outbox& out) override { greet(out); }

  void header_changed(net::Outbox& out) const {
    if (greeted_) out.answer(header_, net::Kind::text);
  }

  void frame(const std::shared_ptr<const std::string>& line, net::Outbox& out) const {
    if (greeted_) out.frame({.body = line, .kind = net::Kind::text});
  }

 private:
  void greet(net::Outbox& out) {
    greeted_ = true;
    out.answer(header_, net::Kind::text);
  }

  const std::string& header_;
  bool greeted_ = false;
};

class JsonProtocol : public ProtocolSink {
 public:
  JsonProtocol(const Target& target, StreamOptions options)
      : ProtocolSink("json", std::move(options)),
        server_(loop(), target.address("json"), "json", {.protocol = net::Protocol::either},
                [this](const net::Address&) { return std::make_unique<JsonSession>(line_); }) {}
  ~JsonProtocol() override { loop().stop(); }

  std::string where() const override { return to_string(server_.address()); }

 protected:
  bool takes_pixels() const override { return true; }
  void start() override {
    line_ = json_header(header(), channel_layout()) + "\n";
    loop().on_tick([this] { server_.tick(); });
  }
  void labels_grew() override {
    line_ = json_header(header(), channel_layout()) + "\n";
    server_.each([](net::Session& session, net::Outbox& out) { static_cast<JsonSession&>(session).header_changed(out); });
  }
  void send(const Instant& instant, FrameTimes times) override {
    std::shared_ptr<const std::string> line;  // made where there is a client
    server_.each([&](net::Session& session, net::Outbox& out) {
      if (line == nullptr)
        line = std::make_shared<const std::string>(json_frame(header(), channel_layout(), instant, times) + "\n");
      static_cast<JsonSession&>(session).frame(line, out);
    });
  }
  void drain() override { server_.drain(kDrainMs); }
  void fill(StreamReport& report) const override { take_counts(report, server_.counts()); }

 private:
  std::string line_;
  net::Server server_;
};

}  // namespace

StreamProtocol json_protocol() {
  return {
      .name = "json",
      .title = "JSON lines over TCP, or a WebSocket",
      .port = 8766,
      .detail =
          "one object a line: a header, then a frame each with points, bodies and its times; positions in m, z up (px of images)",
      .open = [](const Target& target, const StreamOptions& options) -> std::unique_ptr<ProtocolSink> {
        return std::make_unique<JsonProtocol>(target, options);
      }};
}

}  // namespace marey::stream
