#include "marey/detect/keypoints/landmark_network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "marey/core/error.h"
#include "marey/detect/keypoints/blazepose.h"
#include "marey/detect/keypoints/heat_map.h"
#include "marey/detect/network/image_tensor.h"

namespace marey::detect::keypoints {
namespace {

constexpr int kPoints = 33, kAll = 39, kNumbers = 5;
constexpr std::size_t kHips = 33, kRim = 34;  // points that say where the person is
constexpr int kCells = 64;                    // format of the network: a heat map's side
const std::array<std::string, 3> kOutputs{"landmarks", "presence", "heatmaps"};
const std::array<std::string, 2> kPixels{"mask", "presence"};

double likelihood_of(float logit) {
  return 1 / (1 + std::exp(-static_cast<double>(logit)));
}

std::string regular(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) throw Error("{}: is not there; script/model makes the networks for keypoints", path);
  return path;
}

}  // namespace

LandmarkNetwork::LandmarkNetwork(const std::string& onnx)
    : path_(onnx), inference_(regular(onnx), "make it again with script/model") {
  const std::vector<network::Tensor> outputs =
      raw(cv::Mat(PersonRegion::kCrop, PersonRegion::kCrop, CV_8UC3, cv::Scalar::all(128)));
  const std::vector<std::vector<int>> expected{{1, kAll * kNumbers}, {1, 1}, {1, kAll, kCells, kCells}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (outputs[i].shape != expected[i])
      throw Error("{}: is another network than those for keypoints that script/model makes", path_);
  }
}

std::vector<network::Tensor> LandmarkNetwork::run(network::Inference::Engine& engine, const cv::Mat& crop,
                                                  std::span<const std::string> outputs) const {
  try {
    return engine.run(network::image_tensor(crop, network::ChannelOrder::rgb, {}), outputs);
  } catch (const cv::Exception&) {
    throw Error("{}: is another network than those for keypoints that script/model makes", path_);
  }
}

std::vector<network::Tensor> LandmarkNetwork::raw(const cv::Mat& crop) {
  std::vector<network::Tensor> outputs;
  inference_.each(1, [&](network::Inference::Engine& engine, std::size_t) { outputs = run(engine, crop, kOutputs); });
  return outputs;
}

std::vector<Body> LandmarkNetwork::find(const cv::Mat& bgr, std::span<const PersonRegion> regions) {
  std::vector<Body> bodies(regions.size());
  inference_.each(regions.size(), [&](network::Inference::Engine& engine, std::size_t i) {
    bodies[i] = body_of(run(engine, crop_of(bgr, regions[i]), kOutputs), regions[i]);
  });
  return bodies;
}

std::vector<Body> LandmarkNetwork::find(std::span<const ImageRegion> searched) {
  std::vector<Body> bodies(searched.size());
  inference_.each(searched.size(), [&](network::Inference::Engine& engine, std::size_t i) {
    bodies[i] = body_of(run(engine, crop_of(searched[i].image, searched[i].region), kOutputs), searched[i].region);
  });
  return bodies;
}

std::vector<BodyPixels> LandmarkNetwork::pixels(std::span<const ImageRegion> searched) {
  std::vector<BodyPixels> found(searched.size());
  inference_.each(searched.size(), [&](network::Inference::Engine& engine, std::size_t i) {
    const auto outputs = run(engine, crop_of(searched[i].image, searched[i].region), kPixels);
    found[i] = pixels_of(outputs, searched[i].region);
  });
  return found;
}

BodyPixels pixels_of(std::span<const network::Tensor> outputs, const PersonRegion& region) {
  constexpr auto kAllPixels = static_cast<std::size_t>(PersonRegion::kCrop) * PersonRegion::kCrop;  // by definition
  const std::vector<float>& logits = outputs[0].values;
  if (logits.size() != kAllPixels)
    throw Error("a landmark network whose mask has {} pixels in place of {}", logits.size(), kAllPixels);
  BodyPixels pixels{.chance = cv::Mat(PersonRegion::kCrop, PersonRegion::kCrop, CV_32FC1),
                    .presence = outputs[1].values.front(),
                    .region = region};
  std::transform(logits.begin(), logits.end(), pixels.chance.begin<float>(),
                 [](float logit) { return static_cast<float>(likelihood_of(logit)); });
  return pixels;
}

Body body_of(std::span<const network::Tensor> outputs, const PersonRegion& region) {
  const std::vector<float>& numbers = outputs[0].values;
  const auto given = [&](std::size_t point) { return Vector<2>(numbers[kNumbers * point], numbers[kNumbers * point + 1]); };
  const Matrix<2> turn = region.turn();
  Body body;
  body.keypoints.presence = outputs[1].values.front();
  for (std::size_t i = 0; i < kPoints; ++i) {
    constexpr std::size_t kMap = static_cast<std::size_t>(kCells) * kCells;  // by definition
    const HeatPoint found = point_in(std::span(outputs[2].values).subspan(i * kMap, kMap), kCells,
                                     static_cast<double>(PersonRegion::kCrop) / kCells, given(i));
    body.keypoints.points.push_back(Keypoint<2>{.position = region.in_image(found.location),
                                                .covariance = turn * found.covariance * turn.transpose(),
                                                .visibility = likelihood_of(numbers[kNumbers * i + 3]),
                                                .presence = likelihood_of(numbers[kNumbers * i + 4])});
  }
  body.next = region_of(region.in_image(given(kHips)), region.in_image(given(kRim)));
  return body;
}

}  // namespace marey::detect::keypoints
