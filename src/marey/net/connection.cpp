// The one source that knows HTTP's and the WebSocket's bytes, by Boost.Beast. A connection passes through phases: bytes, or a
// request and its answer, again and again, until a request becomes a WebSocket.
#include "marey/net/connection.h"

#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/net/locked_executor.h"
#include "marey/net/whole_writes.h"

namespace marey::net {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Code = beast::error_code;
using Request = http::request<http::empty_body>;
using WebSocket = websocket::stream<WholeWrites, false>;
using Clock = std::chrono::steady_clock;

constexpr int kSilentTicks = 2;
constexpr std::chrono::seconds kGoodbye{1};  // for a client to close its side too
constexpr std::size_t kReadAtOnce = 16'384;

std::string text_of(beast::string_view text) {
  return {text.data(), text.size()};
}

std::array<asio::const_buffer, 2> buffers_of(const Outbox::Message& message, std::size_t begun = 0) {
  const std::size_t of_head = std::min(begun, message.head.size());
  const std::string_view body = message.body_bytes().substr(begun - of_head);
  return {asio::buffer(message.head) + of_head, asio::buffer(body.data(), body.size())};
}

HttpRequest request_of(const Request& from) {
  HttpRequest request{.method = text_of(from.method_string()),
                      .target = text_of(from.target()),
                      .host = text_of(from[http::field::host]),
                      .origin = text_of(from[http::field::origin]),
                      .cookie = text_of(from[http::field::cookie]),
                      .authorization = text_of(from[http::field::authorization]),
                      .upgrade = websocket::is_upgrade(from)};
  for (const auto& protocol : http::token_list(from[http::field::sec_websocket_protocol]))
    request.protocols.push_back(text_of(protocol));
  return request;
}

std::string head_of(const HttpAnswer& answer, std::size_t body_size, bool keep) {
  std::string head = fmt::format("HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\n", answer.status,
                                 text_of(http::obsolete_reason(http::int_to_status(static_cast<unsigned>(answer.status)))),
                                 answer.type, body_size);
  for (const auto& [name, value] : answer.fields) head += name + ": " + value + "\r\n";
  return head + (keep ? "\r\n" : "Connection: close\r\n\r\n");
}

/// Whether a WebSocket ended as they do, and not because its client broke the protocol.
bool is_plain_end(const Code& why) {
  return why == websocket::error::closed || why.category() != make_error_code(websocket::error::closed).category();
}

class TcpConnection final : public Connection, public std::enable_shared_from_this<TcpConnection> {
 public:
  TcpConnection(Loop& loop, Descriptor socket, const ServerOptions& options, std::unique_ptr<Session> session)
      : Connection(std::move(session)),
        options_(options),
        socket_(std::in_place, loop.parts().executor),
        buffer_(2 * options.max_request) {
    Code failed;
    socket_->assign(Tcp::v4(), socket.get(), failed);  // one of IPv6 is read and written likewise
    over_ = bool(failed);
    if (over_) return;
    socket.release();
    socket_->non_blocking(true, failed);
  }

  void start() override {
    if (over_) return;
    out_.on_change([this] { flush(); });
    if (options_.protocol == Protocol::web) return read_request(options_.patience);
    if (options_.protocol == Protocol::bytes) begin_bytes();
    read_bytes();
  }

  void tick() override {
    if (over_) return;
    if (deadline_ && Clock::now() > *deadline_) return close();
    if (phase_ == Phase::undecided && ++ticks_ >= kSilentTicks) begin_bytes();
    if (phase_ == Phase::bytes || phase_ == Phase::web) session_->tick(out_);
  }

  void close() override {
    if (over_) return;
    over_ = true;
    out_.discard();
    Code ignored;
    socket().close(ignored);
  }

 private:
  enum class Phase { undecided, bytes, request, answer, opening, web };

  template <typename Handler>
  auto guarded(Handler handler) {
    return [self = shared_from_this(), handler](const Code& failed, std::size_t count = 0) {
      if (!self->over_) handler(failed, count);
    };
  }

  Socket& socket() { return web_ ? web_->next_layer().next_layer() : *socket_; }

  /// Sends it off, with what explains that to it.
  void disconnect(const std::string& complaint) {
    complaint_ = complaint;
    unread_.clear();
    out_.end();
  }

  // Bytes.

  void begin_bytes() {
    phase_ = Phase::bytes;
    session_->joined(out_);
  }

  void read_bytes() {
    chunk_.resize(kReadAtOnce);
    socket_->async_read_some(asio::buffer(chunk_), guarded([this](const Code& failed, std::size_t count) {
                               if (failed) return close();
                               if (!out_.is_ending()) take_bytes(std::string_view(chunk_).substr(0, count));
                               if (!over_ && phase_ != Phase::request) read_bytes();
                             }));
  }

  void take_bytes(std::string_view came) {
    unread_.append(came);
    if (phase_ == Phase::undecided) {
      if (unread_.size() < 4) return;
      if (unread_.starts_with("GET ")) {
        buffer_.commit(asio::buffer_copy(buffer_.prepare(std::min(unread_.size(), buffer_.max_size())), asio::buffer(unread_)));
        return read_request(options_.patience);
      }
      begin_bytes();
    }
    try {
      while (!unread_.empty() && !over_ && !out_.is_ending()) {
        const std::size_t done = session_->received(unread_, out_);
        if (done == 0) break;
        unread_.erase(0, done);
      }
      if (unread_.size() > options_.max_bytes) throw Error("{} bytes that make no message", unread_.size());
    } catch (const Error& complaint) {
      disconnect(complaint.what());
    }
  }

  // HTTP.

  void read_request(std::chrono::seconds patience) {
    phase_ = Phase::request;
    deadline_ = Clock::now() + patience;
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(options_.max_request));
    http::async_read(*socket_, buffer_, *parser_, guarded([this](const Code& failed, std::size_t) { take_request(failed); }));
  }

  void take_request(const Code& failed) {
    const bool of_http = failed.category() == make_error_code(http::error::bad_method).category();
    if (of_http && failed != http::error::end_of_stream && failed != http::error::partial_message)
      return answer(refusal(400, "this is not an HTTP request"), false, false);
    if (failed) return close();
    request_ = parser_->release();
    // RFC 6455 asks for this field too; clients that leave it out were always served.
    if (http::token_list(request_[http::field::upgrade]).exists("websocket") && request_.count(http::field::connection) == 0)
      request_.set(http::field::connection, "upgrade");
    const HttpAnswer stated = session_->requested(request_of(request_));
    if (stated.upgrade) return open(stated);
    answer(stated, request_.keep_alive(), request_.method() == http::verb::head);
  }

  void answer(const HttpAnswer& stated, bool keep, bool head_only) {
    keep_ = keep && stated.keep;
    if (stated.status >= 400 && !stated.keep && stated.body) complaint_ = stated.body->substr(0, stated.body->find('\n'));
    phase_ = Phase::answer;
    deadline_ = Clock::now() + options_.idle;
    out_.answer({.head = head_of(stated, stated.body ? stated.body->size() : 0, keep_), .body = head_only ? nullptr : stated.body});
  }

  void answered() {
    if (keep_) return read_request(options_.idle);
    Code ignored;
    socket_->shutdown(Tcp::socket::shutdown_send, ignored);
    close();
  }

  // A WebSocket.

  void open(const HttpAnswer& stated) {
    if (buffer_.size() > 0) return answer(refusal(400, "a WebSocket's messages come after its opening was answered"), false, false);
    phase_ = Phase::opening;
    deadline_.reset();
    web_.emplace(std::move(*socket_));
    socket_.reset();
    const bool pings = options_.silence.count() > 0;
    web_->set_option(websocket::stream_base::timeout{
        options_.patience, pings ? Clock::duration(options_.silence) : websocket::stream_base::none(), pings});
    web_->set_option(websocket::stream_base::decorator([protocol = stated.protocol](websocket::response_type& response) {
      if (!protocol.empty()) response.set(http::field::sec_websocket_protocol, protocol);
    }));
    web_->read_message_max(options_.max_message);
    buffer_.max_size(options_.max_message + 1);
    web_->auto_fragment(false);
    web_->async_accept(request_, guarded([this](const Code& failed, std::size_t) {
                         if (failed) return close();
                         phase_ = Phase::web;
                         session_->opened(out_);
                         flush();  // frames that were sent between the answer and this
                         if (!over_) read_message();
                       }));
  }

  void read_message() {
    web_->async_read(buffer_, guarded([this](const Code& failed, std::size_t) {
                       if (failed && !is_plain_end(failed)) complaint_ = failed.message();
                       if (failed) return close();
                       take_message();
                       if (!over_) read_message();
                     }));
  }

  void take_message() {
    const auto data = buffer_.cdata();
    if (!out_.is_ending()) {
      try {
        session_->message({static_cast<const char*>(data.data()), data.size()}, web_->got_text() ? Kind::text : Kind::binary, out_);
      } catch (const Error& complaint) {
        disconnect(complaint.what());
      }
    }
    buffer_.consume(buffer_.size());
  }

  // Both ways of sending.

  void flush() {
    if (over_) return;
    if (out_.is_overfull()) {
      complaint_ = "left its answers unread";
      return close();
    }
    if (writing_) return;
    if (phase_ == Phase::web) return write_messages();
    if (phase_ != Phase::opening) write_bytes();
  }

  /// As much as the system takes at once.
  void write_bytes() {
    while (const Outbox::Message* next = out_.begin_next()) {
      Code failed;
      begun_ += socket_->write_some(buffers_of(*next, begun_), failed);
      if (failed == asio::error::would_block) return wait_to_write();
      if (failed && failed != asio::error::interrupted) return close();
      if (begun_ < next->size()) continue;
      begun_ = 0;
      out_.done();
      if (phase_ == Phase::answer) return answered();
    }
    if (out_.is_ending()) close();
  }

  void write_messages() {
    while (const Outbox::Message* next = out_.begin_next()) {
      Code failed;
      web_->text(next->kind == Kind::text);
      web_->write(buffers_of(*next), failed);
      if (failed) return close();
      if (web_->next_layer().has_rest()) return wait_to_write();
      out_.done();
    }
    if (!out_.is_ending() || std::exchange(closing_, true)) return;
    deadline_ = Clock::now() + kGoodbye;
    const auto why = complaint_.empty() ? websocket::close_code::normal : websocket::close_code::policy_error;
    web_->async_close(why, guarded([this](const Code&, std::size_t) { close(); }));
  }

  void wait_to_write() {
    writing_ = true;
    socket().async_wait(Socket::wait_write, guarded([this](const Code& failed, std::size_t) {
                          writing_ = false;
                          Code now_failed = failed;
                          if (!failed && web_) {
                            web_->next_layer().flush(now_failed);
                            if (!now_failed && web_->next_layer().has_rest()) return wait_to_write();
                            if (!now_failed) out_.done();
                          }
                          if (now_failed) return close();
                          flush();
                        }));
  }

  const ServerOptions options_;
  Phase phase_ = Phase::undecided;
  std::optional<Socket> socket_;  // until it is the WebSocket's
  std::optional<WebSocket> web_;
  std::optional<Clock::time_point> deadline_;
  int ticks_ = 0;

  std::string chunk_, unread_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::empty_body>> parser_;
  Request request_;
  bool keep_ = false;

  bool writing_ = false, closing_ = false;
  std::size_t begun_ = 0;  // bytes that have gone out of the message that is being sent
};

}  // namespace

std::shared_ptr<Connection> make_connection(Loop& loop, Descriptor socket, const ServerOptions& options,
                                            std::unique_ptr<Session> session) {
  return std::make_shared<TcpConnection>(loop, std::move(socket), options, std::move(session));
}

}  // namespace marey::net
