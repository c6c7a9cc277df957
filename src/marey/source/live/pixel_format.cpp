#include "marey/source/live/pixel_format.h"

#include <algorithm>

namespace marey::source::live {
namespace {

/// Luma as it is; of chroma, every second row: the rows between are as good, and the difference is not visible at half size.
Image unpacked_yuyv(std::span<const std::uint8_t> bytes, cv::Size size, std::size_t stride) {
  const cv::Size half((size.width + 1) / 2, (size.height + 1) / 2);
  cv::Mat luma(size, CV_8UC1), cb(half, CV_8UC1), cr(half, CV_8UC1);
  for (int y = 0; y < size.height; ++y) {
    const std::uint8_t* row = bytes.data() + static_cast<std::size_t>(y) * stride;
    auto* bright = luma.ptr<std::uint8_t>(y);
    for (int x = 0; x < size.width; ++x) bright[x] = row[2 * x];
    if (y % 2 != 0) continue;
    auto* blue = cb.ptr<std::uint8_t>(y / 2);
    auto* red = cr.ptr<std::uint8_t>(y / 2);
    for (int x = 0; x < half.width; ++x) blue[x] = row[4 * x + 1], red[x] = row[4 * x + 3];
  }
  return {luma, cb, cr, Image::Range::limited};
}

}  // namespace

std::optional<Image> unpack(Packing packing, std::span<const std::uint8_t> bytes, cv::Size size, std::size_t stride) {
  const auto width = static_cast<std::size_t>(size.width), height = static_cast<std::size_t>(size.height);
  const std::size_t row = packing == Packing::grey ? width : 4 * ((width + 1) / 2);
  if (height == 0 || stride < row || bytes.size() < (height - 1) * stride + row) return std::nullopt;
  if (packing == Packing::yuyv) return unpacked_yuyv(bytes, size, stride);
  cv::Mat luma(size, CV_8UC1);
  for (int y = 0; y < size.height; ++y)
    std::copy_n(bytes.data() + static_cast<std::size_t>(y) * stride, width, luma.ptr<std::uint8_t>(y));
  return Image(luma);
}

}  // namespace marey::source::live
