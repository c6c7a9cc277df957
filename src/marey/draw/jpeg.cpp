#include "marey/draw/jpeg.h"

#include <algorithm>
#include <array>
#include <vector>

#include <opencv2/imgproc.hpp>
#include <turbojpeg.h>

namespace marey::draw {
namespace {

constexpr int kMaxJpegSide = 8192;  // px

/// Luma whose width and height are even, as two by two of it to a chroma pixel are read; the last column and row twice.
cv::Mat evened(const cv::Mat& luma) {
  if (luma.cols % 2 == 0 && luma.rows % 2 == 0) return luma;
  cv::Mat even;
  cv::copyMakeBorder(luma, even, 0, luma.rows % 2, 0, luma.cols % 2, cv::BORDER_REPLICATE);
  return even;
}

/// A plane at `size`, in full range, with its rows one behind the other.
cv::Mat plane_for_jpeg(const cv::Mat& plane, cv::Size size, bool limited, bool chroma) {
  cv::Mat shown;
  if (plane.size() == size) {
    shown = plane;
  } else {
    cv::resize(plane, shown, size, 0, 0, cv::INTER_AREA);
  }
  const double range = !limited ? 1 : chroma ? 255.0 / 224.0 : 255.0 / 219.0;
  const double scale = range * (shown.depth() == CV_16U ? 1.0 / 257.0 : 1.0);
  const double offset = !limited ? 0 : chroma ? 128 * (1 - range) : -16 * range;
  if (scale != 1 || shown.depth() != CV_8U) {
    cv::Mat full;
    shown.convertTo(full, CV_8U, scale, offset);
    return full;
  }
  return shown.isContinuous() ? shown : shown.clone();
}

}  // namespace

JpegEncoder::JpegEncoder() : handle_(tjInitCompress()) {}

JpegEncoder::~JpegEncoder() {
  if (handle_ != nullptr) tjDestroy(handle_);
}

std::string JpegEncoder::encode(const Image& image, int most_width, int quality) {
  if (handle_ == nullptr || image.empty()) return {};
  const cv::Size full = image.size();
  const double scale =
      std::min({1.0, most_width / static_cast<double>(full.width), kMaxJpegSide / static_cast<double>(full.height)});
  const cv::Size size(std::max(1, static_cast<int>(full.width * scale)), std::max(1, static_cast<int>(full.height * scale)));
  const cv::Size half((size.width + 1) / 2, (size.height + 1) / 2);
  const bool limited = image.range() == Image::Range::limited;
  const bool colour = image.is_colour();
  const cv::Mat plain = plane_for_jpeg(image.luma(), size, limited, false), luma = colour ? evened(plain) : plain;
  const cv::Mat cb = colour ? plane_for_jpeg(image.cb(), half, limited, true) : cv::Mat();
  const cv::Mat cr = colour ? plane_for_jpeg(image.cr(), half, limited, true) : cv::Mat();
  std::array<const unsigned char*, 3> planes{luma.data, cb.data, cr.data};
  std::array<int, 3> strides{static_cast<int>(luma.step), static_cast<int>(cb.step), static_cast<int>(cr.step)};
  const int sampling = colour ? TJSAMP_420 : TJSAMP_GRAY;
  const int exact = quality > kToBeObserved ? TJFLAG_ACCURATEDCT : TJFLAG_FASTDCT;
  unsigned long bytes = tjBufSize(size.width, size.height, sampling);
  std::string jpeg(bytes, '\0');
  auto* to = reinterpret_cast<unsigned char*>(jpeg.data());
  if (tjCompressFromYUVPlanes(handle_, planes.data(), size.width, strides.data(), size.height, sampling, &to, &bytes, quality,
                              TJFLAG_NOREALLOC | exact) != 0)
    return {};
  jpeg.resize(bytes);
  return jpeg;
}

}  // namespace marey::draw
