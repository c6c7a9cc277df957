#include "marey/pipeline/people/ground/track_ground.h"

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "marey/format/match/ground_file.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/tracks/mot.h"
#include "marey/pipeline/simulate/match_files.h"
#include "marey/pipeline/take/evaluate_match.h"
#include "marey/simulate/match/match_homographies.h"

#include "support/files.h"

namespace marey::pipeline::people::ground {
namespace {

constexpr double kReach = 1.5;  // m

take::MatchEvaluation assess(const std::string& truth, const std::string& tracks) {
  return take::evaluate_match(format::match::read_ground(truth), format::match::read_ground(tracks), kReach);
}

double fraction(std::int64_t part, std::int64_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

/// A match of 12.5 frames a second, seen by `cameras` round the pitch.
simulate::MatchFilesOptions match(std::uint64_t seed, double seconds, int cameras = 6) {
  simulate::MatchFilesOptions options;
  options.cameras.cameras = cameras, options.cameras.rate_hz = 12.5;
  options.seed = seed, options.seconds = seconds;
  return options;
}

Rig simulate(const std::string& folder, const simulate::MatchFilesOptions& options) {
  simulate::write_match(options, folder);
  return format::rig::read_rig(folder + "/rig.toml");
}

GroundOutput to(const std::string& tracks) {
  GroundOutput output;
  output.tracks = tracks;
  return output;
}

PeopleOnGroundOptions over_pitch(const geometry::PitchSize& pitch = {}, double margin = 2) {
  PeopleOnGroundOptions options;
  options.pitch = pitch, options.margin = margin;
  return options;
}

constexpr double kPixelsPerMetre = 20;

/// An image of 50 m × 68 m of ground seen from straight above, whose left edge is at `from` m.
RigCamera plan(const std::string& name, double from, const std::string& detections) {
  RigCamera camera;
  camera.name = name, camera.detections = detections, camera.rate_hz = 10, camera.offset_s = 0;
  camera.size = cv::Size(static_cast<int>(50 * kPixelsPerMetre), static_cast<int>(68 * kPixelsPerMetre));
  camera.ground_from_image = Matrix<3>::Identity() / kPixelsPerMetre;
  (*camera.ground_from_image)(2, 2) = 1;
  (*camera.ground_from_image)(0, 2) = from;
  return camera;
}

/// One line of MOT text: a person's box, whose foot is at (x, y) m of a plan that begins at `from`; nothing outside the image.
std::string box_at(int frame, double x, double y, double from) {
  if (x < from + 1 || x > from + 49) return "";
  const double u = kPixelsPerMetre * (x - from), v = kPixelsPerMetre * y;
  return fmt::format("{},-1,{:.2f},{:.2f},16,40,0.9\n", frame + 1, u - 8 + 1, v - 40 + 1);
}

TEST(TrackGround, SixCamerasGiveEverybodyOneNumber) {
  const test::TemporaryFolder folder;
  const Rig rig = simulate(folder.path(), match(11, 24));
  const GroundSummary summary = track_ground(rig, to(folder / "out.csv"), over_pitch());
  EXPECT_EQ(summary.frames, 300);
  EXPECT_EQ(summary.tracks, 25);
  EXPECT_NEAR(summary.seconds, 299 / 12.5, 1e-6);
  const take::MatchEvaluation judgement = assess(folder / "truth.csv", folder / "out.csv");
  EXPECT_GT(*judgement.evaluation.scores.identity.f1, 0.97);
  EXPECT_LT(judgement.evaluation.position->rms, 0.15);
  EXPECT_LT(judgement.evaluation.speed->rms, 0.25);
}

TEST(TrackGround, TwoCamerasOnOneStandInTheUsersMirroredFrame) {
  const test::TemporaryFolder folder;
  simulate::MatchFilesOptions options = match(4, 16);
  options.cameras.stand = marey::simulate::match::MatchStand::football;
  const Rig rig = simulate(folder.path(), options);
  ASSERT_TRUE(rig.ground_from_world);
  ASSERT_LT(rig.ground_from_world->determinant(), 0);
  track_ground(rig, to(folder / "out.csv"), over_pitch());
  const take::MatchEvaluation judgement = assess(folder / "truth.csv", folder / "out.csv");
  const auto& clear = judgement.evaluation.scores.clear;
  EXPECT_GT(fraction(clear.matches, clear.matches + clear.misses), 0.85);
  EXPECT_LT(fraction(clear.false_positives, clear.matches + clear.false_positives), 0.1);
  EXPECT_LT(judgement.evaluation.velocity->rms, 1) << "velocities are mirrored too";
}

TEST(TrackGround, ACameraKnownByItsHomographyAloneIsEnough) {
  const test::TemporaryFolder folder;
  simulate::MatchFilesOptions options = match(2, 16, 3);
  options.cameras.distorted = false;
  Rig rig = simulate(folder.path(), options);
  for (RigCamera& camera : rig.cameras) {
    const Camera whole = *camera.camera();
    const geometry::BrownLens& lens = std::get<geometry::BrownLens>(whole.lens());
    Matrix<3> pinhole = Matrix<3>::Identity(), camera_from_ground;
    pinhole.topLeftCorner<2, 2>() = lens.focal.asDiagonal();
    pinhole.topRightCorner<2, 1>() = lens.principal;
    camera_from_ground << whole.camera_from_world().rotation.leftCols<2>(), whole.camera_from_world().translation;
    camera.ground_from_image = (pinhole * camera_from_ground).inverse();
    camera.lens.reset(), camera.camera_from_world.reset();
  }
  track_ground(rig, to(folder / "out.csv"), over_pitch());
  const take::MatchEvaluation judgement = assess(folder / "truth.csv", folder / "out.csv");
  const auto& clear = judgement.evaluation.scores.clear;
  EXPECT_GT(fraction(clear.matches, clear.matches + clear.misses), 0.9);
  EXPECT_LT(fraction(clear.false_positives, clear.matches + clear.false_positives), 0.1);
}

TEST(TrackGround, KeepsIdAcrossSeparateGrounds) {
  const test::TemporaryFolder folder;
  std::string left, right;
  for (int frame = 0; frame < 200; ++frame) {
    const double x = 38 + 0.2 * frame;  // 2 m/s; from 49 to 52 no camera sees it
    left += box_at(frame, x, 30, 0), right += box_at(frame, x, 30, 51);
    left += box_at(frame, 10, 50, 0);  // so that the first camera lasts
  }
  test::write_file(folder / "left.txt", left);
  test::write_file(folder / "right.txt", right);
  Rig rig;
  rig.cameras = {plan("left", 0, folder / "left.txt"), plan("right", 51, folder / "right.txt")};
  const GroundSummary summary = track_ground(rig, to(folder / "out.csv"));
  EXPECT_EQ(summary.tracks, 2);
  const Recording found = format::match::read_ground(folder / "out.csv");
  std::map<int, CameraMask> observed_by;
  for (const TrackColumns& track : found.tracks()) {
    for (const CameraMask cameras : track.cameras()) observed_by[number(track.id())] |= cameras;
  }
  EXPECT_EQ(observed_by, (std::map<int, CameraMask>{{1, 3}, {2, 1}})) << "who walks is seen by both";
}

/// A match of 20 s, cameras behind both touchlines, boxes that end beside the feet for a while, each camera known by a homography
/// that is off by half a metre.
Rig feet_that_err(const std::string& folder, std::uint64_t seed) {
  simulate::MatchFilesOptions options = match(seed, 20);
  options.cameras.stand = marey::simulate::match::MatchStand::sides;
  options.detector.foot_error = 0.25, options.detector.foot_along = 1, options.detector.size_noise = 0.01;
  const Rig exact = simulate(folder, options);
  return marey::simulate::match::known_by_homographies(exact, {}, 0.25, 0.6, seed);
}

TEST(TrackGround, TheWholeRecordingIsNoWorseThanLiveWhereFeetErr) {
  double live = 0, offline = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const test::TemporaryFolder folder;
    const Rig rig = feet_that_err(folder.path(), seed);
    for (const bool as_live : {true, false}) {
      PeopleOnGroundOptions options = over_pitch();
      options.live = as_live;
      if (!as_live) options.tracker.associate = track::ground::GroundAssociation::mht, options.learn.association = true;
      for (const std::string& warning : track_ground(rig, to(folder / "out.csv"), options).warnings)
        EXPECT_EQ(warning.find("look"), std::string::npos) << warning << ": no camera contradicts the others";
      const take::MatchEvaluation judgement = assess(folder / "truth.csv", folder / "out.csv");
      (as_live ? live : offline) += *judgement.evaluation.scores.identity.f1 / 3;
    }
  }
  EXPECT_GT(offline, live - 0.005);
  EXPECT_GT(offline, 0.95);
}

/// What the cameras were warned of, with one of them changed.
std::vector<std::string> warnings_with(const std::function<void(RigCamera&)>& change) {
  const test::TemporaryFolder folder;
  simulate::MatchFilesOptions options = match(3, 10, 4);
  options.cameras.rate_hz = 5;
  Rig rig = marey::simulate::match::known_by_homographies(simulate(folder.path(), options), {}, 0.05, 0.1, 3);
  change(rig.cameras[1]);
  return track_ground(rig, to(folder / "out.csv"), over_pitch()).warnings;
}

TEST(TrackGround, ACameraThatContradictsTheOthersIsNamed) {
  const auto moved = [](RigCamera& camera, const Matrix<3>& by) { *camera.ground_from_image = by * *camera.ground_from_image; };
  EXPECT_EQ(warnings_with([](RigCamera&) {}), std::vector<std::string>());
  const auto mirrored = warnings_with([&](RigCamera& camera) {
    Matrix<3> by = Matrix<3>::Identity();
    by(0, 0) = -1, by(0, 2) = geometry::PitchSize{}.length;
    moved(camera, by);
  });
  ASSERT_EQ(mirrored.size(), 1u);
  EXPECT_NE(mirrored[0].find("camera \"cam2\": its people are not where other cameras"), std::string::npos) << mirrored[0];
  const auto off = warnings_with([&](RigCamera& camera) {
    Matrix<3> by = Matrix<3>::Identity();
    by(0, 2) = 2.1, by(1, 2) = 2.2;
    moved(camera, by);
  });
  ASSERT_EQ(off.size(), 1u);
  EXPECT_NE(off[0].find("camera \"cam2\": its people are not where other cameras"), std::string::npos) << off[0];
}

TEST(TrackGround, PeopleBesideThePitchAreLeftOut) {
  const test::TemporaryFolder folder;
  std::string boxes;
  for (int frame = 0; frame < 100; ++frame)
    boxes += box_at(frame, 10 + 0.1 * frame, 20, 0) + box_at(frame, 20, 46, 0) + box_at(frame, 30, 43, 0);
  test::write_file(folder / "boxes.txt", boxes);
  Rig rig;
  rig.cameras = {plan("above", 0, folder / "boxes.txt")};
  const auto people = [&](double margin) { return track_ground(rig, to(folder / "out.csv"), over_pitch({50, 40}, margin)).tracks; };
  EXPECT_EQ(people(0), 1);
  EXPECT_EQ(people(4), 2);
  EXPECT_EQ(people(8), 3);
  EXPECT_EQ(track_ground(rig, to(folder / "out.csv")).tracks, 3) << "without a pitch every person counts";
}

TEST(TrackGround, ACameraThatWasStartedLaterIsShifted) {
  const test::TemporaryFolder folder;
  std::string first, second;
  for (int frame = 0; frame < 150; ++frame) {
    first += box_at(frame, 10 + 0.2 * frame, 30, 0);
    second += box_at(frame, 10 + 0.2 * (frame + 20), 30, 0);
  }
  test::write_file(folder / "first.txt", first);
  test::write_file(folder / "second.txt", second);
  Rig rig;
  rig.cameras = {plan("first", 0, folder / "first.txt"), plan("second", 0, folder / "second.txt")};
  rig.cameras[1].offset_s = 2;
  const GroundSummary summary = track_ground(rig, to(folder / "out.csv"));
  EXPECT_EQ(summary.tracks, 1);
  EXPECT_EQ(summary.cameras[1].missed, 20) << "before it was started";
  const Recording found = format::match::read_ground(folder / "out.csv");
  ASSERT_EQ(found.tracks().size(), 1u);
  for (std::size_t row = 0; row < found.tracks()[0].size(); ++row) {
    const auto frame = static_cast<double>(found.instants()[row].index);
    EXPECT_NEAR(found.tracks()[0].x()[row], 10 + 0.2 * frame, 0.2) << frame;
  }
}

TEST(TrackGround, LiveAndLaterTheSameEveryTime) {
  const test::TemporaryFolder folder;
  const Rig rig = simulate(folder.path(), match(6, 8, 4));
  for (const bool live : {false, true}) {
    PeopleOnGroundOptions options = over_pitch();
    options.live = live;
    const auto bytes = [&] {
      track_ground(rig, to(folder / "out.csv"), options);
      return test::read_file(folder / "out.csv");
    };
    const std::string once = bytes();
    EXPECT_GT(once.size(), 100'000U);
    EXPECT_EQ(once, bytes()) << (live ? "live" : "with the second pass");
    const take::MatchEvaluation judgement = assess(folder / "truth.csv", folder / "out.csv");
    EXPECT_GT(*judgement.evaluation.scores.identity.f1, 0.9);
  }
}

TEST(TrackGround, BoxesInOneViewBearTheSameNumbers) {
  const test::TemporaryFolder folder;
  const Rig rig = simulate(folder.path(), match(8, 8, 3));
  track_ground(rig, to(folder / "out.csv"), over_pitch());
  GroundOutput view_of = to(folder / "cam2_out.txt");
  view_of.boxes_of = "cam2";
  track_ground(rig, view_of, over_pitch());
  std::map<std::pair<int, int>, Vector<2>> locations;
  const Recording ground = format::match::read_ground(folder / "out.csv");
  InstantsOf instants(ground);
  while (const auto instant = instants.next()) {
    for (const Sample& sample : instant->samples)
      locations[{static_cast<int>(instant->index), number(sample.track)}] = sample.position.head<2>();
  }
  const GroundView view = *rig.cameras[1].ground_view(rig.ground);
  const format::tracks::MotTable boxes = format::tracks::read_mot(folder / "cam2_out.txt", format::tracks::MotKind::tracks);
  EXPECT_GT(boxes.boxes.size(), 1500U);
  std::size_t near = 0;
  for (const LabelledBox& box : boxes.boxes) {
    const auto foot = view.location({box.box.centre().x(), box.box.bottom()});
    const auto known = locations.find({box.frame, box.id});
    near += foot && known != locations.end() && (foot->ground - known->second).norm() < 3 ? 1 : 0;
  }
  EXPECT_GT(fraction(static_cast<std::int64_t>(near), std::ssize(boxes.boxes)), 0.9);
}

TEST(TrackGround, PicturesOfOneCameraAndDetectionsOfAnother) {
  const test::TemporaryFolder folder;
  simulate::MatchFilesOptions options = match(3, 8);
  options.cameras.stand = marey::simulate::match::MatchStand::corners, options.cameras.size = cv::Size(1280, 720);
  options.videos = true;
  Rig rig = simulate(folder.path(), options);
  const Rig boxes = format::rig::read_rig(folder / "boxes.toml");
  rig.cameras[1] = boxes.cameras[1];
  ASSERT_FALSE(rig.cameras[0].source.empty());
  ASSERT_FALSE(rig.cameras[1].detections.empty());
  const GroundOutput output{
      .tracks = folder / "out.csv", .boxes_of = "", .overlays = folder / "films", .pitch_view = folder / "above.mp4"};
  const GroundSummary summary = track_ground(rig, output, over_pitch());
  EXPECT_GT(fraction(summary.cameras[0].detections, summary.cameras[0].frames), 8);
  const auto& clear = assess(folder / "truth.csv", folder / "out.csv").evaluation.scores.clear;
  EXPECT_GT(fraction(clear.matches, clear.matches + clear.misses), 0.9);
  EXPECT_LT(fraction(clear.false_positives, clear.matches + clear.false_positives), 0.1);
  EXPECT_TRUE(std::filesystem::exists(folder / "above.mp4"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() + "/films/" + rig.cameras[0].name + ".mp4"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() + "/films/" + rig.cameras[1].name + ".mp4")) << "it has no images";
}

TEST(TrackGround, ARunThatIsStoppedKeepsWhatItHas) {
  const test::TemporaryFolder folder;
  const Rig rig = simulate(folder.path(), match(1, 8, 2));
  std::stop_source stop;
  const Hooks hooks{.progress =
                        [&](const Progress& at) {
                          if (at.done == 51) stop.request_stop();
                        },
                    .stop = stop.get_token()};
  const GroundSummary summary = track_ground(rig, to(folder / "out.csv"), over_pitch(), hooks);
  EXPECT_TRUE(summary.stopped);
  EXPECT_LT(summary.frames, 100);
  EXPECT_LT(format::match::read_ground(folder / "out.csv").instants().back().index, summary.frames);
}

}  // namespace
}  // namespace marey::pipeline::people::ground
