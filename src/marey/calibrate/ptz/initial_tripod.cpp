#include "marey/calibrate/ptz/initial_tripod.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace marey::calibrate::ptz {
namespace {

constexpr double kCutOff = 0.1;                                  // half image widths: a click that lies farther off costs no more
constexpr double kAround = 70;                                   // m round the pitch
constexpr double kGrid = 6;                                      // m
constexpr std::array<double, 6> kHeights{4, 7, 11, 16, 23, 32};  // m
constexpr double kApart = 15;                                    // m between guesses

/// Clicks of one frame in half image widths.
struct FrameClicks {
  std::vector<Vector<3>> locations;
  std::vector<Vector<2>> detected;
  std::size_t first = 0, last = 0;  // the two that are farthest apart
};

FrameClicks clicks_of(const ClickedFrame& frame, cv::Size size) {
  FrameClicks clicks;
  for (const ClickedPosition& one : frame.locations) {
    clicks.locations.emplace_back(one.ground.x(), one.ground.y(), 0);
    clicks.detected.push_back(geometry::from_pixel(one.pixel, size));
  }
  double maximum = -1;
  for (std::size_t i = 0; i < clicks.detected.size(); ++i) {
    for (std::size_t k = i + 1; k < clicks.detected.size(); ++k) {
      const double apart = (clicks.detected[i] - clicks.detected[k]).norm();
      if (apart > maximum) maximum = apart, clicks.first = i, clicks.last = k;
    }
  }
  return clicks;
}

/// The heading of an upright tripod from two clicks.
std::optional<geometry::Heading> two_point(const geometry::Tripod& tripod, const FrameClicks& clicks) {
  const Vector<3> a = (clicks.locations[clicks.first] - tripod.location).normalized(),
                  b = (clicks.locations[clicks.last] - tripod.location).normalized();
  const Vector<2>&u = clicks.detected[clicks.first], &v = clicks.detected[clicks.last];
  // f such that the angle between the rays (u, f) and (v, f) is that between a and b.
  const double cosine = a.dot(b);
  double low = std::log(0.3), high = std::log(30.0);
  const auto angle_cosine = [&](double f) {
    return (u.dot(v) + f * f) / std::sqrt((u.squaredNorm() + f * f) * (v.squaredNorm() + f * f));
  };
  if (angle_cosine(std::exp(high)) < cosine || angle_cosine(std::exp(low)) > cosine) return std::nullopt;
  for (int i = 0; i < 30; ++i) {
    const double middle = (low + high) / 2;
    (angle_cosine(std::exp(middle)) < cosine ? low : high) = middle;
  }
  geometry::Heading heading;
  heading.log_focal = (low + high) / 2;
  const double f = std::exp(heading.log_focal);
  // Start at the two clicks' middle, then by the remaining error.
  const Vector<3> middle = (a + b).normalized();
  heading.pan = std::atan2(middle.x(), middle.y());
  heading.tilt = std::asin(std::clamp(-middle.z(), -1.0, 1.0));
  for (int i = 0; i < 6; ++i) {
    const auto numbers = tripod.as_numbers();
    const Vector<3> rotated = heading.as_vector();
    const geometry::TripodFrame<double> frame(numbers.data(), rotated.data());
    if (frame.depth(clicks.locations[clicks.first]) < 1 || frame.depth(clicks.locations[clicks.last]) < 1) return std::nullopt;
    const Vector<2> off =
        ((frame.detected(clicks.locations[clicks.first]) - u) + (frame.detected(clicks.locations[clicks.last]) - v)) / 2;
    heading.pan += off.x() / f / std::max(0.2, std::cos(heading.tilt));
    heading.tilt += off.y() / f;
  }
  return heading;
}

std::optional<TripodGuess> guess_at(const Vector<3>& location, std::span<const FrameClicks> frames) {
  TripodGuess guess;
  guess.tripod.location = location;
  const auto numbers = guess.tripod.as_numbers();
  double count = 0;
  for (const FrameClicks& clicks : frames) {
    const auto heading = two_point(guess.tripod, clicks);
    if (!heading || heading->tilt < -0.3) return std::nullopt;
    guess.headings.push_back(*heading);
    const Vector<3> rotated = heading->as_vector();
    const geometry::TripodFrame<double> frame(numbers.data(), rotated.data());
    for (std::size_t i = 0; i < clicks.locations.size(); ++i, ++count)
      guess.cost += frame.depth(clicks.locations[i]) < 1
                        ? kCutOff
                        : std::min(kCutOff, (frame.detected(clicks.locations[i]) - clicks.detected[i]).norm());
  }
  guess.cost /= std::max(1.0, count);
  return guess;
}

}  // namespace

std::vector<TripodGuess> tripod_starts(std::span<const ClickedFrame> frames, cv::Size size, const geometry::PitchSize& pitch,
                                       std::size_t count) {
  std::vector<FrameClicks> clicks;
  for (const ClickedFrame& frame : frames) clicks.push_back(clicks_of(frame, size));
  std::vector<TripodGuess> all;
  for (double x = -kAround; x <= pitch.length + kAround; x += kGrid) {
    for (double y = -kAround; y <= pitch.width + kAround; y += kGrid) {
      for (const double z : kHeights) {
        if (auto guess = guess_at({x, y, z}, clicks)) all.push_back(std::move(*guess));
      }
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const TripodGuess& a, const TripodGuess& b) { return a.cost < b.cost; });
  std::vector<TripodGuess> best;
  for (TripodGuess& guess : all) {
    const bool apart = std::all_of(best.begin(), best.end(), [&](const TripodGuess& other) {
      return (other.tripod.location - guess.tripod.location).norm() > kApart;
    });
    if (apart) best.push_back(std::move(guess));
    if (best.size() == count) break;
  }
  for (TripodGuess& guess : best) guess.cost *= size.width / 2.0;
  return best;
}

}  // namespace marey::calibrate::ptz
