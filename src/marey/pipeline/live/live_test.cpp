// Live runs by a time that the test keeps: the same as from files where nothing is dropped, and cameras that run free of each
// other.
#include "marey/pipeline/live/live.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/core/recording_sink.h"
#include "marey/pipeline/live/live_feeds.h"
#include "marey/pipeline/simulate/room_files.h"
#include "marey/simulate/random.h"
#include "marey/source/live/device_clock.h"

#include "support/files.h"

namespace marey::pipeline::live {
namespace {

class TestTime final : public source::LiveTime {
 public:
  Timestamp now() override { return now_; }
  void wait() override { now_ += duration_from_seconds(0.0005); }

 private:
  Timestamp now_{};
};

/// Passes what it was given when its time has come.
class HandedOver final : public LiveSource {
 public:
  struct Due {
    Timestamp arrival{};
    CameraFrame frame;
  };
  HandedOver(std::shared_ptr<TestTime> time, const RigCamera& camera, std::deque<Due> coming)
      : time_(std::move(time)), coming_(std::move(coming)) {
    info_.name = camera.name;
    info_.size = *camera.size;
    info_.rate_hz = camera.rate_hz;
  }
  SourceInfo info() const override { return info_; }
  std::vector<CameraFrame> arrived() override {
    std::vector<CameraFrame> frames;
    for (; !coming_.empty() && coming_.front().arrival <= time_->now(); coming_.pop_front())
      frames.push_back(std::move(coming_.front().frame));
    return frames;
  }
  bool ended() const override { return coming_.empty(); }

 private:
  std::shared_ptr<TestTime> time_;
  SourceInfo info_;
  std::deque<Due> coming_;
};

Recording recorded(const Rig& rig, corridor::Clock clock) {
  Recording recording;
  markers::MarkersInSpaceOptions options;
  options.live = true;
  const auto stage = markers::markers_in_space(rig, clock.rate_hz(), options);
  corridor::Sinks sinks;
  sinks.add(std::make_unique<RecordingSink>(recording));
  corridor::run(*stage, clock, sinks);
  return recording;
}

Recording live_recording(const Rig& rig, std::vector<std::deque<HandedOver::Due>> coming) {
  const auto time = std::make_shared<TestTime>();
  std::vector<corridor::Feed> feeds;
  for (std::size_t i = 0; i < coming.size(); ++i) {
    RigCamera camera = rig.cameras[i];
    camera.offset_s.reset();
    feeds.push_back(corridor::Feed::live(camera, CameraId{static_cast<int>(i)},
                                         std::make_unique<HandedOver>(time, rig.cameras[i], std::move(coming[i]))));
  }
  return recorded(rig, corridor::Clock(std::move(feeds), {.live = source::LivePolicy{.time = time, .late_s = 0.05}}));
}

marey::simulate::room::RoomOptions walk(std::int64_t frames) {
  marey::simulate::room::RoomOptions room;
  room.cameras = 6;
  room.markers = 30;
  room.rate_hz = 100;
  room.frames = frames;
  return room;
}

TEST(Live, IsTheSameAsFromFilesWhereNothingIsLetGo) {
  const marey::simulate::room::RoomScene scene(walk(200));
  const test::TemporaryFolder folder;
  simulate::write_room(scene, folder.path());
  const auto observations = [&] { return corridor::open_observations(folder / "observations.csv", scene.rig(), {}); };
  const Recording offline = recorded(scene.rig(), corridor::Clock(observations(), {.pace = corridor::ClockOptions::Pace::even}));

  std::vector<std::deque<HandedOver::Due>> coming;
  for (corridor::Feed& feed : observations()) {
    auto& mine = coming.emplace_back();
    marey::simulate::Random delays(coming.size());
    while (auto frame = feed.next()) {
      frame->frame.time += std::chrono::seconds(3);
      mine.push_back({frame->frame.time + duration_from_seconds(delays.uniform(0.001, 0.008)), std::move(*frame)});
    }
  }
  const Recording live = live_recording(scene.rig(), std::move(coming));

  ASSERT_EQ(live.instants().size(), offline.instants().size());
  ASSERT_EQ(live.tracks().size(), offline.tracks().size());
  ASSERT_GE(live.tracks().size(), 25u);
  for (std::size_t t = 0; t < live.tracks().size(); ++t) {
    const TrackColumns& a = live.tracks()[t];
    const TrackColumns& b = offline.tracks()[t];
    ASSERT_EQ(a.size(), b.size()) << t;
    for (std::size_t row = 0; row < a.size(); ++row) {
      ASSERT_EQ(a.at()[row], b.at()[row]);
      ASSERT_EQ(a.position(row), b.position(row)) << "bit for bit";
    }
  }
}

/// RMS distance of all measured points from the nearest true marker at their own times, m.
double error_of(const Recording& recording, const marey::simulate::room::RoomScene& scene, Timestamp begin, double after_s,
                std::int64_t& points) {
  double squares = 0;
  points = 0;
  for (const TrackColumns& track : recording.tracks()) {
    for (std::size_t row = 0; row < track.size(); ++row) {
      const double t = seconds(recording.instants()[static_cast<std::size_t>(track.at()[row])].time - begin);
      if (t < after_s || !track.measured(row)) continue;
      double minimum = std::numeric_limits<double>::infinity();
      for (const Vector<3>& truth : scene.points(t)) minimum = std::min(minimum, (truth - track.position(row)).squaredNorm());
      squares += minimum;
      ++points;
    }
  }
  return std::sqrt(squares / static_cast<double>(std::max<std::int64_t>(1, points)));
}

/// What each camera sees at times of its own: begun up to half a period apart, its clock wrong by up to `drift`, its frames late by
/// chance. When they were taken is found out from their device times.
std::vector<std::deque<HandedOver::Due>> free_running(const marey::simulate::room::RoomScene& scene, bool free, double drift) {
  std::vector<std::deque<HandedOver::Due>> coming;
  const double period = 1 / scene.options().rate_hz;
  for (int c = 0; c < scene.options().cameras; ++c) {
    marey::simulate::Random random(static_cast<std::uint64_t>(c) + 40);
    const double offset = free ? random.uniform(-period / 2, period / 2) : 0, rate = 1 + (free ? random.uniform(-drift, drift) : 0);
    source::live::DeviceClock clock;
    auto& mine = coming.emplace_back();
    Timestamp last{};
    for (std::int64_t i = 0; i < scene.options().frames; ++i) {
      const double taken = offset + static_cast<double>(i) * period * rate;
      CameraFrame frame;
      frame.frame.index = i;
      auto& detections = frame.detections.emplace();
      for (const auto& blob : scene.observed_by(c, taken, static_cast<std::uint64_t>(i))) {
        detections.emplace_back().centre = blob.pixel;
      }
      const Timestamp now = timestamp_from_seconds(10 + taken);
      const Timestamp arrival = std::max(last, now + duration_from_seconds(free ? -0.002 * std::log(random.uniform(1e-4, 1)) : 0));
      last = arrival;
      frame.frame.time = free ? clock.time_of(duration_from_seconds(500 + static_cast<double>(i) * period), arrival) : now;
      mine.push_back({arrival + duration_from_seconds(0.0005), std::move(frame)});
    }
  }
  return coming;
}

TEST(Live, CamerasThatRunFreePlaceMarkersNearlyAsWell) {
  const marey::simulate::room::RoomScene scene(walk(1000));
  const Timestamp begin = timestamp_from_seconds(10);
  std::int64_t points = 0, free_points = 0;
  const double in_step = error_of(live_recording(scene.rig(), free_running(scene, false, 0)), scene, begin, 5, points);
  const double free = error_of(live_recording(scene.rig(), free_running(scene, true, 50e-6)), scene, begin, 5, free_points);
  RecordProperty("in_step_um", static_cast<int>(1e6 * in_step));
  RecordProperty("free_um", static_cast<int>(1e6 * free));
  EXPECT_LT(free, 2 * in_step) << in_step << " m synchronised";
  EXPECT_GT(free_points, points * 95 / 100);
}

TEST(Live, SourcesAreNamedOrCounted) {
  const std::vector<std::string> given{"sim://room?cameras=3", "left=sim://people", "v4l2:/dev/video0"};
  const Rig rig = rig_of_sources(given);
  ASSERT_EQ(rig.cameras.size(), 5u);
  EXPECT_EQ(rig.cameras[0].name, "cam1");
  EXPECT_TRUE(rig.cameras[2].camera()) << "the simulator knows where its cameras are";
  EXPECT_EQ(rig.cameras[2].source, "sim://room?cameras=3&camera=3");
  EXPECT_EQ(rig.cameras[3].name, "left");
  EXPECT_EQ(rig.cameras[4].name, "cam5");
  const std::vector<std::string> path{"out/a=b.mp4"};  // no camera may be called so: its name names files
  EXPECT_EQ(rig_of_sources(path).cameras.at(0).name, "cam1");
  EXPECT_EQ(rig_of_sources(path).cameras.at(0).source, "play:out/a=b.mp4");
  const std::vector<std::string> twice{"a=sim://people", "a=sim://people"};
  EXPECT_THROW(rig_of_sources(twice), Error);
  const std::vector<std::string> unknown{"node:left"};
  EXPECT_THROW(rig_of_sources(unknown), Error);
}

TEST(Live, RunningJobUsesKnownOptions) {
  const std::vector<std::string> calibrated{"sim://room?cameras=3"}, one{"sim://people"}, two{"sim://people", "sim://people"};
  EXPECT_EQ(live_job(rig_of_sources(calibrated), LiveTargets::markers, false), LiveJob::markers_in_space);
  EXPECT_EQ(live_job(rig_of_sources(calibrated), LiveTargets::people, false), LiveJob::preview);
  EXPECT_EQ(live_job(rig_of_sources(calibrated), LiveTargets::people, true), LiveJob::people_on_ground);
  EXPECT_EQ(live_job(rig_of_sources(one), LiveTargets::people, false), LiveJob::people_in_image);
  EXPECT_EQ(live_job(rig_of_sources(two), LiveTargets::markers, false), LiveJob::preview);
}

/// A real run of half a second: a camera away from the beginning is searched for, the others lose nothing by it.
TEST(Live, MissingCameraAffectsOnlyItself) {
  const std::vector<std::string> given{"sim://room?cameras=4&rate=50&blobs&markers=10&away=2,-1,100"};
  std::stop_source end;
  LiveOptions options;
  options.patience_s = 0.2;
  corridor::LiveStatus last;
  options.status = [&](const corridor::LiveStatus& status) {
    last = status;
    if (status.instants >= 20) end.request_stop();
  };
  const LiveSummary summary =
      live(rig_of_sources(given), std::move(options), {.progress = {}, .stop = end.get_token(), .options = {}});
  EXPECT_GE(summary.frames, 20);
  EXPECT_EQ(last.cameras[1].state, FeedState::connecting);
  EXPECT_NE(last.cameras[1].trouble.find("away"), std::string::npos);
  EXPECT_GT(last.cameras[0].frames, 15);
  EXPECT_GT(summary.tracks, 0);
}

}  // namespace
}  // namespace marey::pipeline::live
