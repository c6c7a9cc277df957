#include "marey/pipeline/keypoints/keypoint_skeleton.h"

#include <cmath>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/core/recording_reader.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/pipeline/bodies/solve_skeleton.h"
#include "marey/simulate/random.h"
#include "marey/simulate/room/room_keypoints.h"

#include "support/files.h"

namespace marey::pipeline::keypoints {
namespace {

using marey::simulate::room::RoomScene;

/// The true keypoints of a walker as a recording.
Recording true_recording(const RoomScene& scene, const std::string& person, double noise_m) {
  RecordingHeader header;
  header.frame.kind = FrameOfReference::Kind::space;
  header.rate_hz = scene.options().rate_hz;
  Recording recording(header);
  const KeypointSet& set = marey::simulate::room::room_keypoint_set();
  for (std::int64_t t = 0; t < scene.options().frames; ++t)
    recording.add_time_step({t, timestamp_from_seconds(static_cast<double>(t) / header.rate_hz)});
  marey::simulate::Random random(3);
  for (std::size_t i = 0; i < set.points.size(); ++i) {
    TrackName name;
    name.id = TrackId{static_cast<int>(i) + 1};
    name.label = person + set.points[i];
    TrackColumns track(name, 3);
    for (std::int32_t t = 0; t < scene.options().frames; ++t) {
      Sample sample;
      sample.position = marey::simulate::room::true_keypoints(scene, t / header.rate_hz)[0][i] +
                        noise_m * Vector<3>(random.gaussian(), random.gaussian(), random.gaussian());
      track.add(t, sample);
    }
    recording.put(std::move(track));
  }
  return recording;
}

marey::simulate::room::RoomOptions one_walker() {
  marey::simulate::room::RoomOptions options;
  options.markers = 4;
  options.rate_hz = 50;
  options.frames = 200;
  return options;
}

TEST(KeypointSkeleton, FindsTheBodyOfASimulatedWalker) {
  const RoomScene scene(one_walker());
  const Skeleton skeleton = skeleton_of_keypoints(true_recording(scene, "", 0), "");
  const auto length = [&](const char* segment) {
    return (*skeleton.segments[static_cast<std::size_t>(*skeleton.segment(segment))].end).norm();
  };
  EXPECT_NEAR(length("left_forearm"), 0.25, 0.002);
  const auto below = [&](const char* segment) {
    return skeleton.segments[static_cast<std::size_t>(*skeleton.segment(segment))].joint.parent_from_joint.translation.norm();
  };
  EXPECT_NEAR(below("right_shank"), 0.43, 0.002);
  EXPECT_NEAR(below("right_foot"), 0.43, 0.002);
  EXPECT_NEAR(below("left_forearm"), 0.29, 0.002);
  EXPECT_EQ(skeleton.markers.size(), 25U);
  EXPECT_FALSE(skeleton.coordinate("spine_flexion")) << "no point shows it";
}

TEST(KeypointSkeleton, TellsPeopleApartByWhatStandsBeforeTheirLabels) {
  std::vector<TrackName> tracks;
  for (const char* person : {"P1:", "P2:"}) {
    for (const char* point : {"left_hip", "right_hip", "left_knee", "right_knee", "left_shoulder", "right_shoulder"}) {
      tracks.emplace_back();
      tracks.back().label = std::string(person) + point;
    }
  }
  tracks.emplace_back();
  tracks.back().label = "LASI";
  EXPECT_EQ(people_with_keypoints(tracks), (std::vector<std::string>{"P1:", "P2:"}));
  tracks.erase(tracks.begin());
  EXPECT_EQ(people_with_keypoints(tracks), (std::vector<std::string>{"P2:"}));
}

TEST(KeypointSkeleton, IsSolvedWithoutAStaticTrial) {
  const RoomScene scene(one_walker());
  const test::TemporaryFolder folder;
  const std::string path = folder / "walk.marey";
  const Recording recording = true_recording(scene, "P1:", 0.01);
  const format::Format& format = format::format_to_write(path, {}, format::Content::space);
  const auto sink = format::create_recording(path, format, format::plan_of(*format::reader_of(recording), path));
  MemoryReader reader(recording);
  replay(reader, *sink);
  const bodies::SolvedRecording solved = bodies::solve_with_skeleton(path, "", {});
  EXPECT_EQ(solved.summary.skeleton, "P1");
  EXPECT_LT(solved.summary.rms_m, 0.02);
  double sum = 0, count = 0;
  for (std::size_t t = 0; t < solved.motion.rows.size(); t += 5) {
    const std::vector<Rigid3> pose = pose_of(solved.skeleton, solved.motion.rows[t]);
    const auto truth = marey::simulate::room::true_keypoints(scene, static_cast<double>(t) / 50)[0];
    for (const auto& [segment, point] : {std::pair{"left_thigh", 11},
                                         {"right_thigh", 12},
                                         {"left_shank", 13},
                                         {"right_shank", 14},
                                         {"left_foot", 15},
                                         {"left_upper_arm", 5},
                                         {"right_forearm", 8}}) {
      sum +=
          (pose[static_cast<std::size_t>(*solved.skeleton.segment(segment))].translation - truth[static_cast<std::size_t>(point)])
              .norm();
      ++count;
    }
  }
  EXPECT_LT(sum / count, 0.012) << "17 mm are the points' own";
  bodies::SolveOptions other;
  other.person = "P7";
  EXPECT_THROW(bodies::solve_with_skeleton(path, "", other), Error);
}

}  // namespace
}  // namespace marey::pipeline::keypoints
