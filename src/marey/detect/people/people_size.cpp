// How tall people are at each place of the image, learned from the regions that move in it. On flat ground, seen through
// a camera without distortion, an upright person's height in pixels is a linear function of where the feet are: h = a + b·y +
// c·x. A small term in x² takes up what a wide lens bends. Width follows height by one ratio.
//
// Most regions are not clean single person: fragments are too small, groups too large, shadows lengthen. They do not agree
// with one another, people do: the plane that most regions agree with (within a fifth of the height) is found from triples of
// regions, then refined by weighted least squares with Tukey's weights. Slopes are pulled towards zero with the weight of a
// few regions, so that three people on a line do not tilt the world. The memory is spread over the image: a busy path, or a
// person who stands for minutes, does not outvote the rest.
// Cost: a fit reads at most 64 cells × 12 boxes some 400 times, about a millisecond.
// References: Fischler & Bolles, RANSAC, CACM 24(6), 1981; Hoiem, Efros, Hebert, "Putting objects in perspective", CVPR 2006.
#include "marey/detect/people/people_size.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Dense>

#include "marey/geometry/median.h"

namespace marey::detect::people {
namespace {

constexpr int kSizeCellsAcross = 8;
constexpr std::size_t kBoxesInCell = 12;
constexpr double kMinHeightPx = 12;              // px; below this a body has no shape
constexpr double kFlattest = 1.2, kTallest = 5;  // height over width of what may be one upright person
constexpr double kAgreement = 0.2;               // of the height
constexpr double kTukey = 0.3;                   // of the height; a region further off has no say
constexpr double kTooTall = 2.2;     // of kAgreement: 1.8 times as tall as a person; groups in which one hides another are less
constexpr double kTooTallCut = 1.5;  // the same of what the border cuts off: 1.4 times
constexpr double kAgainst = 1;       // what that weighs, where one who agrees weighs 1
constexpr double kNeeded = 6;        // weight of agreeing regions without which nothing is said
constexpr double kHorizon = 0.6;     // of the smallest height seen: no person is smaller
constexpr int kTrials = 400;

/// Small, fast, the same everywhere; quality does not matter here.
class Draw {
 public:
  std::size_t below(std::size_t count) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::size_t>((state_ >> 33) % count);
  }

 private:
  std::uint64_t state_ = 20;
};

}  // namespace

void PersonSizeModel::observe_frame(const Box& region, cv::Size image) {
  remember(region, image, false);
}

void PersonSizeModel::observe_cut(const Box& region, cv::Size image) {
  remember(region, image, true);
}

void PersonSizeModel::remember(const Box& region, cv::Size image, bool cut) {
  const double tall = region.height / std::max(region.width, 1.0);
  if (region.height < kMinHeightPx || tall < kFlattest || tall > kTallest) return;
  if (image_ != image) {
    *this = {};
    image_ = image;
    cells_.resize(kSizeCellsAcross * kSizeCellsAcross);
    next_.resize(cells_.size(), 0);
  }
  const auto foot = region.foot();
  const int column = std::clamp(static_cast<int>(foot.x() * kSizeCellsAcross / image.width), 0, kSizeCellsAcross - 1);
  const int row = std::clamp(static_cast<int>(foot.y() * kSizeCellsAcross / image.height), 0, kSizeCellsAcross - 1);
  const std::size_t cell = static_cast<std::size_t>(row) * kSizeCellsAcross + column;
  std::vector<Remembered>& boxes = cells_[cell];
  for (const Remembered& known : boxes) {
    if (geometry::iou(known.box, region) > 0.7) return;  // a person who stands says nothing new
  }
  if (boxes.size() < kBoxesInCell) {
    boxes.push_back({region, cut});
  } else {
    boxes[next_[cell]++ % kBoxesInCell] = {region, cut};
  }
  ++fresh_;
  tallest_observed_ = std::max(tallest_observed_, region.height);
}

PersonSizeModel::Features PersonSizeModel::features_of(double x, double y) const {
  const double u = x / image_.width - 0.5;
  const double v = y / image_.width - 0.5 * image_.height / image_.width;
  return {1, v, u, u * u};
}

std::vector<PersonSizeModel::Sample> PersonSizeModel::weighted_samples() const {
  std::vector<Sample> samples;
  for (const std::vector<Remembered>& boxes : cells_) {
    const double weight = 1 / std::sqrt(std::max<double>(1, static_cast<double>(boxes.size()) / 2));
    for (const auto& [box, cut] : boxes) {
      const auto foot = box.foot();
      samples.push_back({features_of(foot.x(), foot.y()), box.height, box.width / box.height, weight, cut});
    }
  }
  return samples;
}

/// What agrees with these heights, less what speaks against them: no person is taller than a person, but much is smaller.
double PersonSizeModel::support_of(const Features& guess, const std::vector<Sample>& samples) {
  double support = 0;
  for (const Sample& sample : samples) {
    const double off = (sample.height - guess.dot(sample.features)) / (kAgreement * sample.height);
    if (off * off < 1 && !sample.cut) support += sample.weight * (1 - off * off);
    if (off > (sample.cut ? kTooTallCut : kTooTall)) support -= kAgainst * sample.weight;
  }
  return support;
}

std::optional<PersonSizeModel::Features> PersonSizeModel::consensus(const std::vector<Sample>& samples) const {
  Draw draw;
  std::optional<Features> best;
  double best_support = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Sample& a = samples[draw.below(samples.size())];
    const Sample& b = samples[draw.below(samples.size())];
    const Sample& c = samples[draw.below(samples.size())];
    if (a.cut || b.cut || c.cut) continue;
    Features guess(a.height, 0, 0, 0);
    if (trial % 4 != 0) {  // every fourth guess is a flat scene, for which one region is enough
      Eigen::Matrix3d M;
      M << a.features.head<3>().transpose(), b.features.head<3>().transpose(), c.features.head<3>().transpose();
      if (std::abs(M.determinant()) < 1e-4) continue;
      guess.head<3>() = M.inverse() * Eigen::Vector3d(a.height, b.height, c.height);
    }
    const double support = support_of(guess, samples);
    if (support > best_support) {
      best_support = support;
      best = guess;
    }
  }
  return best;
}

PersonSizeModel::Features PersonSizeModel::refined(Features start, const std::vector<Sample>& samples) const {
  Features solution = start;
  for (int round = 0; round < 6; ++round) {
    // Ridge: slopes of one height per image width have the say of the weights below, in regions.
    Eigen::Matrix4d A = Features(0, 0.02, 0.02, 0.5).asDiagonal();
    Features b = Features::Zero();
    for (const Sample& sample : samples) {
      const double expected = solution.dot(sample.features);
      if (sample.cut || expected < kMinHeightPx / 2) continue;
      const double off = (sample.height - expected) / (kTukey * expected);
      if (off * off >= 1) continue;
      const double pull = sample.weight * (1 - off * off) * (1 - off * off);
      A += pull * sample.features * sample.features.transpose();
      b += pull * sample.height * sample.features;
    }
    if (A(0, 0) <= 0) return start;
    solution = A.ldlt().solve(b);
  }
  return solution;
}

void PersonSizeModel::take_over(const Features& solution, const std::vector<Sample>& samples) {
  std::vector<geometry::WeightedValue> aspects, offs;
  double support = 0;
  smallest_ = largest_ = 0;
  for (const Sample& sample : samples) {
    const double expected = solution.dot(sample.features);
    const double off = sample.height / std::max(expected, 1.0) - 1;
    if (sample.cut || expected < kMinHeightPx / 2 || std::abs(off) > kAgreement) continue;
    aspects.push_back({sample.aspect, sample.weight});
    offs.push_back({std::abs(off), sample.weight});
    support += sample.weight;
    smallest_ = smallest_ == 0 ? expected : std::min(smallest_, expected);
    largest_ = std::max(largest_, expected);
  }
  if (support < kNeeded || support_of(solution, samples) <= 0) return;
  coefficients_ = solution;
  aspect_ = geometry::weighted_median(aspects).value_or(0);
  spread_ = std::max(0.04, 1.4826 * geometry::weighted_median(offs).value_or(0));
}

void PersonSizeModel::fit() {
  const std::vector<Sample> samples = weighted_samples();
  fresh_ = 0;
  fitted_from_ = samples.size();
  if (samples.empty()) return;
  if (const auto found = consensus(samples)) take_over(refined(*found, samples), samples);
}

std::optional<PersonSize> PersonSizeModel::at(double x, double y) const {
  if (!coefficients_) return std::nullopt;
  const double height = std::min(coefficients_->dot(features_of(x, y)), largest_ * 2);
  if (height < smallest_ * kHorizon) return std::nullopt;
  return PersonSize{height, aspect_ * height};
}

}  // namespace marey::detect::people
