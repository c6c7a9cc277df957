// One who walks before a lawn, alone: bare knees, neck and arms between white and blue, in 4:2:0, with a silhouette that is cut
// out badly from frame to frame. What is held: the outline keeps its limbs, crosses itself nowhere, and is steadier than the
// silhouettes that it is taken from.
#include "marey/track/contour/lone_silhouette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/geometry/bspline.h"
#include "marey/track/contour/colour/colour_patch.h"
#include "marey/track/contour/contour_tracker.h"
#include "marey/track/contour/silhouette_spline.h"

namespace marey::track::contour {
namespace {

constexpr int kSamples = 4;  // a pixel and axis
const cv::Scalar kLawn(90, 105, 115), kWhite(215, 128, 128), kBlue(60, 160, 110), kSkin(100, 116, 138), kInitialise(35, 128, 128);

/// A walker as large as asked, seen from the side, painted limb by limb.
class Walker {
 public:
  Walker(cv::Size image, double height) : size_(image), height_(height) {}

  /// The image, and where the walker is, at a phase of the step (radians).
  void paint(const Vector<2>& hip, double phase) {
    colours_ = cv::Mat(size_ * kSamples, CV_32FC3, kLawn);
    covered_ = cv::Mat::zeros(size_ * kSamples, CV_32FC1);
    hip_ = hip;
    for (const double side : {-1.0, 1.0}) leg(0.55 * side * std::sin(phase), 0.45 * (1 + side * std::cos(phase)));
    limb({0, -0.02}, {0, 0.06}, 0.07, kBlue);
    limb({0, -0.34}, {0, -0.3}, 0.035, kSkin);
    limb({0, -0.42}, {0, -0.4}, 0.055, kInitialise);
    limb({0, -0.25}, {0, -0.08}, 0.085, kWhite);
    for (const double side : {-1.0, 1.0}) {
      const double swing = -0.5 * side * std::sin(phase);
      limb({0.03 * side, -0.27}, {0.03 * side + 0.32 * std::sin(swing), -0.27 + 0.32 * std::cos(swing)}, 0.03, kSkin);
    }
    cv::resize(colours_, colour_, size_, 0, 0, cv::INTER_AREA);
    cv::resize(covered_, fraction_, size_, 0, 0, cv::INTER_AREA);
  }

  Image image(std::mt19937& dice) const {
    std::array<cv::Mat, 3> planes;
    cv::split(colour_, planes);
    std::normal_distribution<float> noise(0, 2);
    for (auto level = planes[0].begin<float>(); level != planes[0].end<float>(); ++level) *level += noise(dice);
    for (int i = 1; i < 3; ++i) cv::resize(planes[i], planes[i], size_ / 2, 0, 0, cv::INTER_AREA);
    for (cv::Mat& plane : planes) plane.convertTo(plane, CV_8U);
    return {planes[0], planes[1], planes[2], Image::Range::limited};
  }

  /// CV_8UC1: what a background model makes of it, too wide by a pixel on some sides, and some of the shadow.
  cv::Mat ragged_mask(std::mt19937& dice) const {
    cv::Mat mask = fraction_ > 0.3F;
    const auto drawn = [&](int maximum) { return static_cast<int>(dice() % static_cast<unsigned>(maximum + 1)); };
    const cv::Mat kernel = cv::Mat::ones(1 + drawn(1), 1 + drawn(1), CV_8UC1);
    cv::dilate(mask, mask, kernel, {drawn(kernel.cols - 1), drawn(kernel.rows - 1)});
    const int foot = static_cast<int>(hip_.y() + 0.47 * height_);
    mask(cv::Rect(static_cast<int>(hip_.x()), foot, 1 + drawn(static_cast<int>(0.15 * height_)), 2)) = 255;
    return mask;
  }

  const cv::Mat& fraction() const { return fraction_; }
  Vector<2> centre() const {
    const cv::Moments time_steps = cv::moments(fraction_);
    return {time_steps.m10 / time_steps.m00, time_steps.m01 / time_steps.m00};
  }

 private:
  void leg(double thigh, double bend) {
    const Vector<2> knee(0.24 * std::sin(thigh), 0.04 + 0.24 * std::cos(thigh));
    const Vector<2> shin(std::sin(thigh - bend), std::cos(thigh - bend));
    limb({0, 0.04}, knee, 0.04, kSkin);
    limb(knee, knee + 0.06 * shin, 0.036, kSkin);
    limb(knee + 0.08 * shin, knee + 0.2 * shin, 0.036, kWhite);
    limb(knee + 0.2 * shin, knee + 0.2 * shin + 0.06 * Vector<2>(shin.y(), -shin.x()), 0.025, kInitialise);
    limb({0, 0.04}, Vector<2>(0, 0.04) + 0.4 * (knee - Vector<2>(0, 0.04)), 0.06, kBlue);
  }

  /// A capsule from `from` to `to`, heights from the hip.
  void limb(const Vector<2>& from, const Vector<2>& to, double radius, const cv::Scalar& colour) {
    const Vector<2> a = hip_ + height_ * from, along = height_ * (to - from);
    for (int y = 0; y < covered_.rows; ++y) {
      const double row = (y + 0.5) / kSamples - 0.5;
      if (std::abs(row - a.y()) > along.norm() + radius * height_) continue;
      for (int x = 0; x < covered_.cols; ++x) {
        const Vector<2> at((x + 0.5) / kSamples - 0.5, row);
        const double part = std::clamp((at - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
        if ((at - a - part * along).norm() > radius * height_) continue;
        covered_.at<float>(y, x) = 1;
        colours_.at<cv::Vec3f>(y, x) =
            cv::Vec3f(static_cast<float>(colour[0]), static_cast<float>(colour[1]), static_cast<float>(colour[2]));
      }
    }
  }

  cv::Size size_;
  double height_;
  Vector<2> hip_ = Vector<2>::Zero();
  cv::Mat colours_, covered_;  // at samples
  cv::Mat colour_, fraction_;  // at pixels
};

/// RMS of the second difference.
double unsteadiness(const std::vector<Vector<2>>& path) {
  double sum = 0;
  for (std::size_t i = 2; i < path.size(); ++i) sum += (path[i] - 2 * path[i - 1] + path[i - 2]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(path.size() - 2));
}

struct Walk {
  double iou = 0;       ///< mean
  double legs = 0;      ///< mean share of what is below the hip that lies within the outline
  double min_legs = 1;  ///< of one frame
  int frames = 0, crossed = 0;
  std::vector<Vector<2>> outlines, silhouettes;  ///< centres
};

void evaluate_outline(const Outline& outline, const Walker& walker, int hip, Walk& walk) {
  const geometry::ClosedSpline spline(outline.order, outline.control_points);
  colour::ColourPatch patch;
  patch.colour = cv::Mat(walker.fraction().size(), CV_32FC3);
  const cv::Mat inside = colour::cells_within(spline.polygon(), patch), &truth = walker.fraction();
  cv::Mat both, either;
  cv::min(inside, truth, both);
  cv::max(inside, truth, either);
  const cv::Range below(hip, truth.rows);
  const double legs = cv::sum(both.rowRange(below))[0] / cv::sum(truth.rowRange(below))[0];
  walk.iou += cv::sum(both)[0] / cv::sum(either)[0];
  walk.legs += legs;
  walk.min_legs = std::min(walk.min_legs, legs);
  walk.crossed += is_simple(spline) ? 0 : 1;
  walk.outlines.push_back(outline.centre);
  ++walk.frames;
}

Walk walk_of(double height, int frames) {
  const cv::Size size(2 * static_cast<int>(height), static_cast<int>(0.75 * height) * 2);
  Walker walker(size, height);
  ContourTracker tracker;
  std::mt19937 dice(3);
  Walk walk;
  for (int k = 0; k < frames; ++k) {
    const Vector<2> hip(0.6 * height + 0.012 * height * k, 0.7 * height);
    walker.paint(hip, 0.32 * k);
    Frame frame;
    frame.index = k;
    frame.time = timestamp_from_seconds(k / 25.0);
    frame.image = walker.image(dice);
    const cv::Mat mask = walker.ragged_mask(dice);
    colour::ColourPatch patch;
    cv::Mat fraction;
    mask.convertTo(fraction, CV_32F, 1 / 255.0);
    Detection detected;
    detected.outline = colour::half_level_curve(fraction, patch);
    detected.centre = geometry::polygon_centroid(detected.outline).value_or(hip);
    const cv::Rect box = cv::boundingRect(mask);
    detected.box = Box(box.x, box.y, box.width, box.height);
    tracker.observe(frame, Foreground{mask, {}}, std::span(&detected, 1));
    Track<2> track;
    track.id = TrackId{1};
    track.position = detected.box.centre();
    track.box = detected.box;
    track.observation = 0;
    const auto tracks = tracker.attach(std::span(&track, 1), std::span(&detected, 1));
    if (k < 5) continue;
    if (!tracks[0].outline) continue;
    walk.silhouettes.push_back(detected.centre);
    evaluate_outline(*tracks[0].outline, walker, static_cast<int>(hip.y()), walk);
  }
  walk.iou /= walk.frames;
  walk.legs /= walk.frames;
  return walk;
}

TEST(LoneSilhouettes, AnOutlineReachesFromTopToFootAndNotIntoTheShadow) {
  const Box silhouette{100, 50, 40, 100};
  const auto outline = [](const Box& box) {  // an ellipse that fills the box, nearly
    std::vector<Vector<2>> points;
    for (int i = 0; i < 24; ++i) {
      const double at = 2 * M_PI * i / 24;
      points.push_back(box.centre() + 0.51 * Vector<2>(box.width * std::cos(at), box.height * std::sin(at)));
    }
    return geometry::ClosedSpline(3, points);
  };
  EXPECT_TRUE(is_whole(outline(silhouette), silhouette));
  EXPECT_FALSE(is_whole(std::nullopt, silhouette));
  EXPECT_FALSE(is_whole(outline({100, 50, 40, 75}), silhouette)) << "legs are missing";
  EXPECT_FALSE(is_whole(outline({100, 50, 70, 100}), silhouette)) << "a shadow beside";
  EXPECT_FALSE(is_whole(outline({100, 50, 40, 130}), silhouette)) << "a shadow at the feet";
}

TEST(LoneSilhouettes, AWalkerKeepsBareLimbsAndIsSteady) {
  for (const double height : {60.0, 120.0}) {
    const Walk walk = walk_of(height, 50);
    EXPECT_EQ(walk.frames, 45) << height;
    EXPECT_EQ(walk.crossed, 0) << height;
    EXPECT_GT(walk.iou, 0.84) << height;
    EXPECT_GT(walk.legs, 0.88) << height;
    EXPECT_GT(walk.min_legs, 0.7) << height;
    EXPECT_LT(unsteadiness(walk.outlines), 0.7 * unsteadiness(walk.silhouettes)) << height;
  }
}

TEST(LoneSilhouettes, AWalkerOf25PixelsHasAnOutlineInEveryFrame) {
  const Walk walk = walk_of(25, 50);
  EXPECT_EQ(walk.frames, 45);
  EXPECT_EQ(walk.crossed, 0);
  EXPECT_GT(walk.iou, 0.7);
  EXPECT_GT(walk.legs, 0.75);
  EXPECT_LT(unsteadiness(walk.outlines), unsteadiness(walk.silhouettes));
}

/// A comb whose teeth and gaps are a pixel wide: least squares ties loops on it.
TEST(SilhouetteSpline, AFittedCurveNeverCrossesItself) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 dice(seed);
    const auto drawn = [&](double low, double high) { return low + (high - low) * (dice() % 1000) / 1000.0; };
    std::vector<Vector<2>> edge{{0, 0}, {40, 0}};
    for (double x = 40; x > 3;) {
      const double tooth = drawn(1, 4), gap = drawn(0.6, 3), depth = drawn(5, 40);
      edge.emplace_back(x, 6 + depth);
      edge.emplace_back(x - tooth, 6 + depth);
      edge.emplace_back(x - tooth, 6);
      edge.emplace_back(x - tooth - gap, 6);
      x -= tooth + gap;
    }
    edge.emplace_back(-3, 6);
    for (const int count : {12, 24, 40}) {
      const auto spline = fit_curve(edge, {.order = 4, .minimum = count, .maximum = count, .rounds = 3});
      EXPECT_TRUE(!spline || is_simple(*spline)) << seed << " " << count;
      EXPECT_TRUE(count < 40 || spline.has_value()) << seed;
    }
  }
}

}  // namespace
}  // namespace marey::track::contour
