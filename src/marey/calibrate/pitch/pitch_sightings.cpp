#include "marey/calibrate/pitch/pitch_sightings.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <random>

#include "marey/geometry/decompositions.h"

namespace marey::calibrate::pitch {
namespace {

constexpr double kStep = 0.5;          // px between readings along a normal
constexpr double kBlur = 2;            // px: how much optics and compression widen paint
constexpr double kMinContrast = 3;     // grey levels above the brighter side
constexpr double kPeakSigma = 0.35;    // px: how well a peak's place is known
constexpr double kTolerance = 0.8;     // units: off the smooth curve
constexpr double kFaint = 0.3;         // of the contrast of a line's brighter fifth
constexpr double kMinFraction = 0.25;  // of a line's samples in the image
constexpr int kMinPeaks = 6;
constexpr int kDraws = 300;
constexpr std::size_t kTrail = 12;   // samples that predict where paint continues
constexpr int kMaxGap = 8;           // samples without paint, as where a person stood
constexpr std::size_t kMaxArc = 60;  // samples: a quarter of the centre circle; longer pieces of arcs are not parabola

// Offsets are counted in units of what a camera nearly right may be wrong by: a pixel far away, centimetres of uneven ground near
// by.
constexpr double kUnitPixels = 1, kUnitMetres = 0.03;

/// Where across one sample of a line paint may be.
struct Candidate {
  int sample;
  double along;   // of the piece, in [0, 1]
  double offset;  // units along the normal
  double contrast;
};

struct Sample {
  Vector<2> ground, pixel, normal;
  double width;  // px: the paint's, across

  double unit() const { return std::hypot(kUnitPixels, kUnitMetres * width / geometry::kPitchLineWidth); }  // px
};

/// A sample in the image, or nothing.
std::optional<Sample> sample_at(const GroundView& view, const Vector<2>& ground, const Vector<2>& tangent, double margin) {
  const Camera& camera = *view.camera();
  const Vector<2> slope = view.surface().slope(ground);
  const auto on_ground = [&](const Vector<2>& direction) { return Vector<3>(direction.x(), direction.y(), slope.dot(direction)); };
  const auto detected = camera.project_with_jacobian({ground.x(), ground.y(), view.surface().height(ground)});
  if (!detected) return std::nullopt;
  const Vector<2> inside = Vector<2>(camera.size().width - 1 - margin, camera.size().height - 1 - margin);
  if ((detected->pixel.array() < margin).any() || (detected->pixel.array() > inside.array()).any()) return std::nullopt;
  const Vector<2> along = (detected->by_world * on_ground(tangent)).normalized();
  const Vector<2> normal(-along.y(), along.x());
  const Vector<2> aside(-tangent.y(), tangent.x());
  return Sample{ground, detected->pixel, normal,
                geometry::kPitchLineWidth * std::abs(normal.dot(detected->by_world * on_ground(aside)))};
}

double brightness(const cv::Mat& luma, const Vector<2>& at) {
  const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y()));
  if (x < 0 || y < 0 || x + 1 >= luma.cols || y + 1 >= luma.rows) return 0;
  const double u = at.x() - x, v = at.y() - y;
  const auto* row = luma.ptr<unsigned char>(y) + x;
  const auto* below = luma.ptr<unsigned char>(y + 1) + x;
  return (1 - v) * ((1 - u) * row[0] + u * row[1]) + v * ((1 - u) * below[0] + u * below[1]);
}

/// Brightness along a sample's normal, smoothed by what the paint's own width allows.
class Profile {
 public:
  struct Peak {
    double offset;    // px
    double contrast;  // grey levels above the brighter side
  };

  Profile(const cv::Mat& luma, const Sample& sample, double reach) : width_(sample.width) {
    const double sigma = std::max(0.5, 0.35 * sample.width);  // wide paint has no peak but a plateau until it is smoothed
    const int half = static_cast<int>(std::ceil(3 * sigma / kStep));
    side_ = static_cast<int>(std::lround((1.1 * sample.width + 2) / kStep));  // paint may be twice as wide as it should
    first_ = -reach - (side_ + 1) * kStep;
    const int count = static_cast<int>(std::ceil(-2 * first_ / kStep)) + 1;
    std::vector<double> raw;
    for (int i = -half; i < count + half; ++i) raw.push_back(brightness(luma, sample.pixel + (first_ + i * kStep) * sample.normal));
    std::vector<double> kernel;
    double sum = 0;
    for (int k = -half; k <= half; ++k) sum += kernel.emplace_back(std::exp(-0.5 * std::pow(k * kStep / sigma, 2)));
    for (int i = 0; i < count; ++i) {
      double value = 0;
      for (int k = 0; k <= 2 * half; ++k) value += kernel[k] * raw[i + k];
      values_.push_back(value / sum);
    }
  }

  /// The peaks that may be paint.
  std::vector<Peak> peaks() const {
    std::vector<Peak> result;
    const int count = static_cast<int>(values_.size());
    for (int i = side_; i + side_ < count; ++i) {
      const double here = values_[i], before = values_[i - 1], after = values_[i + 1];
      if (!(here > before && here >= after)) continue;
      const double low = values_[i - side_], high = values_[i + side_];
      const double contrast = here - std::max(low, high);
      if (contrast < kMinContrast) continue;
      if (!as_wide_as_paint(i, (here + (low + high) / 2) / 2)) continue;
      result.push_back({first_ + (i + (before - after) / (2 * (before - 2 * here + after))) * kStep, contrast});
    }
    return result;
  }

 private:
  bool as_wide_as_paint(int peak, double level) const {
    int left = peak, right = peak;
    while (left > 0 && values_[left] > level) --left;
    while (right + 1 < static_cast<int>(values_.size()) && values_[right] > level) ++right;
    const double measured = (right - left - 1) * kStep, expected = std::hypot(width_, kBlur);
    return measured > 0.5 * expected && measured < 2.2 * expected + kStep;
  }

  double width_;
  int side_;      // readings from a peak to the ground beside it
  double first_;  // px
  std::vector<double> values_;
};

/// Offset along a line as a polynomial: a parabola by consensus, then bent further where paint continues beside it.
using Curve = Eigen::VectorXd;
constexpr int kParabola = 2, kBent = 5;
constexpr int kBendings = 4;

Curve fit(const std::vector<Candidate>& all, const std::vector<int>& which, int degree) {
  Eigen::MatrixXd A(which.size(), degree + 1);
  Eigen::VectorXd b(which.size());
  for (std::size_t i = 0; i < which.size(); ++i) {
    const Candidate& one = all[which[i]];
    double power = 1;
    for (int k = 0; k <= degree; ++k, power *= 2 * one.along - 1) A(static_cast<Eigen::Index>(i), k) = power;
    b(static_cast<Eigen::Index>(i)) = one.offset;
  }
  return geometry::least_squares(A, b);
}

double at(const Curve& curve, double along) {
  double value = 0;
  for (Eigen::Index k = curve.size() - 1; k >= 0; --k) value = value * (2 * along - 1) + curve(k);
  return value;
}

/// The candidates on the smooth curve that most samples agree with; at most one a sample.
std::vector<int> on_one_curve(const std::vector<Candidate>& all, std::size_t samples, double reach) {
  const auto near = [&](const Curve& curve) {
    std::vector<int> hits;
    for (int i = 0; i < static_cast<int>(all.size()); ++i) {
      const double off = std::abs(at(curve, all[i].along) - all[i].offset);
      if (off >= kTolerance) continue;
      if (!hits.empty() && all[hits.back()].sample == all[i].sample) {
        if (off < std::abs(at(curve, all[hits.back()].along) - all[hits.back()].offset)) hits.back() = i;
        continue;
      }
      hits.push_back(i);
    }
    return hits;
  };
  std::mt19937 random(1);
  std::vector<int> best;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<int> three;
    for (int i = 0; i < 3; ++i) three.push_back(static_cast<int>(random() % static_cast<unsigned>(all.size())));
    std::sort(three.begin(), three.end(), [&](int a, int b) { return all[a].along < all[b].along; });
    // Three that stand close together say nothing of the whole line.
    const double span = all[three[2]].along - all[three[0]].along;
    if (span < 0.3 || all[three[1]].along - all[three[0]].along < 0.05 || all[three[2]].along - all[three[1]].along < 0.05)
      continue;
    const Curve curve = fit(all, three, kParabola);
    if (std::max({std::abs(at(curve, 0)), std::abs(at(curve, 0.5)), std::abs(at(curve, 1))}) > reach) continue;
    auto hits = near(curve);
    if (hits.size() > best.size()) best = std::move(hits);
  }
  for (int round = 0; round < kBendings && best.size() > 2 * kBent; ++round)
    best = near(fit(all, best, round == 0 ? kParabola : kBent));
  if (best.size() < std::max<std::size_t>(kMinPeaks, static_cast<std::size_t>(kMinFraction * static_cast<double>(samples))))
    return {};
  return best;
}

/// Walks on from known sightings, `step` +1 or -1 along the candidates (which are in the order of their samples): paint continues
/// where the last of it points to, even where no polynomial follows.
void walk_on(const std::vector<Candidate>& all, std::vector<int>& found, int step) {
  std::vector<char> taken(all.size(), 0);
  for (const int i : found) taken[i] = 1;
  std::deque<int> last;
  const int count = static_cast<int>(all.size());
  for (int i = step > 0 ? 0 : count - 1; i >= 0 && i < count; i += step) {
    if (!taken[i]) {
      if (last.size() < kTrail || all[last.back()].sample == all[i].sample) continue;
      if (std::abs(all[last.back()].sample - all[i].sample) > kMaxGap) continue;
      const Curve ahead = fit(all, {last.begin(), last.end()}, 1);
      if (std::abs(at(ahead, all[i].along) - all[i].offset) >= kTolerance) continue;
      taken[i] = 1;
      found.push_back(i);
    }
    last.push_back(i);
    if (last.size() > kTrail) last.pop_front();
  }
  std::sort(found.begin(), found.end());
}

/// A line is about as bright all along: what is much fainter than most of it is grass.
void drop_faint(std::vector<Candidate>& candidates) {
  if (candidates.empty()) return;
  std::vector<double> contrasts;
  for (const Candidate& one : candidates) contrasts.push_back(one.contrast);
  const auto bright = contrasts.begin() + static_cast<std::ptrdiff_t>(contrasts.size() * 4 / 5);
  std::nth_element(contrasts.begin(), bright, contrasts.end());
  const double minimum = kFaint * *bright;
  std::erase_if(candidates, [&](const Candidate& one) { return one.contrast < minimum; });
}

/// One piece of a line: samples that follow one another.
void find_piece(const cv::Mat& luma, const std::vector<Sample>& samples, int line, double reach, std::vector<LineSighting>& found) {
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (const auto& [offset, contrast] : Profile(luma, samples[i], reach * samples[i].unit()).peaks())
      candidates.push_back({static_cast<int>(i), static_cast<double>(i) / static_cast<double>(samples.size()),
                            offset / samples[i].unit(), contrast});
  }
  drop_faint(candidates);
  if (candidates.size() < static_cast<std::size_t>(kMinPeaks)) return;
  std::vector<int> paint = on_one_curve(candidates, samples.size(), reach);
  for (const int step : {1, -1}) walk_on(candidates, paint, step);
  for (const int which : paint) {
    const Sample& sample = samples[candidates[which].sample];
    found.push_back({sample.ground, sample.pixel + candidates[which].offset * sample.unit() * sample.normal, sample.normal,
                     sample.width / geometry::kPitchLineWidth, kPeakSigma, line});
  }
}

}  // namespace

std::vector<LineSighting> find_lines(const cv::Mat& luma, const GroundView& view, const std::vector<geometry::PitchLine>& lines,
                                     double reach) {
  std::vector<LineSighting> found;
  for (std::size_t number = 0; number < lines.size(); ++number) {
    const geometry::PitchLine& line = lines[number];
    const bool is_arc = line.tangents.front().dot(line.tangents.back()) < 1 - 1e-9;
    std::vector<Sample> samples;
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      if (const auto sample = sample_at(view, line.points[i], line.tangents[i], reach + 8)) samples.push_back(*sample);
      if (is_arc && samples.size() >= kMaxArc) {
        find_piece(luma, samples, static_cast<int>(number), reach, found);
        samples.clear();
      }
    }
    find_piece(luma, samples, static_cast<int>(number), reach, found);
  }
  return found;
}

}  // namespace marey::calibrate::pitch
