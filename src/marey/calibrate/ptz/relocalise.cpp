#include "marey/calibrate/ptz/relocalise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/SVD>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "marey/calibrate/ptz/line_markings.h"
#include "marey/geometry/ground_view.h"

namespace marey::calibrate::ptz {
namespace {

constexpr int kWidth = 480;                  // px: images are shrunk to this
constexpr double kFar = 12;                  // shrunk px: beyond, a line is not there
constexpr double kCoarse = 9;                // shrunk px between headings that are tried about the best, twice as much elsewhere
constexpr double kZoomStep = 0.13;           // of ln f
constexpr std::size_t kRefinedStarts = 250;  // of the coarse headings; numerical: cost alone
constexpr int kRefined = 8;                  // headings that are inspected closely,
constexpr double kMissing = 0.55;            // what a piece of line that is not there counts against
constexpr std::size_t kPositions = 400;      // pieces of paint that a heading has to explain; numerical: cost alone

/// What may be paint in a shrunk image.
struct PaintMask {
  cv::Mat near;                      ///< for each pixel how near the next piece is: 1 on it … 0 beyond kFar, CV_32F
  cv::Mat about;                     ///< the same, 0 beyond twice as much
  std::vector<Vector<2>> positions;  ///< some of the pieces, shrunk px
};

/// The threshold over which a ridge stands out: as low as the grass allows.
double ridge_threshold(const cv::Mat& ridges, const cv::Mat& ground, const FindAgainOptions& options) {
  constexpr std::array<float, 2> kLevels{0, 64};
  const float* levels = kLevels.data();
  const int channel = 0, bins = 64;
  cv::Mat counts;
  cv::calcHist(&ridges, 1, &channel, ground, counts, 1, &bins, &levels);
  const double all = cv::sum(counts)[0];
  double above = all;
  for (int level = 0; level < bins; ++level) {
    above -= counts.at<float>(level);
    if (level >= options.min_ridge && above < options.paint_fraction * all) return std::min<double>(level, options.max_ridge);
  }
  return options.max_ridge;
}

PaintMask paint_mask(const Image& image, const FindAgainOptions& options) {
  const double factor = static_cast<double>(kWidth) / image.size().width;
  const cv::Size size(kWidth, cvRound(image.size().height * factor));
  const cv::Mat& luma = image.luma();
  const int wide = std::max(9, image.size().width / 64) | 1;
  cv::Mat open, ridges, mask, shrunk, smooth;
  cv::GaussianBlur(luma, smooth, {3, 3}, 0.7);
  cv::morphologyEx(smooth, open, cv::MORPH_OPEN, cv::getStructuringElement(cv::MORPH_RECT, {wide, wide}));
  ridges = smooth - open;
  cv::Mat ground(luma.size(), CV_8UC1, cv::Scalar(255));
  if (!image.cb().empty()) {
    // Paint has the ground's green about it: the middle colour of a wide window.
    cv::Mat cb, cr, green;
    cv::resize(image.cb(), cb, size, 0, 0, cv::INTER_AREA);
    cv::resize(image.cr(), cr, size, 0, 0, cv::INTER_AREA);
    cv::blur(cb, cb, {9, 9}), cv::blur(cr, cr, {9, 9});
    green = (cb < 127) & (cr < 127);
    cv::erode(green, green, cv::Mat::ones(5, 5, CV_8U));
    cv::resize(green, ground, luma.size(), 0, 0, cv::INTER_NEAREST);
  }
  cv::threshold(ridges, mask, ridge_threshold(ridges, ground, options), 255, cv::THRESH_BINARY);
  mask &= ground;
  cv::resize(mask, shrunk, size, 0, 0, cv::INTER_AREA);
  PaintMask result;
  const cv::Mat bare = shrunk < 40;  // 0 where there is paint
  cv::Mat far;
  cv::distanceTransform(bare, far, cv::DIST_L2, 3);
  result.near = 1 - far / kFar;
  cv::max(result.near, 0, result.near);
  result.about = 1 - far / (2 * kFar);
  cv::max(result.about, 0, result.about);
  std::vector<cv::Point> painted;
  cv::findNonZero(shrunk >= 40, painted);
  const std::size_t step = std::max<std::size_t>(1, painted.size() / kPositions);
  for (std::size_t i = 0; i < painted.size(); i += step) result.positions.emplace_back(painted[i].x, painted[i].y);
  return result;
}

struct Candidate {
  geometry::Heading heading;
  double score = 0;
};

/// How well a heading explains the mask: lines that are there by their length, others against it.
double score_of(const cv::Mat& near, const geometry::Tripod& tripod, const geometry::Heading& heading,
                std::span<const geometry::PitchLine> lines, std::size_t stride) {
  const auto numbers = tripod.as_numbers();
  const Vector<3> rotated = heading.as_vector();
  const geometry::TripodFrame<double> frame(numbers.data(), rotated.data());
  double score = 0;
  for (const geometry::PitchLine& line : lines) {
    Vector<2> last = Vector<2>::Zero();
    bool goes_on = false;  // from the sample before
    for (std::size_t i = 0; i < line.points.size(); i += stride) {
      const Vector<3> location(line.points[i].x(), line.points[i].y(), 0);
      if (frame.depth(location) < 5) {
        goes_on = false;
        continue;
      }
      const Vector<2> pixel = geometry::to_pixel(frame.detected(location), near.size());
      const bool inside = pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < near.cols - 1 && pixel.y() < near.rows - 1;
      if (inside && goes_on) {
        const double length = std::min(40.0, (pixel - last).norm());
        const float here = near.at<float>(static_cast<int>(pixel.y() + 0.5), static_cast<int>(pixel.x() + 0.5));
        score += length * (here > 0 ? here : -kMissing);
      }
      last = pixel;
      goes_on = true;
    }
  }
  return score;
}

/// Where headings are tried.
struct HeadingRange {
  Vector<3> minimum = Vector<3>::Constant(9), maximum = Vector<3>::Constant(-9);
};

HeadingRange over_pitch(const geometry::Tripod& tripod, const geometry::PitchSize& pitch, const FindAgainOptions& options) {
  HeadingRange range;
  const Vector<2> middle = Vector<2>(pitch.length / 2, pitch.width / 2) - tripod.location.head<2>();
  const double straight = std::atan2(middle.x(), middle.y());
  for (const double x : {0.0, pitch.length}) {
    for (const double y : {0.0, pitch.width}) {
      const Vector<2> to = Vector<2>(x, y) - tripod.location.head<2>();
      const double pan = straight + std::remainder(std::atan2(to.x(), to.y()) - straight, 2 * M_PI);
      const Vector<3> corner(pan, std::atan2(tripod.location.z(), to.norm()), options.min_log_focal);
      range.minimum = range.minimum.cwiseMin(corner), range.maximum = range.maximum.cwiseMax(corner);
    }
  }
  range.maximum.z() = options.max_log_focal;
  return range;
}

HeadingRange about(const NearHeading& near, const FindAgainOptions& options) {
  const double angle = std::min(options.max_near_angle, options.near_angle + options.near_angle_rate * near.frames),
               zoom = std::min(options.max_near_zoom, options.near_zoom + options.near_zoom_rate * near.frames);
  const Vector<3> middle = near.heading.as_vector(), half(angle, angle / 2, zoom);
  HeadingRange range{middle - half, middle + half};
  range.minimum.z() = std::max(range.minimum.z(), options.min_log_focal);
  range.maximum.z() = std::min(range.maximum.z(), options.max_log_focal);
  return range;
}

/// Headings over a range, evenly in the image; `coarse` shrunk px apart.
std::vector<geometry::Heading> headings_over(const HeadingRange& range, double aspect, double coarse, double zoom_step,
                                             bool with_margin) {
  std::vector<geometry::Heading> headings;
  for (double log_focal = range.minimum.z(); log_focal <= range.maximum.z(); log_focal += zoom_step) {
    const double step = coarse / (std::exp(log_focal) * kWidth / 2), half = with_margin ? 0.6 * aspect / std::exp(log_focal) : 0;
    for (double pan = range.minimum.x(); pan <= range.maximum.x(); pan += step) {
      for (double tilt = std::max(0.0, range.minimum.y() - half); tilt <= range.maximum.y() + half / 2; tilt += step)
        headings.push_back({pan, tilt, log_focal});
    }
  }
  return headings;
}

std::vector<Candidate> rated(const cv::Mat& near, const geometry::Tripod& tripod, std::span<const geometry::PitchLine> lines,
                             const std::vector<geometry::Heading>& headings, std::size_t stride) {
  std::vector<Candidate> all(headings.size());
  cv::parallel_for_(cv::Range(0, static_cast<int>(headings.size())), [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      const auto at = static_cast<std::size_t>(i);
      all[at] = {headings[at], score_of(near, tripod, headings[at], lines, stride)};
    }
  });
  return all;
}

void best_first(std::vector<Candidate>& all, std::size_t count) {
  const auto better = [](const Candidate& a, const Candidate& b) {
    return a.score != b.score ? a.score > b.score : a.heading.as_vector().sum() < b.heading.as_vector().sum();
  };
  count = std::min(count, all.size());
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end(), better);
  all.resize(count);
}

/// Headings between the coarse ones, about each of the best of them.
std::vector<geometry::Heading> headings_about(const std::vector<Candidate>& best) {
  std::vector<geometry::Heading> headings;
  for (const Candidate& one : best) {
    const double step = kCoarse / (std::exp(one.heading.log_focal) * kWidth / 2);
    for (int code = 0; code < 27; ++code)
      headings.push_back({one.heading.pan + (code % 3 - 1) * step, one.heading.tilt + (code / 3 % 3 - 1) * step,
                          one.heading.log_focal + (code / 9 - 1) * kZoomStep / 2});
  }
  return headings;
}

/// The best headings of a range that differ: all over it coarsely, then finer about the best.
std::vector<Candidate> best_of(const PaintMask& seen, const geometry::Tripod& tripod, std::span<const geometry::PitchLine> lines,
                               const std::vector<geometry::Heading>& headings, int count) {
  std::vector<Candidate> all = rated(seen.about, tripod, lines, headings, 7);
  best_first(all, kRefinedStarts);
  all = rated(seen.near, tripod, lines, headings_about(all), 5);
  best_first(all, all.size());
  std::vector<Candidate> best;
  for (const Candidate& one : all) {
    const bool apart = std::all_of(best.begin(), best.end(), [&](const Candidate& other) {
      const double method = std::exp(one.heading.log_focal) * kWidth / 2 *
                            std::hypot(one.heading.pan - other.heading.pan, one.heading.tilt - other.heading.tilt);
      return method > 2.5 * kCoarse || std::abs(one.heading.log_focal - other.heading.log_focal) > 2.5 * kZoomStep;
    });
    if (apart) best.push_back(one);
    if (std::ssize(best) == count) break;
  }
  return best;
}

/// By small steps to the top of the score.
Candidate climbed(const cv::Mat& near, const geometry::Tripod& tripod, std::span<const geometry::PitchLine> lines, Candidate at) {
  at.score = score_of(near, tripod, at.heading, lines, 2);
  for (double part = 0.5; part > 0.1; part /= 1.6) {
    const double step = part * kCoarse / (std::exp(at.heading.log_focal) * kWidth / 2), zoom = part * kZoomStep;
    for (int round = 0; round < 4; ++round) {
      Candidate best = at;
      for (int code = 0; code < 27; ++code) {
        const geometry::Heading heading{at.heading.pan + (code % 3 - 1) * step, at.heading.tilt + (code / 3 % 3 - 1) * step,
                                        at.heading.log_focal + (code / 9 - 1) * zoom};
        const double score = score_of(near, tripod, heading, lines, 2);
        if (score > best.score) best = {heading, score};
      }
      if (best.score <= at.score) break;
      at = best;
    }
  }
  return at;
}

struct Close {
  AimFit fit;
  int expected = 0;
  double explained = 0;  ///< fraction of the paint mask that lies on a line
  double merit() const { return explained * fit.agreeing * fit.agreeing / std::max(1.0, 1.0 * expected); }
  double both() const { return std::sqrt(explained * std::min(1.0, fit.agreeing / std::max(1.0, 1.0 * expected))); }
};

/// The fraction of the paint mask that a heading explains; what it puts beside the pitch counts little, for or against.
double explained_by(const PaintMask& seen, const geometry::Tripod& tripod, const geometry::Heading& heading,
                    const geometry::PitchSize& pitch, const FindAgainOptions& options) {
  const GroundView view(geometry::camera_of(tripod, heading, seen.near.size()));
  double on = 0, all = 1e-9;
  for (const Vector<2>& position : seen.positions) {
    const auto location = view.location(position);
    if (!location) continue;
    const Vector<2>& ground = location->ground;
    const bool beside = ground.x() < -options.beyond || ground.y() < -options.beyond ||
                        ground.x() > pitch.length + options.beyond || ground.y() > pitch.width + options.beyond;
    const double metres = geometry::distance_to_line(pitch, ground);
    // Across a line a pixel is between these two lengths of ground.
    const Eigen::JacobiSVD<Matrix<2>> extent(location->by_pixel);
    const bool there = metres < options.explained_px * std::sqrt(extent.singularValues()(0) * extent.singularValues()(1));
    all += beside ? options.off_pitch_weight : 1;
    on += beside ? 0 : there ? 1 : 0;
  }
  return on / all;
}

Close refined(const Image& image, const PaintMask& seen, const geometry::Tripod& tripod, const geometry::PitchSize& pitch,
              std::span<const geometry::PitchLine> lines, const geometry::Heading& start, const FindAgainOptions& options) {
  const cv::Mat& luma = image.luma();
  Close close;
  close.fit.aim.heading = start;
  for (const double reach : {14.0, 8.0, 4.0, 4.0}) {
    PaintOptions how;
    how.reach = reach * std::max(1.0, luma.cols / 1280.0);
    const Paint paint = find_paint(luma, tripod, close.fit.aim.heading, lines, how);
    Aim expected{close.fit.aim.heading, Vector<3>(2.5e-4, 2.5e-4, 2.5e-3).asDiagonal()};
    close.fit = solve_aim(tripod, luma.size(), paint.detected, expected);
    close.expected = paint.expected;
  }
  close.explained = explained_by(seen, tripod, close.fit.aim.heading, pitch, options);
  return close;
}

bool enough(const Close& close, const FindAgainOptions& options) {
  return close.fit.agreeing >= options.lowest_count && close.fit.lines >= options.lines &&
         close.fit.agreeing >= options.fraction * close.expected && close.both() >= options.both;
}

bool alike(const Close& a, const Close& b) {
  const Vector<3> off = a.fit.aim.heading.as_vector() - b.fit.aim.heading.as_vector();
  return off.head<2>().norm() < 0.01 && std::abs(off.z()) < 0.03;
}

/// The closest of the best headings, those that explain more first.
std::vector<Close> closest_of(const Image& image, const PaintMask& seen, const geometry::Tripod& tripod,
                              const geometry::PitchSize& pitch, std::span<const geometry::PitchLine> lines,
                              const std::vector<geometry::Heading>& headings, int count, const FindAgainOptions& options) {
  std::vector<Close> all;
  for (const Candidate& one : best_of(seen, tripod, lines, headings, count))
    all.push_back(refined(image, seen, tripod, pitch, lines, climbed(seen.near, tripod, lines, one).heading, options));
  std::stable_sort(all.begin(), all.end(), [](const Close& a, const Close& b) { return a.merit() > b.merit(); });
  return all;
}

/// The best, if it is enough and no other one is nearly as good.
std::optional<AimFit> decided(const std::vector<Close>& all, const FindAgainOptions& options) {
  if (all.empty() || !enough(all.front(), options)) return std::nullopt;
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (!alike(all[i], all.front()) && all[i].merit() > options.rival * all.front().merit()) return std::nullopt;
  }
  return all.front().fit;
}

}  // namespace

std::optional<AimFit> find_again(const Image& image, const geometry::Tripod& tripod, const geometry::PitchSize& pitch,
                                 std::span<const geometry::PitchLine> lines, const FindAgainOptions& options) {
  const PaintMask seen = paint_mask(image, options);
  const double aspect = static_cast<double>(seen.near.rows) / seen.near.cols;
  if (options.near) {
    const auto headings = headings_over(about(*options.near, options), aspect, 2 * kCoarse, 1.5 * kZoomStep, false);
    if (const auto found = decided(closest_of(image, seen, tripod, pitch, lines, headings, options.near_count, options), options))
      return found;
  }
  if (!options.everywhere) return std::nullopt;
  const auto headings = headings_over(over_pitch(tripod, pitch, options), aspect, 2 * kCoarse, 1.5 * kZoomStep, true);
  return decided(closest_of(image, seen, tripod, pitch, lines, headings, kRefined, options), options);
}

}  // namespace marey::calibrate::ptz
