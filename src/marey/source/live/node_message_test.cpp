#include "marey/source/live/node_message.h"

#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/source/live/node.h"
#include "marey/source/live/node_clock.h"

namespace marey::source::live {
namespace {

Timestamp at(double s) {
  return timestamp_from_seconds(s);
}

NodeFrame two_blobs() {
  NodeFrame frame{.session = 7, .sequence = 41, .taken = at(12.5), .size = {640, 480}};
  Detection found;
  found.centre = {12.25, 99.5};
  found.covariance = (Matrix<2>() << 0.01, 0.002, 0.002, 0.03).finished();
  found.area = 42;
  found.box = {10, 97, 5, 6};
  found.score = 0.75;
  frame.detections = {found, Detection{}};
  return frame;
}

TEST(NodeMessage, RoundTripsMessage) {
  const NodeFrame frame = two_blobs();
  const std::string message = message_of(frame);
  const NodeFrame read = read_node_frame(message, "node");
  EXPECT_EQ(read.session, 7u);
  EXPECT_EQ(read.sequence, 41);
  EXPECT_EQ(read.taken, frame.taken);
  EXPECT_EQ(read.size, cv::Size(640, 480));
  ASSERT_TRUE(read.detections);
  ASSERT_EQ(read.detections->size(), 2u);
  const Detection& found = read.detections->front();
  EXPECT_EQ(found.centre, frame.detections->front().centre);
  EXPECT_EQ(found.covariance, frame.detections->front().covariance);
  EXPECT_FALSE(read.detections->back().covariance);
  EXPECT_EQ(found.area, 42);
  EXPECT_EQ(found.box.height, 6);
  EXPECT_EQ(found.score, 0.75);

  const std::vector<std::uint8_t> jpeg{1, 2, 3};
  const std::string image = message_of(NodeFrame{.session = 7, .sequence = 1, .taken = at(0), .size = {4, 4}, .jpeg = jpeg});
  const NodeFrame with_picture = read_node_frame(image, "node");
  EXPECT_FALSE(with_picture.detections);
  EXPECT_EQ(std::vector(with_picture.jpeg.begin(), with_picture.jpeg.end()), jpeg);

  const NodeAnswer answer{.session = 7, .now = at(3), .known = true, .size = {8, 6}, .rate_hz = 60, .cameras = {"left", "right"}};
  const NodeAnswer received = read_node_answer(message_of(answer), "node");
  EXPECT_EQ(received.now, at(3));
  EXPECT_TRUE(received.known);
  EXPECT_EQ(received.rate_hz, 60);
  EXPECT_EQ(received.cameras, answer.cameras);
}

TEST(NodeMessage, RejectsMalformedInput) {
  std::string message = message_of(two_blobs());
  for (std::size_t length = 0; length < message.size(); ++length)
    EXPECT_THROW(read_node_frame(std::string_view(message).substr(0, length), "node"), Error) << length;
  EXPECT_THROW(read_node_frame(message + "x", "node"), Error);
  EXPECT_THROW(read_node_answer(message, "node"), Error);
  EXPECT_THROW(read_node_answer("MRYA", "node"), Error);
  std::string many = message.substr(0, message.size() - 2 * 11 * 8);
  many.replace(many.size() - 4, 4, "\xff\xff\xff\xff");
  EXPECT_THROW(read_node_frame(many, "node"), Error);
  std::mt19937 random(5);
  for (int i = 0; i < 20'000; ++i) {
    std::string mutated = message;
    for (int k = 0; k < 3; ++k) mutated[random() % mutated.size()] = static_cast<char>(random());
    try {
      const NodeFrame read = read_node_frame(mutated, "node");
      for (const Detection& found : read.detections.value_or(std::vector<Detection>{})) EXPECT_TRUE(found.centre.allFinite());
    } catch (const Error& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("node: ")) << error.what();
    }
  }
}

TEST(NodeMessage, ControlsComeAsTheyAreSaid) {
  const NodeControls stated{.session = 7,
                            .allowed = true,
                            .waits = true,
                            .has = {{Control::exposure, 0.02, 50, 2.5}, {Control::threshold, 0, 65535, 0}},
                            .refused = "too long"};
  const std::string message = message_of(stated);
  const auto received = read_node_controls(message, "node");
  ASSERT_TRUE(received);
  EXPECT_EQ(received->session, 7u);
  EXPECT_TRUE(received->allowed && received->waits);
  ASSERT_EQ(received->has.size(), 2u);
  EXPECT_EQ(received->has[0].now, 2.5);
  EXPECT_EQ(received->has[1].control, Control::threshold);
  EXPECT_EQ(received->refused, "too long");
  EXPECT_FALSE(read_node_controls(message_of(NodeAnswer{}), "node")) << "of a node that knows nothing of them";
  for (std::size_t length = 0; length < message.size() - stated.refused.size(); ++length)
    EXPECT_THROW(read_node_controls(std::string_view(message).substr(0, length), "node"), Error) << length;
  EXPECT_THROW(read_node_controls(message + std::string(1000, 'x'), "node"), Error);
  std::mt19937 random(5);
  for (int i = 0; i < 20'000; ++i) {
    std::string mutated = message;
    for (int k = 0; k < 3; ++k) mutated[4 + random() % (mutated.size() - 4)] = static_cast<char>(random());
    try {
      const auto read = read_node_controls(mutated, "node");
      for (const ControlRange& range : read->has) EXPECT_TRUE(range.minimum <= range.maximum && std::isfinite(range.now));
    } catch (const Error& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("node: ")) << error.what();
    }
  }
}

TEST(NodeMessage, QuestionsAboutControlsAreReadAsTheyAreWritten) {
  const NodeQuestion request{.camera = "left one", .request = NodeQuestion::ControlRequest{Control::exposure, 2.5}};
  EXPECT_EQ(text_of(request), "left one=exposure 2.5");
  const auto received = read_node_question(text_of(request));
  ASSERT_TRUE(received && received->request);
  EXPECT_EQ(received->camera, "left one");
  EXPECT_EQ(received->request->control, Control::exposure);
  EXPECT_EQ(received->request->value, 2.5);
  const auto state = read_node_question("left=");
  ASSERT_TRUE(state);
  EXPECT_FALSE(state->request);
  for (const char* none : {"", "left", "=", "=exposure 1", "left=focus 1", "left=exposure", "left=exposure ", "left=exposure -1",
                           "left=exposure nan", "left=exposure inf", "left=exposure 1e99", "left=exposure 1x", "left= "})
    EXPECT_FALSE(read_node_question(none)) << none;
}

TEST(NodeAddress, IsReadFromAnAddress) {
  const auto location = [](const std::string& text) { return node_address(parse_address(text)); };
  EXPECT_EQ(location("node:lab2:7000/left").node(), "node:lab2:7000");
  EXPECT_EQ(location("node:lab2:7000/left").camera, "left");
  EXPECT_EQ(location("node://lab2").node(), fmt::format("node:lab2:{}", kNodePort));
  EXPECT_EQ(location("node:[::1]/left").host, "[::1]");
  EXPECT_EQ(location("node:[::1]:7000/left").port, 7000);
  for (const char* wrong : {"node:", "node:lab2:0", "node:lab2:65536", "node:lab2:7x", "node:/left", "node:lab2?fast"})
    EXPECT_THROW(location(wrong), Error) << wrong;
}

/// Round trips with delays either way, a slow one now and then, and a drift of 30 ppm: the clock is known to what it says.
TEST(NodeClock, IsWithinWhatItSays) {
  const unsigned seed = std::random_device()();
  SCOPED_TRACE(fmt::format("seed {}", seed));
  std::mt19937 random(seed);
  std::exponential_distribution<double> delay(1 / 0.3e-3);
  NodeClock clock;
  EXPECT_FALSE(clock.here(at(1)));
  const double ahead = 1234.5, drift = 30e-6;
  double worst = 0;
  for (double now = 0; now < 120; now += 1) {
    const double there = now + delay(random) + (random() % 10 == 0 ? 0.05 : 0);
    const double came = there + delay(random);
    clock.learn(at(now), at(ahead + there * (1 + drift)), at(came));
    const double off = seconds(clock.here(at(ahead + came * (1 + drift))).value()) - came;
    EXPECT_LE(std::abs(off), clock.uncertainty(at(came)) + 1e-6);
    if (now > 10) worst = std::max(worst, std::abs(off));
  }
  EXPECT_LT(worst, 1e-3);
}

}  // namespace
}  // namespace marey::source::live
