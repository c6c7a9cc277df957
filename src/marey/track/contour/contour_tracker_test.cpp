#include "marey/track/contour/contour_tracker.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"
#include "marey/core/geometry.h"
#include "marey/geometry/bspline.h"
#include "marey/track/contour/line_search.h"
#include "marey/track/contour/motion_filter.h"
#include "marey/track/contour/shape_filter.h"

namespace marey::track::contour {
namespace {

constexpr double kRate = 25;  // Hz
const cv::Size kImage(160, 120);

/// A body that breathes and leans while it moves: a closed polygon.
std::vector<Vector<2>> body(const Vector<2>& centre, double height, double phase) {
  std::vector<Vector<2>> corners;
  for (int i = 0; i < 60; ++i) {
    const double angle = 2 * std::numbers::pi * i / 60;
    const double radius = 1 + 0.12 * std::cos(3 * angle + phase);
    corners.emplace_back(centre.x() + 0.22 * height * radius * std::cos(angle),
                         centre.y() + 0.5 * height * radius * std::sin(angle));
  }
  return corners;
}

cv::Mat drawn(std::span<const std::vector<Vector<2>>> bodies) {
  cv::Mat mask = cv::Mat::zeros(kImage, CV_8UC1);
  for (const auto& one : bodies) {
    colour::Footprint footprint;
    footprint.fill(one);
    for (int y = 0; y < mask.rows; ++y) {
      for (int x = 0; x < mask.cols; ++x) {
        if (footprint.covers(x, y)) mask.at<std::uint8_t>(y, x) = 255;
      }
    }
  }
  return mask;
}

double overlap(std::span<const Vector<2>> a, std::span<const Vector<2>> b) {
  colour::Footprint one, other;
  one.fill(a);
  other.fill(b);
  int both = 0, either = 0;
  for (int y = -50; y < 200; ++y) {
    for (int x = -50; x < 250; ++x) {
      both += one.covers(x, y) && other.covers(x, y) ? 1 : 0;
      either += one.covers(x, y) || other.covers(x, y) ? 1 : 0;
    }
  }
  return either > 0 ? static_cast<double>(both) / either : 0;
}

Detection detection_of(const std::vector<Vector<2>>& polygon) {
  Detection detection;
  detection.outline = polygon;
  detection.centre = geometry::polygon_centroid(polygon).value_or(Vector<2>::Zero());
  Vector<2> minimum = polygon[0], maximum = polygon[0];
  for (const Vector<2>& corner : polygon) {
    minimum = minimum.cwiseMin(corner);
    maximum = maximum.cwiseMax(corner);
  }
  detection.box = {minimum.x(), minimum.y(), maximum.x() - minimum.x(), maximum.y() - minimum.y()};
  return detection;
}

Track<2> track_of(int id, const Detection& detection, std::optional<int> observation) {
  Track<2> track;
  track.id = TrackId{id};
  track.position = detection.box.centre();
  track.box = detection.box;
  track.observation = observation;
  return track;
}

Frame frame_at(int index) {
  Frame frame;
  frame.index = index;
  frame.time = timestamp_from_seconds(index / kRate);
  return frame;
}

std::vector<Vector<2>> polygon_of(const Outline& outline) {
  return geometry::ClosedSpline(outline.order, outline.control_points).polygon();
}

TEST(ContourTracker, TracksFromSecondSilhouette) {
  ContourTracker tracker;
  for (int k = 0; k < 40; ++k) {
    const auto polygon = body({30 + 1.5 * k, 60}, 50, 0.2 * k);
    const Detection detected = detection_of(polygon);
    const auto hints = tracker.observe(frame_at(k), Foreground{drawn(std::span(&polygon, 1)), {}}, std::span(&detected, 1));
    EXPECT_TRUE(hints.empty()) << "the detection says it all";
    const Track<2> track = track_of(7, detected, 0);
    const auto tracks = tracker.attach(std::span(&track, 1), std::span(&detected, 1));
    ASSERT_EQ(tracks.size(), 1u);
    EXPECT_EQ(tracks[0].outline != nullptr, k > 0) << k;
    if (k < 5) continue;
    const Outline& outline = *tracks[0].outline;
    EXPECT_GT(overlap(polygon_of(outline), polygon), 0.93) << k;
    EXPECT_LT((outline.centre - *geometry::polygon_centroid(polygon)).norm(), 0.7) << k;
    EXPECT_NEAR(outline.velocity.x(), 1.5 * kRate, 12) << k;
    EXPECT_EQ(outline.lines.size(), 24u);
    EXPECT_EQ(outline.state, Outline::State::detected);
  }
}

TEST(ContourTracker, LinesAloneFollowWhomTheDetectorMissesAndSaySo) {
  ContourTracker tracker;
  for (int k = 0; k < 40; ++k) {
    const auto polygon = body({30 + 1.5 * k, 60}, 50, 0.1 * k);
    const Detection detected = detection_of(polygon);
    const bool missed = k > 10;
    const std::span<const Detection> detections(&detected, missed ? 0 : 1);
    const auto hints = tracker.observe(frame_at(k), Foreground{drawn(std::span(&polygon, 1)), {}}, detections);
    ASSERT_EQ(hints.size(), missed ? 1u : 0u) << k;
    if (missed) {
      EXPECT_GT(geometry::iou(*hints[0].box, detected.box), 0.8) << k;
    }
    const Track<2> track = track_of(1, detected, 0);
    const auto tracks = tracker.attach(std::span(&track, 1), detections);
    if (k == 0) continue;
    EXPECT_GT(overlap(polygon_of(*tracks[0].outline), polygon), 0.85) << k;
  }
}

TEST(ContourTracker, CoastsWithLastShape) {
  ContourTracker tracker;
  double area = 0;
  for (int k = 0; k < 35; ++k) {
    const auto polygon = body({30 + 2.0 * k, 60}, 50, 0);
    const Detection detected = detection_of(polygon);
    const bool hidden = k >= 15;
    const std::span<const Detection> detections(&detected, hidden ? 0 : 1);
    tracker.observe(frame_at(k), Foreground{drawn(std::span(&polygon, hidden ? 0 : 1)), {}}, detections);
    const Track<2> track = track_of(1, detected, hidden ? std::nullopt : std::optional<int>(0));
    const auto tracks = tracker.attach(std::span(&track, 1), detections);
    if (k == 0) continue;
    const Outline& outline = *tracks[0].outline;
    const double now = geometry::ClosedSpline(outline.order, outline.control_points).area();
    if (k == 14) area = now;
    if (!hidden) continue;
    EXPECT_EQ(outline.state, Outline::State::held) << k;
    EXPECT_NEAR(now, area, 0.02 * area) << k;
    EXPECT_LT((outline.centre - *geometry::polygon_centroid(polygon)).norm(), 6) << k;
  }
}

TEST(ContourTracker, LinesOnANeighbourAreNotBelieved) {
  ContourTracker tracker;
  for (int k = 0; k < 30; ++k) {
    const std::vector<std::vector<Vector<2>>> bodies = {body({70, 50}, 50, 0), body({30 + 1.2 * k, 58}, 50, 0)};
    std::vector<Detection> detected = {detection_of(bodies[0]), detection_of(bodies[1])};
    const bool meet = geometry::intersection(detected[0].box, detected[1].box).area() > 0;
    for (Detection& one : detected) one.group = meet ? std::optional<int>(0) : std::nullopt;
    tracker.observe(frame_at(k), Foreground{drawn(bodies), {}}, detected);
    const std::vector<Track<2>> given = {track_of(1, detected[0], 0), track_of(2, detected[1], 1)};
    const auto tracks = tracker.attach(given, detected);
    if (k == 0) continue;
    for (int i = 0; i < 2; ++i) EXPECT_GT(overlap(polygon_of(*tracks[i].outline), bodies[i]), 0.75) << k << " " << i;
  }
}

template <typename Change>
void expect_refused(const Change& change) {
  OutlineOptions options;
  change(options);
  EXPECT_THROW(ContourTracker{options}, Error);
}

TEST(ContourTracker, OptionsThatCannotBeAreRefused) {
  expect_refused([](OutlineOptions& o) { o.order = 1; });
  expect_refused([](OutlineOptions& o) { o.order = 9; });
  expect_refused([](OutlineOptions& o) { o.control_points = 3; });
  expect_refused([](OutlineOptions& o) { o.control_points = 65; });
  expect_refused([](OutlineOptions& o) { o.lines = 0; });
  expect_refused([](OutlineOptions& o) { o.tolerance = 0; });
  expect_refused([](OutlineOptions& o) { o.tolerance = std::nan(""); });
  expect_refused([](OutlineOptions& o) { o.min_height = 0; });
}

/// Crossed, one pixel, half outside, barely there: an outline of finite numbers, or none.
TEST(ContourTracker, NoShapeGivesWhatIsNotFinite) {
  for (unsigned seed = 0; seed < 150; ++seed) {
    std::mt19937_64 engine(seed);
    const auto uniform = [&](double low, double high) {
      return low + (high - low) * (static_cast<double>(engine() >> 11) * 0x1.0p-53);
    };
    OutlineOptions options;
    options.order = 2 + static_cast<int>(seed % 7);
    options.min_height = 1;
    ContourTracker tracker(options);
    for (int k = 0; k < 8; ++k) {
      std::vector<Vector<2>> polygon;
      const int corners = static_cast<int>(uniform(1, 12));
      const Vector<2> location(uniform(-20, 180), uniform(-20, 140));
      for (int i = 0; i < corners; ++i) polygon.emplace_back(location + Vector<2>(uniform(-30, 30), uniform(-30, 30)));
      if (seed % 4 == 0) polygon = {location, location + Vector<2>(1, 0), location + Vector<2>(1, 1), location + Vector<2>(0, 1)};
      const Detection detected = detection_of(polygon);
      const cv::Mat mask = seed % 3 == 0 ? cv::Mat::zeros(kImage, CV_8UC1) : drawn(std::span(&polygon, 1));
      const auto hints = tracker.observe(frame_at(k), Foreground{mask, {}}, std::span(&detected, k % 3 == 2 ? 0 : 1));
      for (const Observation<2>& hint : hints) EXPECT_TRUE(hint.value.allFinite()) << "seed " << seed;
      const Track<2> track = track_of(1, detected, k % 3 == 2 ? std::nullopt : std::optional<int>(0));
      const auto tracks = tracker.attach(std::span(&track, 1), std::span(&detected, 1));
      if (!tracks[0].outline) continue;
      const Outline& outline = *tracks[0].outline;
      for (const Vector<2>& point : outline.control_points) EXPECT_TRUE(point.allFinite()) << "seed " << seed;
      for (const Vector<2>& deviation : outline.deviations) EXPECT_TRUE(deviation.allFinite()) << "seed " << seed;
      EXPECT_TRUE(outline.centre.allFinite() && outline.velocity.allFinite() && std::isfinite(outline.scale_rate))
          << "seed " << seed;
    }
  }
}

TEST(ShapeFilter, LinesAreTakenInAsTheTextbooksUpdateDoes) {
  std::vector<Vector<2>> circle;
  for (int i = 0; i < 8; ++i) circle.emplace_back(20 * std::cos(i * std::numbers::pi / 4), 20 * std::sin(i * std::numbers::pi / 4));
  ShapeFilter filter(geometry::ClosedSpline(4, circle), 1);
  filter.predict({1, -2}, 0.1, {0, 0}, {.bend = 0.3, .together = 0.8, .shift = 0.5, .growth = 0.02});
  // The same with matrices, coordinates in the order x₀ … x₇ y₀ … y₇.
  Eigen::VectorXd x(16);
  Eigen::MatrixXd P = 1.1 * 1.1 * Eigen::MatrixXd::Identity(16, 16);
  Eigen::VectorXd arm(16);
  for (int i = 0; i < 8; ++i) {
    arm[i] = circle[i].x();
    arm[8 + i] = circle[i].y();
    x[i] = 1.1 * circle[i].x() + 1;
    x[8 + i] = 1.1 * circle[i].y() - 2;
    for (int j = 0; j < 8; ++j) {
      const double apart = std::min(std::abs(i - j), 8 - std::abs(i - j));
      const double q = 0.64 * std::exp(-0.5 * apart * apart / 2.25) + 0.25 + (i == j ? 0.09 : 0);
      P(i, j) += q;
      P(8 + i, 8 + j) += q;
    }
  }
  P += 0.02 * 0.02 * arm * arm.transpose();
  for (const double u : {0.3, 2.9, 5.5}) {
    const geometry::SplineWeights location = geometry::spline_weights(4, 8, u);
    const Vector<2> normal = *filter.spline().normal(u);
    Eigen::RowVectorXd h = Eigen::RowVectorXd::Zero(16);
    for (int j = 0; j < 4; ++j) {
      h[(location.first + j) % 8] = location.value[j] * normal.x();
      h[8 + (location.first + j) % 8] = location.value[j] * normal.y();
    }
    const double z = h.dot(x) + 1.3, S = h * P * h.transpose() + 0.4;
    EXPECT_NEAR(filter.variance(location, normal), S - 0.4, 1e-9);
    ASSERT_TRUE(filter.correct(location, normal, z, 0.4, 100));
    const Eigen::VectorXd K = P * h.transpose() / S;
    x += 1.3 * K;
    P -= K * h * P;
    for (int i = 0; i < 8; ++i) {
      EXPECT_NEAR(filter.spline().control_points()[i].x(), x[i], 1e-9);
      EXPECT_NEAR(filter.spline().control_points()[i].y(), x[8 + i], 1e-9);
      EXPECT_NEAR(filter.deviation(i).x(), std::sqrt(P(i, i)), 1e-9);
    }
  }
  const geometry::ClosedSpline before = filter.spline();
  EXPECT_FALSE(filter.correct(geometry::spline_weights(4, 8, 1), {1, 0}, 1000, 0.4, 3)) << "an outlier";
  EXPECT_EQ(filter.spline().control_points()[1], before.control_points()[1]);
}

}  // namespace
}  // namespace marey::track::contour
