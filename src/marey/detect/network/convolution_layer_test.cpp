#include "marey/detect/network/convolution_layer.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/dnn.hpp>

namespace marey::detect::network {
namespace {

struct Shape {
  int inputs, outputs, groups, size, stride, pad;
  cv::Size image;
};

cv::Mat random_values(std::vector<int> sizes, std::mt19937& random) {
  cv::Mat values(static_cast<int>(sizes.size()), sizes.data(), CV_32F);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (std::size_t i = 0; i < values.total(); ++i) values.ptr<float>()[i] = uniform(random);
  return values;
}

/// The definition, term by term.
float plain_convolution(const cv::Mat& input, const cv::Mat& weights, const cv::Mat& bias, const Shape& shape, int output, int y,
                        int x) {
  double sum = bias.ptr<float>()[output];
  const int of_group = shape.inputs / shape.groups, first = output / (shape.outputs / shape.groups) * of_group;
  for (int i = 0; i < of_group; ++i) {
    for (int r = 0; r < shape.size; ++r) {
      for (int k = 0; k < shape.size; ++k) {
        const int row = y * shape.stride + r - shape.pad, column = x * shape.stride + k - shape.pad;
        if (row < 0 || column < 0 || row >= input.size[2] || column >= input.size[3]) continue;
        sum += static_cast<double>(weights.ptr<float>(output, i)[r * shape.size + k]) *
               static_cast<double>(input.ptr<float>(0, first + i)[row * input.size[3] + column]);
      }
    }
  }
  return static_cast<float>(sum);
}

void check_convolution(const Shape& shape, bool clipped, std::mt19937& random) {
  const cv::Mat input = random_values({1, shape.inputs, shape.image.height, shape.image.width}, random);
  const cv::Mat weights = random_values({shape.outputs, shape.inputs / shape.groups, shape.size, shape.size}, random);
  const cv::Mat bias = random_values({shape.outputs}, random);
  cv::dnn::LayerParams params;
  params.set("num_output", shape.outputs);
  params.set("kernel_size", shape.size);
  params.set("stride", shape.stride);
  params.set("pad", shape.pad);
  params.set("group", shape.groups);
  params.blobs = {weights, bias};
  cv::dnn::Net net;
  net.addLayerToPrev("c", "Convolution", params);
  cv::dnn::LayerParams clip;
  clip.set("min_value", -0.5F);
  clip.set("max_value", 1.0F);
  if (clipped) net.addLayerToPrev("a", "ReLU6", clip);
  net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
  net.setInput(input);
  const cv::Mat output = net.forward();
  ASSERT_EQ(output.size[1], shape.outputs);
  for (int o = 0; o < shape.outputs; ++o) {
    for (int y = 0; y < output.size[2]; ++y) {
      for (int x = 0; x < output.size[3]; ++x) {
        float due = plain_convolution(input, weights, bias, shape, o, y, x);
        if (clipped) due = std::min(1.0F, std::max(-0.5F, due));
        ASSERT_NEAR(output.ptr<float>(0, o)[y * output.size[3] + x], due, 1e-4) << "channel " << o << " at " << x << ", " << y;
      }
    }
  }
}

TEST(OwnConvolutions, AreWhatTheDefinitionSays) {
  use_own_convolutions();
  std::mt19937 random(5);
  for (const bool clipped : {false, true}) {
    for (const Shape& shape :
         {Shape{8, 8, 8, 3, 1, 1, {64, 64}}, Shape{3, 3, 3, 5, 1, 2, {17, 9}}, Shape{5, 5, 5, 5, 2, 2, {33, 31}},
          Shape{4, 4, 4, 3, 2, 0, {65, 65}}, Shape{4, 4, 4, 3, 2, 1, {16, 40}}, Shape{2, 2, 2, 5, 1, 0, {5, 5}},
          Shape{7, 13, 1, 1, 1, 0, {9, 7}}, Shape{24, 36, 1, 1, 1, 0, {16, 16}}, Shape{1, 1, 1, 1, 1, 0, {1, 1}},
          Shape{6, 8, 2, 1, 1, 0, {8, 8}}, Shape{6, 8, 1, 1, 2, 0, {8, 8}}, Shape{3, 8, 1, 3, 2, 1, {20, 20}},
          Shape{4, 8, 4, 3, 1, 1, {20, 20}}}) {
      SCOPED_TRACE(testing::Message() << shape.inputs << " to " << shape.outputs << ", " << shape.groups << " groups, "
                                      << shape.size << " taps, stride " << shape.stride << (clipped ? ", clipped" : ""));
      check_convolution(shape, clipped, random);
    }
  }
}

}  // namespace
}  // namespace marey::detect::network
