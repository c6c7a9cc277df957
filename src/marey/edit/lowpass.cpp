#include "marey/edit/lowpass.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "marey/geometry/vector.h"

namespace marey::edit {
namespace {

/// y[i] = b0 x[i] + b1 x[i − 1] + b2 x[i − 2] − a1 y[i − 1] − a2 y[i − 2]
struct Biquad {
  double b0, b1, b2, a1, a2;
};

/// By the bilinear transform; `cutoff` of one pass, as a share of the rate.
Biquad butterworth(double cutoff) {
  const double k = std::tan(std::numbers::pi * cutoff), root = std::numbers::sqrt2 * k, scale = 1 / (1 + root + k * k);
  return {k * k * scale, 2 * k * k * scale, k * k * scale, 2 * (k * k - 1) * scale, (1 - root + k * k) * scale};
}

/// Begins as if the first place had been there for ever.
void pass(const Biquad& f, std::span<Vector<3>> path) {
  Vector<3> x1 = path.front(), x2 = x1, y1 = x1, y2 = x1;
  for (Vector<3>& place : path) {
    const Vector<3> x = place;
    place = f.b0 * x + f.b1 * x1 + f.b2 * x2 - f.a1 * y1 - f.a2 * y2;
    x2 = x1;
    x1 = x;
    y2 = y1;
    y1 = place;
  }
}

/// With the path turned about its ends before and after, so that it goes on as it came.
std::vector<Vector<3>> padded(std::span<const Vector<3>> path, std::size_t margin) {
  std::vector<Vector<3>> longer;
  longer.reserve(path.size() + 2 * margin);
  for (std::size_t i = margin; i > 0; --i) longer.push_back(2 * path.front() - path[i]);
  longer.insert(longer.end(), path.begin(), path.end());
  for (std::size_t i = 1; i <= margin; ++i) longer.push_back(2 * path.back() - path[path.size() - 1 - i]);
  return longer;
}

double rms_difference(std::span<const Vector<3>> a, std::span<const Vector<3>> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

}  // namespace

void lowpass(std::span<Vector<3>> path, double rate_hz, double cutoff_hz) {
  constexpr double kTwoPasses = 0.802;  // (√2 − 1)^¼: what one pass lets through at the cut-off of both
  const double cutoff = cutoff_hz / kTwoPasses / rate_hz;
  if (path.size() < 4 || !(cutoff > 0 && cutoff < 0.5)) return;
  const auto settles = static_cast<std::size_t>(std::ceil(3 / cutoff));
  const std::size_t margin = std::min(path.size() - 1, std::max<std::size_t>(9, settles));
  std::vector<Vector<3>> work = padded(path, margin);
  const Biquad filter = butterworth(cutoff);
  pass(filter, work);
  std::reverse(work.begin(), work.end());
  pass(filter, work);
  std::reverse(work.begin(), work.end());
  std::copy_n(work.begin() + static_cast<std::ptrdiff_t>(margin), path.size(), path.begin());
}

std::optional<double> proposed_cutoff(std::span<const Vector<3>> path, double rate_hz) {
  if (static_cast<double>(path.size()) < rate_hz || path.size() < 16) return std::nullopt;
  // Residuals over the cut-off fall on a straight line where only noise is taken away; Winter extends it to 0 Hz.
  std::vector<double> cutoffs, residuals;
  for (double cutoff = 1; cutoff < 0.4 * rate_hz && cutoff <= 30; cutoff += 0.5) {
    std::vector<Vector<3>> smooth(path.begin(), path.end());
    lowpass(smooth, rate_hz, cutoff);
    cutoffs.push_back(cutoff);
    residuals.push_back(rms_difference(path, smooth));
  }
  const std::size_t count = cutoffs.size(), from = count - count / 3;
  if (count < 6) return std::nullopt;
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = from; i < count; ++i) {
    ++n;
    sx += cutoffs[i];
    sy += residuals[i];
    sxx += cutoffs[i] * cutoffs[i];
    sxy += cutoffs[i] * residuals[i];
  }
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx), at_zero = (sy - slope * sx) / n;
  for (std::size_t i = 0; i < count; ++i) {
    if (residuals[i] <= at_zero) return cutoffs[i];
  }
  return cutoffs.back();
}

double rate_between(std::span<const Recording::Moment> moments, std::int32_t first, std::int32_t last) {
  if (first == last) return 1;
  const auto &a = moments[static_cast<std::size_t>(first)], &b = moments[static_cast<std::size_t>(last)];
  return (last - first) / seconds(b.time - a.time);
}

}  // namespace marey::edit
