// The one source that includes Boost.Beast. One thread runs everything here; only what `publish` brings comes from others, by way
// of one slot a topic, so that a server that is busy holds nobody up and gathers nothing.
#include "web_server.h"

#include <array>
#include <atomic>
#include <chrono>
#include <deque>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/basic_stream.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "marey/core/error.h"

#include "access.h"

namespace marey::viewer {
namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Tcp = net::ip::tcp;
using Executor = net::io_context::executor_type;
using Stream = beast::basic_stream<Tcp, Executor>;
using Socket = websocket::stream<Stream, false>;
using Code = beast::error_code;
using Request = http::request<http::empty_body>;

constexpr int kMostConnections = 64;
constexpr std::uint32_t kMostHeaderBytes = 8192;
constexpr std::size_t kMostReceivedBytes = 4096;
constexpr int kSendBuffer = 1 << 18;  // bytes in the kernel: what lies there is old when it arrives
constexpr std::chrono::seconds kPatience{10}, kIdle{30};
/// Nothing is loaded from elsewhere, and nobody puts the page into one of theirs.
constexpr const char* kPolicy =
    "default-src 'self'; img-src 'self' blob: data:; style-src 'self' 'unsafe-inline'; frame-ancestors 'none'; base-uri 'none'";

std::string text_of(beast::string_view text) {
  return {text.data(), text.size()};
}

RequestHead head_of(const Request& request) {
  return {.method = text_of(request.method_string()),
          .target = text_of(request.target()),
          .host = text_of(request[http::field::host]),
          .origin = text_of(request[http::field::origin]),
          .cookie = text_of(request[http::field::cookie]),
          .authorization = text_of(request[http::field::authorization]),
          .upgrade = websocket::is_upgrade(request)};
}

/// The address by which others reach a machine that listens on all of its own.
std::string first_outer_address() {
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return "127.0.0.1";
  std::string found = "127.0.0.1";
  for (const ifaddrs* each = all; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET) continue;
    const auto* in = reinterpret_cast<const sockaddr_in*>(each->ifa_addr);
    const auto address = net::ip::address_v4(ntohl(in->sin_addr.s_addr));
    if (address.is_loopback()) continue;
    found = address.to_string();
    break;
  }
  freeifaddrs(all);
  return found;
}

std::vector<std::string> names_of_this_machine() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0 || name.front() == '\0') return {};
  return {name.data(), std::string(name.data()) + ".local"};
}

net::ip::address listened_address(const std::string& listen) {
  if (listen == "localhost") return net::ip::address_v4::loopback();
  Code failed;
  const auto address = net::ip::make_address(listen, failed);
  if (failed)
    throw Error("\"{}\" is no address to listen on; give one of this machine's in digits, or 0.0.0.0 for all of them", listen);
  return address;
}

}  // namespace

class WebServer::Core {
 public:
  Core(const WebPlace& place, Handlers handlers);
  ~Core() {
    context_.stop();
    if (thread_.joinable()) thread_.join();
  }

  void start() {
    accept();
    thread_ = std::thread([this] { context_.run(); });
  }
  std::string address() const;
  void publish(Message message, std::function<bool(PageId)> wants);
  void send(PageId page, Message message);
  Count count() const { return {sent_, dropped_, pages_}; }

 private:
  class Visit;
  class Page;
  struct Published {
    Message message;
    std::function<bool(PageId)> wants;
  };

  void listen(const WebPlace& place);
  void accept();
  void hand_out();

  Handlers handlers_;
  std::optional<Access> access_;
  std::string shown_host_;
  std::atomic<std::uint64_t> sent_ = 0, dropped_ = 0;
  std::atomic<int> pages_ = 0;
  int connections_ = 0;
  std::uint64_t last_page_ = 0;
  std::map<PageId, Page*> open_;

  std::mutex mutex_;
  std::map<int, Published> published_;  // by topic: the newest
  bool waking_ = false;

  // Destroyed first, with all that it still holds: the visits and the pages, which look at what stands above.
  net::io_context context_{1};
  net::basic_socket_acceptor<Tcp, Executor> acceptor_{context_};
  net::steady_timer again_{context_};
  std::thread thread_;
};

/// A WebSocket.
class WebServer::Core::Page : public std::enable_shared_from_this<Page> {
 public:
  Page(Core& core, Stream stream) : core_(core), socket_(std::move(stream)), id_(PageId{++core.last_page_}) {
    ++core_.connections_;
  }
  ~Page() {
    --core_.connections_;
    if (!open_) return;
    core_.open_.erase(id_);
    --core_.pages_;
    if (core_.handlers_.left) core_.handlers_.left(id_);
  }

  void open(const Request& request) {
    beast::get_lowest_layer(socket_).expires_never();
    socket_.set_option(websocket::stream_base::timeout{kPatience, kIdle, true});
    socket_.read_message_max(kMostReceivedBytes);
    socket_.auto_fragment(false);
    socket_.async_accept(request, [self = shared_from_this()](Code failed) {
      if (!failed) self->opened();
    });
  }

  void put(const Message& message) {
    const auto [slot, fresh] = slots_.insert_or_assign(message.topic, message);
    if (fresh) {
      order_.push_back(message.topic);
    } else {
      ++core_.dropped_;
    }
    if (!writing_) write();
  }

 private:
  void opened() {
    open_ = true;
    core_.open_[id_] = this;
    ++core_.pages_;
    if (core_.handlers_.joined) core_.handlers_.joined(id_);
    read();
  }

  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](Code failed, std::size_t) {
      if (failed) return;
      if (self->core_.handlers_.received && self->socket_.got_text()) {
        const auto data = self->buffer_.cdata();
        self->core_.handlers_.received(self->id_, {static_cast<const char*>(data.data()), data.size()});
      }
      self->buffer_.clear();
      self->read();
    });
  }

  /// Topics in turn, so that a picture never waits behind ten poses, nor a pose behind ten pictures.
  void write() {
    if (order_.empty()) return;
    const auto slot = slots_.find(order_.front());
    order_.pop_front();
    in_flight_ = std::move(slot->second);
    slots_.erase(slot);
    writing_ = true;
    socket_.text(in_flight_.text);
    socket_.async_write(net::buffer(*in_flight_.bytes), [self = shared_from_this()](Code failed, std::size_t) {
      self->writing_ = false;
      if (failed) return;
      ++self->core_.sent_;
      self->write();
    });
  }

  Core& core_;
  Socket socket_;
  PageId id_;
  bool open_ = false, writing_ = false;
  beast::flat_buffer buffer_;
  Message in_flight_;
  std::map<int, Message> slots_;
  std::deque<int> order_;  // of the topics in `slots_`, which has waited longest
};

/// A connection that asks by HTTP, and may become a page.
class WebServer::Core::Visit : public std::enable_shared_from_this<Visit> {
 public:
  Visit(Core& core, net::basic_stream_socket<Tcp, Executor> socket) : core_(core), stream_(std::move(socket)) {
    ++core_.connections_;
  }
  ~Visit() { --core_.connections_; }

  void read(std::chrono::seconds patience) {
    parser_.emplace();
    parser_->header_limit(kMostHeaderBytes);
    stream_.expires_after(patience);
    http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](Code failed, std::size_t) { self->answer(failed); });
  }

 private:
  void answer(const Code& failed) {
    if (failed.category() == http::make_error_code(http::error::bad_method).category() && failed != http::error::end_of_stream &&
        failed != http::error::partial_message)
      return refuse(400, "this is no request that a page makes");
    if (failed) return;
    const Request request = parser_->release();
    const RequestHead head = head_of(request);
    const Access::Verdict verdict = core_.access_->check(head);
    if (verdict.status != 200) return refuse(verdict.status, verdict.sentence);
    if (head.upgrade) {
      if (path_of(head.target) != "/socket") return refuse(404, "there is no such socket");
      std::make_shared<Page>(core_, std::move(stream_))->open(request);
      return;
    }
    if (head.method != "GET" && head.method != "HEAD") return refuse(405, "there is nothing to be changed here");
    reply(core_.handlers_.get(head.target), verdict.by_link, request.keep_alive(), head.method == "HEAD");
  }

  void refuse(int status, const std::string& sentence) {
    reply({.status = status, .type = "text/plain; charset=utf-8", .body = bytes_of(sentence + "\n")}, false, false, false);
  }

  void reply(WebAnswer answer, bool set_cookie, bool keep, bool head_only) {
    body_ = std::move(answer.body);
    response_ = {};
    response_.version(11);
    response_.result(static_cast<unsigned>(answer.status));
    response_.set(http::field::content_type, answer.type);
    response_.set(http::field::cache_control, "no-store");
    response_.set("Content-Security-Policy", kPolicy);
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set("Cross-Origin-Resource-Policy", "same-origin");
    if (set_cookie) response_.set(http::field::set_cookie, core_.access_->set_cookie());
    response_.keep_alive(keep);
    response_.content_length(body_->size());
    if (!head_only) response_.body() = {body_->data(), body_->size()};
    stream_.expires_after(kIdle);
    http::async_write(stream_, response_, [self = shared_from_this(), keep](Code failed, std::size_t) {
      if (failed) return;
      if (keep) return self->read(kIdle);
      Code ignored;
      self->stream_.socket().shutdown(Tcp::socket::shutdown_send, ignored);
    });
  }

  Core& core_;
  Stream stream_;
  beast::flat_buffer buffer_{2 * kMostHeaderBytes};
  std::optional<http::request_parser<http::empty_body>> parser_;
  http::response<http::span_body<const char>> response_;
  Bytes body_;
};

WebServer::Core::Core(const WebPlace& place, Handlers handlers) : handlers_(std::move(handlers)) {
  listen(place);
}

void WebServer::Core::listen(const WebPlace& place) {
  const net::ip::address address = listened_address(place.listen);
  const Tcp::endpoint wanted(address, static_cast<unsigned short>(place.port.value_or(kUsualPort)));
  Code failed;
  acceptor_.open(wanted.protocol());
  acceptor_.set_option(net::socket_base::reuse_address(true));
  acceptor_.bind(wanted, failed);
  if (failed && !place.port) acceptor_.bind({address, 0}, failed);
  if (!failed) acceptor_.listen(net::socket_base::max_listen_connections, failed);
  if (failed)
    throw Error("{} port {}: cannot listen there ({}); --port 0 takes one that is free", place.listen, wanted.port(),
                failed.message());
  const int port = acceptor_.local_endpoint().port();
  const std::string host = address.is_unspecified() ? first_outer_address() : address.to_string();
  shown_host_ = fmt::format(fmt::runtime(address.is_v6() && !address.is_unspecified() ? "[{}]:{}" : "{}:{}"), host, port);
  access_.emplace(new_token(), fmt::format("marey_{}", port), names_of_this_machine());
}

void WebServer::Core::accept() {
  acceptor_.async_accept(context_.get_executor(), [this](Code failed, net::basic_stream_socket<Tcp, Executor> socket) {
    if (failed == net::error::operation_aborted) return;
    if (failed) {  // no descriptor is left, say: a while later there may be
      again_.expires_after(std::chrono::milliseconds(100));
      again_.async_wait([this](Code stopped) {
        if (!stopped) accept();
      });
      return;
    }
    if (connections_ < kMostConnections) {
      Code ignored;
      socket.set_option(Tcp::no_delay(true), ignored);
      socket.set_option(net::socket_base::send_buffer_size(kSendBuffer), ignored);
      std::make_shared<Visit>(*this, std::move(socket))->read(kPatience);
    }
    accept();
  });
}

std::string WebServer::Core::address() const {
  return fmt::format("http://{}/?token={}", shown_host_, access_->token());
}

void WebServer::Core::publish(Message message, std::function<bool(PageId)> wants) {
  if (pages_ == 0) return;
  const std::lock_guard lock(mutex_);
  const int topic = message.topic;
  published_.insert_or_assign(topic, Published{std::move(message), std::move(wants)});
  if (std::exchange(waking_, true)) return;
  net::post(context_, [this] { hand_out(); });
}

void WebServer::Core::hand_out() {
  std::map<int, Published> published;
  {
    const std::lock_guard lock(mutex_);
    published.swap(published_);
    waking_ = false;
  }
  for (const auto& [topic, one] : published) {
    for (const auto& [id, page] : open_) {
      if (!one.wants || one.wants(id)) page->put(one.message);
    }
  }
}

void WebServer::Core::send(PageId page, Message message) {
  if (const auto found = open_.find(page); found != open_.end()) found->second->put(message);
}

WebServer::WebServer(const WebPlace& place, Handlers handlers) : core_(std::make_unique<Core>(place, std::move(handlers))) {}
WebServer::~WebServer() = default;
void WebServer::start() {
  core_->start();
}
std::string WebServer::address() const {
  return core_->address();
}
void WebServer::publish(Message message, std::function<bool(PageId)> wants) {
  core_->publish(std::move(message), std::move(wants));
}
void WebServer::send(PageId page, Message message) {
  core_->send(page, std::move(message));
}
WebServer::Count WebServer::count() const {
  return core_->count();
}

}  // namespace marey::viewer
