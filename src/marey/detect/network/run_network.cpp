#include "marey/detect/network/run_network.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <opencv2/dnn.hpp>
#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"

namespace marey::detect::network {

namespace {

constexpr double kGrey = 114;  // format: the networks were trained with it round an image in its letterbox

/// Where an image lies in the network's: px there = offset + scale · px of the image.
struct Fitted {
  double scale_x = 1, scale_y = 1, left = 0, top = 0;
};

Fitted fitted(cv::Size image, const NetworkModel& model) {
  const double x = static_cast<double>(model.input.width) / image.width, y = static_cast<double>(model.input.height) / image.height;
  if (*model.resize == NetworkModel::Resize::segment) return {x, y, 0, 0};
  const double scale = std::min(x, y);
  Fitted fit{scale, scale, 0, 0};
  if (*model.resize == NetworkModel::Resize::letterbox) {
    fit.left = std::floor((model.input.width - std::round(scale * image.width)) / 2);
    fit.top = std::floor((model.input.height - std::round(scale * image.height)) / 2);
  }
  return fit;
}

cv::Mat located(const cv::Mat& bgr, const Fitted& fit, const NetworkModel& model) {
  const cv::Size size(std::max(1, static_cast<int>(std::lround(fit.scale_x * bgr.cols))),
                      std::max(1, static_cast<int>(std::lround(fit.scale_y * bgr.rows))));
  cv::Mat resized;
  cv::resize(bgr, resized, size, 0, 0, fit.scale_x < 1 ? cv::INTER_AREA : cv::INTER_LINEAR);
  if (size == model.input) return resized;
  cv::Mat whole(model.input, CV_8UC3, cv::Scalar::all(kGrey));
  const cv::Rect where(cv::Point(static_cast<int>(fit.left), static_cast<int>(fit.top)), size);
  const cv::Rect inside = where & cv::Rect(cv::Point(), model.input);
  resized(cv::Rect(cv::Point(), inside.size())).copyTo(whole(inside));
  return whole;
}

/// 1×3×h×w of floats.
cv::Mat planes_of(const cv::Mat& image, const NetworkModel& model) {
  cv::Mat blob = cv::dnn::blobFromImage(image, 1, image.size(), {}, *model.rgb);
  const std::size_t plane = static_cast<std::size_t>(image.rows) * static_cast<std::size_t>(image.cols);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto scale = static_cast<float>(*model.scale / (*model.deviation)[c]);
    const auto shift = static_cast<float>((*model.mean)[c] / (*model.deviation)[c]);
    float* values = blob.ptr<float>() + c * plane;
    for (std::size_t i = 0; i < plane; ++i) values[i] = values[i] * scale - shift;
  }
  return blob;
}

/// What the layout's networks are usually given, where the model's file does not specify.
void fill_default(NetworkModel& model) {
  const Layout layout = *model.layout;
  const bool ssd = layout == Layout::ssd_raw || layout == Layout::ssd;
  const bool detr = layout == Layout::rt_detr || layout == Layout::rf_detr;
  const bool raw_colours = layout == Layout::yolox || layout == Layout::nanodet;
  using Resize = NetworkModel::Resize;
  if (!model.resize) model.resize = ssd || detr ? Resize::segment : layout == Layout::yolox ? Resize::corner : Resize::letterbox;
  if (!model.rgb) model.rgb = !raw_colours;
  const bool stated = model.mean || model.deviation;
  if (!model.scale) model.scale = ssd ? 1 / 127.5 : raw_colours ? 1 : 1 / 255.0;
  if (!model.mean) {
    model.mean = ssd ? std::array<double, 3>{1, 1, 1} : std::array<double, 3>{};
    if (layout == Layout::nanodet && !stated) model.mean = {103.53, 116.28, 123.675};
    if (layout == Layout::rf_detr && !stated) model.mean = {0.485, 0.456, 0.406};
  }
  if (!model.deviation) {
    model.deviation = {1, 1, 1};
    if (layout == Layout::nanodet && !stated) model.deviation = {57.375, 57.12, 58.395};
    if (layout == Layout::rf_detr && !stated) model.deviation = {0.229, 0.224, 0.225};
  }
}

/// The network's own file, where it is there.
std::string there(const NetworkModel& model) {
  if (!std::filesystem::is_regular_file(model.network)) throw Error("{}: its network {} is not there", model.path, model.network);
  return model.network;
}

}  // namespace

LoadedNetwork::LoadedNetwork(const NetworkModel& model) : model_(model), inference_(there(model)) {
  NetworkModel trial = model_;
  if (!trial.layout) trial.layout = Layout::yolov8;
  fill_default(trial);
  std::swap(model_, trial);
  std::vector<Tensor> outputs;
  inference_.each(1, [&](Inference::Engine& engine, std::size_t) {
    outputs = run(engine, cv::Mat(model_.input, CV_8UC3, cv::Scalar::all(kGrey)));
  });
  std::swap(model_, trial);
  if (!model_.layout) model_.layout = layout_of(outputs, model_.input);
  if (!model_.layout)
    throw Error("{}: the outputs of {} are of no known layout; say layout = one of {}, if it is a detector", model_.path,
                model_.network, layout_names());
  fill_default(model_);
  try {
    candidates_of(outputs, *model_.layout, model_.input, model_.person, model_.score);
  } catch (const Error& error) {
    throw Error("{}: {}", model_.path, error.what());
  }
}

std::vector<Tensor> LoadedNetwork::run(Inference::Engine& engine, const cv::Mat& bgr) const {
  try {
    return engine.run(planes_of(located(bgr, fitted(bgr.size(), model_), model_), model_));
  } catch (const cv::Exception& error) {
    throw Error("{}: does not run on images of {}x{} px ({}); is input in {} what the network wants?", model_.network,
                model_.input.width, model_.input.height, reason_of(error), model_.path);
  }
}

std::vector<Candidate> LoadedNetwork::find(Inference::Engine& engine, const cv::Mat& bgr) const {
  std::vector<Candidate> found = candidates_of(run(engine, bgr), *model_.layout, model_.input, model_.person, model_.score);
  const Fitted fit = fitted(bgr.size(), model_);
  for (Candidate& one : found) {
    one.left = (one.left - fit.left) / fit.scale_x, one.right = (one.right - fit.left) / fit.scale_x;
    one.top = (one.top - fit.top) / fit.scale_y, one.bottom = (one.bottom - fit.top) / fit.scale_y;
  }
  return found;
}

std::vector<Candidate> LoadedNetwork::find(const cv::Mat& bgr) {
  return find_all({&bgr, 1}).front();
}

std::vector<std::vector<Candidate>> LoadedNetwork::find_all(std::span<const cv::Mat> images) {
  std::vector<std::vector<Candidate>> found(images.size());
  inference_.each(images.size(), [&](Inference::Engine& engine, std::size_t i) { found[i] = find(engine, images[i]); });
  return found;
}

}  // namespace marey::detect::network
