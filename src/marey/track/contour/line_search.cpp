// One line is searched like a signal: the foreground is read along it, a pixel apart and interpolated, into a short array; every
// place where it falls from inside to outside is a candidate, with the sub-pixel place at which it passes one half. The best has
// foreground on all of its inner side and none on its outer side, near to where the outline was predicted.
// A pixel that a neighbour covers says nothing of this target (MacCormick & Blake's exclusion principle, IJCV 39(1), 2000): it is
// omitted on both sides, and a line that has none left at its middle is hidden.
// Cost: 4 reads a pixel of the line.
#include "marey/track/contour/line_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace marey::track::contour {
namespace {

constexpr int kMaxReachPx = 48;      // px
constexpr int kSide = 3;             // px on either side of a candidate that must agree with it
constexpr double kAgreement = 3;     // what full agreement is worth, in log-likelihood
constexpr double kMinStep = 0.5;     // of the foreground's mean from the inner to the outer side
constexpr double kPixelNoise = 0.4;  // px, standard deviation of a clean edge of the mask
constexpr double kFrayed = 1.5;      // px, added for an edge of no agreement

struct Profile {
  int reach = 0;                                 ///< samples at −reach … reach
  std::array<float, 2 * kMaxReachPx + 1> value;  ///< share of foreground, in [0, 1]
  std::array<bool, 2 * kMaxReachPx + 1> known;
};

float interpolated(const cv::Mat& mask, double x, double y) {
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const float fx = static_cast<float>(x - left), fy = static_cast<float>(y - top);
  const std::uint8_t* upper = mask.ptr<std::uint8_t>(top) + left;
  const std::uint8_t* lower = mask.ptr<std::uint8_t>(top + 1) + left;
  const float above = static_cast<float>(upper[0]) + fx * static_cast<float>(upper[1] - upper[0]);
  const float below = static_cast<float>(lower[0]) + fx * static_cast<float>(lower[1] - lower[0]);
  return (above + fy * (below - above)) / 255;
}

void read_profile(const MeasurementLine& line, const LineScene& scene, Profile& profile) {
  const int reach = std::clamp(static_cast<int>(std::ceil(line.reach)), 1, kMaxReachPx);
  profile.reach = reach;
  for (int i = 0; i <= 2 * reach; ++i) {
    const Vector<2> at = line.foot + (i - reach) * line.normal;
    // Written so that what is not a number is outside, too.
    profile.known[i] = at.x() >= 0 && at.y() >= 0 && at.x() < scene.mask.cols - 1 && at.y() < scene.mask.rows - 1;
    profile.value[i] = 0;
    if (!profile.known[i]) continue;
    profile.value[i] = interpolated(scene.mask, at.x(), at.y());
    const int x = static_cast<int>(std::lround(at.x())), y = static_cast<int>(std::lround(at.y()));
    for (const colour::Footprint* other : scene.others) profile.known[i] = profile.known[i] && !other->covers(x, y);
  }
}

/// Mean over up to kSide known samples from `begin` on in steps of `step`; nothing known is a half.
double side(const Profile& profile, int begin, int step) {
  double sum = 0;
  int count = 0;
  for (int k = 0; k < kSide; ++k) {
    const int i = begin + k * step;
    if (i < 0 || i > 2 * profile.reach || !profile.known[i]) break;
    sum += profile.value[i];
    ++count;
  }
  return count > 0 ? sum / count : 0.5;
}

}  // namespace

void search_line(MeasurementLine& line, const LineScene& scene, double deviation) {
  Profile profile;
  read_profile(line, scene, profile);
  line.finding = MeasurementLine::Finding::nothing;
  line.offset = 0;
  line.variance = 1;
  const int middle = profile.reach;
  double best = -std::numeric_limits<double>::infinity();
  int known = 0;
  for (int i = 0; i < 2 * profile.reach; ++i) {
    if (!profile.known[i] || !profile.known[i + 1]) continue;
    ++known;
    const double inner = profile.value[i], outer = profile.value[i + 1];
    if (!(inner >= 0.5 && outer < 0.5)) continue;
    const double step = side(profile, i, -1) - side(profile, i + 1, 1);
    if (step < kMinStep) continue;
    const double offset = i - middle + (inner - 0.5) / (inner - outer);
    const double merit = kAgreement * step - 0.5 * offset * offset / (deviation * deviation + 1);
    if (merit <= best) continue;
    best = merit;
    line.finding = MeasurementLine::Finding::found;
    line.offset = offset;
    const double sigma = kPixelNoise + kFrayed * (1 - std::min(1.0, step));
    line.variance = sigma * sigma;
  }
  if (line.finding == MeasurementLine::Finding::found || 2 * known > profile.reach) return;
  const bool outside =
      !(line.foot.x() >= 0 && line.foot.y() >= 0 && line.foot.x() <= scene.mask.cols - 1 && line.foot.y() <= scene.mask.rows - 1);
  line.finding = outside ? MeasurementLine::Finding::outside : MeasurementLine::Finding::hidden;
}

}  // namespace marey::track::contour
