#include "marey/edit/lowpass.h"

#include <algorithm>
#include <cmath>

#include "marey/geometry/butterworth.h"
#include "marey/geometry/vector.h"

namespace marey::edit {
namespace {

double rms_difference(std::span<const Vector<3>> a, std::span<const Vector<3>> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

}  // namespace

void lowpass(std::span<Vector<3>> path, double rate_hz, double cutoff_hz) {
  const double cutoff = geometry::cutoff_of_one_pass(cutoff_hz) / rate_hz;
  if (path.size() < 4 || !(cutoff > 0 && cutoff < 0.5)) return;
  const auto settles = static_cast<std::size_t>(std::ceil(3 / cutoff));
  geometry::low_pass(path, cutoff, std::max<std::size_t>(9, settles));
}

double highest_cutoff(double rate_hz) {
  return 0.5 * rate_hz / geometry::cutoff_of_one_pass(1);
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

double rate_between(std::span<const Recording::TimeStep> time_steps, std::int32_t first, std::int32_t last) {
  if (first == last) return 1;
  const auto &a = time_steps[static_cast<std::size_t>(first)], &b = time_steps[static_cast<std::size_t>(last)];
  return (last - first) / seconds(b.time - a.time);
}

}  // namespace marey::edit
