#include "marey/source/live/live_camera.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/source/live/address.h"

namespace marey::source::live {
namespace {

/// Gives what the test has put down, then what `after` says.
class Scripted final : public Connection {
 public:
  Scripted(std::vector<std::pair<Came, Shot>> shots, Came after) : shots_(std::move(shots)), after_(after) {
    info_.name = "scripted";
    info_.size = {8, 6};
    info_.rate_hz = 100;
  }
  const SourceInfo& info() const override { return info_; }
  Came next(Shot& shot) override {
    if (next_ == shots_.size()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      if (after_ == Came::damaged) throw Error("{}", "unplugged");
      return after_;
    }
    shot = shots_[next_].second;
    return shots_[next_++].first;
  }

 private:
  SourceInfo info_;
  std::vector<std::pair<Came, Shot>> shots_;
  Came after_;
  std::size_t next_ = 0;
};

Shot shot(std::int64_t sequence, cv::Size size = {8, 6}) {
  Shot made;
  made.given.frame.image = Image(cv::Mat(size, CV_8UC1, cv::Scalar(0)));
  made.sequence = sequence;
  return made;
}

bool soon(const std::function<bool()>& is) {
  for (int i = 0; i < 1000 && !is(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  return is();
}

Connect always(std::vector<std::pair<Came, Shot>> shots, Came after) {
  return [=](LiveTime&, const std::stop_token&) { return std::make_unique<Scripted>(shots, after); };
}

TEST(LiveCamera, KeepsTheLastFewAndCountsTheRest) {
  std::vector<std::pair<Came, Shot>> shots;
  for (int i = 0; i < 10; ++i) shots.emplace_back(Came::frame, shot(i));
  const auto camera = keep_connected("cam", always(shots, Came::end), steady_time(), {.keep = 4});
  ASSERT_TRUE(soon([&] { return camera->ended(); }));
  const auto frames = camera->arrived();
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_EQ(frames.front().frame.index, 6);
  for (std::size_t i = 1; i < frames.size(); ++i) EXPECT_GT(frames[i].frame.time, frames[i - 1].frame.time);
  EXPECT_EQ(camera->health().frames, 10);
  EXPECT_EQ(camera->health().overrun, 6);
  EXPECT_TRUE(camera->arrived().empty());
}

TEST(LiveCamera, GapsAndDamageAreCounted) {
  const std::vector<std::pair<Came, Shot>> shots{{Came::frame, shot(5)}, {Came::frame, shot(6)},          {Came::damaged, {}},
                                                 {Came::frame, shot(9)}, {Came::frame, shot(10, {4, 3})}, {Came::frame, shot(11)}};
  const auto camera = keep_connected("cam", always(shots, Came::end), steady_time(), {.keep = 10});
  ASSERT_TRUE(soon([&] { return camera->ended(); }));
  const CameraHealth health = camera->health();
  EXPECT_EQ(health.frames, 4);
  EXPECT_EQ(health.lost, 1) << "of 7 and 8 one came damaged";
  EXPECT_EQ(health.damaged, 2) << "one said so, one had another size";
  EXPECT_NE(health.trouble.find("4 × 3"), std::string::npos) << health.trouble;
}

TEST(LiveCamera, IsTriedAgainFromTheFirstAttemptOn) {
  std::atomic<int> attempts = 0;
  const Connect connect = [&](LiveTime&, const std::stop_token&) -> std::unique_ptr<Connection> {
    if (++attempts < 4) throw Error("{}", "no such device");
    return std::make_unique<Scripted>(std::vector<std::pair<Came, Shot>>{{Came::frame, shot(0)}}, Came::nothing);
  };
  const auto camera = keep_connected("cam", connect, steady_time(), {.first_retry_s = 0.01, .longest_retry_s = 0.02});
  EXPECT_TRUE(soon([&] { return camera->health().trouble == "no such device" || camera->connected(); }));
  EXPECT_TRUE(soon([&] { return camera->connected() && camera->health().frames == 1; }));
  EXPECT_EQ(attempts, 4);
}

TEST(LiveCamera, ComesBackAfterItWasUnplugged) {
  std::atomic<int> opened = 0;
  const Connect connect = [&](LiveTime&, const std::stop_token&) -> std::unique_ptr<Connection> {
    ++opened;
    return std::make_unique<Scripted>(std::vector<std::pair<Came, Shot>>{{Came::frame, shot(0)}}, Came::damaged);
  };
  const auto camera = keep_connected("cam", connect, steady_time(), {.keep = 100, .first_retry_s = 0.01, .longest_retry_s = 0.02});
  ASSERT_TRUE(soon([&] { return camera->health().connections >= 3; }));
  const CameraHealth health = camera->health();
  EXPECT_EQ(health.trouble, "unplugged");
  EXPECT_EQ(health.lost, 0) << "its numbers begin again";
  EXPECT_FALSE(camera->ended());
}

TEST(LiveCamera, ReopensSilentCamera) {
  const auto camera = keep_connected("cam", always({{Came::frame, shot(0)}}, Came::nothing), steady_time(),
                                     {.keep = 4, .first_retry_s = 0.01, .longest_retry_s = 0.02, .silent_s = 0.1});
  EXPECT_TRUE(soon([&] { return camera->health().connections >= 2; }));
}

TEST(Address, SaysWhatItIsAndRefusesTheRest) {
  const Address address = parse_address("sim://room?cameras=8&drawn&motion=walk");
  EXPECT_EQ(address.scheme, "sim");
  EXPECT_EQ(address.location, "room");
  int cameras = 1;
  bool drawn = false;
  std::string motion;
  AddressOptions options(address);
  options.whole("cameras", cameras, 1, 64);
  options.flag("drawn", drawn);
  EXPECT_THROW(options.done(), Error) << "motion is not known yet";
  options.text("motion", motion);
  options.done();
  EXPECT_EQ(cameras, 8);
  EXPECT_TRUE(drawn);
  EXPECT_EQ(motion, "walk");
  EXPECT_THROW(AddressOptions(parse_address("v4l2:/dev/video0?rate=fast")).number("rate", *std::make_unique<double>(1), 1, 2),
               Error);
  EXPECT_THROW(parse_address("walk.avi"), Error);
  EXPECT_THROW(parse_address("sim://room?a=1&a=2"), Error);
  EXPECT_EQ(parse_address("v4l2:/dev/video0").location, "/dev/video0");
}

}  // namespace
}  // namespace marey::source::live
