#include "marey/pipeline/corridor/clock.h"

#include <cmath>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "marey/core/error.h"

#include "support/files.h"

namespace marey::pipeline::corridor {
namespace {

/// A camera whose detections lie in frames of these numbers, at `rate_hz`, started `offset_s` late. x of a box gives its frame.
Feed camera(const test::TemporaryFolder& folder, int id, const std::vector<int>& frames, double rate_hz, double offset_s) {
  std::string text;
  for (const int frame : frames) text += std::to_string(frame + 1) + ",-1," + std::to_string(frame + 1) + ",40,20,50,0.9\n";
  RigCamera camera;
  camera.name = "cam" + std::to_string(id);
  camera.detections = folder / (camera.name + ".txt");
  camera.rate_hz = rate_hz;
  camera.offset_s = offset_s;
  camera.size = cv::Size(640, 480);
  test::write_file(camera.detections, text);
  return {camera, CameraId{id}};
}

std::vector<int> all(int count) {
  std::vector<int> frames;
  for (int i = 0; i < count; ++i) frames.push_back(i);
  return frames;
}

TEST(Clock, TheFirstCameraSetsThePaceAndTheOthersGiveTheirNearest) {
  const test::TemporaryFolder folder;
  std::vector<Feed> feeds;
  feeds.push_back(camera(folder, 0, all(50), 25, 0));
  feeds.push_back(camera(folder, 1, all(60), 25, 0.13));  // 3.25 frames late
  Clock clock(std::move(feeds));
  int sets = 0, gaps = 0;
  while (const auto set = clock.next()) {
    EXPECT_EQ(set->index, sets);
    EXPECT_NEAR(seconds(set->time), sets / 25.0, 1e-9);
    ASSERT_TRUE(set->cameras[0]);
    if (set->cameras[1]) {
      EXPECT_EQ(set->cameras[1]->frame.index, sets - 3);
      EXPECT_NEAR(seconds(set->cameras[1]->frame.time), (sets - 3) / 25.0 + 0.13, 1e-9);
    } else {
      ++gaps;
    }
    ++sets;
  }
  EXPECT_EQ(sets, 50);
  EXPECT_EQ(gaps, 3) << "before the second camera was started";
  EXPECT_EQ(clock.missed(1), 3);
}

TEST(Clock, NoFrameIsGivenTwiceAndTheNearestWins) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  const test::TemporaryFolder folder;
  for (int trial = 0; trial < 20; ++trial) {
    const double offset = std::uniform_real_distribution(-0.5, 0.5)(random);
    const double rate = std::uniform_real_distribution(10.0, 60.0)(random);
    std::vector<Feed> feeds;
    feeds.push_back(camera(folder, 0, all(40), 25, 0));
    feeds.push_back(camera(folder, 1, all(100), rate, offset));
    Clock clock(std::move(feeds));
    std::set<std::int64_t> given;
    while (const auto set = clock.next()) {
      if (!set->cameras[1]) continue;
      const Frame& frame = set->cameras[1]->frame;
      EXPECT_TRUE(given.insert(frame.index).second);
      // The slow twin: every frame's distance, among those not given before.
      double minimum = HUGE_VAL;
      for (int i = 0; i < 100; ++i) {
        if (given.contains(i) && i != frame.index) continue;
        if (!given.empty() && i < *given.rbegin() && i != frame.index) continue;
        minimum = std::min(minimum, std::abs(i / rate + offset - seconds(set->time)));
      }
      EXPECT_NEAR(std::abs(seconds(frame.time - set->time)), minimum, 1e-6);
      EXPECT_LE(minimum, 0.505 / 25 + 1e-9);
    }
  }
}

TEST(Clock, ACameraThatEndsOrHasGapsCostsOnlyItself) {
  const test::TemporaryFolder folder;
  std::vector<Feed> feeds;
  feeds.push_back(camera(folder, 0, all(30), 25, 0));
  feeds.push_back(camera(folder, 1, all(10), 25, 0));
  Clock clock(std::move(feeds), {.pace = ClockOptions::Pace::even});
  int sets = 0;
  while (const auto set = clock.next()) {
    EXPECT_EQ(set->cameras[1].has_value(), sets < 10) << sets;
    EXPECT_EQ(set->complete(), sets < 10);
    ++sets;
  }
  EXPECT_EQ(sets, 30);
  EXPECT_EQ(clock.missed(1), 20);
}

TEST(Clock, TheFastestCameraSetsAnEvenPaceFromTheEarliestFrame) {
  const test::TemporaryFolder folder;
  std::vector<Feed> feeds;
  feeds.push_back(camera(folder, 0, all(20), 25, 0));
  feeds.push_back(camera(folder, 1, all(40), 50, 0.1));
  Clock clock(std::move(feeds), {.pace = ClockOptions::Pace::even});
  EXPECT_EQ(clock.rate_hz(), 50);
  const auto first = clock.next();
  ASSERT_TRUE(first);
  EXPECT_NEAR(seconds(first->time), 0, 1e-9);
  EXPECT_TRUE(first->cameras[0]);
  EXPECT_FALSE(first->cameras[1]);
}

/// Finds nothing, in every frame.
class Blind final : public detect::Detector {
 public:
  detect::Detections detect(const Frame&, std::span<const Expected>) override { return {}; }
};

TEST(Clock, AFeedThatDetectsLosesNoFrame) {
  const test::TemporaryFolder folder;
  std::vector<Feed> feeds;
  feeds.push_back(camera(folder, 0, all(50), 25, 0));
  feeds.front().find(std::make_unique<Blind>());
  Clock clock(std::move(feeds));
  for (int i = 0; i < 50; ++i) {
    const auto set = clock.next();
    ASSERT_TRUE(set) << i;
    EXPECT_EQ(set->index, i);
  }
  EXPECT_FALSE(clock.next());
}

TEST(Clock, AgainGivesTheSameMoments) {
  const test::TemporaryFolder folder;
  std::vector<Feed> feeds;
  feeds.push_back(camera(folder, 0, all(20), 25, 0));
  feeds.push_back(camera(folder, 1, all(20), 25, 0.07));
  Clock clock(std::move(feeds));
  ASSERT_TRUE(clock.can_rewind());
  Clock again = clock.again();
  while (const auto set = clock.next()) {
    const auto other = again.next();
    ASSERT_TRUE(other);
    EXPECT_EQ(set->time, other->time);
    for (std::size_t c = 0; c < 2; ++c) {
      ASSERT_EQ(set->cameras[c].has_value(), other->cameras[c].has_value());
      if (!set->cameras[c]) continue;
      EXPECT_EQ(set->cameras[c]->frame.index, other->cameras[c]->frame.index);
    }
  }
  EXPECT_FALSE(again.next());
}

TEST(Clock, DetectionsAreMovedBetweenFramesByMutualNearestPartners) {
  CameraFrame early, late;
  early.frame.time = timestamp_from_seconds(0);
  late.frame.time = timestamp_from_seconds(0.1);
  const auto blob = [](double x, double y) {
    Detection detection;
    detection.centre = {x, y};
    return detection;
  };
  early.detections = {blob(10, 10), blob(100, 50), blob(300, 300)};  // the last has no partner
  late.detections = {blob(108, 54), blob(14, 8)};
  const auto moved = moved_to(timestamp_from_seconds(0.025), early, late);
  ASSERT_EQ(moved.size(), 2u);
  EXPECT_LT((moved[0].centre - Vector<2>(11, 9.5)).norm(), 1e-9);
  EXPECT_LT((moved[1].centre - Vector<2>(102, 51)).norm(), 1e-9);
}

TEST(Feed, SaysWhichCameraAndWhy) {
  RigCamera camera;
  camera.name = "left";
  const auto message_of = [&] {
    try {
      Feed(camera, CameraId{});
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message_of().find("camera \"left\" has neither images nor detections"), std::string::npos);
  camera.source = "no_such_film.mp4";
  EXPECT_NE(message_of().find("camera \"left\": no_such_film.mp4"), std::string::npos) << message_of();
  const test::TemporaryFolder folder;
  test::ffmpeg("-f lavfi -i testsrc=size=320x240:rate=10 -t 1 -c:v mpeg4 " + folder / "film.avi");
  camera.source = folder / "film.avi";
  camera.region = cv::Rect(300, 200, 100, 100);
  EXPECT_NE(message_of().find("region 100x100 at (300, 200) is not within"), std::string::npos) << message_of();
}

TEST(Feed, HonoursRegionRateAndOffset) {
  const test::TemporaryFolder folder;
  test::ffmpeg("-f lavfi -i testsrc=size=320x240:rate=10 -t 1 -c:v mpeg4 " + folder / "film.avi");
  RigCamera camera;
  camera.source = folder / "film.avi";
  camera.region = cv::Rect(20, 40, 200, 100);
  camera.rate_hz = 5;
  camera.offset_s = 0.5;
  Feed feed(camera, CameraId{3});
  EXPECT_EQ(feed.camera().size, cv::Size(200, 100));
  int count = 0;
  for (auto frame = feed.next(); frame; frame = feed.next()) {
    EXPECT_EQ(frame->frame.image.size(), cv::Size(200, 100));
    EXPECT_EQ(frame->frame.camera, CameraId{3});
    EXPECT_NEAR(seconds(frame->frame.time), 0.5 + count++ / 5.0, 1e-9);
  }
  EXPECT_EQ(count, 10);
  EXPECT_EQ(feed.state(), FeedState::ended);
  EXPECT_EQ(feed.again().next()->frame.image.size(), cv::Size(200, 100));
  EXPECT_EQ(feed.sample(5, 2, 300).size(), 5u);
}

TEST(Feed, WarnsOfARateThatIsNotTheVideosOwn) {
  const test::TemporaryFolder folder;
  test::ffmpeg("-f lavfi -i testsrc=size=64x48:rate=60000/1001 -t 0.5 -c:v mpeg4 " + folder / "film.mp4");
  RigCamera camera;
  camera.name = "left";
  camera.source = folder / "film.mp4";
  EXPECT_TRUE(Feed(camera, CameraId{0}).warnings().empty());
  camera.rate_hz = 60;
  EXPECT_TRUE(Feed(camera, CameraId{0}).warnings().empty()) << "of 59.94 that is the same";
  camera.rate_hz = 120;
  const Feed feed(camera, CameraId{0});
  ASSERT_EQ(feed.warnings().size(), 1u);
  const std::string warning = feed.warnings().front();
  for (const char* part : {"camera \"left\"", "59.94", "120", "remove the rate"})
    EXPECT_NE(warning.find(part), std::string::npos) << warning;
}

}  // namespace
}  // namespace marey::pipeline::corridor
