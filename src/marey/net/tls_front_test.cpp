// Over real sockets of this host.
#include "marey/net/tls_front.h"

#include <chrono>
#include <string>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/write.hpp>
#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/net/server.h"

namespace marey::net {
namespace {

using TestTcp = boost::asio::ip::tcp;

/// Sends back what comes, byte for byte.
class TlsEcho : public Session {
 public:
  std::size_t received(std::string_view bytes, Outbox& out) override {
    out.answer(std::string(bytes));
    return bytes.size();
  }
};

class TlsFrontTest : public testing::Test {
 protected:
  TlsFrontTest() { loop_.start(); }
  ~TlsFrontTest() override { loop_.stop(); }

  TestTcp::endpoint location() const { return {boost::asio::ip::address_v4::loopback(), front_.address().port}; }

  Loop loop_;
  Server server_{loop_, Address{.host = kLoopback, .port = 0}, "echo", {.protocol = Protocol::bytes}, [](const Address&) {
                   return std::make_unique<TlsEcho>();
                 }};
  TlsFront front_{Address{.host = kLoopback, .port = 0}, server_.address().port, "front"};
  boost::asio::io_context context_;
};

TEST_F(TlsFrontTest, PassesOnWhatComes) {
  boost::asio::ssl::context tls(boost::asio::ssl::context::tls_client);
  boost::asio::ssl::stream<TestTcp::socket> client(context_, tls);
  client.next_layer().connect(location());
  client.handshake(boost::asio::ssl::stream_base::client);
  std::string text(500'000, 'a');
  for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>('a' + i % 23);
  std::string answer(text.size(), '\0');
  // Both at once, or full buffers block each other; in one thread, for a TLS stream is not made for two.
  const auto ended = [](const boost::system::error_code& error, std::size_t) { EXPECT_FALSE(error) << error.message(); };
  boost::asio::async_write(client, boost::asio::buffer(text), ended);
  boost::asio::async_read(client, boost::asio::buffer(answer), ended);
  context_.run();
  EXPECT_TRUE(answer == text);
  EXPECT_EQ(front_.fingerprint().size(), 32U * 3 - 1);
}

TEST_F(TlsFrontTest, TheCertificateIsForThisMachine) {
  boost::asio::ssl::context tls(boost::asio::ssl::context::tls_client);
  boost::asio::ssl::stream<TestTcp::socket> client(context_, tls);
  client.next_layer().connect(location());
  client.handshake(boost::asio::ssl::stream_base::client);
  X509* certificate = SSL_get1_peer_certificate(client.native_handle());
  ASSERT_NE(certificate, nullptr);
  EXPECT_EQ(X509_check_host(certificate, "localhost", 0, 0, nullptr), 1);
  EXPECT_EQ(X509_check_ip_asc(certificate, "127.0.0.1", 0), 1);
  EXPECT_EQ(X509_check_ip_asc(certificate, "192.0.2.7", 0), 0);
  X509_free(certificate);
}

TEST_F(TlsFrontTest, ClientsThatSpeakNoTlsEndAlone) {
  for (const std::string& bytes : {std::string("GET / HTTP/1.1\r\n\r\n"), std::string(3000, '\xff'), std::string()}) {
    TestTcp::socket wrong(context_);
    wrong.connect(location());
    boost::system::error_code ignored;
    boost::asio::write(wrong, boost::asio::buffer(bytes), ignored);
    wrong.close(ignored);
  }
  boost::asio::ssl::context tls(boost::asio::ssl::context::tls_client);
  boost::asio::ssl::stream<TestTcp::socket> client(context_, tls);
  client.next_layer().connect(location());
  client.handshake(boost::asio::ssl::stream_base::client);
  boost::asio::write(client, boost::asio::buffer("hello", 5));
  std::string answer(5, '\0');
  boost::asio::read(client, boost::asio::buffer(answer));
  EXPECT_EQ(answer, "hello");
}

TEST_F(TlsFrontTest, APortInUseIsReported) {
  EXPECT_THROW(TlsFront(front_.address(), server_.address().port, "front"), Error);
}

}  // namespace
}  // namespace marey::net
