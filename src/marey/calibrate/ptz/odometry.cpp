#include "marey/calibrate/ptz/odometry.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "marey/calibrate/ptz/ptz_fit.h"
#include "marey/geometry/median.h"

namespace marey::calibrate::ptz {
namespace {

constexpr int kWindow = 15, kLevels = 3;
constexpr double kMaxDistance = 110;    // m: objects above the ground are this far away
constexpr double kStillPixels = 0.35;   // shrunk px: what moved less on the image stands still
constexpr double kMovingFraction = 1;   // of those that stand: more that move together are the scene
constexpr double kMaxTrajectory = 0.3;  // of the image's width: then there is a new reference
constexpr double kMaxZoom = 0.1;

/// What a pixel shows: the ground, or something far away.
Vector<3> shown(const geometry::TripodFrame<double>& frame, const Vector<2>& detected) {
  const Vector<2> straight = detected / (1 + frame.bend * detected.squaredNorm());
  const Vector<3> ray = frame.focal * frame.ahead + straight.x() * frame.right + straight.y() * frame.down;
  const double far = ray.z() < -1e-9 ? -frame.centre.z() / ray.z() * ray.norm() : kMaxDistance;
  return frame.centre + std::min(kMaxDistance, far) * ray.normalized();
}

}  // namespace

Odometry::Odometry(cv::Size size, const OdometryOptions& options) : options_(options) {
  const double factor = std::min(1.0, static_cast<double>(options.width) / size.width);
  size_ = {cvRound(size.width * factor), cvRound(size.height * factor)};
}

void Odometry::refer(const geometry::Tripod& tripod, const geometry::Heading& heading) {
  reference_ = pyramid_;
  reference_tripod_ = tripod;
  reference_heading_ = heading;
  chains_ = {heading};
  age_ = 0;
  corners_.clear();
  locations_.clear();
  cv::Mat free(size_, CV_8UC1, cv::Scalar(255));
  for (const cv::Point2f& at : standing_) cv::circle(free, at, options_.graphics_reach, 0, cv::FILLED);
  cv::goodFeaturesToTrack(reference_[0], corners_, options_.corners, options_.quality, 8, free);
  corners_.insert(corners_.end(), standing_.begin(), standing_.end());  // letters must not take the places of what moves
  const auto numbers = tripod.as_numbers();
  const Vector<3> rotated = heading.as_vector();
  const geometry::TripodFrame<double> frame(numbers.data(), rotated.data());
  for (const cv::Point2f& corner : corners_) locations_.push_back(shown(frame, geometry::from_pixel({corner.x, corner.y}, size_)));
  now_ = corners_;
  begun_with_ = corners_.size();
}

/// The corners in the new image; those that cannot be followed are dropped.
std::vector<Odometry::Match> Odometry::track_corners() {
  std::vector<Match> matches;
  if (corners_.empty()) return matches;
  std::vector<unsigned char> found;
  std::vector<float> error;
  const std::vector<cv::Point2f> before = now_;
  cv::calcOpticalFlowPyrLK(reference_, pyramid_, corners_, now_, found, error, {kWindow, kWindow}, kLevels,
                           {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 20, 0.02}, cv::OPTFLOW_USE_INITIAL_FLOW, 1e-3);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const cv::Point2f& at = now_[i];
    if (found[i] == 0 || error[i] > 30 || at.x < 2 || at.y < 2 || at.x > size_.width - 3 || at.y > size_.height - 3) continue;
    const bool still = std::hypot(at.x - corners_[i].x, at.y - corners_[i].y) < kStillPixels;
    matches.push_back({locations_[i], geometry::from_pixel({at.x, at.y}, size_), still});
    corners_[kept] = corners_[i], now_[kept] = at, locations_[kept] = locations_[i];
    ++kept;
  }
  corners_.resize(kept), now_.resize(kept), locations_.resize(kept);
  return matches;
}

namespace {

struct OdometryFit {
  Vector<3> heading;
  int agreeing = 0;
};

/// Pan, tilt and ln f that most places agree with, from `start` on.
template <typename Matches>
OdometryFit fit_heading(const geometry::Tripod& tripod, const Matches& matches, const geometry::Heading& start, cv::Size size,
                        double agree_px) {
  const double px = size.width / 2.0;
  const auto numbers = tripod.as_numbers();
  OdometryFit result{start.as_vector()};
  // The middle of all displacements brings most of them near.
  std::vector<double> across, down;
  {
    const geometry::TripodFrame<double> frame(numbers.data(), result.heading.data());
    for (const auto& match : matches) {
      const Vector<2> off = match.detected - frame.detected(match.location);
      across.push_back(off.x()), down.push_back(off.y());
    }
    const auto median = [](std::vector<double>& values) { return geometry::median(values); };
    result.heading.x() -= median(across) / frame.focal / std::max(0.3, std::cos(start.tilt));
    result.heading.y() -= median(down) / frame.focal;
  }
  for (double reach = 6 * agree_px; reach > 0.6 * agree_px; reach /= 1.5) {
    Matrix<3> information = Matrix<3>::Identity() * 1e-3;
    Vector<3> slope = Vector<3>::Zero();
    const geometry::TripodFrame<double> frame(numbers.data(), result.heading.data());
    for (const auto& match : matches) {
      const Vector<2> off = px * (frame.detected(match.location) - match.detected);
      const auto by = pixel_by_heading(tripod, geometry::Heading::of(result.heading), size, match.location);
      const double robust = 1 / std::pow(1 + off.squaredNorm() / (reach * reach), 2);
      information += robust * by.transpose() * by;
      slope += robust * by.transpose() * off;
    }
    result.heading -= information.ldlt().solve(slope);
  }
  const geometry::TripodFrame<double> frame(numbers.data(), result.heading.data());
  for (const auto& match : matches)
    result.agreeing += px * (frame.detected(match.location) - match.detected).norm() < agree_px ? 1 : 0;
  return result;
}

}  // namespace

std::optional<Rotated> Odometry::fit(const geometry::Tripod& tripod, const std::vector<Match>& matches) {
  const geometry::Heading& start = chains_.front();
  if (std::ssize(matches) < options_.min_corners) return std::nullopt;
  const int tracked = static_cast<int>(matches.size());
  std::vector<Match> moving;
  for (const Match& match : matches) {
    if (!match.still) moving.push_back(match);
  }
  OdometryFit best = fit_heading(tripod, matches, start, size_, options_.agree_px);
  std::optional<Vector<3>> otherwise;
  if (std::ssize(moving) >= options_.min_corners && moving.size() < matches.size()) {
    OdometryFit other = fit_heading(tripod, moving, start, size_, options_.agree_px);
    const auto still = static_cast<double>(matches.size() - moving.size());
    if (other.agreeing >= options_.min_corners && other.agreeing >= 0.6 * static_cast<double>(moving.size())) {
      if (other.agreeing > kMovingFraction * still) std::swap(best, other);
      const Vector<2> apart = (best.heading - other.heading).head<2>();
      if (std::exp(start.log_focal) * size_.width / 2.0 * apart.norm() > options_.agree_px) otherwise = other.heading;
    }
  }
  if (best.agreeing < options_.min_corners || best.agreeing < options_.fraction * tracked) return std::nullopt;
  // Each group's step is from where the nearer of the two was before.
  const auto step_to = [this](const Vector<3>& heading) {
    const auto nearest = std::min_element(chains_.begin(), chains_.end(), [&](const auto& a, const auto& b) {
      return (a.as_vector() - heading).norm() < (b.as_vector() - heading).norm();
    });
    return Vector<3>(heading - nearest->as_vector());
  };
  Rotated rotated;
  rotated.by = step_to(best.heading);
  if (otherwise) rotated.otherwise = step_to(*otherwise);
  rotated.log_focal = reference_heading_.log_focal;
  rotated.agreeing = best.agreeing, rotated.tracked = tracked;
  chains_ = {geometry::Heading::of(best.heading)};
  if (otherwise) chains_.push_back(geometry::Heading::of(*otherwise));
  return rotated;
}

void Odometry::prefer_other(Rotated& rotated, const geometry::Heading& last) {
  std::swap(rotated.by, *rotated.otherwise);
  if (age_ == 0) refer(reference_tripod_, geometry::Heading::of(last.as_vector() + rotated.by));
}

std::optional<Rotated> Odometry::step(const cv::Mat& luma, const geometry::Tripod& tripod, const geometry::Heading& last) {
  cv::Mat shrunk;
  if (luma.size() == size_)
    shrunk = luma;
  else
    cv::resize(luma, shrunk, size_, 0, 0, cv::INTER_AREA);
  pyramid_.clear();
  cv::buildOpticalFlowPyramid(shrunk, pyramid_, {kWindow, kWindow}, kLevels, true, cv::BORDER_REFLECT_101, cv::BORDER_CONSTANT,
                              false);
  if (reference_.empty()) {
    refer(tripod, last);
    return std::nullopt;
  }
  const std::vector<Match> matches = track_corners();
  const auto rotated = fit(reference_tripod_, matches);
  standing_.clear();
  for (std::size_t i = 0; rotated && rotated->otherwise && i < matches.size(); ++i) {
    if (matches[i].still) standing_.push_back(now_[i]);
  }
  if (!rotated) {
    refer(tripod, last);
    return std::nullopt;
  }
  ++age_;
  const geometry::Heading& chained = chains_.front();
  const double travelled =
      std::exp(chained.log_focal) / 2 * std::hypot(chained.pan - reference_heading_.pan, chained.tilt - reference_heading_.tilt);
  const bool spent = age_ >= options_.longest || travelled > kMaxTrajectory ||
                     std::abs(chained.log_focal - reference_heading_.log_focal) > kMaxZoom || 2 * corners_.size() < begun_with_ ||
                     rotated->agreeing < 3 * options_.min_corners;
  if (spent) refer(tripod, geometry::Heading::of(last.as_vector() + rotated->by));
  return rotated;
}

}  // namespace marey::calibrate::ptz
