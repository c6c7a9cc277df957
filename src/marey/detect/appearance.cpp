#include "marey/detect/appearance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "marey/core/colour.h"
#include "marey/geometry/median.h"

namespace marey::detect {
namespace {

/// Rows and columns of the box, shares of its height from the top and of its width from the left.
struct Rows {
  double first = 0, last = 1;
  double first_column = 0.25, last_column = 0.75;
};

constexpr Rows kChest{0.2, 0.5};
constexpr Rows kMiddleOfChest{0.22, 0.45, 0.38, 0.62};  // where no mask separates the person from the scene
constexpr Rows kThighs{0.52, 0.8};
constexpr Rows kShanks{0.8, 0.94, 0, 1};
constexpr int max_samples = 100;
constexpr int min_samples = 6;
constexpr float alike = 3;                 // neighbouring samples share light, cloth and compression: this many count as one
constexpr float shared_ambiguity = 5;      // L*a*b*: more deviation of a colour that may be in part another's
constexpr float coded_to = 2;              // L*a*b*: what compression leaves uncertain however many samples there are
constexpr float half_of_normal = 1.4826F;  // standard deviations in a median distance from the median

/// A rectangle of chroma samples, visited every `step`-th in both directions.
struct Grid {
  int left = 0, right = 0, top = 0, bottom = 0;  // right and bottom are not included
  int step = 1;
};

Grid grid_of(const Box& box, const Rows& rows, cv::Size chroma) {
  Grid grid;
  const auto cell = [](double pixel) { return static_cast<int>(std::floor(pixel / 2)); };
  grid.left = std::max(0, cell(box.left + rows.first_column * box.width));
  grid.right = std::min(chroma.width, cell(box.left + rows.last_column * box.width) + 1);
  grid.top = std::max(0, cell(box.top + rows.first * box.height));
  grid.bottom = std::min(chroma.height, cell(box.top + rows.last * box.height) + 1);
  const double cells = static_cast<double>(std::max(0, grid.right - grid.left)) * std::max(0, grid.bottom - grid.top);
  grid.step = std::max(1, static_cast<int>(std::ceil(std::sqrt(cells / max_samples))));
  return grid;
}

/// BT.601.
std::array<float, 3> lab_of(float luma, float cb, float cr, Image::Range range) {
  const bool limited = range == Image::Range::limited;
  const float y = limited ? (luma - 16) * (255.0F / 219.0F) : luma;
  const float chroma = limited ? 255.0F / 224.0F : 1.0F;
  const float u = chroma * (cb - 128);
  const float v = chroma * (cr - 128);
  return lab_from_srgb(y + 1.402F * v, y - 0.344136F * u - 0.714136F * v, y + 1.772F * u);
}

/// The four pixels of a chroma sample: their mean luma, and whether half of them are a person's.
struct Quad {
  float luma = 0;
  bool detected = false;
};

/// An empty mask: all is the person's.
Quad quad_at(const cv::Mat& luma, const cv::Mat& mask, int column, int row) {
  int sum = 0, detected = 0, all = 0;
  for (int y = 2 * row; y < std::min(2 * row + 2, luma.rows); ++y) {
    for (int x = 2 * column; x < std::min(2 * column + 2, luma.cols); ++x) {
      sum += luma.at<std::uint8_t>(y, x);
      detected += mask.empty() || mask.at<std::uint8_t>(y, x) != 0 ? 1 : 0;
      ++all;
    }
  }
  return {static_cast<float>(sum) / static_cast<float>(all), 2 * detected > all};
}

/// The boxes of those who share the region of `detection` and stand nearer.
std::vector<Box> boxes_before(std::span<const Detection> detections, const Detection& detection) {
  std::vector<Box> nearer;
  if (!detection.group) return nearer;
  for (const Detection& other : detections) {
    if (other.group == detection.group && other.box.bottom() > detection.box.bottom()) nearer.push_back(other.box);
  }
  return nearer;
}

bool is_within(const std::vector<Box>& boxes, double x, double y) {
  return std::any_of(boxes.begin(), boxes.end(),
                     [&](const Box& box) { return x >= box.left && x < box.right() && y >= box.top && y < box.bottom(); });
}

/// The colours, in L*a*b*, of the person's pixels in these rows of the box.
class Samples {
 public:
  void take(const Image& image, const cv::Mat& mask, const Grid& grid, const std::vector<Box>& nearer) {
    for (int row = grid.top; row < grid.bottom; row += grid.step) {
      for (int column = grid.left; column < grid.right && n_ < 2 * max_samples; column += grid.step) {
        if (is_within(nearer, 2 * column + 0.5, 2 * row + 0.5)) continue;
        const Quad quad = quad_at(image.luma(), mask, column, row);
        if (!quad.detected) continue;
        const std::array<float, 3> lab =
            lab_of(quad.luma, image.cb().at<std::uint8_t>(row, column), image.cr().at<std::uint8_t>(row, column), image.range());
        for (int i = 0; i < 3; ++i) values_[i][n_] = lab[i];
        ++n_;
      }
    }
  }

  /// Of all samples together. Uses them up.
  std::optional<Appearance> middle(bool shared) {
    if (n_ < min_samples) return std::nullopt;
    std::array<float, 3> colour{};
    float variance = 0;
    for (int i = 0; i < 3; ++i) {
      colour[i] = geometry::median(std::span(values_[i]).first(static_cast<std::size_t>(n_)));
      for (int k = 0; k < n_; ++k) values_[i][k] = std::abs(values_[i][k] - colour[i]);
      const float spread = half_of_normal * geometry::median(std::span(values_[i]).first(static_cast<std::size_t>(n_)));
      variance += spread * spread / 3;
    }
    const float independent = std::max(1.0F, static_cast<float>(n_) / alike);
    return Appearance{.lightness = colour[0],
                      .a = colour[1],
                      .b = colour[2],
                      .deviation = std::sqrt(variance / independent + coded_to * coded_to) + (shared ? shared_ambiguity : 0)};
  }

 private:
  std::array<std::array<float, 2 * max_samples>, 3> values_{};
  int n_ = 0;
};

std::optional<Appearance> colour_in(const Rows& rows, const Image& image, const Foreground& foreground,
                                    std::span<const Detection> detections, std::size_t which) {
  const Detection& detection = detections[which];
  if (!image.is_colour() || detection.box.top < 1) return std::nullopt;
  Samples samples;
  samples.take(image, foreground.covered.empty() ? foreground.mask : foreground.covered,
               grid_of(detection.box, rows, image.cb().size()), boxes_before(detections, detection));
  return samples.middle(detection.group.has_value() || foreground.mask.empty());
}

}  // namespace

std::optional<Appearance> upper_body(const Image& image, const Foreground& foreground, std::span<const Detection> detections,
                                     std::size_t which) {
  return colour_in(foreground.mask.empty() ? kMiddleOfChest : kChest, image, foreground, detections, which);
}

std::optional<Appearance> lower_body(const Image& image, const Foreground& foreground, std::span<const Detection> detections,
                                     std::size_t which) {
  const cv::Mat& mask = foreground.mask;
  if (mask.empty() || detections[which].box.bottom() > mask.rows - 1) return std::nullopt;
  return colour_in(kThighs, image, foreground, detections, which);
}

std::optional<Appearance> shanks(const Image& image, const Foreground& foreground, std::span<const Detection> detections,
                                 std::size_t which) {
  const cv::Mat& mask = foreground.mask;
  if (mask.empty() || detections[which].box.bottom() > mask.rows - 1) return std::nullopt;
  return colour_in(kShanks, image, foreground, detections, which);
}

}  // namespace marey::detect
