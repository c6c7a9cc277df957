// People who stand in the scene from the first frame on, as a detector with a background model learns it.
#include "marey/pipeline/people/standing_people.h"

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "marey/geometry/box.h"
#include "marey/pipeline/people/image_stage.h"
#include "marey/simulate/people/people_video.h"

namespace marey::pipeline::people {
namespace {

using marey::simulate::people::PeopleSituation;
using marey::simulate::people::PeopleVideo;
using marey::simulate::people::PeopleVideoOptions;

std::shared_ptr<const PeopleVideo> video_standing(std::uint64_t seed, const PeopleVideoOptions& options) {
  return std::make_shared<PeopleVideo>(PeopleSituation::standing, seed, options);
}

PeopleVideoOptions small_video() {
  PeopleVideoOptions options;
  options.size = {384, 288};
  options.height_px = 44;
  options.rate_hz = 10;
  options.frames = 220;
  options.people = 6;
  options.samples = 2;
  return options;
}

/// Boxes by frame, of one track or one person.
using Trajectory = std::map<std::int64_t, Box>;

class Trajectories final : public Sink {
 public:
  explicit Trajectories(std::map<TrackId, Trajectory>& trajectories) : trajectories_(trajectories) {}
  std::string name() const override { return "ways"; }
  SinkRequirements begin(const RecordingHeader& /*header*/) override { return {}; }
  void write(const Instant& instant) override {
    for (const Sample& sample : instant.samples) trajectories_[sample.track].emplace(instant.index, *sample.box);
  }
  void finish() override {}

 private:
  std::map<TrackId, Trajectory>& trajectories_;
};

corridor::Summary track(const std::shared_ptr<const PeopleVideo>& video, bool live, std::map<TrackId, Trajectory>& trajectories) {
  corridor::FeedOptions how;
  how.open = [&] { return marey::simulate::people::make_source(video); };
  how.opens_again = true;
  how.ahead = 0;
  RigCamera camera;
  camera.source = "film";
  corridor::Feed feed(camera, CameraId{}, how);
  ImagePeopleOptions options;
  options.live = live;
  const auto stage = people_in_image(feed, options);
  corridor::Sinks sinks;
  sinks.add(std::make_unique<Trajectories>(trajectories));
  std::vector<corridor::Feed> feeds;
  feeds.push_back(std::move(feed));
  corridor::Clock clock(std::move(feeds));
  return corridor::run(*stage, clock, sinks);
}

/// Where each of those who stand is seen, while they do: the first half of the people, before they move by half their height.
std::map<int, Trajectory> standing_in(const PeopleVideo& video) {
  std::map<int, Trajectory> standing;
  std::map<int, Box> home;
  const int standers = (*video.options().people + 1) / 2;
  for (int frame = 0; frame < video.frames(); ++frame) {
    for (const auto& person : video.render(frame).people) {
      if (person.id > standers) continue;
      const Box box = person.whole.box();
      const Box& begin = home.emplace(person.id, box).first->second;
      const bool left = (box.centre() - begin.centre()).norm() > begin.height / 2;
      if (left || frame > video.frames() * 4 / 5 || person.visible_fraction < 0.6) continue;
      standing[person.id].emplace(frame, box);
    }
  }
  return standing;
}

/// The largest share of a person's trajectory that one track lies on.
double tracked(const Trajectory& person, const std::map<TrackId, Trajectory>& tracks) {
  std::size_t maximum = 0;
  for (const auto& [id, trajectory] : tracks) {
    maximum = std::max(
        maximum, static_cast<std::size_t>(std::count_if(person.begin(), person.end(), [&, &track = trajectory](const auto& at) {
          const auto found = track.find(at.first);
          return found != track.end() && geometry::iou(found->second, at.second) > 0.5;
        })));
  }
  return static_cast<double>(maximum) / static_cast<double>(person.size());
}

TEST(StandingPeople, AreTrackedFromTheFirstFrameOnOnceTheyHaveWalkedOff) {
  int people = 0, added = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto video = video_standing(seed, small_video());
    std::map<TrackId, Trajectory> tracks;
    const corridor::Summary summary = track(video, false, tracks);
    for (const auto& [id, trajectory] : standing_in(*video)) {
      ++people;
      added += tracked(trajectory, tracks) > 0.9;
    }
    EXPECT_EQ(summary.notes.size(), 1U);
  }
  EXPECT_GE(added, 0.9 * people) << people;
}

TEST(StandingPeople, AreSaidToHaveComeOutOfTheBackgroundWhereNothingIsReadTwice) {
  const auto video = video_standing(1, small_video());
  std::map<TrackId, Trajectory> tracks;
  const corridor::Summary summary = track(video, true, tracks);
  EXPECT_GE(std::count_if(summary.notes.begin(), summary.notes.end(),
                          [](const std::string& note) { return note.find("came out of the background") != note.npos; }),
            3);
}

TEST(StandingPeople, TracksAreTheSameForAnyNumberOfThreads) {
  const auto video = video_standing(2, small_video());
  for (const bool live : {false, true}) {
    std::map<TrackId, Trajectory> with_one;
    for (const std::size_t threads : {1, 2, 4}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      std::map<TrackId, Trajectory> tracks;
      track(video, live, tracks);
      if (threads == 1) with_one = tracks;
      EXPECT_GE(tracks.size(), 4U);
      EXPECT_TRUE(with_one == tracks) << threads << " threads" << (live ? ", live" : "");
    }
  }
}

/// A detector that sees nothing and holds an image for the scene.
class HeldScene final : public detect::Detector {
 public:
  explicit HeldScene(Image scene) : scene_(std::move(scene)) {}
  detect::Detections detect(const Frame& /*frame*/, std::span<const Expected> /*expected*/) override { return {}; }
  Image scene() const override { return scene_; }
  void trust(const Image& /*image*/, const cv::Mat& mask, cv::Point corner) override {
    trusted.emplace_back(corner.x, corner.y, cv::countNonZero(mask));
  }
  std::vector<cv::Point3i> trusted;

 private:
  Image scene_;
};

TEST(StandingPeople, LookingBeforeTheDetectorIsDoneChangesNothing) {
  const auto video = video_standing(3, small_video());
  const Image scene = video->render(0).image;
  // Before every frame, before none, and before some that `see` is then not asked about.
  std::vector<std::vector<cv::Point3i>> trusted;
  std::vector<std::vector<std::string>> stated;
  for (const int every : {1, 0, 3}) {
    StandingPeople standing(scene);
    HeldScene detector(scene);
    for (int index = 0; index < video->frames(); ++index) {
      const auto shown = video->render(index);
      Frame frame;
      frame.index = index;
      frame.time = timestamp_from_seconds(index / 10.0);
      frame.image = shown.image;
      std::vector<Track<2>> tracks;
      for (const auto& person : shown.people) {
        Track<2>& one = tracks.emplace_back();
        one.id = TrackId{person.id};
        one.confirmed = true;
        one.box = person.whole.box();
      }
      if (every > 0 && index % every == 0) standing.inspect(frame);
      if (index % 7 != 6) standing.observe_frame(frame, tracks, detector);
    }
    trusted.push_back(detector.trusted);
    stated.push_back(standing.stated());
  }
  EXPECT_GE(stated[0].size(), 2U);
  EXPECT_EQ(stated[0], stated[1]);
  EXPECT_EQ(stated[0], stated[2]);
  EXPECT_EQ(trusted[0], trusted[1]);
  EXPECT_EQ(trusted[0], trusted[2]);
}

}  // namespace
}  // namespace marey::pipeline::people
