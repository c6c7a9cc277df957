#include "marey/net/tls_front.h"

#include <array>
#include <chrono>
#include <cstddef>
#include <optional>
#include <thread>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>

#include "marey/core/error.h"
#include "marey/net/certificate.h"

namespace marey::net {
namespace {

namespace ssl = boost::asio::ssl;
using TlsContext = boost::asio::io_context;
using TlsTcp = boost::asio::ip::tcp;
using TlsCode = boost::system::error_code;

constexpr std::size_t kPiece = std::size_t{64} << 10;  // bytes that are passed on at once
constexpr std::size_t kMaxLinks = 64;                  // clients at a time
constexpr std::chrono::seconds kHandshake{10};
constexpr std::chrono::milliseconds kAfterFailure{100};  // without a descriptor for the next client

ssl::context tls_context(const Certificate& certificate) {
  ssl::context context(ssl::context::tls_server);
  context.set_options(ssl::context::no_tlsv1 | ssl::context::no_tlsv1_1 | ssl::context::default_workarounds);
  if (SSL_CTX_use_certificate(context.native_handle(), certificate.certificate.get()) != 1 ||
      SSL_CTX_use_PrivateKey(context.native_handle(), certificate.key.get()) != 1)
    throw Error("OpenSSL does not take its own certificate");
  return context;
}

/// One client and the plain connection behind it. It lives as long as something of it waits.
class TlsLink : public std::enable_shared_from_this<TlsLink> {
 public:
  TlsLink(TlsTcp::socket client, ssl::context& context, std::size_t& links)
      : client_(std::move(client), context), plain_(client_.get_executor()), timer_(client_.get_executor()), links_(links) {
    ++links_;
  }
  ~TlsLink() { --links_; }
  TlsLink(const TlsLink&) = delete;
  TlsLink& operator=(const TlsLink&) = delete;

  void start(const TlsTcp::endpoint& to) {
    timer_.expires_after(kHandshake);
    timer_.async_wait([self = shared_from_this()](const TlsCode& failed) {
      if (!failed) self->close();
    });
    client_.async_handshake(ssl::stream_base::server, [self = shared_from_this(), to](const TlsCode& failed) {
      if (failed) return self->close();
      self->plain_.async_connect(to, [self](const TlsCode& refused) {
        self->timer_.cancel();
        if (refused) return self->close();
        TlsCode ignored;
        self->plain_.set_option(TlsTcp::no_delay(true), ignored);
        self->pass(self->client_, self->plain_, self->inward_);
        self->pass(self->plain_, self->client_, self->outward_);
      });
    });
  }

 private:
  using Piece = std::array<char, kPiece>;

  /// All that comes from `from` goes to `to`, piece by piece: a slow side delays the other.
  template <typename From, typename To>
  void pass(From& from, To& to, Piece& piece) {
    from.async_read_some(boost::asio::buffer(piece),
                         [this, self = shared_from_this(), &from, &to, &piece](const TlsCode& failed, std::size_t count) {
                           if (failed) return close();
                           boost::asio::async_write(to, boost::asio::buffer(piece.data(), count),
                                                    [this, self, &from, &to, &piece](const TlsCode& refused, std::size_t) {
                                                      if (refused) return close();
                                                      pass(from, to, piece);
                                                    });
                         });
  }

  void close() {
    TlsCode ignored;
    timer_.cancel();
    client_.lowest_layer().close(ignored);
    plain_.close(ignored);
  }

  ssl::stream<TlsTcp::socket> client_;
  TlsTcp::socket plain_;
  boost::asio::steady_timer timer_;
  std::size_t& links_;
  Piece inward_{}, outward_{};
};

}  // namespace

struct TlsFront::Parts {
  Parts(Address where, std::uint16_t to, const std::string& what)
      : at(where), listener(listen_at(at, what)), target(boost::asio::ip::address_v4::loopback(), to) {
    acceptor.assign(TlsTcp::v4(), listener.release());
    accept();
    thread = std::thread([this] { context.run(); });
  }
  ~Parts() {
    context.stop();
    thread.join();
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  void accept() {
    acceptor.async_accept([this](const TlsCode& failed, TlsTcp::socket client) {
      if (failed) {
        again.expires_after(kAfterFailure);
        again.async_wait([this](const TlsCode& stopped) {
          if (!stopped) accept();
        });
        return;
      }
      TlsCode ignored;
      client.set_option(TlsTcp::no_delay(true), ignored);
      if (links < kMaxLinks) std::make_shared<TlsLink>(std::move(client), tls, links)->start(target);
      accept();
    });
  }

  Address at;
  Descriptor listener;
  TlsTcp::endpoint target;
  Certificate certificate = new_certificate();
  ssl::context tls = tls_context(certificate);
  std::size_t links = 0;
  // Destroyed before all else but the thread: the handlers that wait in it.
  TlsContext context{1};
  TlsTcp::acceptor acceptor{context};
  boost::asio::steady_timer again{context};
  std::thread thread;
};

TlsFront::TlsFront(Address at, std::uint16_t to, const std::string& what) : parts_(std::make_unique<Parts>(at, to, what)) {}
TlsFront::~TlsFront() = default;
const Address& TlsFront::address() const {
  return parts_->at;
}
const std::string& TlsFront::fingerprint() const {
  return parts_->certificate.fingerprint;
}

}  // namespace marey::net
