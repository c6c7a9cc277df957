// What contours must survive: whatever is shown, each one is a simple curve of finite numbers, about as large as its target, or is
// not there.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>
#include <tbb/global_control.h>

#include "marey/geometry/bspline.h"
#include "marey/track/contour/colour/colour_patch.h"
#include "marey/track/contour/contour_tracker.h"
#include "marey/track/contour/silhouette_spline.h"

namespace marey::track::contour {
namespace {

const cv::Size kHardSize(240, 160);
const cv::Scalar kHardGrass(90, 105, 115), kDark(28, 128, 128), kBright(190, 120, 140);
constexpr double kOversized = 1.5;

/// A body of a shape: head and trunk, or a car.
struct HardBody {
  Vector<2> centre;
  double width, height;
  cv::Scalar colour;
  bool car = false;
};

std::vector<Vector<2>> edge_of_body(const HardBody& body) {
  std::vector<Vector<2>> polygon;
  for (int i = 0; i < 80; ++i) {
    const double angle = 2 * std::numbers::pi * i / 80;
    const double power = body.car ? 0.4 : 1;  // a box with round corners
    const auto bent = [&](double value) { return std::copysign(std::pow(std::abs(value), power), value); };
    polygon.emplace_back(body.centre + Vector<2>(body.width / 2 * bent(std::cos(angle)), body.height / 2 * bent(std::sin(angle))));
  }
  return polygon;
}

/// One frame: the farthest body first.
class HardScene {
 public:
  explicit HardScene(double noise = 2) : noise_(noise) {}

  void paint(const std::vector<HardBody>& bodies, int frame, const Vector<2>& shake = Vector<2>::Zero(), bool interlaced = false) {
    cv::Mat colour(kHardSize, CV_32FC3, kHardGrass);
    for (int x = 0; x < kHardSize.width; x += 12)
      colour.col(std::clamp(x + static_cast<int>(shake.x()), 0, kHardSize.width - 1)) += cv::Scalar(25, 0, 0);
    mask_ = cv::Mat::zeros(kHardSize, CV_8UC1);
    for (const HardBody& body : bodies) {
      for (int field = 0; field < 2; ++field) {
        HardBody moved = body;
        moved.centre += shake;
        if (interlaced && field == 1) moved.centre.x() += 3;  // half a frame later
        std::vector<cv::Point> corners;
        for (const Vector<2>& p : edge_of_body(moved))
          corners.emplace_back(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
        cv::Mat own = cv::Mat::zeros(kHardSize, CV_8UC1);
        cv::fillPoly(own, std::vector{corners}, 255);
        for (int y = 1 - field; interlaced && y < own.rows; y += 2) own.row(y).setTo(0);
        colour.setTo(body.colour, own);
        mask_.setTo(255, own);
      }
    }
    std::mt19937 dice(static_cast<unsigned>(frame));
    std::normal_distribution<float> grain(0, static_cast<float>(noise_));
    for (auto pixel = colour.begin<cv::Vec3f>(); pixel != colour.end<cv::Vec3f>(); ++pixel) (*pixel)[0] += grain(dice);
    std::array<cv::Mat, 3> planes;
    cv::split(colour, planes);
    for (int i = 1; i < 3; ++i) cv::resize(planes[i], planes[i], kHardSize / 2, 0, 0, cv::INTER_AREA);
    for (cv::Mat& plane : planes) plane.convertTo(plane, CV_8U);
    image_ = Image(planes[0], planes[1], planes[2], Image::Range::limited);
  }

  const Image& image() const { return image_; }
  cv::Mat& mask() { return mask_; }

 private:
  double noise_;
  Image image_;
  cv::Mat mask_;
};

/// The silhouettes of the mask, each alone, or all of those that touch as one group.
std::vector<Detection> silhouettes_in(const cv::Mat& mask) {
  std::vector<std::vector<cv::Point>> edges;
  cv::findContours(mask.clone(), edges, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  std::vector<Detection> all;
  for (const auto& edge : edges) {
    if (edge.size() < 20) continue;
    Detection one;
    for (const cv::Point& p : edge) one.outline.emplace_back(p.x, p.y);
    const cv::Rect box = cv::boundingRect(edge);
    one.box = {static_cast<double>(box.x), static_cast<double>(box.y), static_cast<double>(box.width),
               static_cast<double>(box.height)};
    one.centre = geometry::polygon_centroid(one.outline).value_or(one.box.centre());
    all.push_back(one);
  }
  return all;
}

/// Every contour is simple, finite and about as large as its body; the mean IoU with them, of contours that are there.
class HardCheck {
 public:
  explicit HardCheck(ContourTracker& tracker) : tracker_(tracker) {}

  void step(HardScene& scene, const std::vector<HardBody>& bodies, int frame) {
    Frame given;
    given.index = frame;
    given.time = timestamp_from_seconds(frame / 25.0);
    given.image = scene.image();
    const std::vector<Detection> detections = silhouettes_in(scene.mask());
    tracker_.observe(given, Foreground{scene.mask(), {}}, detections);
    std::vector<Track<2>> tracks;
    for (std::size_t i = 0; i < bodies.size(); ++i) tracks.push_back(track_of(bodies[i], static_cast<int>(i) + 1, detections));
    for (const Track<2>& track : tracker_.attach(tracks, detections)) {
      const HardBody& body = bodies[static_cast<std::size_t>(number(track.id)) - 1];
      ++requests;
      if (track.outline) note(*track.outline);
      if (track.outline) inspect(*track.outline, body, frame);
    }
  }

  double iou() const { return contours > 0 ? sum_ / contours : 0; }

  int requests = 0, contours = 0;
  std::vector<double> numbers;  ///< all that contours were

 private:
  void note(const Outline& outline) {
    numbers.push_back(static_cast<double>(outline.state));
    for (const auto* places : {&outline.control_points, &outline.deviations}) {
      for (const Vector<2>& one : *places) numbers.insert(numbers.end(), {one.x(), one.y()});
    }
    for (const Vector<2>& one : {outline.centre, outline.velocity, outline.centre_deviation})
      numbers.insert(numbers.end(), {one.x(), one.y()});
    for (const int hidden : outline.hidden) numbers.push_back(hidden);
    for (const TrackId other : outline.behind) numbers.push_back(number(other));
  }

  static Track<2> track_of(const HardBody& body, int id, const std::vector<Detection>& detections) {
    Track<2> track;
    track.id = TrackId{id};
    track.position = body.centre;
    track.box = Box::from_centre(body.centre, body.width, body.height);
    track.confirmed = true;
    for (std::size_t i = 0; i < detections.size(); ++i) {
      if (geometry::iou(detections[i].box, *track.box) > 0.6) track.observation = static_cast<int>(i);
    }
    return track;
  }

  void inspect(const Outline& outline, const HardBody& body, int frame) {
    const geometry::ClosedSpline spline(outline.order, outline.control_points);
    ++contours;
    for (const Vector<2>& point : outline.control_points) ASSERT_TRUE(point.allFinite()) << frame;
    for (const Vector<2>& deviation : outline.deviations) ASSERT_TRUE(deviation.allFinite() && deviation.minCoeff() >= 0) << frame;
    EXPECT_TRUE(is_simple(spline)) << frame;
    EXPECT_LE(spline.box().height, kOversized * body.height + 3) << frame;
    EXPECT_LE(spline.box().width, kOversized * std::max(body.width, 0.4 * body.height) + 3) << frame;
    colour::ColourPatch patch;
    patch.colour = cv::Mat(kHardSize, CV_32FC3);
    const cv::Mat own = colour::cells_within(spline.polygon(), patch), truth = colour::cells_within(edge_of_body(body), patch);
    cv::Mat both, either;
    cv::min(own, truth, both);
    cv::max(own, truth, either);
    sum_ += cv::sum(both)[0] / std::max(1.0, cv::sum(either)[0]);
  }

  ContourTracker& tracker_;
  double sum_ = 0;
};

HardBody hard_walker(double x, const cv::Scalar& colour = kBright) {
  return {{x, 80}, 22, 60, colour};
}

TEST(ContourBadInput, EverybodyInTheSameBlack) {
  ContourTracker tracker;
  HardCheck check(tracker);
  HardScene scene;
  for (int k = 0; k < 60; ++k) {
    const std::vector<HardBody> bodies{hard_walker(60 + 2.0 * k, kDark), hard_walker(180 - 2.0 * k, kDark)};
    scene.paint(bodies, k);
    check.step(scene, bodies, k);
  }
  EXPECT_GT(check.contours, 100);
  EXPECT_GT(check.iou(), 0.7);
}

TEST(ContourBadInput, ATargetAsLargeAsThePicture) {
  ContourTracker tracker;
  HardCheck check(tracker);
  HardScene scene;
  for (int k = 0; k < 10; ++k) {
    const std::vector<HardBody> bodies{{{120, 80}, 260, 180, kBright, true}};
    scene.paint(bodies, k);
    check.step(scene, bodies, k);
  }
  EXPECT_EQ(check.requests, 10);
}

TEST(ContourBadInput, AMaskOfAModelThatIsNotTheTargets) {
  for (const bool wrong : {false, true}) {
    ContourTracker tracker;
    // A network that is sure of a place half a body away.
    tracker.use_masks([&](const Image&, std::span<const Box> boxes) {
      std::vector<colour::BodyMask> masks;
      for (const Box& box : boxes) {
        colour::BodyMask mask{
            .chance = cv::Mat(80, 80, CV_32FC1, cv::Scalar(0.01)), .corner = box.centre() - Vector<2>(40, 40), .scale = 1};
        cv::ellipse(mask.chance, {wrong ? 60 : 40, 40}, {11, 30}, 0, 0, 360, 0.99, cv::FILLED);
        masks.push_back(mask);
      }
      return masks;
    });
    HardCheck check(tracker);
    HardScene scene;
    for (int k = 0; k < 40; ++k) {
      const std::vector<HardBody> bodies{hard_walker(60 + 2.0 * k)};
      scene.paint(bodies, k);
      check.step(scene, bodies, k);
    }
    EXPECT_GT(check.contours, 35);
    EXPECT_GT(check.iou(), wrong ? 0.6 : 0.85) << wrong;
  }
}

TEST(ContourBadInput, ACameraThatMovesALittle) {
  ContourTracker tracker;
  HardCheck check(tracker);
  HardScene scene;
  for (int k = 0; k < 40; ++k) {
    const std::vector<HardBody> bodies{hard_walker(60 + 2.0 * k)};
    const Vector<2> shake(2 * std::sin(0.9 * k), std::cos(1.3 * k));
    scene.paint(bodies, k, shake);
    for (int x = 0; x < kHardSize.width; x += 12) scene.mask().col(x).setTo(255);  // the scene's edges are foreground
    cv::morphologyEx(scene.mask(), scene.mask(), cv::MORPH_OPEN, cv::Mat::ones(2, 2, CV_8UC1));
    check.step(scene, bodies, k);
  }
  EXPECT_GT(check.contours, 35);
  EXPECT_GT(check.iou(), 0.75);
}

TEST(ContourBadInput, InterlacedVideo) {
  ContourTracker tracker;
  HardCheck check(tracker);
  HardScene scene;
  for (int k = 0; k < 40; ++k) {
    const std::vector<HardBody> bodies{hard_walker(60 + 2.0 * k)};
    scene.paint(bodies, k, Vector<2>::Zero(), true);
    check.step(scene, bodies, k);
  }
  EXPECT_GT(check.iou(), 0.7);
}

TEST(ContourBadInput, GrainOfTheNight) {
  ContourTracker tracker;
  HardCheck check(tracker);
  HardScene scene(14);
  for (int k = 0; k < 40; ++k) {
    const std::vector<HardBody> bodies{hard_walker(60 + 2.0 * k, cv::Scalar(115, 118, 124))};
    scene.paint(bodies, k);
    std::mt19937 dice(static_cast<unsigned>(1000 + k));
    for (int i = 0; i < 300; ++i) {
      scene.mask().at<std::uint8_t>(static_cast<int>(dice() % 160), static_cast<int>(dice() % 240)) = dice() % 2 == 0 ? 255 : 0;
    }
    check.step(scene, bodies, k);
  }
  EXPECT_GT(check.contours, 30);
  EXPECT_GT(check.iou(), 0.7);
}

TEST(ContourBadInput, CarsInPlaceOfPeople) {
  ContourTracker tracker;
  HardCheck check(tracker);
  HardScene scene;
  for (int k = 0; k < 40; ++k) {
    const std::vector<HardBody> bodies{{{60 + 2.0 * k, 50}, 70, 26, kDark, true}, {{190 - 2.0 * k, 115}, 80, 30, kBright, true}};
    scene.paint(bodies, k);
    check.step(scene, bodies, k);
  }
  EXPECT_GT(check.contours, 70);
  EXPECT_GT(check.iou(), 0.8);
}

/// All that the contours of a scene are, processed by this many threads: people apart and people who cross, two by two.
std::vector<double> contours_by(std::size_t threads) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
  ContourTracker tracker;
  HardCheck check(tracker);
  HardScene scene;
  for (int k = 0; k < 40; ++k) {
    const std::vector<HardBody> bodies{hard_walker(40 + 1.5 * k), hard_walker(110 - 1.5 * k, kDark), hard_walker(150 + 1.0 * k),
                                       hard_walker(218 - 1.0 * k)};
    scene.paint(bodies, k);
    check.step(scene, bodies, k);
  }
  EXPECT_GT(check.contours, 100);
  return std::move(check.numbers);
}

TEST(ContourThreads, AnyNumberGivesTheSameContours) {
  const std::vector<double> alone = contours_by(1);
  EXPECT_GT(alone.size(), 5000u);
  for (const std::size_t threads : {2, 4, 7}) EXPECT_EQ(contours_by(threads), alone) << threads;
}

}  // namespace
}  // namespace marey::track::contour
