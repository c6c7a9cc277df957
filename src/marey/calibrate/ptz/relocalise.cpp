#include "marey/calibrate/ptz/relocalise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "marey/calibrate/ptz/line_markings.h"

namespace marey::calibrate::ptz {
namespace {

constexpr int kWidth = 480;         // px: images are shrunk to this
constexpr double kFar = 12;         // shrunk px: beyond, a line is not there
constexpr double kCoarse = 9;       // shrunk px between headings that are tried
constexpr double kZoomStep = 0.13;  // of ln f
constexpr int kRefined = 8;         // headings that are inspected closely
constexpr double kMissing = 0.55;   // what a piece of line that is not there counts against

/// For each pixel of the shrunk image how near the next piece of paint is: 1 on it … 0 beyond kFar, CV_32F.
cv::Mat nearness(const Image& image) {
  const double factor = static_cast<double>(kWidth) / image.size().width;
  const cv::Size size(kWidth, cvRound(image.size().height * factor));
  const cv::Mat& luma = image.luma();
  const int wide = std::max(9, image.size().width / 64) | 1;
  cv::Mat open, ridges, mask, shrunk;
  cv::morphologyEx(luma, open, cv::MORPH_OPEN, cv::getStructuringElement(cv::MORPH_RECT, {wide, wide}));
  ridges = luma - open;
  cv::threshold(ridges, mask, 14, 255, cv::THRESH_BINARY);
  if (!image.cb().empty()) {
    // Paint has the ground's green about it: the middle colour of a wide window.
    cv::Mat cb, cr, green;
    cv::resize(image.cb(), cb, size, 0, 0, cv::INTER_AREA);
    cv::resize(image.cr(), cr, size, 0, 0, cv::INTER_AREA);
    cv::blur(cb, cb, {9, 9}), cv::blur(cr, cr, {9, 9});
    green = (cb < 127) & (cr < 127);
    cv::erode(green, green, cv::Mat::ones(5, 5, CV_8U));
    cv::resize(green, green, luma.size(), 0, 0, cv::INTER_NEAREST);
    mask &= green;
  }
  cv::resize(mask, shrunk, size, 0, 0, cv::INTER_AREA);
  const cv::Mat paint = shrunk < 40;  // 0 where there is paint
  cv::Mat far;
  cv::distanceTransform(paint, far, cv::DIST_L2, 3);
  cv::Mat near = 1 - far / kFar;
  cv::max(near, 0, near);
  return near;
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

/// Headings over the pitch, evenly in the image.
std::vector<geometry::Heading> headings_over(const geometry::Tripod& tripod, const geometry::PitchSize& pitch, double aspect,
                                             const FindAgainOptions& options) {
  double least_pan = 9, most_pan = -9, least_tilt = 9, most_tilt = -9;
  const Vector<2> middle = Vector<2>(pitch.length / 2, pitch.width / 2) - tripod.location.head<2>();
  const double straight = std::atan2(middle.x(), middle.y());
  for (const double x : {0.0, pitch.length}) {
    for (const double y : {0.0, pitch.width}) {
      const Vector<2> to = Vector<2>(x, y) - tripod.location.head<2>();
      const double pan = straight + std::remainder(std::atan2(to.x(), to.y()) - straight, 2 * M_PI);
      least_pan = std::min(least_pan, pan), most_pan = std::max(most_pan, pan);
      const double tilt = std::atan2(tripod.location.z(), to.norm());
      least_tilt = std::min(least_tilt, tilt), most_tilt = std::max(most_tilt, tilt);
    }
  }
  std::vector<geometry::Heading> headings;
  for (double log_focal = options.min_log_focal; log_focal <= options.max_log_focal; log_focal += kZoomStep) {
    const double step = kCoarse / (std::exp(log_focal) * kWidth / 2), half = 0.6 * aspect / std::exp(log_focal);
    for (double pan = least_pan; pan <= most_pan; pan += step) {
      for (double tilt = std::max(0.0, least_tilt - half); tilt <= most_tilt + half / 2; tilt += step)
        headings.push_back({pan, tilt, log_focal});
    }
  }
  return headings;
}

std::vector<Candidate> best_of(const cv::Mat& near, const geometry::Tripod& tripod, std::span<const geometry::PitchLine> lines,
                               const std::vector<geometry::Heading>& headings) {
  std::vector<Candidate> all(headings.size());
  cv::parallel_for_(cv::Range(0, static_cast<int>(headings.size())), [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      const auto at = static_cast<std::size_t>(i);
      all[at] = {headings[at], score_of(near, tripod, headings[at], lines, 5)};
    }
  });
  std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  std::vector<Candidate> best;
  for (const Candidate& one : all) {
    const bool apart = std::all_of(best.begin(), best.end(), [&](const Candidate& other) {
      const double method = std::exp(one.heading.log_focal) * kWidth / 2 *
                            std::hypot(one.heading.pan - other.heading.pan, one.heading.tilt - other.heading.tilt);
      return method > 2.5 * kCoarse || std::abs(one.heading.log_focal - other.heading.log_focal) > 2.5 * kZoomStep;
    });
    if (apart) best.push_back(one);
    if (best.size() == kRefined) break;
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
};

Close refined(const cv::Mat& luma, const geometry::Tripod& tripod, std::span<const geometry::PitchLine> lines,
              const geometry::Heading& start) {
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
  return close;
}

}  // namespace

std::optional<AimFit> find_again(const Image& image, const geometry::Tripod& tripod, const geometry::PitchSize& pitch,
                                 std::span<const geometry::PitchLine> lines, const FindAgainOptions& options) {
  const cv::Mat near = nearness(image);
  const double aspect = static_cast<double>(near.rows) / near.cols;
  std::vector<Close> all;
  for (const Candidate& one : best_of(near, tripod, lines, headings_over(tripod, pitch, aspect, options)))
    all.push_back(refined(image.luma(), tripod, lines, climbed(near, tripod, lines, one).heading));
  const auto merit = [](const Close& close) {
    return close.fit.agreeing * close.fit.agreeing / std::max(1.0, 1.0 * close.expected);
  };
  std::stable_sort(all.begin(), all.end(), [&](const Close& a, const Close& b) { return merit(a) > merit(b); });
  if (all.empty()) return std::nullopt;
  const Close& best = all.front();
  if (best.fit.agreeing < options.lowest_count || best.fit.lines < options.lines ||
      best.fit.agreeing < options.fraction * best.expected)
    return std::nullopt;
  for (std::size_t i = 1; i < all.size(); ++i) {
    const Vector<3> off = all[i].fit.aim.heading.as_vector() - best.fit.aim.heading.as_vector();
    const bool same = off.head<2>().norm() < 0.01 && std::abs(off.z()) < 0.03;
    if (!same && merit(all[i]) > options.rival * merit(best)) return std::nullopt;
  }
  return best.fit;
}

}  // namespace marey::calibrate::ptz
