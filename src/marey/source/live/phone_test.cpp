// A phone's browser, played over this machine's loopback: its own clock, images that it could not send, malformed messages.
#include "marey/source/live/phone.h"

#include <chrono>
#include <cstring>
#include <functional>
#include <string>
#include <thread>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "marey/core/error.h"
#include "marey/net/token.h"
#include "marey/source/live/live_camera.h"
#include "marey/source/live/phone_server.h"

namespace marey::source::live {
namespace {

namespace beast = boost::beast;
using PhoneTcp = boost::asio::ip::tcp;

constexpr double kAhead = 5'000;  // ms that the phone's clock is before this one's

double host_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

bool comes_true(const std::function<bool()>& is) {
  for (int i = 0; i < 2000; ++i) {
    if (is()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

std::string jpeg_of(cv::Size size) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", cv::Mat(size, CV_8UC3, cv::Scalar(40, 90, 160)), bytes);
  return {bytes.begin(), bytes.end()};
}

std::string token_of(const PhoneServer& server) {
  return std::string(net::query_value(server.address(), "token"));
}

/// What a GET of `target` answers.
std::string answer_to(const PhoneServer& server, const std::string& target, unsigned& status) {
  boost::asio::io_context context;
  PhoneTcp::socket socket(context);
  socket.connect({boost::asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(server.plain_port())});
  beast::http::request<beast::http::empty_body> request(beast::http::verb::get, target, 11);
  request.set(beast::http::field::host, "localhost");
  beast::http::write(socket, request);
  beast::flat_buffer buffer;
  beast::http::response<beast::http::string_body> response;
  beast::http::read(socket, buffer, response);
  status = response.result_int();
  return response.body();
}

class Phone {
 public:
  Phone(const PhoneServer& server, const std::string& camera, const std::string& token, const std::string& page = "")
      : socket_(context_) {
    socket_.next_layer().connect({boost::asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(server.plain_port())});
    socket_.handshake("localhost", "/camera?token=" + token + "&camera=" + camera + "&page=" + page);
  }

  void send_image(std::uint32_t sequence, const std::string& jpeg) {
    std::string message(16, '\0');
    const double taken = host_ms() + kAhead;
    const std::uint32_t omitted = 3;
    std::memcpy(message.data(), &taken, sizeof taken);
    std::memcpy(message.data() + 8, &sequence, sizeof sequence);
    std::memcpy(message.data() + 12, &omitted, sizeof omitted);
    send(message + jpeg, true);
  }
  void send(const std::string& message, bool binary) {
    socket_.binary(binary);
    socket_.write(boost::asio::buffer(message));
  }
  /// The next message; empty when the connection is closed.
  std::string receive() {
    beast::flat_buffer buffer;
    beast::error_code failed;
    socket_.read(buffer, failed);
    return failed ? std::string() : beast::buffers_to_string(buffer.data());
  }
  void answer_clock() {
    const std::string question = receive();
    if (question.starts_with("clock ")) send(question + " " + std::to_string(host_ms() + kAhead), false);
  }

 private:
  boost::asio::io_context context_;
  beast::websocket::stream<PhoneTcp::socket> socket_;
};

TEST(Phone, ImagesHaveTheirTimesByTheHostsClock) {
  const auto server = PhoneServer::at(0);
  const auto time = steady_time();
  const auto camera = keep_connected("left", connect_phone("left", PhoneServer::at(0)), time, {.keep = 1000});
  Phone phone(*server, "left", token_of(*server));
  ASSERT_TRUE(comes_true([&] { return server->is_connected("left"); }));
  for (int i = 0; i < 5; ++i) phone.answer_clock();
  const std::string jpeg = jpeg_of({64, 48});
  std::vector<CameraFrame> came;
  std::uint32_t sequence = 0;
  double sent = 0;
  ASSERT_TRUE(comes_true([&] {
    sent = seconds(time->now().time_since_epoch());
    phone.send_image(sequence, jpeg);
    sequence += 2;  // each second one could not be sent
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    for (CameraFrame& frame : camera->arrived()) came.push_back(std::move(frame));
    return came.size() > 20;
  }));
  EXPECT_EQ(camera->info().size, cv::Size(64, 48));
  EXPECT_LT(std::abs(seconds(came.back().frame.time.time_since_epoch()) - sent), 1) << "not by the phone's clock, 5 s ahead";
  EXPECT_GE(camera->health().lost, 10);
  EXPECT_EQ(server->states().front().not_sent, 3);
}

TEST(Phone, ThePageIsForThoseWithTheToken) {
  const auto server = PhoneServer::at(0);
  server->offer("one");
  unsigned status = 0;
  EXPECT_NE(answer_to(*server, "/?token=" + token_of(*server), status).find("getUserMedia"), std::string::npos);
  EXPECT_EQ(status, 200U);
  EXPECT_EQ(answer_to(*server, "/cameras?token=" + token_of(*server), status), "free one\n");
  EXPECT_NE(answer_to(*server, "/", status).find("token"), std::string::npos);
  EXPECT_EQ(status, 401U);
  answer_to(*server, "/cameras?token=0", status);
  EXPECT_EQ(status, 401U);
  EXPECT_THROW(Phone(*server, "one", "0123"), std::exception);
  EXPECT_THROW(Phone(*server, "two", token_of(*server)), std::exception) << "no such camera";
  server->forget("one");
}

TEST(Phone, TheOneThatComesLastIsTheCamera) {
  const auto server = PhoneServer::at(0);
  server->offer("left");
  Phone first(*server, "left", token_of(*server));
  ASSERT_TRUE(comes_true([&] { return server->is_connected("left"); }));
  Phone second(*server, "left", token_of(*server));
  EXPECT_TRUE(second.receive().starts_with("clock "));
  first.send("state here", false);
  std::string last;
  for (std::string message = first.receive(); !message.empty(); message = first.receive()) last = message;
  EXPECT_EQ(last, "taken");
  second.send("state battery 12 %", false);
  EXPECT_TRUE(comes_true([&] { return server->states().front().stated == "battery 12 %"; }));
  server->forget("left");
}

/// A phone that changes its network is the same page on a new line; what it took in between is lost, and counted. Another page
/// begins a count of its own, and nothing is lost by that.
TEST(Phone, OfAPageThatComesBackTheGapIsCounted) {
  const auto server = PhoneServer::at(0);
  const auto camera = keep_connected("left", connect_phone("left", PhoneServer::at(0)), steady_time(), {.keep = 1000});
  const std::string token = token_of(*server), jpeg = jpeg_of({64, 48});
  const auto sends = [&](const std::string& page, std::uint32_t first, std::int64_t frames) {
    Phone phone(*server, "left", token, page);
    for (std::uint32_t i = 0; i < 3; ++i) phone.send_image(first + i, jpeg);
    EXPECT_TRUE(comes_true([&] { return camera->health().frames == frames; })) << page;
  };
  const auto goes = [&] { EXPECT_TRUE(comes_true([&] { return !server->is_connected("left"); })); };
  sends("a", 100, 3);
  EXPECT_EQ(camera->health().lost, 0);
  goes();
  sends("a", 120, 6);
  EXPECT_EQ(camera->health().lost, 17);
  goes();
  sends("b", 900, 9);
  EXPECT_EQ(camera->health().lost, 17);
}

TEST(Phone, ASecondPageIsToldTheSizeOfTheFirst) {
  const auto server = PhoneServer::at(0);
  server->offer("left");
  Phone first(*server, "left", token_of(*server), "a");
  first.send("size 1280x720", false);
  first.send("state here", false);
  ASSERT_TRUE(comes_true([&] { return server->states().front().stated == "here"; }));
  Phone second(*server, "left", token_of(*server), "b");
  EXPECT_EQ(second.receive(), "size 1280x720");
  EXPECT_TRUE(comes_true([&] { return server->states().front().stated == "another phone has taken its place"; }));
  server->forget("left");
}

TEST(Phone, MalformedMessagesEndTheirConnectionAlone) {
  const auto server = PhoneServer::at(0);
  server->offer("left");
  for (const auto& [message, binary] : {std::pair<std::string, bool>{"short", true},
                                        {"clock", false},
                                        {"clock x", false},
                                        {"clock 1 nan", false},
                                        {"state " + std::string(100'000, 'x'), false}}) {
    Phone phone(*server, "left", token_of(*server));
    phone.send(message, binary);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  Phone phone(*server, "left", token_of(*server));
  ASSERT_TRUE(comes_true([&] { return server->is_connected("left"); }));
  phone.send_image(0, "no JPEG at all");
  const auto image = server->next("left", std::chrono::seconds(2));
  ASSERT_TRUE(image.has_value());
  EXPECT_EQ(image->jpeg().size(), 14U);
  server->forget("left");
}

TEST(Phone, TwoCamerasCannotBeOnePhone) {
  const auto server = PhoneServer::at(0);
  const Connect first = connect_phone("left", PhoneServer::at(0));
  EXPECT_THROW(connect_phone("left", PhoneServer::at(0)), Error);
}

TEST(Phone, WithoutAPhoneThereIsNoCamera) {
  const Connect connect = connect_phone("left", PhoneServer::at(0));
  const auto time = steady_time();
  EXPECT_THROW(connect(*time, {}), Error);
}

}  // namespace
}  // namespace marey::source::live
