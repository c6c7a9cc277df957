// A node and the host that listens to it, over this machine's loopback.
#include "marey/source/live/node.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/source/live/live_camera.h"

namespace marey::source::live {
namespace {

bool becomes_true(const std::function<bool()>& is) {
  for (int i = 0; i < 2000; ++i) {
    if (is()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

/// A node whose clock is a quarter of an hour ahead, on whatever ports are free.
class Node {
 public:
  explicit Node(std::uint64_t session, int port = 0, NodeServer::Set set = {}) : session_(session) {
    std::mt19937 random(std::random_device{}());
    for (int tries = 0; server_ == nullptr; ++tries) {
      port_ = port != 0 ? port : 20'000 + static_cast<int>(random() % 20'000) * 2;
      try {
        server_ = std::make_unique<NodeServer>(
            "127.0.0.1", port_, [this](const std::string& camera) { return answer(camera); }, [] { return "the rig"; }, set);
      } catch (const Error&) {
        if (tries == 100) throw;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));  // of one that has just gone
      }
    }
  }

  NodeAddress location(const std::string& camera) const { return {.host = "127.0.0.1", .port = port_, .camera = camera}; }
  int port() const { return port_; }

  void send(std::int64_t sequence) {
    NodeFrame frame{.session = session_, .sequence = sequence, .taken = now(), .size = {64, 48}};
    frame.detections.emplace().emplace_back().centre = {static_cast<double>(sequence), 1};
    server_->send("left", message_of(frame));
  }

 private:
  Timestamp now() const { return time_->now() + std::chrono::minutes(15); }
  NodeAnswer answer(const std::string& camera) const {
    return {.session = session_, .now = now(), .known = camera == "left", .size = {64, 48}, .rate_hz = 50, .cameras = {"left"}};
  }

  std::uint64_t session_;
  int port_ = 0;
  std::shared_ptr<LiveTime> time_ = steady_time();
  std::unique_ptr<NodeServer> server_;
};

TEST(Node, FramesArriveWithTimesByTheHostsClock) {
  Node node(1);
  const auto time = steady_time();
  const auto camera = keep_connected("left", connect_node(node.location("left")), time, {.keep = 1000});
  ASSERT_TRUE(becomes_true([&] { return camera->connected(); }));
  std::int64_t sequence = 0;
  std::vector<CameraFrame> came;
  ASSERT_TRUE(becomes_true([&] {
    node.send(sequence++);
    for (CameraFrame& frame : camera->arrived()) came.push_back(std::move(frame));
    return came.size() > 20;
  }));
  EXPECT_EQ(camera->info().rate_hz, 50);
  EXPECT_EQ(camera->info().size, cv::Size(64, 48));
  EXPECT_EQ(camera->health().lost, 0);
  ASSERT_TRUE(came.back().detections);
  EXPECT_GT(came.back().detections->front().centre.x(), 0);
  const double old = seconds(time->now() - came.back().frame.time);
  EXPECT_TRUE(old >= 0 && old < 1) << old << " s: the node's clock is 900 s ahead";
  EXPECT_EQ(query_rig_of_node(node.location("")), "the rig");
}

TEST(Node, CountsMissingFrames) {
  Node node(1);
  const auto camera = keep_connected("left", connect_node(node.location("left")), steady_time(), {.keep = 1000});
  std::int64_t sequence = 0;
  ASSERT_TRUE(becomes_true([&] {
    node.send(sequence++);
    return camera->health().frames > 0;
  }));
  node.send(sequence + 5);
  ASSERT_TRUE(becomes_true([&] { return camera->health().lost == 5; })) << camera->health().lost;
}

TEST(Node, ReconnectsToRestartedNode) {
  auto node = std::make_unique<Node>(1);
  const int port = node->port();
  const auto camera = keep_connected("left", connect_node(node->location("left")), steady_time(), {.silent_s = 0.5});
  std::int64_t sequence = 0;
  const auto gives = [&] {
    const std::int64_t before = camera->health().frames;
    return becomes_true([&] {
      node->send(sequence++);
      return camera->health().frames > before;
    });
  };
  ASSERT_TRUE(gives());
  node.reset();
  ASSERT_TRUE(becomes_true([&] { return !camera->connected(); }));
  node = std::make_unique<Node>(2, port);
  sequence = 0;
  ASSERT_TRUE(gives());
  EXPECT_EQ(camera->health().connections, 2);
}

/// How the only camera of a node is set, which takes exposures up to 10 ms, after it was asked three times.
class Settings {
 public:
  std::optional<NodeControls> listen(const NodeQuestion& question) {
    const std::lock_guard lock(mutex_);
    if (question.camera != "left") return std::nullopt;
    if (question.request) {
      control_requests_ = question.request;
      requested_ = 0;
    }
    const bool waits = control_requests_ && ++requested_ < 3;
    std::string refused;
    if (control_requests_ && !waits && control_requests_->value > 10) refused = "too long";
    if (control_requests_ && !waits && control_requests_->value <= 10) now_ = control_requests_->value;
    return NodeControls{
        .session = 1, .allowed = allowed, .waits = waits, .has = {{Control::exposure, 0.1, 10, now_}}, .refused = refused};
  }

  std::atomic<bool> allowed = true;

 private:
  std::mutex mutex_;
  std::optional<NodeQuestion::ControlRequest> control_requests_;
  int requested_ = 0;
  double now_ = 5;
};

TEST(Node, ItsCamerasAreSetFromTheHost) {
  Settings settings;
  Node node(1, 0, [&](const NodeQuestion& question) { return settings.listen(question); });
  const auto time = steady_time();
  const std::unique_ptr<Connection> camera = connect_node(node.location("left"))(*time, {});
  ASSERT_EQ(camera->controls().size(), 1u);
  EXPECT_EQ(camera->controls()[0].now, 5);
  EXPECT_EQ(camera->controls()[0].maximum, 10);
  camera->set(Control::exposure, 2.5);
  EXPECT_EQ(camera->controls()[0].now, 2.5) << "when the call is over it is set";
  EXPECT_THROW(camera->set(Control::exposure, 20), Error);
  EXPECT_EQ(camera->controls()[0].now, 2.5);
  settings.allowed = false;
  try {
    camera->set(Control::exposure, 3);
    FAIL() << "it is not allowed";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("without --allow-control"), std::string::npos) << error.what();
  }
  std::int64_t sequence = 0;
  Shot shot;
  ASSERT_TRUE(becomes_true([&] {
    node.send(sequence++);
    return camera->next(shot) == Came::frame;
  })) << "frames come as before";
}

TEST(Node, ReportsOlderNodeAndLeavesItUnset) {
  Node node(1);  // which knows nothing of controls
  const auto time = steady_time();
  const std::unique_ptr<Connection> camera = connect_node(node.location("left"))(*time, {});
  EXPECT_TRUE(camera->controls().empty());
  try {
    camera->set(Control::gain, 2);
    FAIL() << "it cannot be set";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("its gain cannot be set from here: marey node there is of an older version"),
              std::string::npos)
        << error.what();
  }
}

TEST(Node, ReportsMissingNode) {
  Node node(1);
  const auto unknown = keep_connected("nobody", connect_node(node.location("nobody")), steady_time());
  ASSERT_TRUE(becomes_true([&] { return !unknown->health().trouble.empty(); }));
  EXPECT_NE(unknown->health().trouble.find("has no camera \"nobody\"; it has left"), std::string::npos)
      << unknown->health().trouble;
  EXPECT_THROW(Node(2, node.port()), Error) << "the ports are taken";
  NodeAddress elsewhere = node.location("");
  elsewhere.port = 1;
  EXPECT_THROW(query_rig_of_node(elsewhere), Error);
  std::stop_source stop;
  stop.request_stop();
  const StopScope scope(stop.get_token());
  EXPECT_THROW(query_rig_of_node(elsewhere), Stopped);
}

}  // namespace
}  // namespace marey::source::live
