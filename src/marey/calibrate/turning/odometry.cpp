#include "marey/calibrate/turning/odometry.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "marey/calibrate/turning/aim.h"
#include "marey/geometry/median.h"

namespace marey::calibrate::turning {
namespace {

constexpr int kWindow = 15, kLevels = 3;
constexpr double kFarthest = 110;      // m: what is seen above the ground stands so far away
constexpr double kStillPixels = 0.35;  // shrunk px: what moved less on the picture stands still
constexpr double kMovingShare = 0.35;  // of those that stand: so many that move together are the scene
constexpr double kLongestWay = 0.3;    // of the picture's width: then there is a new reference
constexpr double kMostZoom = 0.1;

/// What a pixel shows: the ground, or something far away.
Vector<3> shown(const geometry::TripodFrame<double>& frame, const Vector<2>& seen) {
  const Vector<2> straight = seen / (1 + frame.bend * seen.squaredNorm());
  const Vector<3> ray = frame.focal * frame.ahead + straight.x() * frame.right + straight.y() * frame.down;
  const double far = ray.z() < -1e-9 ? -frame.centre.z() / ray.z() * ray.norm() : kFarthest;
  return frame.centre + std::min(kFarthest, far) * ray.normalized();
}

}  // namespace

Odometry::Odometry(cv::Size size, const OdometryOptions& options) : options_(options) {
  const double factor = std::min(1.0, static_cast<double>(options.width) / size.width);
  size_ = {cvRound(size.width * factor), cvRound(size.height * factor)};
}

void Odometry::refer(const geometry::Tripod& tripod, const geometry::Heading& heading) {
  reference_ = pyramid_;
  reference_tripod_ = tripod;
  reference_heading_ = chained_ = heading;
  age_ = 0;
  corners_.clear();
  places_.clear();
  cv::goodFeaturesToTrack(reference_[0], corners_, options_.corners, 0.01, 8);
  const auto numbers = tripod.as_numbers();
  const Vector<3> turned = heading.as_vector();
  const geometry::TripodFrame<double> frame(numbers.data(), turned.data());
  for (const cv::Point2f& corner : corners_) places_.push_back(shown(frame, geometry::from_pixel({corner.x, corner.y}, size_)));
  now_ = corners_;
  begun_with_ = corners_.size();
}

/// The corners in the new picture; those that cannot be followed are let go.
std::vector<Odometry::Match> Odometry::follow() {
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
    matches.push_back({places_[i], geometry::from_pixel({at.x, at.y}, size_), still});
    corners_[kept] = corners_[i], now_[kept] = at, places_[kept] = places_[i];
    ++kept;
  }
  corners_.resize(kept), now_.resize(kept), places_.resize(kept);
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
  // The middle of all ways brings most of them near.
  std::vector<double> across, down;
  {
    const geometry::TripodFrame<double> frame(numbers.data(), result.heading.data());
    for (const auto& match : matches) {
      const Vector<2> off = match.seen - frame.seen(match.place);
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
      const Vector<2> off = px * (frame.seen(match.place) - match.seen);
      const auto by = pixel_by_heading(tripod, geometry::Heading::of(result.heading), size, match.place);
      const double robust = 1 / std::pow(1 + off.squaredNorm() / (reach * reach), 2);
      information += robust * by.transpose() * by;
      slope += robust * by.transpose() * off;
    }
    result.heading -= information.ldlt().solve(slope);
  }
  const geometry::TripodFrame<double> frame(numbers.data(), result.heading.data());
  for (const auto& match : matches) result.agreeing += px * (frame.seen(match.place) - match.seen).norm() < agree_px ? 1 : 0;
  return result;
}

}  // namespace

std::optional<Turned> Odometry::fit(const geometry::Tripod& tripod, const std::vector<Match>& matches,
                                    const geometry::Heading& start) const {
  if (std::ssize(matches) < options_.fewest) return std::nullopt;
  const int followed = static_cast<int>(matches.size());
  std::vector<Match> moving;
  for (const Match& match : matches) {
    if (!match.still) moving.push_back(match);
  }
  OdometryFit best = fit_heading(tripod, matches, start, size_, options_.agree_px);
  if (std::ssize(moving) >= options_.fewest && moving.size() < matches.size()) {
    const OdometryFit other = fit_heading(tripod, moving, start, size_, options_.agree_px);
    const auto still = static_cast<double>(matches.size() - moving.size());
    if (other.agreeing >= options_.fewest && other.agreeing >= 0.6 * static_cast<double>(moving.size()) &&
        other.agreeing > kMovingShare * still)
      best = other;
  }
  if (best.agreeing < options_.fewest || best.agreeing < options_.share * followed) return std::nullopt;
  Turned turned;
  turned.by = best.heading - chained_.as_vector();
  turned.log_focal = reference_heading_.log_focal;
  turned.agreeing = best.agreeing, turned.followed = followed;
  return turned;
}

std::optional<Turned> Odometry::step(const cv::Mat& luma, const geometry::Tripod& tripod, const geometry::Heading& last) {
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
  const auto turned = fit(reference_tripod_, follow(), chained_);
  if (!turned) {
    refer(tripod, last);
    return std::nullopt;
  }
  chained_ = geometry::Heading::of(chained_.as_vector() + turned->by);
  ++age_;
  const double way =
      std::exp(chained_.log_focal) / 2 * std::hypot(chained_.pan - reference_heading_.pan, chained_.tilt - reference_heading_.tilt);
  const bool spent = age_ >= options_.longest || way > kLongestWay ||
                     std::abs(chained_.log_focal - reference_heading_.log_focal) > kMostZoom || 2 * corners_.size() < begun_with_ ||
                     turned->agreeing < 3 * options_.fewest;
  if (spent) refer(tripod, geometry::Heading::of(last.as_vector() + turned->by));
  return turned;
}

}  // namespace marey::calibrate::turning
