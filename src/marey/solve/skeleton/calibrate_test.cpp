#include "marey/solve/skeleton/calibrate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <utility>
#include <vector>

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
  for (const auto& [name, location] : at) {
    segments.push_back({name, {Matrix<3>::Identity(), location}});
    for (int i = 0; i < 5; ++i)
      markers.push_back({name + std::to_string(i), name, location + Vector<3>(coordinate(), coordinate(), coordinate())});
  }
  return human_skeleton("person", segments, markers);
}

std::vector<ObservedMarkers> motion(const Skeleton& skeleton, int count) {
  std::vector<ObservedMarkers> frames;
  for (int f = 0; f < count; ++f) {
    std::vector<double> coordinates = skeleton.rest();
    for (std::size_t c = 0; c < coordinates.size(); ++c) {
      if (skeleton.coordinates[c].is_rotation)
        coordinates[c] = 0.5 * std::sin(0.15 * f + 1.7 * static_cast<double>(c)) + (skeleton.coordinates[c].lowest ? 0.6 : 0);
    }
    const auto pose = pose_of(skeleton, coordinates);
    ObservedMarkers detected;
    for (const SkeletonMarker& marker : skeleton.markers)
      detected.emplace_back(pose[static_cast<std::size_t>(marker.segment)] * marker.position);
    frames.push_back(std::move(detected));
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

/// A thigh whose shank may only bend in one direction, and a person whose knee goes 12° beyond that.
Skeleton leg(double lowest) {
  Skeleton skeleton{.name = "leg", .coordinates = {}, .segments = {}, .markers = {}};
  Segment thigh{.name = "thigh", .parent = {}, .joint = {}, .end = {}};
  for (int i = 0; i < 6; ++i) {
    thigh.joint.axes.push_back({i >= 3, Vector<3>::Unit(i % 3), {}, i});
    skeleton.coordinates.push_back(
        {.name = "root" + std::to_string(i), .is_rotation = i >= 3, .lowest = {}, .highest = {}, .coupling = {}});
  }
  skeleton.segments.push_back(thigh);
  Segment shank{.name = "shank", .parent = 0, .joint = {}, .end = {}};
  shank.joint.parent_from_joint.translation = {0, 0, -0.4};
  shank.joint.axes.push_back({true, Vector<3>::UnitY(), {}, 6});
  skeleton.coordinates.push_back({.name = "knee", .is_rotation = true, .lowest = lowest, .highest = 2.5, .coupling = {}});
  skeleton.segments.push_back(shank);
  for (const double side : {-0.05, 0.05}) {
    skeleton.markers.push_back({"t" + std::to_string(side), 0, {0.03, side, -0.1}, 1});
    skeleton.markers.push_back({"u" + std::to_string(side), 0, {-0.04, side, -0.35}, 1});
    skeleton.markers.push_back({"s" + std::to_string(side), 1, {0.04, side, -0.1}, 1});
    skeleton.markers.push_back({"a" + std::to_string(side), 1, {0.02, side, -0.36}, 1});
  }
  return skeleton;
}

/// What a calibration makes least, with the priors of its options, at these sizes of thigh and shank: poses by the solver.
double cost_of(const Skeleton& skeleton, const std::vector<ObservedMarkers>& frames, const std::vector<Vector<3>>& scales,
               const std::vector<Vector<3>>& offsets, const CalibrateOptions& options) {
  Skeleton trial = scaled(skeleton, scales);
  double cost = 0;
  for (std::size_t j = 0; j < offsets.size(); ++j) {
    trial.markers[j].position += offsets[j];
    cost += offsets[j].squaredNorm() / (options.offset_sigma_m * options.offset_sigma_m);
  }
  for (const Vector<3>& scale : scales)
    cost += (scale - Vector<3>::Ones()).squaredNorm() / (options.scale_sigma * options.scale_sigma);
  for (const ObservedMarkers& detected : frames) {
    PoseSolver solver(trial, {.marker_sigma_m = options.marker_sigma_m, .robust_m = 0.2});
    const SolvedPose& pose = solver.step(0.1, detected);
    cost += pose.rms_m * pose.rms_m * pose.detected / (options.marker_sigma_m * options.marker_sigma_m);
    const double beyond = std::max(0.0, *trial.coordinates[6].lowest - pose.coordinates[6]);
    cost += beyond * beyond / (0.005 * 0.005);
  }
  return cost;
}

TEST(Calibrate, HonoursLimits) {
  const Skeleton truth = leg(-1), generic = leg(0);
  std::vector<ObservedMarkers> frames;
  for (int f = 0; f < 20; ++f) {
    const double bent = f % 2 == 0 ? -0.21 : 0.3 + 0.03 * f;
    const auto pose = pose_of(truth, std::vector<double>{0.01 * f, 0, 1, 0.02 * f, 0, 0, bent});
    ObservedMarkers& detected = frames.emplace_back();
    for (const SkeletonMarker& marker : truth.markers)
      detected.emplace_back(pose[static_cast<std::size_t>(marker.segment)] * marker.position);
  }
  const CalibrateOptions options{.overall = false, .rounds = 40};
  const Calibration found = calibrate(generic, frames, options);
  const Skeleton sized = scaled(generic, found.scales);
  std::vector<Vector<3>> offsets;
  for (std::size_t j = 0; j < sized.markers.size(); ++j)
    offsets.push_back(found.skeleton.markers[j].position - sized.markers[j].position);
  const double minimum = cost_of(generic, frames, found.scales, offsets, options);
  const double generic_cost = cost_of(generic, frames, {Vector<3>::Ones(), Vector<3>::Ones()},
                                      std::vector<Vector<3>>(sized.markers.size(), Vector<3>::Zero()), options);
  std::printf("cost %.2f, at the generic sizes %.2f\n", minimum, generic_cost);
  EXPECT_LT(minimum, 0.5 * generic_cost);  // sizes that pay for what limits forbid cost more than those of before
  for (std::size_t s = 0; s < 2; ++s) {    // nowhere near is it much less: the solver's poses are not quite the calibration's own
    for (int axis = 0; axis < 3; ++axis) {
      for (const double step : {-0.004, 0.004}) {
        std::vector<Vector<3>> scales = found.scales;
        scales[s][axis] += step;
        EXPECT_GT(cost_of(generic, frames, scales, offsets, options), 0.75 * minimum)
            << "segment " << s << " axis " << axis << " by " << step;
      }
    }
  }
  for (std::size_t j = 0; j < offsets.size(); ++j) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double step : {-0.0005, 0.0005}) {
        std::vector<Vector<3>> moved = offsets;
        moved[j][axis] += step;
        EXPECT_GT(cost_of(generic, frames, found.scales, moved, options), 0.75 * minimum)
            << "marker " << j << " axis " << axis << " by " << step;
      }
    }
  }
}

/// A thigh that is marked about the hip alone, and a shank with one marker low down: only a knee that bends shows where it is.
std::vector<std::string> undetermined_of(bool bends) {
  Skeleton skeleton = leg(-3);
  skeleton.markers.clear();
  const std::pair<const char*, Vector<3>> hip[] = {
      {"front", {0.05, 0.05, 0}}, {"inside", {0.05, -0.05, 0.01}}, {"back", {-0.05, 0, 0.02}}, {"outside", {-0.04, 0.02, -0.01}}};
  for (const auto& [label, location] : hip) skeleton.markers.push_back({label, 0, location, 1});
  skeleton.markers.push_back({"ankle", 1, {0, 0, -0.6}, 1});
  std::vector<ObservedMarkers> frames;
  for (int f = 0; f < 40; ++f) {
    const auto pose = pose_of(skeleton, std::vector<double>{0.01 * f, 0, 1, 0.01 * f, 0, 0.02 * f, bends ? 0.04 * f : 0});
    ObservedMarkers& detected = frames.emplace_back();
    for (const SkeletonMarker& marker : skeleton.markers)
      detected.emplace_back(pose[static_cast<std::size_t>(marker.segment)] * marker.position);
  }
  return calibrate(skeleton, frames, {.overall = false}).undetermined;
}

TEST(Calibrate, NamesWhatTheMotionDoesNotDetermine) {
  const std::vector<std::string> still = undetermined_of(false), bent = undetermined_of(true);
  EXPECT_NE(std::find(still.begin(), still.end(), "thigh"), still.end());
  EXPECT_EQ(std::find(bent.begin(), bent.end(), "thigh"), bent.end());
}

/// The model has the shank's markers 6° about the knee from where they sit: of frames that bend, only the static trial shows it.
TEST(Calibrate, TakesAKneeOfAStandingPersonForStraight) {
  const Skeleton truth = leg(-1);
  Skeleton model = truth;
  const Matrix<3> about = Eigen::AngleAxisd(0.105, Vector<3>::UnitY()).toRotationMatrix();
  for (SkeletonMarker& marker : model.markers) {
    if (marker.segment == 1) marker.position = about * marker.position;
  }
  const auto observed = [&](const std::vector<double>& coordinates) {
    const auto pose = pose_of(truth, coordinates);
    ObservedMarkers detected;
    for (const SkeletonMarker& marker : truth.markers)
      detected.emplace_back(pose[static_cast<std::size_t>(marker.segment)] * marker.position);
    return detected;
  };
  std::vector<ObservedMarkers> frames;
  for (int f = 0; f < 20; ++f) frames.push_back(observed({0.01 * f, 0, 1, 0.02 * f, 0, 0, 0.3 + 0.03 * f}));
  CalibrateOptions options{.overall = false};
  options.scale_sigma = 0;
  options.offset_sigma_m = 0.03;
  options.lasting_sigma_m = 0.05;
  const auto knee_off = [&](const Calibration& found) {
    PoseSolver solver(found.skeleton);
    return std::abs(solver.step(0.1, frames.back()).coordinates[6] - (0.3 + 0.03 * 19));
  };
  const double alone = knee_off(calibrate(model, frames, options));
  options.standing = observed({2, 1, 1, 0, 0, 1, 0});
  options.standing_sigmas_rad = {0, 0, 0, 0, 0, 0, 0.07};
  const Calibration found = calibrate(model, frames, options);
  std::printf("knee off by %.2f deg, with who stands %.2f deg\n", alone * 57.3, knee_off(found) * 57.3);
  EXPECT_GT(alone, 0.08);
  EXPECT_LT(knee_off(found), 0.5 * alone);
  ASSERT_EQ(found.standing.size(), 7U);
  options.standing = observed({2, 1, 1, 0, 0, 1, 1.0});  // in a deep crouch: the markers' places say so
  EXPECT_LT(knee_off(calibrate(model, frames, options)), 1.3 * alone);
}

TEST(Calibrate, RefusesNothing) {
  EXPECT_THROW(calibrate(person(), {}), Error);
}

}  // namespace
}  // namespace marey::solve::skeleton
