// JSON, one object a line: for scripts. A client that connects gets the header and then a frame a line; one that opens a WebSocket
// gets the same as messages.
#include <memory>
#include <utility>

#include "marey/stream/json_text.h"
#include "marey/stream/server.h"
#include "marey/stream/websocket.h"
#include "marey/stream/wires.h"

namespace marey::stream {
namespace {

/// Says nothing in the first moment: a browser speaks first, and would take our line for a broken answer.
class JsonSession : public Session {
 public:
  explicit JsonSession(const std::string& header) : header_(header) {}

  std::size_t received(std::string_view bytes, Outbox& out) override {
    if (kind_ == Kind::unknown && bytes.size() >= 4) kind_ = bytes.starts_with("GET ") ? Kind::web : Kind::lines;
    if (kind_ == Kind::unknown) return 0;
    if (kind_ == Kind::lines) {
      greet(out);
      return bytes.size();  // nothing is asked of a client, nothing heeded
    }
    return socket_.received(bytes, out, [&] { greet(out); }, [](std::string_view) {});
  }

  void tick(Outbox& out) override {
    if (kind_ == Kind::unknown && ++ticks_ > 1) kind_ = Kind::lines;
    if (kind_ == Kind::lines) greet(out);
  }

  void header_changed(Outbox& out) {
    if (greeted_) say_header(out);
  }

  void frame(const std::shared_ptr<const std::string>& line, Outbox& out) {
    if (greeted_) out.frame(kind_ == Kind::web ? frame_head(Opcode::text, line->size()) : std::string(), line);
  }

 private:
  enum class Kind { unknown, lines, web };

  void greet(Outbox& out) {
    if (!greeted_) say_header(out);
    greeted_ = true;
  }
  void say_header(Outbox& out) {
    out.answer((kind_ == Kind::web ? frame_head(Opcode::text, header_.size()) : std::string()) + header_);
  }

  const std::string& header_;
  Kind kind_ = Kind::unknown;
  int ticks_ = 0;
  bool greeted_ = false;
  WebSocket socket_;
};

class JsonWire : public WireSink {
 public:
  JsonWire(const Target& target, StreamOptions options)
      : WireSink("json", std::move(options)),
        server_(loop(), target.address("json"), "json", 64, 65'536 + 64,
                [this](const Address&) { return std::make_unique<JsonSession>(line_); }) {}
  ~JsonWire() override { loop().stop(); }

  std::string where() const override { return to_string(server_.address()); }

 protected:
  bool takes_pixels() const override { return true; }
  void start() override {
    line_ = json_header(header(), cast()) + "\n";
    loop().on_tick([this] { server_.tick(); });
  }
  void labels_grew() override {
    line_ = json_header(header(), cast()) + "\n";
    server_.each([](Session& session, Outbox& out) { static_cast<JsonSession&>(session).header_changed(out); });
  }
  void send(const Instant& instant, FrameTimes times) override {
    std::shared_ptr<const std::string> line;  // made where anybody is there
    server_.each([&](Session& session, Outbox& out) {
      if (line == nullptr) line = std::make_shared<const std::string>(json_frame(header(), cast(), instant, times) + "\n");
      static_cast<JsonSession&>(session).frame(line, out);
    });
  }
  void drain() override { server_.drain(kDrainMs); }
  void fill(WireReport& report) const override { take_counts(report, server_.counts()); }

 private:
  std::string line_;
  Server server_;
};

}  // namespace

Wire json_wire() {
  return {
      .name = "json",
      .title = "JSON lines over TCP, or a WebSocket",
      .port = 8766,
      .detail =
          "one object a line: a header, then a frame each with points, bodies and its times; positions in m, z up (px of pictures)",
      .open = [](const Target& target, const StreamOptions& options) -> std::unique_ptr<WireSink> {
        return std::make_unique<JsonWire>(target, options);
      }};
}

}  // namespace marey::stream
