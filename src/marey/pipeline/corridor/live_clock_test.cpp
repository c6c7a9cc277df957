// Live cameras by a time that the test keeps itself: what continues when one is late, stalls, is lost and comes back, and what is
// dropped.
#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "marey/pipeline/corridor/clock.h"

namespace marey::pipeline::corridor {
namespace {

constexpr double kRate = 25;

class FakeTime final : public source::LiveTime {
 public:
  Timestamp now() override { return now_; }
  void wait() override { now_ += duration_from_seconds(0.001); }
  void pass(double s) { now_ += duration_from_seconds(s); }

 private:
  Timestamp now_{};
};

/// A camera whose frames come when the test says.
class FakeCamera final : public LiveSource {
 public:
  explicit FakeCamera(std::shared_ptr<FakeTime> time) : time_(std::move(time)) {
    info_.name = "fake";
    info_.size = {64, 48};
    info_.rate_hz = kRate;
  }

  /// Frames `first` to `last` of kRate, each `delay_s` after its time.
  void gives(int first, int last, double delay_s) {
    for (int i = first; i <= last; ++i) {
      Frame frame;
      frame.index = i;
      frame.time = timestamp_from_seconds(i / kRate);
      coming_.push_back({frame.time + duration_from_seconds(delay_s), frame});
    }
  }

  SourceInfo info() const override { return info_; }
  std::vector<CameraFrame> arrived() override {
    std::vector<CameraFrame> frames;
    for (; !coming_.empty() && coming_.front().first <= time_->now(); coming_.pop_front())
      frames.push_back({.frame = coming_.front().second, .detections = {}});
    return frames;
  }
  bool ended() const override { return coming_.empty(); }

 private:
  std::shared_ptr<FakeTime> time_;
  SourceInfo info_;
  std::deque<std::pair<Timestamp, Frame>> coming_;
};

class LiveClockTest : public testing::Test {
 protected:
  FakeCamera& camera() {
    auto source = std::make_unique<FakeCamera>(time_);
    FakeCamera& reference = *source;
    RigCamera rig_camera;
    rig_camera.name = "cam" + std::to_string(feeds_.size());
    feeds_.push_back(Feed::live(rig_camera, CameraId{static_cast<int>(feeds_.size())}, std::move(source)));
    return reference;
  }

  Clock clock() { return Clock(std::move(feeds_), {.live = source::LivePolicy{.time = time_}}); }
  double now() const { return seconds(time_->now()); }

  std::shared_ptr<FakeTime> time_ = std::make_shared<FakeTime>();
  std::vector<Feed> feeds_;
};

TEST_F(LiveClockTest, EveryMomentGoesOnWhenItsLastFrameHasCome) {
  camera().gives(0, 49, 0.01);
  camera().gives(0, 49, 0.03);
  Clock clock = this->clock();
  for (int i = 0; i < 50; ++i) {
    const auto set = clock.next();
    ASSERT_TRUE(set) << i;
    EXPECT_EQ(set->index, i);
    EXPECT_NEAR(seconds(set->time), i / kRate, 1e-6);
    EXPECT_TRUE(set->complete());
    EXPECT_NEAR(now(), i / kRate + 0.03, 0.0021);
  }
  EXPECT_FALSE(clock.next());
  EXPECT_EQ(clock.drops()->superseded + clock.drops()->incomplete + clock.drops()->empty + clock.drops()->late_frames, 0);
}

TEST_F(LiveClockTest, AMomentWaitsAsLongAsThePolicySaysAndGoesOnWithItsGap) {
  camera().gives(0, 49, 0.005);
  FakeCamera& slow = camera();
  slow.gives(0, 9, 0.005);
  slow.gives(10, 10, 0.15);
  slow.gives(11, 49, 0.15);  // from now on each is later than the 0.1 s that are waited
  Clock clock = this->clock();
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(clock.next()->complete()) << i;
  const auto late = clock.next();
  ASSERT_TRUE(late);
  EXPECT_EQ(late->index, 10);
  EXPECT_FALSE(late->cameras[1]);
  EXPECT_TRUE(late->cameras[0]);
  EXPECT_NEAR(now(), 10 / kRate + 0.1, 0.0021);
  while (clock.next()) continue;
  EXPECT_GE(clock.drops()->late_frames, 20);
  EXPECT_EQ(clock.frames(1), 50);
}

TEST_F(LiveClockTest, ACameraThatStallsCostsOnlyItselfAndComesBack) {
  camera().gives(0, 399, 0.005);
  FakeCamera& falters = camera();
  falters.gives(0, 49, 0.005);     // until 2 s
  falters.gives(250, 399, 0.005);  // from 10 s on
  Clock clock = this->clock();
  std::vector<std::pair<double, FeedState>> changes;
  std::int64_t last = -1, skipped = 0;
  while (const auto set = clock.next()) {
    skipped += set->index - last - 1;
    last = set->index;
    EXPECT_TRUE(set->cameras[0]);
    EXPECT_EQ(set->cameras[1].has_value(), set->index < 50 || set->index >= 250) << set->index;
    EXPECT_EQ(set->states[0] == FeedState::live || set->index >= 398, true);
    if (set->states[1] == FeedState::stalled || set->states[1] == FeedState::lost) {
      EXPECT_LT(now() - seconds(set->time), 0.01) << "nothing waits for it";
    }
    if (changes.empty() || changes.back().second != set->states[1]) changes.emplace_back(seconds(set->time), set->states[1]);
  }
  EXPECT_EQ(last, 399);
  EXPECT_LE(skipped, 3) << "those that waited for it when it was given up: the newest continues";
  EXPECT_EQ(clock.drops()->superseded, skipped);
  using enum FeedState;
  const std::vector<std::pair<double, FeedState>> required = {{0, live}, {2.9, stalled}, {6.97, lost}, {10, back}, {11, live}};
  ASSERT_GE(changes.size(), required.size());
  for (std::size_t i = 0; i < required.size(); ++i) {
    EXPECT_EQ(changes[i].second, required[i].second) << i;
    EXPECT_NEAR(changes[i].first, required[i].first, 0.11) << i;
  }
}

TEST_F(LiveClockTest, SlowReaderGetsNewestFrameSet) {
  camera().gives(0, 249, 0.005);
  camera().gives(0, 249, 0.03);
  Clock clock = this->clock();
  std::int64_t last = -1, skipped = 0, sets = 0;
  while (const auto set = clock.next()) {
    EXPECT_TRUE(set->complete()) << "a newer instant that is not whole does not overtake one that is";
    EXPECT_GT(set->index, last);
    if (now() < 249 / kRate) {
      EXPECT_LT(now() - seconds(set->time), 0.03 + 1.1 / kRate) << "an older one was given";
    }
    skipped += set->index - last - 1;
    last = set->index;
    ++sets;
    time_->pass(0.2);  // what the consumer takes
  }
  EXPECT_EQ(last, 249);
  EXPECT_EQ(sets + skipped, 250);
  EXPECT_GE(skipped, 190);
  EXPECT_EQ(clock.drops()->superseded + clock.drops()->incomplete, skipped);
  EXPECT_EQ(clock.drops()->empty, 0);
}

TEST_F(LiveClockTest, CountsGapIfAllCamerasAreSilent) {
  FakeCamera& one = camera();
  one.gives(0, 9, 0.005);
  one.gives(60, 69, 0.005);
  Clock clock = this->clock();
  std::vector<std::int64_t> indices;
  while (const auto set = clock.next()) indices.push_back(set->index);
  ASSERT_EQ(indices.size(), 20u);
  EXPECT_EQ(indices[10], 60);
  EXPECT_EQ(clock.drops()->empty, 50);
}

TEST_F(LiveClockTest, ACameraThatNeverComesIsConnectingThenLost) {
  camera().gives(0, 199, 0.005);
  FakeCamera& never = camera();
  never.gives(100'000, 100'000, 0);
  Clock clock = this->clock();
  for (int i = 0; i < 190; ++i) {
    const auto set = clock.next();
    ASSERT_TRUE(set);
    if (now() < 4.9) {
      EXPECT_EQ(set->index, i);
    }
    EXPECT_EQ(set->states[1], now() < 5 ? FeedState::connecting : FeedState::lost) << now();
    EXPECT_LT(now() - seconds(set->time), now() < 5.1 ? 0.103 : 0.01);
  }
  EXPECT_LE(clock.drops()->superseded, 3);
}

TEST_F(LiveClockTest, EndsWhereItIsAskedTo) {
  camera().gives(100'000, 100'000, 0);
  std::stop_source source;
  source.request_stop();
  const StopScope scope(source.get_token());
  Clock clock = this->clock();
  EXPECT_FALSE(clock.next());
}

}  // namespace
}  // namespace marey::pipeline::corridor
