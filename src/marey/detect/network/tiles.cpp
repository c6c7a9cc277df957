#include "marey/detect/network/tiles.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "marey/geometry/box.h"

namespace marey::detect::network {
namespace {

constexpr int kProbes = 9;                        // places along each side of an image or tile where sizes are asked for
constexpr double kMinTile = 64;                   // px
constexpr double kMinPerson = 8;                  // px: lower people are not searched for
constexpr double kSmaller = 1.6;                  // people this much smaller than one are too small in a tile round that one
constexpr double kMaxWidth = 2, kMinWidth = 3.6;  // height over width of a person, beyond which a box is less likely one
constexpr double kShapeSpread = 0.25;             // of its logarithm

Box box_of(const Candidate& one) {
  return {one.left, one.top, one.right - one.left, one.bottom - one.top};
}

/// The heights of people over the image, px: the lowest and the highest.
std::optional<std::pair<double, double>> heights_over(cv::Size image, const HeightAt& height_at) {
  std::optional<std::pair<double, double>> range;
  for (int row = 0; row < kProbes; ++row) {
    for (int column = 0; column < kProbes; ++column) {
      const auto height = height_at(image.width * (column + 0.5) / kProbes, image.height * (row + 0.5) / kProbes);
      if (!height || *height < kMinPerson) continue;
      if (!range) range = {*height, *height};
      range->first = std::min(range->first, *height), range->second = std::max(range->second, *height);
    }
  }
  return range;
}

bool holds_height(const cv::Rect& tile, const HeightAt& height_at, double height, double apart) {
  const double slack = std::sqrt(apart) * 1.05;
  for (int row = 1; row <= kProbes; ++row) {
    for (int column = 0; column < kProbes; ++column) {
      const auto here =
          height_at(tile.x + tile.width * (column + 0.5) / kProbes, tile.y + tile.height * static_cast<double>(row) / kProbes);
      if (here && *here > height / slack && *here < height * slack) return true;
    }
  }
  return false;
}

/// Begins of as few tiles of this side as reach over `length` with at least this overlap.
std::vector<int> begins(int length, int side, double overlap) {
  if (side >= length) return {0};
  const double step = std::max(1.0, side - overlap);
  const int count = 1 + static_cast<int>(std::ceil((length - side) / step));
  std::vector<int> result;
  for (int i = 0; i < count; ++i)
    result.push_back(static_cast<int>(std::lround(static_cast<double>(length - side) * i / std::max(1, count - 1))));
  return result;
}

void add_tiles(cv::Size image, const HeightAt& height_at, double height, const TileOptions& options, std::vector<cv::Rect>& tiles) {
  const int longer = std::max(image.width, image.height);
  const int side = static_cast<int>(std::lround(std::min<double>(std::max(height / options.fraction, kMinTile), longer)));
  const double overlap = std::min(options.overlap * height, 0.75 * side);
  for (const int top : begins(image.height, side, overlap)) {
    for (const int left : begins(image.width, side, overlap)) {
      const cv::Rect tile(left, top, side, side);
      if (!height_at || holds_height(tile, height_at, height, options.apart)) tiles.push_back(tile);
    }
  }
}

/// The square round a box, within the image as far as it has room.
cv::Rect square_round(const Box& box, int side, cv::Size image) {
  const auto begin = [side](double middle, int length) {
    return std::clamp(static_cast<int>(std::lround(middle - side / 2.0)), 0, std::max(0, length - side));
  };
  return {begin(box.left + box.width / 2, image.width), begin(box.top + box.height / 2, image.height), side, side};
}

/// How well a find is one person: its score, less where two side by side, or a part, would have its shape.
double likeness(const Candidate& one) {
  const double tall = (one.bottom - one.top) / (one.right - one.left);
  const double off = std::max({0.0, std::log(kMaxWidth / tall), std::log(tall / kMinWidth)}) / kShapeSpread;
  return one.score * std::exp(-0.5 * off * off);
}

bool cut_off(const Candidate& one, const cv::Rect& tile, cv::Size image, double border) {
  const double near = border * tile.width;
  return (tile.x > 0 && one.left < tile.x + near) || (tile.y > 0 && one.top < tile.y + near) ||
         (tile.br().x < image.width && one.right > tile.br().x - near) ||
         (tile.br().y < image.height && one.bottom > tile.br().y - near);
}

}  // namespace

std::vector<cv::Rect> tiles_over(cv::Size image, const HeightAt& height_at, double typical, const TileOptions& options) {
  std::vector<cv::Rect> tiles;
  const auto range = height_at ? heights_over(image, height_at) : std::nullopt;
  if (!range) {
    const double largest = options.fraction * std::min(image.width, image.height);
    for (double height = std::min(typical, largest); height < largest; height *= options.levels)
      add_tiles(image, {}, height, options, tiles);
    add_tiles(image, {}, largest, options, tiles);
    if (image.width != image.height)  // one who fills the image is too large for its shorter side
      add_tiles(image, {}, options.fraction * std::max(image.width, image.height), options, tiles);
    return tiles;
  }
  const double ratio = range->second / range->first;
  const int levels = std::max(1, static_cast<int>(std::ceil(std::log(ratio) / std::log(options.apart))));
  for (int level = 0; level < levels; ++level)
    add_tiles(image, height_at, range->first * std::pow(ratio, (level + 0.5) / levels), options, tiles);
  return tiles;
}

std::vector<cv::Rect> tiles_round(cv::Size image, std::span<const Box> people, const TileOptions& options) {
  const int longer = std::max(image.width, image.height);
  const auto grown = [&](const Box& box) {
    const double by = options.margin * box.height;
    return Box{box.left - by, box.top - by, box.width + 2 * by, box.height + 2 * by};
  };
  std::vector<Box> left(people.begin(), people.end());
  std::erase_if(left, [](const Box& box) { return box.empty(); });
  std::stable_sort(left.begin(), left.end(), [](const Box& a, const Box& b) { return a.height > b.height; });
  std::vector<cv::Rect> tiles;
  while (!left.empty()) {
    const Box first = left.front();
    Box all = grown(first);
    const double required = std::max({first.height / options.fraction, all.width, all.height, kMinTile});
    const int side = static_cast<int>(std::lround(std::min<double>(required, longer)));
    std::vector<Box> others;
    for (std::size_t i = 1; i < left.size(); ++i) {
      const Box with = geometry::hull(all, grown(left[i]));
      const bool fits = with.width <= side && with.height <= side && left[i].height * kSmaller >= first.height;
      if (fits) all = with;
      if (!fits) others.push_back(left[i]);
    }
    tiles.push_back(square_round(all, side, image));
    left = std::move(others);
  }
  return tiles;
}

std::vector<Candidate> join_finds(std::span<const TileFinds> tiles, cv::Size image, const JoinOptions& options) {
  std::vector<Candidate> all;
  for (const TileFinds& one : tiles) {
    std::copy_if(one.found.begin(), one.found.end(), std::back_inserter(all), [&](const Candidate& find) {
      return find.right > find.left && find.bottom > find.top && !cut_off(find, one.tile, image, options.border);
    });
  }
  std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return likeness(a) > likeness(b); });
  std::vector<Candidate> joined;
  for (const Candidate& one : all) {
    const Box box = box_of(one);
    const bool known = std::any_of(joined.begin(), joined.end(), [&](const Candidate& before) {
      const Box other = box_of(before);
      return geometry::iou(box, other) > options.same ||
             geometry::intersection(box, other).area() > options.within * std::min(box.area(), other.area());
    });
    double covered = 0;
    for (const Candidate& before : joined) covered += geometry::intersection(box, box_of(before)).area();
    if (!known && covered < options.spanned * box.area()) joined.push_back(one);
  }
  return joined;
}

}  // namespace marey::detect::network
