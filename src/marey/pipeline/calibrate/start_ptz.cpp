#include "marey/pipeline/calibrate/start_ptz.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "marey/core/stop.h"

namespace marey::pipeline::calibrate {
namespace {

using marey::calibrate::ptz::SearchedTripod;
using marey::calibrate::ptz::SearchImage;
using marey::calibrate::ptz::TripodVerdict;

constexpr double kSearchWindow = 60;  // s that are searched together; numerical: memory and cost alone
constexpr double kSearchEvery = 0.4;  // s between images whose lines are counted; numerical: memory and cost alone
constexpr std::size_t kSearchImages =
    10;                       // of a window, each the one of its tenth that shows most lines; numerical: memory and cost alone
constexpr int kMinLines = 2;  // an image with fewer shows no pitch; numerical: cost alone

Image searched_copy(const Image& image) {
  if (!image.is_colour()) return Image(image.luma().clone());
  return Image(image.luma().clone(), image.cb().clone(), image.cr().clone(), image.range());
}

/// Of a window's images, those of even spans of time that show most lines.
std::vector<SearchImage> images_with_lines(std::vector<SearchImage> all) {
  std::vector<SearchImage> best;
  for (std::size_t k = 0; k < kSearchImages; ++k) {
    const std::size_t begin = k * all.size() / kSearchImages, end = (k + 1) * all.size() / kSearchImages;
    if (begin == end) continue;
    const auto most =
        std::max_element(all.begin() + static_cast<std::ptrdiff_t>(begin), all.begin() + static_cast<std::ptrdiff_t>(end),
                         [](const SearchImage& a, const SearchImage& b) { return a.lines < b.lines; });
    if (most->lines >= kMinLines) best.push_back(std::move(*most));
  }
  return best;
}

/// The images of the next minute; false at the video's end.
bool read_search_window(corridor::Feed& feed, std::int64_t& index, std::int64_t window, std::vector<SearchImage>& images,
                        const Hooks& hooks) {
  const auto every = std::max<std::int64_t>(1, std::llround(kSearchEvery * feed.rate_hz()));
  const std::int64_t end = index + window;
  for (; index < end; ++index) {
    stop_point();
    const auto given = feed.next();
    if (!given) return false;
    if (index % every != 0) continue;
    SearchImage& one = images.emplace_back();
    one.frame = index;
    one.image = in_bytes(given->frame.image);
    one.lines = marey::calibrate::ptz::distinct_lines(marey::calibrate::ptz::paint_mask(one.image));
    one.image = one.lines >= kMinLines ? searched_copy(one.image) : Image();
    hooks.advance({"searching for lines", index, feed.info().frame_count.value_or(0)});
  }
  return true;
}

}  // namespace

Image in_bytes(const Image& image) {
  if (image.luma().type() == CV_8UC1) return image;
  cv::Mat bytes;
  image.luma().convertTo(bytes, CV_8U, 1.0 / 257);
  return Image(bytes);
}

PtzStart start_of_video(const corridor::Feed& feed, const geometry::PitchSize& pitch,
                        const marey::calibrate::ptz::TripodSolveOptions& solve, const Hooks& hooks) {
  corridor::Feed ahead = feed.again();
  const auto window = std::max<std::int64_t>(1, std::llround(kSearchWindow * ahead.rate_hz()));
  PtzStart start;
  std::int64_t index = 0;
  for (bool more = true; more;) {
    std::vector<SearchImage> images;
    more = read_search_window(ahead, index, window, images, hooks);
    for (const SearchImage& one : images) {
      if (one.lines > start.lines) start.lines = one.lines, start.frame = one.frame;
    }
    const std::vector<SearchImage> searched = images_with_lines(std::move(images));
    SearchedTripod found = marey::calibrate::ptz::search_tripod(searched, pitch, solve);
    start.ambiguous = start.ambiguous || found.verdict == TripodVerdict::ambiguous;
    if (found.verdict == TripodVerdict::found) {
      start.found = std::move(found);
      return start;
    }
  }
  return start;
}

}  // namespace marey::pipeline::calibrate
