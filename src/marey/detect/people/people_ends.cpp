// A silhouette is what differs from the scene at all, and so it holds the halo of a sharpened image, colour that a codec smears
// and the faint shadow under the shoes: two to three pixels below the soles and above the crown, at whatever distance. Blur is
// symmetric, so that a body ends where half of its contrast is left; a halo has less than that, on either side of the ground's
// level. Column by column: the contrast inside is the largest within a few pixels, and the end is where half of it is crossed,
// to a fraction of a pixel. The lowest end that two neighbouring columns share is the sole's.
// Assumes that shoes and hair differ from the ground at least half as much as what they touch does; what differs too little is
// not measured. Cost: a few hundred pixels a person.
#include "marey/detect/people/people_ends.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace marey::detect::people {
namespace {

// Chosen by bench/sweep/feet on people of 20 to 200 px, with halos and smears of two kinds, and checked on the football clip.
constexpr double kFootDepth = 0.1, kHeadDepth = 0.03;          // of the height: how far inside the contrast is searched for,
constexpr double kMinFootDepth = 2, kMinHeadDepth = 1;         // px: at least,
constexpr double kMaxDepth = 14;                               // px: and at most, inside of where the body may end
constexpr float kFootFraction = 0.45F, kHeadFraction = 0.35F;  // of that contrast, which is left where the body ends
constexpr double kMaxExcess = 5, kExcessMaxFraction = 0.05;    // px; of the height: more is not a halo
constexpr double kUnusual = 1.5;                               // px
constexpr int kBesides = 3;                                    // px to either side
constexpr int kOutside = 2;                                    // px outside the silhouette
constexpr float kMinBodyContrast = 24;                         // levels; unswept
constexpr double kMedianStep = 0.25, kMinMedianStep = 0.02;    // px by which a running median moves: at first, later; unswept

int depth_of(const Box& box, double fraction, double minimum) {
  return static_cast<int>(std::clamp(std::round(fraction * box.height), minimum, kMaxDepth));
}

double max_excess(const Box& box) {
  return std::min(kMaxExcess, kExcessMaxFraction * box.height);
}

/// How far each pixel of a strip is from the empty scene, levels.
cv::Mat contrast_of(const ObservedPart& detected, const cv::Rect& rows) {
  cv::Mat contrast(rows.size(), CV_32FC1);
  const bool colour = detected.frame.is_colour() && detected.scene.is_colour();
  for (int y = 0; y < rows.height; ++y) {
    const int row = rows.y + y - detected.corner.y;
    for (int x = 0; x < rows.width; ++x) {
      const int column = rows.x + x - detected.corner.x;
      const auto difference = [](const cv::Mat& a, const cv::Mat& b, int i, int j) {
        return static_cast<float>(a.at<std::uint8_t>(i, j)) - static_cast<float>(b.at<std::uint8_t>(i, j));
      };
      float square = std::pow(difference(detected.frame.luma(), detected.scene.luma(), row, column), 2.0F);
      if (colour) {
        square += std::pow(difference(detected.frame.cb(), detected.scene.cb(), row / 2, column / 2), 2.0F) +
                  std::pow(difference(detected.frame.cr(), detected.scene.cr(), row / 2, column / 2), 2.0F);
      }
      contrast.at<float>(y, x) = std::sqrt(square);
    }
  }
  return contrast;
}

/// Of each column of the box, how many rows of a strip the body has, counted from its inner end; nothing if that is not reported.
/// `contrast` has its innermost row first, `last` is each column's outermost row of the silhouette there, −1 for none. `share` of
/// the contrast is left where the body ends.
std::vector<std::optional<double>> lengths_of(const cv::Mat& contrast, const std::vector<int>& last, float fraction) {
  const int columns = contrast.cols;
  std::vector<float> maximum(static_cast<std::size_t>(columns), 0);
  for (int x = 0; x < columns; ++x) {
    for (int y = 0; y <= last[static_cast<std::size_t>(x)]; ++y)
      maximum[static_cast<std::size_t>(x)] = std::max(maximum[static_cast<std::size_t>(x)], contrast.at<float>(y, x));
  }
  std::vector<std::optional<double>> lengths(static_cast<std::size_t>(columns));
  for (int x = 0; x < columns; ++x) {
    const auto begin = maximum.begin() + std::max(0, x - kBesides), end = maximum.begin() + std::min(columns, x + kBesides + 1);
    const float inside = *std::max_element(begin, end);
    if (last[static_cast<std::size_t>(x)] < 0 || inside < kMinBodyContrast) continue;
    const float half = fraction * inside;
    int y = std::min(last[static_cast<std::size_t>(x)] + kOutside, contrast.rows - 1);
    if (contrast.at<float>(y, x) >= half) continue;  // continues beyond what is searched
    while (y > 0 && contrast.at<float>(y - 1, x) < half) --y;
    if (y == 0) continue;  // halo alone
    const float in = contrast.at<float>(y - 1, x), out = contrast.at<float>(y, x);
    lengths[static_cast<std::size_t>(x)] = y - 0.5 + (in - half) / std::max(in - out, 1e-3F);
  }
  return lengths;
}

/// The farthest that two neighbouring columns agree on.
std::optional<double> farthest(const std::vector<std::optional<double>>& lengths) {
  std::optional<double> result;
  for (std::size_t x = 0; x + 1 < lengths.size(); ++x) {
    if (!lengths[x] || !lengths[x + 1]) continue;
    const double both = std::min(*lengths[x], *lengths[x + 1]);
    if (!result || both > *result) result = both;
  }
  return result;
}

void track_median(double value, double& median, int& detected) {
  const double step = std::max(kMinMedianStep, kMedianStep / std::sqrt(++detected));
  median += std::clamp(value - median, -step, step);
}

}  // namespace

cv::Rect part_for_ends(const Box& box, cv::Size image) {
  const auto even = [](double value) { return static_cast<int>(std::floor(value / 2)) * 2; };
  const cv::Point corner(even(box.left - kBesides), even(box.top - kOutside - 1));
  const cv::Point end(even(box.right() + kBesides) + 2, even(box.bottom() + kOutside + 1) + 2);
  return cv::Rect(corner, end) & cv::Rect({}, image);
}

BodyEnds find_ends(std::span<const PixelRun> runs, const Box& box, const ObservedPart& detected) {
  const cv::Rect all(detected.corner, detected.frame.size());
  const int left = std::max(static_cast<int>(std::floor(box.left)), all.x);
  const int right = std::min(static_cast<int>(std::ceil(box.right())), all.br().x);
  const int top = static_cast<int>(std::lround(box.top)), bottom = static_cast<int>(std::lround(box.bottom()));
  const int excess = static_cast<int>(std::ceil(max_excess(box)));
  const int inner_top = std::min(top + depth_of(box, kHeadDepth, kMinHeadDepth) + excess, all.br().y);
  const int inner_bottom = std::max(bottom - depth_of(box, kFootDepth, kMinFootDepth) - excess, all.y);
  const int above = std::max(top - kOutside - 1, all.y), below = std::min(bottom + kOutside + 1, all.br().y);
  if (right - left < 2 || above >= inner_top || inner_top > inner_bottom || inner_bottom >= below) return {};
  std::vector<int> down(static_cast<std::size_t>(right - left), -1), up = down;
  for (const PixelRun& run : runs) {
    for (int x = std::max(run.begin, left); x < std::min(run.end, right); ++x) {
      const auto i = static_cast<std::size_t>(x - left);
      if (run.row >= inner_bottom && run.row < bottom) down[i] = run.row - inner_bottom;
      if (run.row < inner_top && run.row >= top && up[i] < 0) up[i] = inner_top - 1 - run.row;
    }
  }
  BodyEnds ends;
  const cv::Mat feet = contrast_of(detected, {left, inner_bottom, right - left, below - inner_bottom});
  if (const auto length = farthest(lengths_of(feet, down, kFootFraction))) ends.bottom = inner_bottom + *length;
  cv::Mat head = contrast_of(detected, {left, above, right - left, inner_top - above});
  cv::flip(head, head, 0);
  if (const auto length = farthest(lengths_of(head, up, kHeadFraction))) ends.top = inner_top - *length;
  return ends;
}

void SilhouetteExcess::learn(const Box& box, const BodyEnds& ends) {
  if (ends.top) track_median(std::clamp(*ends.top - box.top, -1.0, max_excess(box)), above_, observed_above_);
  if (ends.bottom) track_median(std::clamp(box.bottom() - *ends.bottom, -1.0, max_excess(box)), below_, observed_below_);
}

Box SilhouetteExcess::without(const Box& box, const BodyEnds& ends) const {
  const auto excess = [&](std::optional<double> measured, double typical) {
    return std::min(max_excess(box), measured ? std::clamp(*measured, typical - kUnusual, typical + kUnusual) : typical);
  };
  const double above = excess(ends.top ? std::optional(*ends.top - box.top) : std::nullopt, above_);
  const double below = excess(ends.bottom ? std::optional(box.bottom() - *ends.bottom) : std::nullopt, below_);
  return {box.left, box.top + above, box.width, std::max(1.0, box.height - above - below)};
}

}  // namespace marey::detect::people
