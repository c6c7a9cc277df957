// Every filter at every frame rate: people on a simulated street, as a detector sees them, through the whole of the job.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "marey/filter/default_motion.h"
#include "marey/filter/filters.h"
#include "marey/geometry/box.h"
#include "marey/pipeline/people/image_stage.h"
#include "marey/simulate/square/square_boxes.h"
#include "marey/simulate/square/square_cameras.h"

namespace marey::pipeline::people {
namespace {

constexpr double kLasts = 12;  // s
const cv::Size kImage(1920, 1080);

/// A street as one camera sees it: its people, and what a detector makes of them.
struct Street {
  double rate_hz = 0;
  std::vector<std::vector<Detection>> detected;  // by frame
  std::vector<std::map<int, Box>> truth;         // by frame: people by their ids
  std::map<int, int> frames_of = {};             // in which each of them is
};

Detection detection_of(const Box& box, double score) {
  Detection detection;
  detection.box = box;
  detection.centre = box.centre();
  detection.score = score;
  detection.covariance = Vector<2>(std::pow(1 + 0.08 * box.width, 2), std::pow(1 + 0.04 * box.height, 2)).asDiagonal();
  return detection;
}

Street video_street(double rate_hz) {
  using namespace marey::simulate::square;
  const SquareOptions options{.arrivals = 0.3, .runners = 0.1, .stopping = 0.2};
  SquareMotion motion(5, options);
  const Rig rig = square_cameras(1, rate_hz, options, 5);
  const Camera camera = *rig.cameras.front().camera();
  marey::simulate::Random noise(6);
  Street street{.rate_hz = rate_hz, .detected = {}, .truth = {}};
  for (int frame = 0; frame < kLasts * rate_hz; ++frame) {
    motion.advance(frame / rate_hz);
    auto& detected = street.detected.emplace_back();
    for (const LabelledBox& box :
         square_boxes(motion.people(), motion, camera, frame, {.missed = 0.05, .false_alarms = 0.02}, noise))
      detected.push_back(detection_of(box.box, 0.9));
    auto& truth = street.truth.emplace_back();
    for (const SquarePerson& person : motion.people()) {
      marey::simulate::Random none(1);
      const auto box = square_boxes({&person, 1}, motion, camera, frame, {.missed = 0, .size_noise = 0, .hidden_missed = 0}, none);
      if (box.empty()) continue;
      truth.emplace(person.id, box.front().box);
      ++street.frames_of[person.id];
    }
  }
  return street;
}

class StreetSource final : public Source {
 public:
  explicit StreetSource(const Street& street) : street_(street), image_(cv::Mat(kImage, CV_8UC1, cv::Scalar(90))) {
    info_.name = "street";
    info_.size = kImage;
    info_.rate_hz = street.rate_hz;
  }
  const SourceInfo& info() const override { return info_; }
  std::optional<Frame> next() override {
    if (next_ == std::ssize(street_.detected)) return std::nullopt;
    Frame frame;
    frame.index = next_;
    frame.time = timestamp_from_seconds(static_cast<double>(next_++) / street_.rate_hz);
    frame.image = image_;
    return frame;
  }

 private:
  const Street& street_;
  SourceInfo info_;
  Image image_;
  std::int64_t next_ = 0;
};

class StreetDetector final : public detect::Detector {
 public:
  StreetDetector(const Street& street, int every) : street_(street), every_(every) {}
  detect::Detections detect(const Frame& frame, std::span<const Expected> /*expected*/) override {
    if (frame.index % every_ != 0) return {.detections = {}, .foreground = {}, .searched = false};
    return {.detections = street_.detected[static_cast<std::size_t>(frame.index)], .foreground = {}};
  }

 private:
  const Street& street_;
  int every_;
};

/// For each person in how many frames a track lies on them.
class Matches final : public Sink {
 public:
  Matches(const Street& street, std::map<int, int>& found) : street_(street), found_(found) {}
  std::string name() const override { return "matches"; }
  SinkRequirements begin(const RecordingHeader& /*header*/) override { return {}; }
  void write(const Instant& instant) override {
    constexpr double kOnIt = 0.5;
    for (const auto& [id, box] : street_.truth[static_cast<std::size_t>(instant.index)]) {
      found_[id] += std::any_of(instant.samples.begin(), instant.samples.end(),
                                [&, &person = box](const Sample& sample) { return geometry::iou(*sample.box, person) > kOnIt; });
    }
  }
  void finish() override {}

 private:
  const Street& street_;
  std::map<int, int>& found_;
};

/// How many people are found for half of their time at least, of those who are there for two seconds.
/// `every`: only every n-th frame is searched.
std::pair<int, int> people_found(const Street& street, const filter::FilterOptions& filter, bool live, int every = 1) {
  corridor::FeedOptions how;
  how.open = [&] { return std::make_unique<StreetSource>(street); };
  how.ahead = 0;
  RigCamera camera;
  camera.source = "street";
  corridor::Feed feed(camera, CameraId{}, how);
  feed.find(std::make_unique<StreetDetector>(street, every));
  ImagePeopleOptions options;
  options.tracker.filter = filter;
  options.live = live;
  const auto stage = people_in_image(feed, options);
  std::map<int, int> matched;
  corridor::Sinks sinks;
  sinks.add(std::make_unique<Matches>(street, matched));
  std::vector<corridor::Feed> feeds;
  feeds.push_back(std::move(feed));
  corridor::Clock clock(std::move(feeds));
  corridor::run(*stage, clock, sinks);
  std::pair<int, int> found;
  for (const auto& [id, frames] : street.frames_of) {
    if (frames < 2 * street.rate_hz) continue;
    ++found.second;
    found.first += 2 * matched[id] >= frames;
  }
  return found;
}

TEST(PeopleFilters, EveryoneIsFoundAtEveryRateByEveryFilter) {
  const std::set<std::string_view> good = {"alpha-beta", "kalman", "ekf", "ukf", "imm"};
  for (const double rate_hz : {2.0, 5.0, 7.0, 10.0, 25.0, 60.0, 120.0}) {
    const Street street = video_street(rate_hz);
    for (const bool live : {false, true}) {
      const auto typical = people_found(street, ImagePeopleOptions{}.tracker.filter, live);
      for (const filter::NamedFilter& named : filter::named_filters()) {
        const auto found = people_found(street, filter::filter_for_people_in_image(named.name), live);
        EXPECT_GT(found.first, 0) << named.name << " at " << rate_hz << " Hz, live " << live;
        if (good.contains(named.name)) {
          EXPECT_GE(found.first, 0.9 * typical.first) << named.name << " at " << rate_hz << " Hz, live " << live;
        }
      }
    }
  }
}

TEST(PeopleFilters, SkippedFramesKeepEveryone) {
  const filter::FilterOptions filter = ImagePeopleOptions{}.tracker.filter;
  const Street street = video_street(25);
  for (const bool live : {false, true}) {
    const auto typical = people_found(street, filter, live);
    for (const int every : {2, 5}) {
      const auto found = people_found(street, filter, live, every);
      EXPECT_GE(found.first, 0.9 * typical.first) << "of " << typical.first << ", every " << every << ", live " << live;
    }
  }
}

}  // namespace
}  // namespace marey::pipeline::people
