// A mask ends where a pixel differs from the ground by more than noise: that is where the camera's sharpening, the blocks of a
// codec and smeared colour end, some pixels outside the body, above the head and below the feet. A body ends where its contrast has
// fallen to about one half: blur is symmetric about it, and halos are weaker.
//
// For each end, the ground's colour is the median of what lies about it and is not in the mask (a pitch's line does not matter).
// What of the mask differs plainly from it is the body; the columns in which it reaches farthest are averaged to a profile along
// the rows, and its edge is the first place from outside at which the profile differs from the ground by a share of the most that
// it does within the next rows. Any colour counts: a dark shoe under a white sock is as much a body as the sock.
//
// The two feet are the lower ends of the left and the right half of the legs. A person stands between them, not at the nearer one,
// which is what the lowest pixel shows: half a step before the body where it walks towards the camera or away. A foot that would
// stand more than a stride behind the other is in the air, and does not count.
//
// Assumed: one body, upright, alone in its box, whole; a ground that is one colour round a foot but for lines. Cost: some thousand
// pixels a person.
#include "marey/detect/people/body_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace marey::detect::people {
namespace {

constexpr double kLegsPart = 0.3;   // of the height: the parts in which feet and head are looked for
constexpr double kFarthest = 0.03;  // of the height: columns that end so near to the farthest make the profile
constexpr double kPlainly = 0.3;    // of the contrast that a tenth of an end exceeds: what differs as much is the body
constexpr double kDeep = 0.03;      // of the height, and kNearPixels: how far inside the edge the strongest contrast is sought
constexpr int kNearPixels = 3;      // px
constexpr double kGroundAside = 0.12, kGroundBeyond = 0.07;  // of the height, and
constexpr int kGroundPixels = 4;                             // px: how far the ground is looked at
constexpr int kAway = 3;              // px from the mask, where nothing of the body colours the ground any more
constexpr double kBeyondBox = 0.06;   // of the height: how far beyond the box the body may reach
constexpr double kMostOff = 0.08;     // of the height, and
constexpr double kMostOffPixels = 5;  // px: how far from the box's an end may be
constexpr double kBorderPixels = 2;
constexpr double kHeadAcross = 0.2;  // of the width, about the middle, where a head is

using Levels = std::array<double, 3>;

class BodyEnds {
 public:
  BodyEnds(const Picture& picture, const cv::Mat& mask, const Box& box, const BodyRowsOptions& options)
      : picture_(picture), mask_(mask), box_(box), options_(options), colour_(!picture.cb().empty()) {
    const int reach = kGroundPixels + kAway + static_cast<int>((kGroundAside + kBeyondBox) * box.height) + 1;
    around_ = cv::Rect(static_cast<int>(box.left) - reach, static_cast<int>(box.top) - reach,
                       static_cast<int>(box.width) + 2 * reach, static_cast<int>(box.height) + 2 * reach) &
              cv::Rect({0, 0}, mask.size());
    constexpr int kSide = 2 * kAway + 1;
    cv::dilate(mask(around_), near_, cv::Mat::ones(kSide, kSide, CV_8UC1));
  }

  /// The part of `place` in which the mask holds the body, as it differs from the ground about the lower (`down` 1) or upper (−1)
  /// end of it; what else the mask holds is left out from now on. Nothing where nothing stands out.
  std::optional<cv::Rect> find_body(const cv::Rect& place, int down) {
    place_ = place & cv::Rect({0, 0}, mask_.size());
    columns_ = {place_.x, place_.br().x - 1};
    body_ = cv::Mat::zeros(place_.size(), CV_8UC1);
    const auto ground = place_.empty() ? std::nullopt : ground_about(down > 0 ? box_.bottom() - 1 : box_.top, down);
    if (!ground) return std::nullopt;
    std::vector<double> contrasts;
    for_mask([&](int y, int x) { contrasts.push_back(apart(at(y, x), *ground)); });
    if (contrasts.empty()) return std::nullopt;
    const auto tenth = contrasts.begin() + static_cast<std::ptrdiff_t>(contrasts.size() * 9 / 10);
    std::nth_element(contrasts.begin(), tenth, contrasts.end());
    if (*tenth < options_.least_contrast) return std::nullopt;
    const double least = kPlainly * *tenth;
    for_mask([&](int y, int x) { body_.at<std::uint8_t>(y - place_.y, x - place_.x) = apart(at(y, x), *ground) >= least; });
    const cv::Rect found = cv::boundingRect(body_);
    if (found.empty()) return std::nullopt;
    return cv::Rect(found.tl() + place_.tl(), found.size());
  }

  /// The lower or upper edge of the body that was found last, in columns [left, right); nothing where there is none.
  std::optional<double> edge(int left, int right, int down) {
    const auto end = farthest(std::max(left, place_.x), std::min(right, place_.br().x), down);
    if (!end) return std::nullopt;
    const auto ground = ground_about(*end, down);
    if (!ground) return std::nullopt;
    return refined(*end, *ground, down);
  }

 private:
  Levels at(int row, int column) const {
    Levels result{static_cast<double>(picture_.luma().at<std::uint8_t>(row, column)), 0, 0};
    if (!colour_) return result;
    result[1] = options_.chroma * picture_.cb().at<std::uint8_t>(row / 2, column / 2);
    result[2] = options_.chroma * picture_.cr().at<std::uint8_t>(row / 2, column / 2);
    return result;
  }

  static double apart(const Levels& a, const Levels& b) {
    const double y = a[0] - b[0], cb = a[1] - b[1], cr = a[2] - b[2];
    return std::sqrt(y * y + cb * cb + cr * cr);
  }

  template <typename Visit>
  void for_mask(Visit&& visit) const {
    for (int y = place_.y; y < place_.br().y; ++y) {
      for (int x = place_.x; x < place_.br().x; ++x) {
        if (mask_.at<std::uint8_t>(y, x) != 0) visit(y, x);
      }
    }
  }

  /// The row in which the body ends within columns [left, right), and in `columns_` the columns that end there or nearly.
  std::optional<int> farthest(int left, int right, int down) {
    std::vector<std::pair<int, int>> ends;  // column, row
    std::optional<int> most;
    for (int x = left; x < right; ++x) {
      for (int i = 0; i < place_.height; ++i) {
        const int y = down > 0 ? place_.height - 1 - i : i;
        if (body_.at<std::uint8_t>(y, x - place_.x) == 0) continue;
        ends.emplace_back(x, y + place_.y);
        if (!most || (ends.back().second - *most) * down > 0) most = ends.back().second;
        break;
      }
    }
    columns_.clear();
    if (!most) return std::nullopt;
    const double slack = std::max(1.5, kFarthest * box_.height);
    for (const auto& [x, y] : ends) {
      if ((*most - y) * down <= slack) columns_.push_back(x);
    }
    return most;
  }

  /// The median colour of what lies beyond and beside the end in row `end` and is not in the mask.
  std::optional<Levels> ground_about(double end_row, int down) const {
    const int end = static_cast<int>(end_row);
    const int aside = kGroundPixels + static_cast<int>(kGroundAside * box_.height);
    const int beyond = kGroundPixels + static_cast<int>(kGroundBeyond * box_.height);
    const int first = columns_.front() - aside, last = columns_.back() + aside;
    std::array<std::vector<double>, 3> levels;
    for (int i = -aside; i <= kAway + beyond; ++i) {
      const int y = end + i * down;
      for (int x = first; x <= last; ++x) {
        if (!around_.contains({x, y}) || near_mask(y, x)) continue;
        const Levels colour = at(y, x);
        for (std::size_t k = 0; k < 3; ++k) levels[k].push_back(colour[k]);
      }
    }
    if (levels[0].size() < 12) return std::nullopt;
    Levels median{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto middle = levels[k].begin() + static_cast<std::ptrdiff_t>(levels[k].size() / 2);
      std::nth_element(levels[k].begin(), middle, levels[k].end());
      median[k] = *middle;
    }
    return median;
  }

  bool near_mask(int row, int column) const { return near_.at<std::uint8_t>(row - around_.y, column - around_.x) != 0; }

  /// The edge by contrast with the ground, going inwards from beyond `end`.
  std::optional<double> refined(int end, const Levels& ground, int down) {
    const int deep = static_cast<int>(std::lround(kDeep * box_.height)) + kNearPixels;
    contrast_.clear();
    for (int i = kNearPixels; i >= -deep; --i) {
      const int y = end + i * down;
      if (y < 0 || y >= mask_.rows) return std::nullopt;
      Levels sum{};
      for (const int x : columns_) {
        const Levels one = at(y, x);
        for (std::size_t k = 0; k < 3; ++k) sum[k] += one[k];
      }
      for (double& value : sum) value /= static_cast<double>(columns_.size());
      contrast_.push_back(apart(sum, ground));
    }
    const double most = *std::max_element(contrast_.begin(), contrast_.end());
    const double least = options_.edge * most;
    const auto first = std::find_if(contrast_.begin(), contrast_.end(), [&](double one) { return one >= least; });
    if (most < options_.least_contrast || first == contrast_.begin()) return std::nullopt;
    const double before = *(first - 1);
    const double share = (*first - least) / (*first - before);
    const double steps = static_cast<double>(first - contrast_.begin()) - share;
    return end + (kNearPixels - steps) * down;
  }

  const Picture& picture_;
  const cv::Mat& mask_;
  const Box& box_;
  const BodyRowsOptions& options_;
  bool colour_;
  cv::Rect around_;           ///< all that is looked at
  cv::Mat near_;              ///< CV_8UC1 of its size: not zero within kAway of the mask
  cv::Rect place_;            ///< where the body is looked for
  cv::Mat body_;              ///< CV_8UC1 of its size: not zero where it is
  std::vector<int> columns_;  ///< in order, that the end is made of
  std::vector<double> contrast_;
};

}  // namespace

std::optional<BodyRows> find_body_rows(const Picture& picture, const cv::Mat& mask, const Box& box, double steepness,
                                       const BodyRowsOptions& options) {
  if (picture.empty() || mask.size() != picture.size() || picture.luma().depth() != CV_8U) return std::nullopt;
  if (box.left < kBorderPixels || box.top < kBorderPixels || box.right() > mask.cols - kBorderPixels ||
      box.bottom() > mask.rows - kBorderPixels)
    return std::nullopt;
  BodyEnds ends(picture, mask, box, options);
  const double slack = std::max(2.0, kBeyondBox * box.height), half = kHeadAcross * box.width;
  const auto whole = [](double value) { return static_cast<int>(std::lround(value)); };
  const int left = whole(box.left), right = whole(box.right()), legs = whole(box.bottom() - kLegsPart * box.height);
  const auto feet = ends.find_body({cv::Point(left, legs), cv::Point(right, whole(box.bottom() + slack))}, 1);
  if (!feet) return std::nullopt;
  const int axis = feet->x + feet->width / 2;
  const auto one = ends.edge(feet->x, axis, 1), other = ends.edge(axis, feet->br().x, 1);
  if (!one && !other) return std::nullopt;
  const double first = one ? *one : *other, second = other ? *other : *one, middle = box.left + box.width / 2;
  const auto head = ends.find_body({cv::Point(whole(middle - half), whole(box.top - slack)),
                                    cv::Point(whole(middle + half), whole(box.top + kLegsPart * box.height))},
                                   -1);
  const auto crown = head ? ends.edge(head->x, head->br().x, -1) : std::nullopt;
  BodyRows rows{.head = crown.value_or(box.top - 0.5), .sole = std::max(first, second)};
  // Where the mask ends elsewhere than the body in it does, a part of the body is hidden.
  const double most = kMostOff * box.height + kMostOffPixels;
  if (std::abs(rows.sole - box.foot().y()) > most || std::abs(rows.head - (box.top - 0.5)) > most) return std::nullopt;
  const bool both = std::abs(first - second) <= options.stride * steepness * box.height;
  rows.stand = both ? (first + second) / 2 : rows.sole;
  return rows;
}

}  // namespace marey::detect::people
