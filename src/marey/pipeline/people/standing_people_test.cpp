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
#include "marey/pipeline/people/people_in_picture.h"
#include "marey/simulate/people/people_film.h"

namespace marey::pipeline::people {
namespace {

using marey::simulate::people::PeopleFilm;
using marey::simulate::people::PeopleFilmOptions;
using marey::simulate::people::PeopleSituation;

std::shared_ptr<const PeopleFilm> film_standing(std::uint64_t seed, const PeopleFilmOptions& options) {
  return std::make_shared<PeopleFilm>(PeopleSituation::standing, seed, options);
}

PeopleFilmOptions small_film() {
  PeopleFilmOptions options;
  options.size = {384, 288};
  options.height_px = 44;
  options.rate_hz = 10;
  options.frames = 220;
  options.people = 6;
  options.samples = 2;
  return options;
}

/// Boxes by frame, of one track or one person.
using Way = std::map<std::int64_t, Box>;

class Ways final : public Sink {
 public:
  explicit Ways(std::map<TrackId, Way>& ways) : ways_(ways) {}
  std::string name() const override { return "ways"; }
  Wants begin(const RecordingHeader& /*header*/) override { return {}; }
  void write(const Instant& instant) override {
    for (const Sample& sample : instant.samples) ways_[sample.track].emplace(instant.index, *sample.box);
  }
  void finish() override {}

 private:
  std::map<TrackId, Way>& ways_;
};

corridor::Summary track(const std::shared_ptr<const PeopleFilm>& film, bool live, std::map<TrackId, Way>& ways) {
  corridor::FeedOptions how;
  how.open = [&] { return marey::simulate::people::make_source(film); };
  how.opens_again = true;
  how.ahead = 0;
  RigCamera camera;
  camera.source = "film";
  corridor::Feed feed(camera, CameraId{}, how);
  PeopleInPictureOptions options;
  options.live = live;
  const auto stage = people_in_picture(feed, options);
  corridor::Sinks sinks;
  sinks.add(std::make_unique<Ways>(ways));
  std::vector<corridor::Feed> feeds;
  feeds.push_back(std::move(feed));
  corridor::Clock clock(std::move(feeds));
  return corridor::run(*stage, clock, sinks);
}

/// Where each of those who stand is seen, while they do: the first half of the people, before they move by half their height.
std::map<int, Way> standing_in(const PeopleFilm& film) {
  std::map<int, Way> standing;
  std::map<int, Box> home;
  const int standers = (*film.options().people + 1) / 2;
  for (int frame = 0; frame < film.frames(); ++frame) {
    for (const auto& person : film.render(frame).people) {
      if (person.id > standers) continue;
      const Box box = person.whole.box();
      const Box& begin = home.emplace(person.id, box).first->second;
      const bool left = (box.centre() - begin.centre()).norm() > begin.height / 2;
      if (left || frame > film.frames() * 4 / 5 || person.visible_share < 0.6) continue;
      standing[person.id].emplace(frame, box);
    }
  }
  return standing;
}

/// The largest share of a person's way that one track lies on.
double followed(const Way& person, const std::map<TrackId, Way>& tracks) {
  std::size_t most = 0;
  for (const auto& [id, way] : tracks) {
    most = std::max(most, static_cast<std::size_t>(std::count_if(person.begin(), person.end(), [&, &track = way](const auto& at) {
                      const auto found = track.find(at.first);
                      return found != track.end() && geometry::iou(found->second, at.second) > 0.5;
                    })));
  }
  return static_cast<double>(most) / static_cast<double>(person.size());
}

TEST(StandingPeople, AreTrackedFromTheFirstFrameOnOnceTheyHaveWalkedOff) {
  int people = 0, added = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto film = film_standing(seed, small_film());
    std::map<TrackId, Way> tracks;
    const corridor::Summary summary = track(film, false, tracks);
    for (const auto& [id, way] : standing_in(*film)) {
      ++people;
      added += followed(way, tracks) > 0.9;
    }
    EXPECT_EQ(summary.notes.size(), 1U);
  }
  EXPECT_GE(added, 0.9 * people) << people;
}

TEST(StandingPeople, AreSaidToHaveComeOutOfTheBackgroundWhereNothingIsReadTwice) {
  const auto film = film_standing(1, small_film());
  std::map<TrackId, Way> tracks;
  const corridor::Summary summary = track(film, true, tracks);
  EXPECT_GE(std::count_if(summary.notes.begin(), summary.notes.end(),
                          [](const std::string& note) { return note.find("came out of the background") != note.npos; }),
            3);
}

TEST(StandingPeople, TracksAreTheSameForAnyNumberOfThreads) {
  const auto film = film_standing(2, small_film());
  for (const bool live : {false, true}) {
    std::map<TrackId, Way> with_one;
    for (const std::size_t threads : {1, 2, 4}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      std::map<TrackId, Way> tracks;
      track(film, live, tracks);
      if (threads == 1) with_one = tracks;
      EXPECT_GE(tracks.size(), 4U);
      EXPECT_TRUE(with_one == tracks) << threads << " threads" << (live ? ", live" : "");
    }
  }
}

/// A detector that sees nothing and holds a picture for the scene.
class HeldScene final : public detect::Detector {
 public:
  explicit HeldScene(Picture scene) : scene_(std::move(scene)) {}
  detect::Detections detect(const Frame& /*frame*/, std::span<const Expected> /*expected*/) override { return {}; }
  Picture scene() const override { return scene_; }
  void believe(const Picture& /*picture*/, const cv::Mat& mask, cv::Point corner) override {
    believed.emplace_back(corner.x, corner.y, cv::countNonZero(mask));
  }
  std::vector<cv::Point3i> believed;

 private:
  Picture scene_;
};

TEST(StandingPeople, LookingBeforeTheDetectorIsDoneChangesNothing) {
  const auto film = film_standing(3, small_film());
  const Picture scene = film->render(0).picture;
  // Before every frame, before none, and before some that `see` is then not asked about.
  std::vector<std::vector<cv::Point3i>> believed;
  std::vector<std::vector<std::string>> said;
  for (const int every : {1, 0, 3}) {
    StandingPeople standing(scene);
    HeldScene detector(scene);
    for (int index = 0; index < film->frames(); ++index) {
      const auto shown = film->render(index);
      Frame frame;
      frame.index = index;
      frame.time = timestamp_from_seconds(index / 10.0);
      frame.picture = shown.picture;
      std::vector<Track<2>> tracks;
      for (const auto& person : shown.people) {
        Track<2>& one = tracks.emplace_back();
        one.id = TrackId{person.id};
        one.confirmed = true;
        one.box = person.whole.box();
      }
      if (every > 0 && index % every == 0) standing.look(frame);
      if (index % 7 != 6) standing.see(frame, tracks, detector);
    }
    believed.push_back(detector.believed);
    said.push_back(standing.said());
  }
  EXPECT_GE(said[0].size(), 2U);
  EXPECT_EQ(said[0], said[1]);
  EXPECT_EQ(said[0], said[2]);
  EXPECT_EQ(believed[0], believed[1]);
  EXPECT_EQ(believed[0], believed[2]);
}

}  // namespace
}  // namespace marey::pipeline::people
