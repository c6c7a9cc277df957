#include "marey/track/ground/offline/ground_recorder.h"

#include <cmath>
#include <map>
#include <random>
#include <set>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace marey::track::ground::offline {
namespace {

constexpr Appearance white_shirt{.lightness = 90, .a = 0, .b = 0, .deviation = 5};
constexpr Appearance blue_shirt{.lightness = 35, .a = 15, .b = -50, .deviation = 5};

struct Sighting {
  int track = 0;
  double x = 0, y = 0;
  std::optional<Appearance> clothing = {};
  bool confirmed = true;
  bool observed = true;
  CameraId camera{};
  double sigma = 0.1;
};

/// Records instants as a tracker would report them, one inspection a camera.
class Story {
 public:
  explicit Story(double rate = 25) : rate_(rate) {}

  void instant(const std::vector<Sighting>& detected, double late = 0) {
    const Timestamp now = timestamp_from_seconds(frame_ / rate_);
    std::map<CameraId, std::vector<Observation<2>>> observations;
    std::vector<Track<2>> tracks;
    std::vector<std::tuple<CameraId, int, TrackId>> claims;
    for (const Sighting& s : detected) {
      Track<2> track;
      track.id = TrackId{s.track};
      track.position = Vector<2>(s.x, s.y);
      track.velocity = Vector<2>(5, 0);
      track.confirmed = s.confirmed;
      if (tracks.empty() || tracks.back().id != track.id) tracks.push_back(track);
      if (!s.observed) continue;
      Observation<2> observation;
      observation.value = Vector<2>(s.x, s.y);
      observation.covariance = s.sigma * s.sigma * Matrix<2>::Identity();
      observation.camera = s.camera;
      observation.appearance = s.clothing;
      auto& list = observations[s.camera];
      claims.emplace_back(s.camera, static_cast<int>(list.size()), track.id);
      list.push_back(observation);
    }
    std::vector<CameraObservations> appearances;
    std::map<CameraId, int> look_of;
    for (const auto& [camera, list] : observations) {
      look_of[camera] = static_cast<int>(appearances.size());
      appearances.push_back({camera, now - duration_from_seconds(late), list});
    }
    std::vector<ObservationMatch> reported;
    for (const auto& [camera, index, track] : claims) reported.push_back({track, look_of[camera], index});
    recorder_.add(frame_++, now, tracks, appearances, reported);
  }

  double now() const { return frame_ / rate_; }
  GroundRecorder::Joined join(const GroundJoinOptions& options = {}) { return std::move(recorder_).join(options); }

 private:
  double rate_;
  int frame_ = 0;
  GroundRecorder recorder_;
};

struct Row {
  std::int32_t frame = 0;
  Sample sample;

  Vector<2> location() const { return sample.position.head<2>(); }
  std::size_t person() const { return static_cast<std::size_t>(number(sample.track)) - 1; }
};

/// By frame, then by person.
std::vector<Row> rows_of(const Recording& recording) {
  std::vector<Row> rows;
  InstantsOf instants(recording);
  while (const auto instant = instants.next()) {
    for (const Sample& sample : instant->samples) rows.push_back({static_cast<std::int32_t>(instant->index), sample});
  }
  return rows;
}

TEST(GroundRecorder, PredictsPersonBeforeCameraStart) {
  Story story;
  for (int k = 0; k < 50; ++k) {
    std::vector<Sighting> detected = {{.track = 1, .x = 0.2 * k, .y = 0}};
    if (k >= 5) detected.push_back({.track = 2, .x = 30 + 0.08 * k, .y = 5, .camera = CameraId{1}});
    if (k >= 20) detected.push_back({.track = 3, .x = 60 + 0.08 * k, .y = 5, .camera = CameraId{1}});
    story.instant(detected);
  }
  const GroundRecorder::Joined joined = story.join();
  ASSERT_EQ(joined.recording.tracks().size(), 3U);
  const TrackColumns& late = joined.recording.tracks()[1];
  ASSERT_EQ(late.at().front(), 0);
  for (std::size_t row = 0; row < 5; ++row) {
    EXPECT_EQ(late.sample(row).provenance, Provenance::predicted);
    EXPECT_NEAR(late.x()[row], 30 + 0.08 * static_cast<double>(row), 0.15) << row;
  }
  EXPECT_EQ(late.sample(5).provenance, Provenance::measured);
  EXPECT_EQ(joined.recording.tracks()[2].at().front(), 20) << "the camera had seen before, and not this one";
}

TEST(GroundRecorder, JoinsFillsAndTellsWhichTrackWasWhom) {
  Story story;
  for (int k = 0; k < 200; ++k) {
    const Vector<2> location(0.1 * k, 3);
    if (k < 80) story.instant({{.track = 4, .x = location.x(), .y = location.y()}});
    if (k >= 80 && k < 120) story.instant({});
    if (k >= 120) story.instant({{.track = 9, .x = location.x(), .y = location.y()}});
  }
  const auto joined = story.join();
  ASSERT_EQ(joined.recording.tracks().size(), 1U);
  EXPECT_EQ(joined.recording.tracks()[0].id(), TrackId{1});
  ASSERT_EQ(joined.recording.samples(), 200);
  for (const Row& row : rows_of(joined.recording)) {
    EXPECT_EQ(row.sample.measured(), row.frame < 80 || row.frame >= 120);
    EXPECT_EQ(row.sample.cameras, row.sample.measured() ? 1U : 0U);
    EXPECT_NEAR(row.location().x(), 0.1 * row.frame, 0.1);
    EXPECT_NEAR(row.sample.velocity->x(), 2.5, 0.3);
  }
  EXPECT_EQ(joined.person_of(TrackId{4}, 79), TrackId{1});
  EXPECT_EQ(joined.person_of(TrackId{9}, 120), TrackId{1});
  EXPECT_EQ(joined.person_of(TrackId{9}, 119), std::nullopt);
  EXPECT_EQ(joined.person_of(TrackId{5}, 79), std::nullopt);
  EXPECT_TRUE(joined.recording.header.smoothed);
  EXPECT_EQ(joined.recording.header.frame.kind, FrameOfReference::Kind::ground);
  EXPECT_EQ(joined.recording.header.rate_hz, 25);
}

TEST(GroundRecorder, SeveralCamerasBecomeOnePlaceByWhatTheyKnow) {
  Story story;
  for (int k = 0; k < 50; ++k) {
    story.instant({{.track = 1, .x = 10, .y = 0, .camera = CameraId{0}, .sigma = 0.1},
                   {.track = 1, .x = 11, .y = 0, .camera = CameraId{2}, .sigma = 0.3}});
  }
  const auto joined = story.join();
  ASSERT_EQ(joined.recording.samples(), 50);
  EXPECT_EQ(joined.recording.tracks()[0].cameras()[20], 0b101U);
  EXPECT_NEAR(joined.recording.tracks()[0].x()[20], 10.1, 1e-3);
}

TEST(GroundRecorder, LateFramesAreBroughtToTheInstant) {
  Story story;
  for (int k = 0; k < 50; ++k) story.instant({{.track = 1, .x = 0.2 * k - 0.05, .y = 0}}, 0.01);  // at 5 m/s
  const auto joined = story.join();
  EXPECT_NEAR(joined.recording.tracks()[0].x()[25], 5.0, 1e-2);
}

TEST(GroundRecorder, DropsBriefRareAndUnconfirmedTracks) {
  Story story;
  for (int k = 0; k < 250; ++k) {
    std::vector<Sighting> detected{{.track = 1, .x = 0.1 * k, .y = 3}};
    if (k < 100) detected.push_back({.track = 2, .x = 50, .y = 50, .confirmed = false});
    if (k >= 30 && k < 40) detected.push_back({.track = 3, .x = 70, .y = 50});
    if (k > 100) detected.push_back({.track = 4, .x = 90, .y = 10, .observed = k % 20 == 0});
    story.instant(detected);
  }
  const auto joined = story.join();
  EXPECT_EQ(joined.recording.tracks().size(), 1U);
  EXPECT_EQ(joined.recording.samples(), 250);
}

TEST(GroundRecorder, AnEmptyOneIsAnEmptyRecording) {
  Story nothing;
  EXPECT_TRUE(nothing.join().recording.tracks().empty());
  Story no_person;
  for (int k = 0; k < 10; ++k) no_person.instant({});
  EXPECT_TRUE(no_person.join().recording.tracks().empty());
}

TEST(GroundRecorder, ALongGapIsJoinedButNothingIsSaidOfIt) {
  Story story;
  for (int k = 0; k < 400; ++k) {
    if (k < 100 || k >= 300) {
      story.instant({{.track = k < 100 ? 1 : 2, .x = 30, .y = 3 + 0.001 * k}});
    } else {
      story.instant({});
    }
  }
  const auto joined = story.join();
  EXPECT_EQ(joined.recording.tracks().size(), 1U);
  EXPECT_EQ(joined.recording.samples(), 200);
}

/// Two in other shirts run into each other; the tracker comes out with their names exchanged.
TEST(GroundRecorder, ExchangedIdentitiesAreExchangedBack) {
  Story story;
  std::mt19937_64 engine(5);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 250; ++k) {
    const double t = 0.04 * k - 5;
    const Vector<2> a(20 + 2 * t, 10 + 0.3 * t * t), b(20 - 2 * t, 10.3 - 0.3 * t * t);
    const auto noise = [&] { return 0.1 * normal(engine); };
    const bool swapped = k >= 125;
    const Vector<2>& first = swapped ? b : a;
    const Vector<2>& second = swapped ? a : b;
    story.instant(
        {{.track = 1, .x = first.x() + noise(), .y = first.y() + noise(), .clothing = swapped ? blue_shirt : white_shirt},
         {.track = 2, .x = second.x() + noise(), .y = second.y() + noise(), .clothing = swapped ? white_shirt : blue_shirt}});
  }
  const auto joined = story.join();
  ASSERT_EQ(joined.recording.tracks().size(), 2U);
  ASSERT_EQ(joined.recording.samples(), 500);
  for (const Row& row : rows_of(joined.recording)) {
    const double t = 0.04 * row.frame - 5;
    if (std::abs(t) < 0.5) continue;
    const bool first = joined.clothing[row.person()]->lightness > 60;
    const Vector<2> truth = first ? Vector<2>(20 + 2 * t, 10 + 0.3 * t * t) : Vector<2>(20 - 2 * t, 10.3 - 0.3 * t * t);
    EXPECT_LT((row.location() - truth).norm(), 0.5) << "frame " << row.frame;
  }
  EXPECT_NE(joined.person_of(TrackId{1}, 0), joined.person_of(TrackId{1}, 249));
}

/// Where the first of two who run past each other is at time t, and the second; s and m.
Vector<2> runs_right(double t) {
  return {20 + 4 * t, 10};
}
Vector<2> runs_left(double t) {
  return {20 - 4 * t, 10.3};
}

/// The story of two who run past each other at t = 0; from then on with their names exchanged, or not.
GroundRecorder::Joined two_pass(bool ids_swap) {
  Story story;
  std::mt19937_64 engine(8);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 150; ++k) {
    const double t = 0.04 * k - 3;
    const bool swapped = ids_swap && t >= 0;
    const Vector<2> first = swapped ? runs_left(t) : runs_right(t);
    const Vector<2> second = swapped ? runs_right(t) : runs_left(t);
    const auto noise = [&] { return 0.1 * normal(engine); };
    story.instant({{.track = 1, .x = first.x() + noise(), .y = first.y() + noise()},
                   {.track = 2, .x = second.x() + noise(), .y = second.y() + noise()}});
  }
  return story.join();
}

TEST(GroundRecorder, RunnerPassingAnotherContinues) {
  for (const bool swapped : {false, true}) {
    const auto joined = two_pass(swapped);
    ASSERT_EQ(joined.recording.tracks().size(), 2U);
    for (const Row& row : rows_of(joined.recording)) {
      const double t = 0.04 * row.frame - 3;
      const bool right = row.sample.track == *joined.person_of(TrackId{1}, 0);
      EXPECT_LT((row.location() - (right ? runs_right(t) : runs_left(t))).norm(), 0.3) << "frame " << row.frame;
    }
    EXPECT_EQ(joined.person_of(TrackId{1}, 0) == joined.person_of(TrackId{1}, 149), !swapped);
  }
}

TEST(GroundRecorder, ReturnsTakenOverTrack) {
  Story story;
  std::mt19937_64 engine(4);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 150; ++k) {
    const double t = 0.04 * k - 3;
    const Vector<2> right = runs_right(t) + 0.1 * Vector<2>(normal(engine), normal(engine));
    const Vector<2> left = runs_left(t) + 0.1 * Vector<2>(normal(engine), normal(engine));
    // The track of the one continues with the other, whose track ends; the one is found again under a new id.
    std::vector<Sighting> detected{{.track = 1, .x = t < 0 ? right.x() : left.x(), .y = t < 0 ? right.y() : left.y()}};
    if (t < -0.1) detected.push_back({.track = 2, .x = left.x(), .y = left.y()});
    if (t > 0.3) detected.push_back({.track = 3, .x = right.x(), .y = right.y()});
    story.instant(detected);
  }
  const auto joined = story.join();
  ASSERT_EQ(joined.recording.tracks().size(), 2U);
  EXPECT_EQ(joined.person_of(TrackId{1}, 0), joined.person_of(TrackId{3}, 149));
  EXPECT_EQ(joined.person_of(TrackId{2}, 0), joined.person_of(TrackId{1}, 149));
}

/// People who run about as people do, five metres apart at first.
struct Runner {
  Vector<2> location, velocity, push;
  double length = 0;  ///< m, of the path

  void go_on(std::mt19937_64& engine) {
    std::normal_distribution<double> normal;
    push = 0.9 * push + 0.6 * Vector<2>(normal(engine), normal(engine));
    velocity = 0.99 * velocity + 0.04 * push;
    location += 0.04 * velocity;
    length += 0.04 * velocity.norm();
  }
};

/// What two cameras see of a runner: a tenth of the observations is missed.
void inspect(const Runner& runner, int track, std::mt19937_64& engine, std::vector<Sighting>& detected) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0, 1);
  for (int camera = 0; camera < 2; ++camera) {
    const Vector<2> at = runner.location + 0.2 * Vector<2>(normal(engine), normal(engine));
    detected.push_back(
        {.track = track, .x = at.x(), .y = at.y(), .observed = unit(engine) > 0.1, .camera = CameraId{camera}, .sigma = 0.2});
  }
}

TEST(GroundRecorder, PlacesAndSpeedsAreNearTheTruth) {
  std::mt19937_64 engine(11);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Runner> runners;
  for (int k = 0; k < 20; ++k) runners.push_back({{5.0 * k, 40 * unit(engine)}, {0, 0}, {0, 0}});
  std::vector<std::vector<Runner>> truth;
  Story story;
  for (int frame = 0; frame < 1500; ++frame) {
    std::vector<Sighting> detected;
    for (std::size_t k = 0; k < runners.size(); ++k) {
      runners[k].go_on(engine);
      inspect(runners[k], static_cast<int>(k) + 1, engine, detected);
    }
    truth.push_back(runners);
    story.instant(detected);
  }
  const auto joined = story.join();
  ASSERT_EQ(joined.recording.tracks().size(), 20U);
  double location = 0, speed = 0, in_sigmas = 0;
  std::map<int, double> length;
  std::map<int, Vector<2>> last;
  for (const Row& row : rows_of(joined.recording)) {
    const Runner& runner = truth[row.frame][number(*joined.person_of(row.sample.track, row.frame)) - 1];
    location += (row.location() - runner.location).squaredNorm();
    if (row.sample.covariance) {
      const Vector<2> off = row.location() - runner.location;
      in_sigmas += off.dot(row.sample.covariance->topLeftCorner<2, 2>().inverse() * off);
    }
    speed += std::pow(row.sample.velocity->norm() - runner.velocity.norm(), 2);
    const int identity = static_cast<int>(row.person());
    if (last.contains(identity)) length[identity] += (row.location() - last[identity]).norm();
    last[identity] = row.location();
  }
  const auto n = static_cast<double>(joined.recording.samples());
  EXPECT_LT(std::sqrt(location / n), 0.12);
  EXPECT_LT(std::sqrt(speed / n), 0.25);
  EXPECT_GT(in_sigmas / n, 0.5) << "two, where covariances are just right;";
  EXPECT_LT(in_sigmas / n, 3) << "less, where errors are taken to persist and do not";
  for (const auto& [person, method] : length) EXPECT_NEAR(method / truth.back()[person].length, 1, 0.03);
}

}  // namespace
}  // namespace marey::track::ground::offline
