#include "marey/detect/shirts/shirt_network.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <numeric>

#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"
#include "marey/detect/keypoints/model_folder.h"
#include "marey/detect/network/image_tensor.h"

namespace marey::detect::shirts {
namespace {

// The format of the network (script/numbers_to_onnx.py).
constexpr int kCropWidth = 96, kCropHeight = 48, kColumns = 12, kClasses = 6625;
constexpr std::array<std::size_t, kColumnClasses> kClassOf{0, 26, 93, 25, 94, 632, 631, 933, 29, 27, 1109};  // blank, "0" … "9"
constexpr network::PixelRange kPixels{.divisor = 127.5F, .summand = -1};  // [-1, 1], blue first, as it was trained
constexpr const char* kFile = "shirt_numbers.onnx";

constexpr double kPartSide = 0.448;  // by definition: the side of a ShirtRegion's square in statures (shirt_region.cpp)
constexpr double kCropShape = 1.4;   // width over height
// Heights of crops in statures, the middle one first (bench/tuning.md)
constexpr std::array kCropHeights{0.26, 0.20, 0.32};
constexpr double kMinDigits = 0.1;  // legibility of the first crop below which no other one is read

cv::Mat crop_of(const cv::Mat& part, double height) {
  const double scale = part.rows / kPartSide;
  const cv::Size size(std::min(part.cols, static_cast<int>(kCropShape * height * scale)),
                      std::min(part.rows, static_cast<int>(height * scale)));
  const cv::Rect where(cv::Point((part.cols - size.width) / 2, (part.rows - size.height) / 2), size);
  cv::Mat crop;
  cv::resize(part(where), crop, {kCropWidth, kCropHeight}, 0, 0, cv::INTER_AREA);
  return crop;
}

ShirtReading reading_of(const network::Tensor& output) {
  std::array<std::array<double, kColumnClasses>, kColumns> columns{}, digits{};
  for (std::size_t t = 0; t < kColumns; ++t) {
    for (std::size_t k = 0; k < kColumnClasses; ++k) columns[t][k] = output.values[t * kClasses + kClassOf[k]];
    const double sum = std::max(1e-12, std::accumulate(columns[t].begin(), columns[t].end(), 0.0));
    for (std::size_t k = 0; k < kColumnClasses; ++k) digits[t][k] = columns[t][k] / sum;
  }
  const StringProbabilities all = string_likelihoods(columns);
  ShirtReading reading{.strings = string_likelihoods(digits)};
  reading.legibility = std::accumulate(all.begin() + 1, all.end(), 0.0);
  const double total = std::max(1e-12, std::accumulate(reading.strings.begin(), reading.strings.end(), 0.0));
  for (double& probability : reading.strings) probability /= total;
  return reading;
}

}  // namespace

std::string shirt_network_file() {
  try {
    return keypoints::model_file(kFile);
  } catch (const Error&) {
    throw Error(
        "the network {} is not there; script/model --numbers makes it (or install marey-models; MAREY_MODELS names another folder)",
        kFile);
  }
}

ShirtNetwork::ShirtNetwork(const std::string& onnx) : path_(onnx), inference_(onnx, "make it again with script/model --numbers") {
  if (raw(cv::Mat(kCropHeight, kCropWidth, CV_8UC3, cv::Scalar::all(128))).shape != std::vector<int>{1, kColumns, kClasses})
    throw Error("{}: is another network than the one for shirt numbers that script/model --numbers makes", path_);
}

network::Tensor ShirtNetwork::run(network::Inference::Engine& engine, const cv::Mat& crop) const {
  try {
    return std::move(engine.run(network::image_tensor(crop, network::ChannelOrder::bgr, kPixels)).front());
  } catch (const cv::Exception&) {
    throw Error("{}: is another network than the one for shirt numbers that script/model --numbers makes", path_);
  }
}

network::Tensor ShirtNetwork::raw(const cv::Mat& crop) {
  network::Tensor output;
  inference_.each(1, [&](network::Inference::Engine& engine, std::size_t) { output = run(engine, crop); });
  return output;
}

ShirtReading ShirtNetwork::read(network::Inference::Engine& engine, const ShirtView& view) const {
  const cv::Mat part = keypoints::crop_of(view.image, view.region.part);
  ShirtReading mean;
  for (std::size_t i = 0; i < kCropHeights.size(); ++i) {
    const ShirtReading one = reading_of(run(engine, crop_of(part, kCropHeights[i])));
    if (i == 0 && one.legibility < kMinDigits) return one;
    for (std::size_t k = 0; k < one.strings.size(); ++k) mean.strings[k] += one.strings[k] / kCropHeights.size();
    mean.legibility += one.legibility / kCropHeights.size();
  }
  return mean;
}

std::vector<ShirtReading> ShirtNetwork::read(std::span<const ShirtView> views) {
  std::vector<ShirtReading> readings(views.size());
  inference_.each(views.size(), [&](network::Inference::Engine& engine, std::size_t i) { readings[i] = read(engine, views[i]); });
  return readings;
}

}  // namespace marey::detect::shirts
