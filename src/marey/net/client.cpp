#include "marey/net/client.h"

#include <algorithm>
#include <deque>
#include <thread>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/error.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "marey/core/error.h"
#include "marey/core/stop.h"

namespace marey::net {
namespace {

namespace ip = boost::asio::ip;
using ClientCode = boost::beast::error_code;
using ClientExecutor = boost::asio::io_context::executor_type;
using ClientSocket = boost::asio::basic_stream_socket<ip::tcp, ClientExecutor>;
using ClientClock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kTryAgain{50};

}  // namespace

struct WebSocketClient::Parts {
  using Stream = boost::beast::websocket::stream<ClientSocket, false>;

  explicit Parts(const ClientOptions& how) : options(how) {}

  /// Runs until `is_done`, at most until `end`. Returns whether it is. Throws Stopped.
  template <typename Done>
  bool run_until(ClientClock::time_point end, const std::stop_token& stop, Done is_done) {
    while (!is_done()) {
      if (stop.stop_requested()) throw Stopped();
      const auto now = ClientClock::now();
      if (now >= end) return false;
      context.restart();
      context.run_one_until(std::min(end, now + kStopSlice));
    }
    return true;
  }

  ClientCode connect_once(const std::string& host, int port, ClientClock::time_point end, const std::stop_token& stop) {
    stream.emplace(context.get_executor());
    std::optional<ClientCode> done;
    const auto step = [&] {
      if (run_until(end, stop, [&] { return done.has_value(); })) return *std::exchange(done, std::nullopt);
      return ClientCode(boost::asio::error::timed_out);
    };
    ip::basic_resolver<ip::tcp, ClientExecutor> resolver(context.get_executor());
    ip::basic_resolver<ip::tcp, ClientExecutor>::results_type found;
    resolver.async_resolve(host, std::to_string(port), [&](const ClientCode& failed, auto results) {
      found = std::move(results);
      done = failed;
    });
    if (const ClientCode failed = step()) return failed;
    boost::asio::async_connect(stream->next_layer(), found,
                               [&](const ClientCode& failed, const ip::tcp::endpoint&) { done = failed; });
    if (const ClientCode failed = step()) return failed;
    ClientCode ignored;
    stream->next_layer().set_option(ip::tcp::no_delay(true), ignored);
    const bool pings = options.silence.count() > 0;
    stream->set_option(boost::beast::websocket::stream_base::timeout{
        options.connect, pings ? ClientClock::duration(options.silence) : boost::beast::websocket::stream_base::none(), pings});
    stream->read_message_max(options.max_message);
    stream->async_handshake(host.find(':') == std::string::npos ? host : "[" + host + "]", "/",
                            [&](const ClientCode& failed) { done = failed; });
    return step();
  }

  void read() {
    incoming.emplace(message);
    stream->async_read(*incoming, [this](const ClientCode& failed, std::size_t) {
      if (failed) {
        gone = failed;
        return;
      }
      came = std::exchange(message, {});
    });
  }

  void write() {
    stream->text(true);
    stream->async_write(boost::asio::buffer(outgoing.front()), [this](const ClientCode& failed, std::size_t) {
      outgoing.pop_front();
      if (failed) {
        gone = failed;
      } else if (!outgoing.empty()) {
        write();
      }
    });
  }

  void check() const {
    if (gone) throw Error("{}", gone.message());
  }

  ClientOptions options;
  std::string message;
  std::optional<boost::asio::dynamic_string_buffer<char, std::char_traits<char>, std::allocator<char>>> incoming;  // of `message`
  std::optional<std::string> came;
  std::deque<std::string> outgoing;
  ClientCode gone;
  // Before the stream, which is a part of it.
  boost::asio::io_context context{1};
  std::optional<Stream> stream;
};

WebSocketClient::WebSocketClient(const std::string& host, int port, const ClientOptions& options, const std::stop_token& stop) {
  const bool brackets = host.size() > 2 && host.front() == '[' && host.back() == ']';
  const std::string name = brackets ? host.substr(1, host.size() - 2) : host;
  const auto end = ClientClock::now() + options.connect;
  for (;;) {
    parts_ = std::make_unique<Parts>(options);
    const ClientCode failed = parts_->connect_once(name, port, end, stop);
    if (!failed) break;
    const bool refused = failed.category() == boost::system::system_category();
    if (!refused || ClientClock::now() + kTryAgain >= end) throw Error("{}", failed.message());
    std::this_thread::sleep_for(kTryAgain);
  }
  parts_->read();
}

WebSocketClient::~WebSocketClient() = default;

void WebSocketClient::send(const std::string& text) {
  parts_->check();
  parts_->outgoing.push_back(text);
  if (parts_->outgoing.size() == 1) parts_->write();
}

std::optional<std::string> WebSocketClient::receive(std::chrono::milliseconds wait) {
  const auto end = ClientClock::now() + wait;
  Parts& parts = *parts_;
  while (!parts.came && !parts.gone) {
    parts.context.restart();
    const std::size_t ran = wait.count() > 0 ? parts.context.run_one_until(end) : parts.context.poll_one();
    if (ran == 0) break;
  }
  if (!parts.came) {
    parts.check();
    return std::nullopt;
  }
  std::optional<std::string> message = std::exchange(parts.came, std::nullopt);
  parts.read();
  return message;
}

}  // namespace marey::net
