#include "marey/detect/network/tiles.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "marey/geometry/box.h"

namespace marey::detect::network {
namespace {

constexpr int kProbes = 9;            // places along each side of a picture or tile where sizes are asked for
constexpr double kSmallestTile = 64;  // px
constexpr double kLowestPerson = 8;   // px: lower people are not searched for

Box box_of(const Candidate& one) {
  return {one.left, one.top, one.right - one.left, one.bottom - one.top};
}

/// The heights of people over the picture, px: the lowest and the highest.
std::optional<std::pair<double, double>> heights_over(cv::Size picture, const HeightAt& height_at) {
  std::optional<std::pair<double, double>> range;
  for (int row = 0; row < kProbes; ++row) {
    for (int column = 0; column < kProbes; ++column) {
      const auto height = height_at(picture.width * (column + 0.5) / kProbes, picture.height * (row + 0.5) / kProbes);
      if (!height || *height < kLowestPerson) continue;
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

void add_tiles(cv::Size picture, const HeightAt& height_at, double height, const TileOptions& options,
               std::vector<cv::Rect>& tiles) {
  const int shorter = std::min(picture.width, picture.height);
  const int side = static_cast<int>(std::lround(std::min<double>(std::max(height / options.share, kSmallestTile), shorter)));
  const double overlap = std::min(options.overlap * height, 0.75 * side);
  for (const int top : begins(picture.height, side, overlap)) {
    for (const int left : begins(picture.width, side, overlap)) {
      const cv::Rect tile(left, top, side, side);
      if (!height_at || holds_height(tile, height_at, height, options.apart)) tiles.push_back(tile);
    }
  }
}

bool cut_off(const Candidate& one, const cv::Rect& tile, cv::Size picture, double border) {
  const double near = border * tile.width;
  return (tile.x > 0 && one.left < tile.x + near) || (tile.y > 0 && one.top < tile.y + near) ||
         (tile.br().x < picture.width && one.right > tile.br().x - near) ||
         (tile.br().y < picture.height && one.bottom > tile.br().y - near);
}

}  // namespace

std::vector<cv::Rect> tiles_over(cv::Size picture, const HeightAt& height_at, double usual, const TileOptions& options) {
  std::vector<cv::Rect> tiles;
  const auto range = height_at ? heights_over(picture, height_at) : std::nullopt;
  if (!range) {
    add_tiles(picture, {}, usual, options, tiles);
    return tiles;
  }
  const double ratio = range->second / range->first;
  const int levels = std::max(1, static_cast<int>(std::ceil(std::log(ratio) / std::log(options.apart))));
  for (int level = 0; level < levels; ++level)
    add_tiles(picture, height_at, range->first * std::pow(ratio, (level + 0.5) / levels), options, tiles);
  return tiles;
}

std::vector<Candidate> join_finds(std::span<const TileFinds> tiles, cv::Size picture, const JoinOptions& options) {
  std::vector<Candidate> all;
  for (const TileFinds& one : tiles) {
    std::copy_if(one.found.begin(), one.found.end(), std::back_inserter(all), [&](const Candidate& find) {
      return find.right > find.left && find.bottom > find.top && !cut_off(find, one.tile, picture, options.border);
    });
  }
  std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  std::vector<Candidate> joined;
  for (const Candidate& one : all) {
    const Box box = box_of(one);
    const bool known = std::any_of(joined.begin(), joined.end(), [&](const Candidate& before) {
      const Box other = box_of(before);
      return geometry::iou(box, other) > options.same ||
             geometry::intersection(box, other).area() > options.within * std::min(box.area(), other.area());
    });
    if (!known) joined.push_back(one);
  }
  return joined;
}

}  // namespace marey::detect::network
