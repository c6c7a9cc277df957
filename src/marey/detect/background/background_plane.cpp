#include "marey/detect/background/background_plane.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include <opencv2/imgproc.hpp>

namespace marey::detect::background {
namespace {

constexpr int kSameLevel = 10;            // levels; samples this near each other show the same thing
constexpr std::uint8_t kFirstSpread = 8;  // 1 level, until the noise is known

std::int16_t clamp_level(float mean) {
  return static_cast<std::int16_t>(std::lround(std::clamp(mean, 0.0F, 255.0F * 128.0F)));
}

}  // namespace

void ScenePlane::make_room(cv::Size size) {
  mean_.create(size, CV_16SC1);
  spread_.create(size, CV_8UC1);
  low_.create(size, CV_8UC1);
  high_.create(size, CV_8UC1);
}

void ScenePlane::begin(const cv::Mat& image) {
  begin(std::span(&image, 1));
}

/// Calls `row(y, middle, spread)` with what as many of the samples as are a power of two, at most 32, have in common.
template <typename Row>
void ScenePlane::summarise(std::span<const cv::Mat> samples, Row&& row) const {
  const cv::Size size = samples.front().size();
  int log2_count = 0;
  while ((std::size_t{2} << log2_count) <= samples.size()) ++log2_count;
  const int count = 1 << log2_count;
  const int stride = (size.width + 31) / 32 * 32;
  std::vector<std::uint8_t> rows(static_cast<std::size_t>(count) * stride, 0);
  std::vector<std::uint8_t> middle(stride), spread(stride);
  for (int y = 0; y < size.height; ++y) {
    for (int i = 0; i < count; ++i) {
      const std::size_t which = i * samples.size() / count;
      std::memcpy(&rows[static_cast<std::size_t>(i) * stride], samples[which].ptr<std::uint8_t>(y), size.width);
    }
    kernels_.sort(rows.data(), log2_count, stride, stride);
    kernels_.shortest_half(rows.data(), count, stride, stride, middle.data(), spread.data());
    row(y, middle.data(), spread.data());
  }
}

void ScenePlane::begin(std::span<const cv::Mat> samples) {
  make_room(samples.front().size());
  summarise(samples, [&](int y, const std::uint8_t* middle, const std::uint8_t* spread) {
    for (int x = 0; x < mean_.cols; ++x) {
      trust(y, x, middle[x]);
      spread_.at<std::uint8_t>(y, x) = std::max(spread[x], kFirstSpread);
    }
  });
  renew_bands(0, mean_.rows);
}

void ScenePlane::correct(std::span<const cv::Mat> samples, const cv::Mat& fixed, const cv::Mat& flagged) {
  const auto agreeing = [&](int y, int x, int required) {
    return std::count_if(samples.begin(), samples.end(),
                         [&](const cv::Mat& sample) { return std::abs(sample.at<std::uint8_t>(y, x) - required) <= kSameLevel; });
  };
  summarise(samples, [&](int y, const std::uint8_t* middle, const std::uint8_t* spread) {
    const auto* fixed_row = fixed.ptr<std::uint8_t>(y);
    const auto* doubted_row = flagged.ptr<std::uint8_t>(y);
    auto* spreads = spread_.ptr<std::uint8_t>(y);
    for (int x = 0; x < mean_.cols; ++x) {
      if (fixed_row[x] != 0) continue;
      spreads[x] = std::max(spreads[x], spread[x]);
      const int now = level(y, x);
      if (doubted_row[x] == 0 || std::abs(middle[x] - now) <= kSameLevel) continue;
      if (agreeing(y, x, middle[x]) >= 2 * agreeing(y, x, now)) trust(y, x, middle[x]);
    }
  });
  renew_bands(0, mean_.rows);
}

cv::Mat ScenePlane::image(const cv::Rect& part) const {
  cv::Mat levels;
  mean_(part).convertTo(levels, CV_8U, 1 / 128.0);
  return levels;
}

void ScenePlane::replace(const cv::Mat& levels, const cv::Mat& spreads, const cv::Mat& where) {
  for (int y = 0; y < mean_.rows; ++y) {
    const auto* marked = where.ptr<std::uint8_t>(y);
    for (int x = 0; x < mean_.cols; ++x) {
      if (marked[x] == 0) continue;
      trust(y, x, levels.at<std::uint8_t>(y, x));
      spread_.at<std::uint8_t>(y, x) = spreads.at<std::uint8_t>(y, x);
    }
  }
  renew_bands(0, mean_.rows);
}

void ScenePlane::renew_bands(int first, int last) {
  const int bottom = mean_.rows - 1;
  for (int row = first; row < last; ++row) {
    const std::int16_t* const rows[3] = {mean(std::max(row - 1, 0)), mean(row), mean(std::min(row + 1, bottom))};
    kernels_.band(rows, spread_.ptr<std::uint8_t>(row), mean_.cols, gate_, floor_, low_.ptr<std::uint8_t>(row),
                  high_.ptr<std::uint8_t>(row));
  }
}

void ScenePlane::scale(const cv::Mat& gains, int origin) {
  const float zero = static_cast<float>(origin) * 128.0F;
  for (int y = 0; y < mean_.rows; ++y) {
    std::int16_t* means = mean_.ptr<std::int16_t>(y);
    const float* gain = gains.ptr<float>(y / kBlock);
    for (int x = 0; x < mean_.cols; ++x) {
      means[x] = clamp_level(zero + (static_cast<float>(means[x]) - zero) * gain[x / kBlock]);
    }
  }
  renew_bands(0, mean_.rows);
}

void ScenePlane::relight(const cv::Mat& gains, int origin) {
  const float zero = static_cast<float>(origin) * 128.0F;
  cv::Mat row, wide;
  for (int y = 0; y < mean_.rows; ++y) {
    const float at =
        std::clamp((static_cast<float>(y) + 0.5F) * static_cast<float>(gains.rows) / static_cast<float>(mean_.rows) - 0.5F, 0.0F,
                   static_cast<float>(gains.rows - 1));
    const int upper = static_cast<int>(at), lower = std::min(upper + 1, gains.rows - 1);
    cv::addWeighted(gains.row(upper), 1 - (at - static_cast<float>(upper)), gains.row(lower), at - static_cast<float>(upper), 0,
                    row);
    if (std::all_of(row.begin<float>(), row.end<float>(), [](float gain) { return gain == 1; })) continue;
    cv::resize(row, wide, {mean_.cols, 1}, 0, 0, cv::INTER_LINEAR);
    std::int16_t* means = mean_.ptr<std::int16_t>(y);
    const float* gain = wide.ptr<float>();
    for (int x = 0; x < mean_.cols; ++x) means[x] = clamp_level(zero + (static_cast<float>(means[x]) - zero) * gain[x]);
  }
  renew_bands(0, mean_.rows);
}

void ScenePlane::shift(double levels) {
  const auto step = static_cast<float>(levels * 128);
  for (int y = 0; y < mean_.rows; ++y) {
    std::int16_t* means = mean_.ptr<std::int16_t>(y);
    for (int x = 0; x < mean_.cols; ++x) means[x] = clamp_level(static_cast<float>(means[x]) + step);
  }
  renew_bands(0, mean_.rows);
}

}  // namespace marey::detect::background
