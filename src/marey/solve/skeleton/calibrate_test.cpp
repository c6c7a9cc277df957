#include "marey/solve/skeleton/calibrate.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/solve/skeleton/human.h"

namespace marey::solve::skeleton {
namespace {

/// A person of 1.7 m that stands, with five markers on each segment.
Skeleton person() {
  std::mt19937 random(3);
  const auto coordinate = [&] { return 0.08 * (static_cast<double>(random()) / 2147483648.0 - 1); };
  const std::vector<std::pair<std::string, Vector<3>>> at = {{"pelvis", {0, 0, 0.95}},
                                                             {"trunk", {0, 0, 1.1}},
                                                             {"head", {0, 0, 1.6}},
                                                             {"left_thigh", {0, 0.09, 0.9}},
                                                             {"left_shank", {0, 0.09, 0.48}},
                                                             {"left_foot", {0, 0.09, 0.08}},
                                                             {"right_thigh", {0, -0.09, 0.9}},
                                                             {"right_shank", {0, -0.09, 0.48}},
                                                             {"right_foot", {0, -0.09, 0.08}},
                                                             {"left_upper_arm", {0, 0.18, 1.4}},
                                                             {"left_forearm", {0, 0.18, 1.1}},
                                                             {"left_hand", {0, 0.18, 0.85}}};
  std::vector<StandingSegment> segments;
  std::vector<StandingMarker> markers;
  for (const auto& [name, place] : at) {
    segments.push_back({name, {Matrix<3>::Identity(), place}});
    for (int i = 0; i < 5; ++i)
      markers.push_back({name + std::to_string(i), name, place + Vector<3>(coordinate(), coordinate(), coordinate())});
  }
  return human_skeleton("person", segments, markers);
}

std::vector<SeenMarkers> motion(const Skeleton& skeleton, int count) {
  std::vector<SeenMarkers> frames;
  for (int f = 0; f < count; ++f) {
    std::vector<double> coordinates = skeleton.rest();
    for (std::size_t c = 0; c < coordinates.size(); ++c) {
      if (skeleton.coordinates[c].turns)
        coordinates[c] = 0.5 * std::sin(0.15 * f + 1.7 * static_cast<double>(c)) + (skeleton.coordinates[c].lowest ? 0.6 : 0);
    }
    const auto pose = pose_of(skeleton, coordinates);
    SeenMarkers seen;
    for (const SkeletonMarker& marker : skeleton.markers)
      seen.emplace_back(pose[static_cast<std::size_t>(marker.segment)] * marker.position);
    frames.push_back(std::move(seen));
  }
  return frames;
}

TEST(HumanSkeleton, HasTheJointsOfWhatItIsGiven) {
  const Skeleton skeleton = person();
  EXPECT_EQ(skeleton.segments.size(), 12U);
  EXPECT_TRUE(skeleton.coordinate("left_knee_flexion"));
  EXPECT_FALSE(skeleton.segment("right_upper_arm"));
  const auto pose = pose_of(skeleton, skeleton.rest());
  EXPECT_NEAR((pose[static_cast<std::size_t>(*skeleton.segment("left_foot"))].translation - pose[0].translation).z(), 0.08 - 0.95,
              1e-12);
  EXPECT_THROW(human_skeleton("nobody", {}, {}), Error);
}

TEST(HumanSkeleton, FlexesBothKneesBackwards) {
  const Skeleton skeleton = person();
  std::vector<double> coordinates = skeleton.rest();
  for (const char* side : {"left", "right"})
    coordinates[static_cast<std::size_t>(*skeleton.coordinate(std::string(side) + "_knee_flexion"))] = 1;
  const auto pose = pose_of(skeleton, coordinates);
  for (const char* side : {"left_foot", "right_foot"})
    EXPECT_LT(pose[static_cast<std::size_t>(*skeleton.segment(side))].translation.x(), -0.2);
}

TEST(Calibrate, FindsSizesAndPlacesOfMarkers) {
  const Skeleton truth = person();
  std::vector<Vector<3>> scales;
  for (const Segment& segment : truth.segments) {
    const bool leg = segment.name.find("thigh") != std::string::npos || segment.name.find("shank") != std::string::npos;
    scales.push_back(leg ? Vector<3>(0.9, 0.9, 0.84) : Vector<3>(0.9, 0.9, 0.9));
  }
  Skeleton generic = scaled(truth, scales);
  generic.markers[0].position.x() += 0.01;
  const Calibration found = calibrate(generic, motion(truth, 60));
  EXPECT_NEAR(found.overall_scale, 1 / 0.88, 0.05);
  EXPECT_LT(found.rms_after_m, 0.002);
  EXPECT_GT(found.rms_before_m, 0.015);
  // Bones as long as they are.
  for (const char* name : {"left_shank", "right_foot", "left_forearm"}) {
    const auto s = static_cast<std::size_t>(*truth.segment(name));
    EXPECT_NEAR(found.skeleton.segments[s].joint.parent_from_joint.translation.norm(),
                truth.segments[s].joint.parent_from_joint.translation.norm(), 0.006)
        << name;
  }
}

TEST(Calibrate, RefusesNothing) {
  EXPECT_THROW(calibrate(person(), {}), Error);
}

}  // namespace
}  // namespace marey::solve::skeleton
