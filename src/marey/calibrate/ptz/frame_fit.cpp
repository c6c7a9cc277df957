#include "marey/calibrate/ptz/frame_fit.h"

#include <algorithm>
#include <cmath>

#include "marey/geometry/median.h"

namespace marey::calibrate::ptz {
namespace {

constexpr double kNarrowReach = 3.5;  // px at 1280: paint is searched for again where the first fit says

}  // namespace

double Correction::merit() const {
  return static_cast<double>(fit.agreeing) * fit.agreeing / std::max(1, paint.expected);
}

double unsure_px(const Aim& aim) {
  const double angle = std::exp(aim.heading.log_focal) * std::sqrt(aim.covariance.topLeftCorner<2, 2>().trace()),
               zoom = std::sqrt(aim.covariance(2, 2));
  return 640 * std::max(angle, 0.7 * zoom);
}

Correction correct_aim(const cv::Mat& luma, const geometry::Tripod& tripod, std::span<const geometry::PitchLine> lines,
                       const Aim& expected, std::span<const PaintSighting> clicks, const AimOptions& options) {
  const double unit = luma.cols / 1280.0;
  const auto solved = [&](const Paint& paint, const Aim& prior) {
    std::vector<PaintSighting> all = paint.detected;
    all.insert(all.end(), clicks.begin(), clicks.end());
    return solve_aim(tripod, luma.size(), all, prior, options);
  };
  const auto within = [&](double reach, const Aim& prior) {
    Correction result;
    PaintOptions how;
    how.reach = unit * reach;
    const Paint wide = find_paint(luma, tripod, prior.heading, lines, how);
    const AimFit first = solved(wide, prior);
    how.reach = unit * kNarrowReach;
    result.paint = find_paint(luma, tripod, first.aim.heading, lines, how);
    result.fit = solved(result.paint, prior);
    return result;
  };
  Correction result = within(std::clamp(4 + 3 * unsure_px(expected), 5.0, 16.0), expected);
  if (result.fit.agreeing >= options.enough * result.paint.expected) return result;
  // Much is not where it ought to be: perhaps the expectation is surer than it should be.
  const double angle = options.loose_px / 640 * std::exp(-expected.heading.log_focal), zoom = options.loose_px / 450;
  Aim loose = expected;
  loose.covariance += Vector<3>(angle * angle, angle * angle, zoom * zoom).asDiagonal().toDenseMatrix();
  const Correction other = within(options.loose_reach, loose);
  return other.merit() > options.better * result.merit() ? other : result;
}

std::vector<PaintSighting> agreeing_paint(const std::vector<PaintSighting>& paint, const geometry::Tripod& tripod, const Aim& aim,
                                          cv::Size size, double cut_off, std::size_t maximum) {
  const auto numbers = tripod.as_numbers();
  const Vector<3> rotated = aim.heading.as_vector();
  const geometry::TripodFrame<double> frame(numbers.data(), rotated.data());
  std::vector<PaintSighting> agreeing, kept;
  for (const PaintSighting& one : paint) {
    const Vector<2> pixel = geometry::to_pixel(frame.detected({one.ground.x(), one.ground.y(), 0}), size);
    const double off = one.normal.cast<double>().dot(pixel - one.pixel.cast<double>());
    if (std::abs(off) < 2 * cut_off * one.sigma) agreeing.push_back(one);
  }
  if (agreeing.size() <= maximum) return agreeing;
  for (std::size_t i = 0; i < maximum; ++i) kept.push_back(agreeing[i * agreeing.size() / maximum]);
  return kept;
}

double lines_present(const Correction& detected, const geometry::Tripod& tripod, cv::Size size, double cut_off, int in_view,
                     double present) {
  std::vector<int> agreeing(detected.paint.expected_of.size(), 0);
  const auto& paint = detected.paint.detected;
  for (const PaintSighting& one : agreeing_paint(paint, tripod, detected.fit.aim, size, cut_off / 2, paint.size()))
    ++agreeing[static_cast<std::size_t>(one.line)];
  int lines = 0, there = 0;
  for (std::size_t i = 0; i < agreeing.size(); ++i) {
    if (detected.paint.expected_of[i] < in_view) continue;
    ++lines;
    there += agreeing[i] >= present * detected.paint.expected_of[i] ? 1 : 0;
  }
  return lines == 0 ? 1 : static_cast<double>(there) / lines;
}

std::vector<PaintSighting> click_sightings(std::span<const ClickedPosition> clicks, double sigma) {
  std::vector<PaintSighting> sightings;
  std::int16_t line = kFirstClick;
  for (const ClickedPosition& click : clicks) {
    for (const Eigen::Vector2f& axis : {Eigen::Vector2f(1, 0), Eigen::Vector2f(0, 1)})
      sightings.push_back({click.ground.cast<float>(), click.pixel.cast<float>(), axis, static_cast<float>(sigma), line++});
  }
  return sightings;
}

Aim aim_of_clicks(std::span<const PaintSighting> clicks, const geometry::Tripod& tripod, const geometry::Heading& start,
                  cv::Size size, const AimOptions& options) {
  const Vector<3> wide(options.click_angle * options.click_angle, options.click_angle * options.click_angle,
                       options.click_zoom * options.click_zoom);
  return solve_aim(tripod, size, clicks, Aim{start, wide.asDiagonal().toDenseMatrix()}, options).aim;
}

double distance_from_clicks(std::span<const ClickedPosition> clicks, const geometry::Tripod& tripod,
                            const geometry::Heading& heading, cv::Size size) {
  const auto numbers = tripod.as_numbers();
  const Vector<3> rotated = heading.as_vector();
  const geometry::TripodFrame<double> frame(numbers.data(), rotated.data());
  std::vector<double> off;
  for (const ClickedPosition& click : clicks)
    off.push_back((geometry::to_pixel(frame.detected({click.ground.x(), click.ground.y(), 0}), size) - click.pixel).norm());
  return off.empty() ? 0 : geometry::median(off);
}

}  // namespace marey::calibrate::ptz
