#include "marey/detect/blobs/filter_bank.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace marey::detect::blobs {
namespace {

// Of the two Gaussians of which the Mexican hat is the difference: by definition (Marr & Hildreth 1980).
constexpr double kHatRatio = 1.6;

constexpr float kBlack = 16, kWhite = 235, kFull = 255;  // of luma in video

/// Blurs a plane and writes the responses at the grid's points as channels `blurred` and `hat`. `scale`: the plane's px in one of
/// the image.
void filter_plane(const cv::Mat& plane, double scale, int step, int channel, float offset, float gain, cv::Mat& responses) {
  const double sigma = std::max(0.5 * step * scale, 0.4);
  cv::Mat narrow, wide;
  cv::GaussianBlur(plane, narrow, {}, sigma, sigma, cv::BORDER_REPLICATE);
  cv::GaussianBlur(plane, wide, {}, kHatRatio * sigma, kHatRatio * sigma, cv::BORDER_REPLICATE);
  const auto nearest = [&](int index, int size) {
    const double at = index * step + 0.5 * (step - 1);
    return std::clamp(static_cast<int>(std::lround((at + 0.5) * scale - 0.5)), 0, size - 1);
  };
  for (int row = 0; row < responses.rows; ++row) {
    const int y = nearest(row, plane.rows);
    Response* out = responses.ptr<Response>(row);
    for (int column = 0; column < responses.cols; ++column) {
      const int x = nearest(column, plane.cols);
      const float blurred = narrow.at<float>(y, x);
      out[column][channel] = (blurred - offset) * gain;
      out[column][channel + 3] = (blurred - wide.at<float>(y, x)) * gain;
    }
  }
}

cv::Mat as_float(const cv::Mat& plane) {
  cv::Mat result;
  plane.convertTo(result, CV_32F, plane.depth() == CV_16U ? 1 / 257.0 : 1.0);
  return result;
}

}  // namespace

cv::Size grid_size(cv::Size image, int step) {
  return {std::max(1, image.width / step), std::max(1, image.height / step)};
}

cv::Mat filter_responses(const Image& image, int step) {
  cv::Mat responses(grid_size(image.size(), step), CV_32FC(kResponses), cv::Scalar::all(0));
  const bool limited = image.range() == Image::Range::limited;
  filter_plane(as_float(image.luma()), 1, step, 0, limited ? kBlack : 0, limited ? kFull / (kWhite - kBlack) : 1, responses);
  if (!image.is_colour()) {
    for (int row = 0; row < responses.rows; ++row) {
      for (int column = 0; column < responses.cols; ++column)
        responses.at<Response>(row, column)[1] = responses.at<Response>(row, column)[2] = 128;
    }
    return responses;
  }
  filter_plane(as_float(image.cb()), 0.5, step, 1, 0, 1, responses);
  filter_plane(as_float(image.cr()), 0.5, step, 2, 0, 1, responses);
  return responses;
}

}  // namespace marey::detect::blobs
