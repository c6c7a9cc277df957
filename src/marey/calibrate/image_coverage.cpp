#include "marey/calibrate/image_coverage.h"

#include <algorithm>
#include <optional>

#include "marey/assign/disjoint_sets.h"

namespace marey::calibrate {
namespace {

std::optional<int> part_of(const Vector<2>& pixel, cv::Size size) {
  if (!(pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < size.width && pixel.y() < size.height)) return std::nullopt;
  const auto column = static_cast<int>(pixel.x() / size.width * ImageCoverage::kPartsAcross);
  const auto row = static_cast<int>(pixel.y() / size.height * ImageCoverage::kPartsDown);
  return row * ImageCoverage::kPartsAcross + column;
}

}  // namespace

void ImageCoverage::add_view(std::size_t camera, std::span<const Vector<2>> pixels, cv::Size size) {
  Camera& seen = cameras_[camera];
  ++seen.views;
  for (const Vector<2>& pixel : pixels) {
    const auto part = part_of(pixel, size);
    if (part && seen.parts.insert(*part).second) seen.views_at_growth = seen.views;
  }
}

void ImageCoverage::add_shared(std::size_t a, std::size_t b, std::int64_t views) {
  shared_[{std::min(a, b), std::max(a, b)}] += views;
}

std::int64_t ImageCoverage::shared(std::size_t a, std::size_t b) const {
  const auto found = shared_.find({std::min(a, b), std::max(a, b)});
  return found != shared_.end() ? found->second : 0;
}

double ImageCoverage::coverage(std::size_t camera) const {
  return static_cast<double>(cameras_[camera].parts.size()) / (kPartsAcross * kPartsDown);
}

bool ImageCoverage::is_covered(std::size_t camera) const {
  const bool no_more = cameras_[camera].views - cameras_[camera].views_at_growth >= criteria_.nothing_new;
  return coverage(camera) >= (no_more ? criteria_.min_fraction : criteria_.fraction);
}

std::vector<std::size_t> ImageCoverage::chained_to() const {
  assign::DisjointSets chained(cameras_.size());
  for (const auto& [pair, views] : shared_) {
    if (views >= criteria_.shared) chained.join(static_cast<int>(pair.first), static_cast<int>(pair.second));
  }
  std::vector<std::size_t> first(cameras_.size());
  for (std::size_t c = 0; c < first.size(); ++c) {
    first[c] = 0;
    while (chained.find(static_cast<int>(first[c])) != chained.find(static_cast<int>(c))) ++first[c];
  }
  return first;
}

bool ImageCoverage::is_enough() const {
  const std::vector<std::size_t> first = chained_to();
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    if (!is_covered(c) || first[c] != 0) return false;
  }
  return true;
}

}  // namespace marey::calibrate
