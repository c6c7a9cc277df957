// Colours are histograms of luma and chroma, one for each of six bands from head to foot: a shirt, its number, arms and shorts are
// several colours at once, which one Gaussian cannot model. A sample is shared among the bins about it.
#include "marey/track/contour/colour/body_model.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace marey::track::contour::colour {
namespace {

constexpr double kTopOfBands = -0.5, kBottom = 0.5;     // heights
constexpr double kHalfAcross = 0.48, kHalfDown = 0.72;  // heights that the coverage spans to either side
constexpr float kMixedRim = 1.6F,
                kMixedWeight = 0.15F;  // cells below the edge where colours mix with the ground's; weight there; unswept
constexpr double kMinCells = 3;        // of a band; numerical

/// Where a value lies among bins: the first of two neighbours, and the second one's share.
struct BinPosition {
  int first = 0;
  float part = 0;
};
BinPosition bin_position(double at, int count) {
  const double clamped = std::clamp(at, 0.0, count - 1.0);
  const int first = std::min(static_cast<int>(clamped), count - 2);
  return {first, static_cast<float>(clamped - first)};
}

template <int Luma, int Chroma, typename Visit>
void for_bins(const cv::Vec3f& colour, double luma_bin, double chroma_bin, const Visit& visit) {
  const BinPosition y = bin_position(colour[0] / luma_bin - 0.5, Luma);
  const BinPosition cb = bin_position((colour[1] - 128) / chroma_bin + (Chroma - 1) / 2.0, Chroma);
  const BinPosition cr = bin_position((colour[2] - 128) / chroma_bin + (Chroma - 1) / 2.0, Chroma);
  for (int i = 0; i < 8; ++i) {
    const int a = i & 1, b = (i >> 1) & 1, c = i >> 2;
    const float weight = (a != 0 ? y.part : 1 - y.part) * (b != 0 ? cb.part : 1 - cb.part) * (c != 0 ? cr.part : 1 - cr.part);
    visit(((y.first + a) * Chroma + cb.first + b) * Chroma + cr.first + c, weight);
  }
}

int band_of(double down, int bands) {
  const double part = (down - kTopOfBands) / (kBottom - kTopOfBands);
  return std::clamp(static_cast<int>(std::floor(part * bands)), 0, bands - 1);
}

/// A person who stands: head, trunk, legs.
double standing(const Vector<2>& location) {
  const auto within = [&](double x, double y, double half_width, double half_height) {
    return std::pow((location.x() - x) / half_width, 2) + std::pow((location.y() - y) / half_height, 2) < 1;
  };
  const bool body = within(0, -0.38, 0.07, 0.09) || within(0, -0.12, 0.14, 0.22) || within(0, 0.25, 0.13, 0.27);
  return body ? 0.8 : 0.06;
}

}  // namespace

BodyModel::BodyModel() {
  for (int row = 0; row < kDown; ++row) {
    for (int column = 0; column < kAcross; ++column) {
      const Vector<2> location(kHalfAcross * (2 * (column + 0.5) / kAcross - 1), kHalfDown * (2 * (row + 0.5) / kDown - 1));
      coverage_[row * kAcross + column] = static_cast<float>(standing(location));
    }
  }
}

void BodyModel::learn_colours(const ColourPatch& patch, const cv::Mat& fraction, const Vector<2>& centre, double height,
                              double rate) {
  std::vector<Histogram> now(kBands);
  std::array<double, kBands> weight{};
  for (Histogram& one : now) one.fill(0);
  cv::Mat depth;
  cv::distanceTransform(fraction > 0.5F, depth, cv::DIST_L2, 3);
  for (int y = 0; y < fraction.rows; ++y) {
    const int band = band_of((patch.pixel({0, y}).y() - centre.y()) / height, kBands);
    for (int x = 0; x < fraction.cols; ++x) {
      const float covered = fraction.at<float>(y, x);
      if (covered < 0.7F) continue;
      const float own = depth.at<float>(y, x) > kMixedRim ? 1 : kMixedWeight;
      for_bins<kLuma, kChroma>(patch.colour.at<cv::Vec3f>(y, x), kLumaBin, kChromaBin,
                               [&](int bin, float part) { now[band][bin] += own * part; });
      weight[band] += own;
    }
  }
  if (colours_.empty()) {
    colours_.resize(kBands);
    for (Histogram& one : colours_) one.fill(0);
  }
  for (int band = 0; band < kBands; ++band) {
    if (weight[band] < kMinCells) continue;
    const auto old = static_cast<float>(known_ ? 1 - rate : 0), fresh = static_cast<float>((known_ ? rate : 1) / weight[band]);
    for (std::size_t bin = 0; bin < now[band].size(); ++bin)
      colours_[band][bin] = old * colours_[band][bin] + fresh * now[band][bin];
  }
  known_ = true;
}

void BodyModel::learn_coverage(const ColourPatch& patch, const cv::Mat& fraction, const Vector<2>& centre, double height,
                               double rate) {
  for (int row = 0; row < kDown; ++row) {
    for (int column = 0; column < kAcross; ++column) {
      const Vector<2> location(kHalfAcross * (2 * (column + 0.5) / kAcross - 1), kHalfDown * (2 * (row + 0.5) / kDown - 1));
      const Vector<2> cell = patch.cell(centre + height * location);
      const int x = static_cast<int>(std::lround(cell.x())), y = static_cast<int>(std::lround(cell.y()));
      if (x < 0 || y < 0 || x >= fraction.cols || y >= fraction.rows) continue;
      float& known = coverage_[row * kAcross + column];
      known += static_cast<float>(rate) * (fraction.at<float>(y, x) - known);
    }
  }
}

BodyModel::Bands BodyModel::bands_at(double down) const {
  if (!known_) return {};
  // Two bands are mixed, so that a seam between shirt and shorts may lie a little higher or lower.
  const double band = std::clamp((down - kTopOfBands) / (kBottom - kTopOfBands) * kBands - 0.5, 0.0, kBands - 1.0);
  const int upper = std::min(static_cast<int>(band), kBands - 2);
  return {colours_[upper].data(), colours_[upper + 1].data(), static_cast<float>(band - upper)};
}

int BodyModel::bin_of(const cv::Vec3f& colour) {
  // Samples were shared among neighbouring bins as they were learned: here the nearest bin says it all.
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): what is below 0 is clamped, and lround costs a call for each pixel.
  const auto nearest = [](float at, int count) { return std::clamp(static_cast<int>(at + 0.5F), 0, count - 1); };
  const int y = nearest(colour[0] / static_cast<float>(kLumaBin) - 0.5F, kLuma);
  const int cb = nearest((colour[1] - 128) / static_cast<float>(kChromaBin) + (kChroma - 1) / 2.0F, kChroma);
  const int cr = nearest((colour[2] - 128) / static_cast<float>(kChromaBin) + (kChroma - 1) / 2.0F, kChroma);
  return (y * kChroma + cb) * kChroma + cr;
}

BodyModel::CoveragePosition BodyModel::column_at(double location) {
  const double x = ((location / kHalfAcross + 1) / 2) * kAcross - 0.5;
  const BinPosition position = bin_position(x, kAcross);
  return {position.first, position.part, x < -1 || x > kAcross};
}

BodyModel::CoveragePosition BodyModel::row_at(double location) {
  const double y = ((location / kHalfDown + 1) / 2) * kDown - 0.5;
  const BinPosition position = bin_position(y, kDown);
  return {position.first, position.part, y < -1 || y > kDown};
}

}  // namespace marey::track::contour::colour
