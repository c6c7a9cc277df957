// A simulated walker whose joints are known: live as offline, near the truth, honest about what is hidden.
#include "marey/pipeline/markers/skeleton_in_space.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/motion/marker_set.h"
#include "marey/format/take/take_file.h"
#include "marey/pipeline/bodies/solve_skeleton.h"
#include "marey/pipeline/markers/reconstruct.h"
#include "marey/pipeline/simulate/room_files.h"
#include "marey/simulate/random.h"

#include "support/files.h"

namespace marey::pipeline::markers {
namespace {

marey::simulate::room::RoomOptions walker(std::int64_t frames) {
  marey::simulate::room::RoomOptions room;
  room.cameras = 8;
  room.markers = 50;
  room.rate_hz = 100;
  room.frames = frames;
  return room;
}

/// The walker's true points as a recording has them, σ m of noise along each axis; from `from` on for `count` instants the segments
/// of those names have none.
std::vector<Instant> instants_of(const marey::simulate::room::RoomScene& scene, double sigma_m,
                                 const std::vector<std::string>& hidden = {}, std::int64_t from = 0, std::int64_t count = 0) {
  marey::simulate::Random noise(5);
  std::vector<Instant> instants;
  for (std::int64_t i = 0; i < scene.options().frames; ++i) {
    Instant& instant = instants.emplace_back();
    instant.index = i;
    instant.time = timestamp_from_seconds(static_cast<double>(i) / scene.options().rate_hz);
    const auto points = scene.points(seconds(instant.time));
    for (std::size_t m = 0; m < points.size(); ++m) {
      const TrackId id{static_cast<int>(m) + 1};
      if (i == 0) instant.named.push_back({id, "Jane:" + scene.labels()[m], {}});
      const bool gone =
          i >= from && i < from + count &&
          std::any_of(hidden.begin(), hidden.end(), [&](const std::string& name) { return scene.labels()[m].starts_with(name); });
      const Vector<3> off(noise.gaussian(0, sigma_m), noise.gaussian(0, sigma_m), noise.gaussian(0, sigma_m));
      if (!gone) instant.samples.emplace_back().track = id, instant.samples.back().position = points[m] + off;
    }
  }
  return instants;
}

double degrees_between(const Matrix<3>& a, const Matrix<3>& b) {
  return std::acos(std::clamp(((a.transpose() * b).trace() - 1) / 2, -1.0, 1.0)) * 180 / 3.14159265358979;
}

TEST(SkeletonInSpace, LiveIsWhatIsSolvedAfterwards) {
  const marey::simulate::room::RoomScene scene(walker(250));
  const test::TemporaryFolder folder;
  simulate::write_room(scene, folder.path());
  MarkersInSpaceOptions options;
  options.live = true;
  options.predict_s = 0.1;
  options.set = format::motion::read_marker_set(folder / "labels.csv");
  std::vector<std::string> warnings;
  options.skeleton = skeleton_with_markers(folder / "skeleton.toml", warnings);
  const corridor::Summary summary = reconstruct(scene.rig(), folder / "observations.csv", folder / "walk.marey", options);
  EXPECT_LT(summary.skeleton.value().rms_mm.value(), 2);
  EXPECT_EQ(summary.skeleton.value().initialisations, 1);
  const auto step =
      std::find_if(summary.steps.begin(), summary.steps.end(), [](const auto& each) { return each.name == "skeleton"; });
  ASSERT_NE(step, summary.steps.end());
  std::printf("skeleton: median %.3f ms, 99 %% %.3f ms\n", 1000 * step->median, 1000 * step->p99);

  const Recording live = format::take::read_recording(folder / "walk.marey");
  const bodies::SolvedRecording after = bodies::solve_with_skeleton(folder / "walk.marey", folder / "skeleton.toml", {});
  const std::vector<Matrix<3>> rest = rest_of(after.skeleton);
  ASSERT_EQ(live.bodies().size(), 15u);
  double off = 0, worst_m = 0, worst_deg = 0;
  std::size_t compared = 0;
  for (const BodyColumns& body : live.bodies()) {
    const auto s = static_cast<std::size_t>(number(body.body())) - 1;
    for (std::size_t row = 0; row < body.size(); ++row) {
      const auto i = static_cast<std::size_t>(body.at()[row]);
      const Rigid3 here = body.pose(row).world_from_body;
      const Rigid3 there = body_pose(pose_of(after.skeleton, after.motion.rows[i])[s], rest[s]);
      off = std::max({off, (here.translation - there.translation).norm(), (here.rotation - there.rotation).norm()});
      const Rigid3 truth = scene.segments(live.seconds_at(i))[s];
      if (body.pose(row).tracked) {
        worst_m = std::max(worst_m, (here.translation - truth.translation).norm());
        worst_deg = std::max(worst_deg, degrees_between(here.rotation, truth.rotation));
      }
      ++compared;
    }
  }
  EXPECT_GT(compared, 15u * 240);
  EXPECT_LT(off, 1e-6) << "a take keeps poses in single precision";
  std::printf("against the truth: worst %.1f mm, %.1f deg\n", 1000 * worst_m, worst_deg);
  EXPECT_LT(worst_m, 0.015);
  EXPECT_LT(worst_deg, 8);
}

TEST(SkeletonInSpace, SaysWhatIsHiddenAndGoesOn) {
  const marey::simulate::room::RoomScene scene(walker(200));
  SkeletonInSpace solved(std::make_shared<const Skeleton>(*scene.skeleton()), 100);
  Instant nothing;
  nothing.time = timestamp_from_seconds(-0.01);
  solved.add_to(nothing);
  EXPECT_TRUE(nothing.bodies.empty()) << "its position is unknown";
  double worst = 0, worst_after = 0;
  for (Instant& instant : instants_of(scene, 0.0005, {"left_shank", "left_foot"}, 100, 20)) {
    solved.add_to(instant);
    ASSERT_EQ(instant.bodies.size(), 15u);
    const bool hidden = instant.index >= 100 && instant.index < 120;
    for (std::size_t s = 0; s < 15; ++s) {
      const std::string& name = solved.bodies()[s].label;
      if (name == "left_shank" || name == "left_foot") {
        EXPECT_EQ(instant.bodies[s].tracked, !hidden) << name << " at " << instant.index;
      }
      const double off =
          (instant.bodies[s].world_from_body.translation - scene.segments(seconds(instant.time))[s].translation).norm();
      (hidden ? worst : worst_after) = std::max(hidden ? worst : worst_after, off);
    }
  }
  std::printf("hidden: worst %.0f mm, else %.1f mm\n", 1000 * worst, 1000 * worst_after);
  EXPECT_LT(worst, 0.35) << "the foot of a leg that is hidden for 0.2 s";
  EXPECT_LT(worst_after, 0.01);
  EXPECT_TRUE(solved.warnings().empty());
}

/// Another person's skeleton, twice as large: it is sought again now and then, not at every frame.
TEST(SkeletonInSpace, CostsNoMoreWhereItDoesNotFit) {
  const marey::simulate::room::RoomScene scene(walker(300));
  Skeleton large = *scene.skeleton();
  for (Segment& segment : large.segments) segment.joint.parent_from_joint.translation *= 3;
  for (SkeletonMarker& marker : large.markers) marker.position *= -3;
  SkeletonInSpace solved(std::make_shared<const Skeleton>(large), 100, live_pose_options());
  for (Instant& instant : instants_of(scene, 0)) solved.add_to(instant);
  SkeletonInSpace eager(std::make_shared<const Skeleton>(large), 100);
  for (Instant& instant : instants_of(scene, 0)) {
    if (instant.index < 30) eager.add_to(instant);
  }
  EXPECT_GT(eager.starts(), 3) << "a file's instants wait for it";
  EXPECT_GT(solved.starts(), 1) << "this test needs one that is lost";
  EXPECT_LE(solved.starts(), 1 + 300 / 25);
  ASSERT_EQ(solved.warnings().size(), 1u);
  EXPECT_NE(solved.warnings()[0].find("scaled to this person"), std::string::npos) << solved.warnings()[0];
}

TEST(SkeletonInSpace, SaysThatNoNameIsKnown) {
  const marey::simulate::room::RoomScene scene(walker(2));
  Skeleton other = *scene.skeleton();
  for (SkeletonMarker& marker : other.markers) marker.label = "X" + marker.label;
  SkeletonInSpace solved(std::make_shared<const Skeleton>(other), 100);
  for (Instant& instant : instants_of(scene, 0)) {
    solved.add_to(instant);
    EXPECT_TRUE(instant.bodies.empty());
  }
  ASSERT_EQ(solved.warnings().size(), 1u);
  EXPECT_NE(solved.warnings()[0].find("none of its labels"), std::string::npos);
  MarkersInSpaceOptions options;
  options.skeleton = std::make_shared<const Skeleton>(other);
  EXPECT_THROW(markers_in_space(scene.rig(), 100, options), Error) << "points without names";
}

/// Whose places a skeleton of the markers "a" and "b" takes: by track, the x of each is its number.
std::vector<double> taken_of(const std::vector<std::string>& labels) {
  Skeleton skeleton;
  skeleton.markers = {{"a", 0, Vector<3>::Zero(), 1}, {"b", 0, Vector<3>::Zero(), 1}};
  SkeletonMarkers markers(skeleton);
  std::vector<TrackName> names;
  Instant instant;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const TrackId track{static_cast<int>(i) + 1};
    names.push_back({track, labels[i], ""});
    Sample& sample = instant.samples.emplace_back();
    sample.track = track;
    sample.position = {static_cast<double>(i) + 1, 0, 1};
  }
  markers.name(names);
  solve::skeleton::ObservedMarkers detected;
  markers.take(instant, detected);
  std::vector<double> taken;
  for (const auto& location : detected) taken.push_back(location ? location->x() : 0);
  return taken;
}

TEST(SkeletonMarkers, AreOfOneSubject) {
  EXPECT_EQ(taken_of({"a", "b"}), (std::vector<double>{1, 2}));
  EXPECT_EQ(taken_of({"Jane:a", "Jane:b"}), (std::vector<double>{1, 2}));
  EXPECT_EQ(taken_of({"Jane:a", "Bob:a", "Bob:b", "Jane:b"}), (std::vector<double>{1, 4}));
  EXPECT_EQ(taken_of({"Bob:a", "Bob:b", "a", "b"}), (std::vector<double>{3, 4}));
}

}  // namespace
}  // namespace marey::pipeline::markers
