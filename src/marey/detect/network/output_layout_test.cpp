#include "marey/detect/network/output_layout.h"

#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::detect::network {
namespace {

const cv::Size kInput(320, 320);
constexpr int kClasses = 80, kRequired = 2;
constexpr double kX = 150, kY = 110, kW = 40, kH = 96;  // one person: centre and size, px

Tensor zeros(const std::string& name, std::vector<int> shape, float value = 0) {
  std::size_t count = 1;
  for (const int side : shape) count *= static_cast<std::size_t>(side);
  return {name, std::move(shape), std::vector<float>(count, value)};
}

void put(Tensor& tensor, std::size_t row, std::initializer_list<double> values) {
  const auto columns = static_cast<std::size_t>(tensor.shape.back());
  std::size_t at = row * columns;
  for (const double value : values) tensor.values[at++] = static_cast<float>(value);
}

void expect_the_person(const std::vector<Tensor>& outputs, Layout layout) {
  EXPECT_EQ(layout_of(outputs, kInput), layout) << layout_name(layout);
  const auto found = candidates_of(outputs, layout, kInput, kRequired, 0.5);
  ASSERT_EQ(found.size(), 1U) << layout_name(layout);
  EXPECT_NEAR(found[0].left, kX - kW / 2, 0.5) << layout_name(layout);
  EXPECT_NEAR(found[0].right, kX + kW / 2, 0.5) << layout_name(layout);
  EXPECT_NEAR(found[0].top, kY - kH / 2, 0.5) << layout_name(layout);
  EXPECT_NEAR(found[0].bottom, kY + kH / 2, 0.5) << layout_name(layout);
  EXPECT_NEAR(found[0].score, 0.81, 0.01) << layout_name(layout);
  EXPECT_TRUE(candidates_of(outputs, layout, kInput, kRequired, 0.9).empty());
  EXPECT_TRUE(candidates_of(outputs, layout, kInput, kRequired + 1, 0.5).empty());
}

TEST(OutputLayout, Yolov5) {
  Tensor out = zeros("output", {1, 3 * 2100, 5 + kClasses});
  put(out, 1234, {kX, kY, kW, kH, 0.9, 0, 0, 0.9});
  expect_the_person({out}, Layout::yolov5);
}

TEST(OutputLayout, Yolox) {
  Tensor out = zeros("output", {1, 2100, 5 + kClasses});
  const std::size_t row = 1600 + 6 * 20 + 9;  // stride 16, cell (9, 6)
  put(out, row, {kX / 16 - 9, kY / 16 - 6, std::log(kW / 16), std::log(kH / 16), 0.9, 0, 0, 0.9});
  expect_the_person({out}, Layout::yolox);
}

TEST(OutputLayout, Yolov8) {
  Tensor out = zeros("output0", {1, 4 + kClasses, 2100});
  const double values[] = {kX, kY, kW, kH, 0, 0, 0.81};
  for (std::size_t i = 0; i < 7; ++i) out.values[i * 2100 + 777] = static_cast<float>(values[i]);
  expect_the_person({out}, Layout::yolov8);
}

TEST(OutputLayout, SuppressedInside) {
  Tensor out = zeros("output0", {1, 300, 6});
  put(out, 3, {kX - kW / 2, kY - kH / 2, kX + kW / 2, kY + kH / 2, 0.81, kRequired});
  expect_the_person({out}, Layout::suppressed);
}

TEST(OutputLayout, NanoDet) {
  Tensor out = zeros("output", {1, 1600 + 400 + 100 + 25, kClasses + 32}, -30);
  const std::size_t row = 1600 + 400 + 3 * 10 + 5;  // stride 32, its point (160, 96)
  put(out, row, {0, 0, 0.81});
  const double sides[] = {160 - (kX - kW / 2), 96 - (kY - kH / 2), kX + kW / 2 - 160, kY + kH / 2 - 96};
  for (std::size_t side = 0; side < 4; ++side) {  // between two whole distances
    const double cells = sides[side] / 32;
    const auto low = static_cast<std::size_t>(cells);
    float* bins = out.values.data() + row * (kClasses + 32) + kClasses + side * 8;
    bins[low] = static_cast<float>(std::log(1 - (cells - static_cast<double>(low)) + 1e-9));
    bins[low + 1] = static_cast<float>(std::log(cells - static_cast<double>(low) + 1e-9));
  }
  expect_the_person({out}, Layout::nanodet);
}

TEST(OutputLayout, SsdAfterItsPostProcessing) {
  Tensor boxes = zeros("TFLite_Detection_PostProcess", {1, 10, 4}), classes = zeros("TFLite_Detection_PostProcess:1", {1, 10});
  Tensor scores = zeros("TFLite_Detection_PostProcess:2", {1, 10}), count = zeros("TFLite_Detection_PostProcess:3", {1}, 1);
  put(boxes, 0, {(kY - kH / 2) / 320, (kX - kW / 2) / 320, (kY + kH / 2) / 320, (kX + kW / 2) / 320});
  classes.values[0] = kRequired, scores.values[0] = 0.81F;
  expect_the_person({boxes, classes, scores, count}, Layout::ssd);
}

TEST(OutputLayout, DetectionOutput) {
  Tensor out = zeros("detection_out", {1, 1, 100, 7});
  put(out, 4, {0, kRequired, 0.81, (kX - kW / 2) / 320, (kY - kH / 2) / 320, (kX + kW / 2) / 320, (kY + kH / 2) / 320});
  expect_the_person({out}, Layout::ssd);
}

TEST(OutputLayout, SsdBeforeIt) {
  const int anchors = (400 + 0) * 3 + (100 + 25 + 9 + 4 + 1) * 6;
  Tensor boxes = zeros("boxes", {1, anchors, 4}), logits = zeros("logits", {1, anchors, 24}, -20);
  const std::size_t row =
      400 * 3 + 6 * (3 * 10 + 4) + 2;  // layer 2, scale 0.35, ratio 1/2: 79.2 px wide, 158.4 high, over (144, 112)
  const double height = 0.35 / std::sqrt(0.5) * 320, width = 0.35 * std::sqrt(0.5) * 320;
  put(boxes, row, {(kY - 112) / height * 10, (kX - 144) / width * 10, std::log(kH / height) * 5, std::log(kW / width) * 5});
  logits.values[row * 24 + kRequired] = static_cast<float>(std::log(0.81 / 0.19));
  expect_the_person({boxes, logits}, Layout::ssd_raw);
  expect_the_person({logits, boxes}, Layout::ssd_raw);
}

TEST(OutputLayout, RtDetr) {
  Tensor labels = zeros("labels", {1, 300}), boxes = zeros("boxes", {1, 300, 4}), scores = zeros("scores", {1, 300});
  put(boxes, 7, {kX - kW / 2, kY - kH / 2, kX + kW / 2, kY + kH / 2});
  labels.values[7] = kRequired, scores.values[7] = 0.81F;
  expect_the_person({labels, boxes, scores}, Layout::rt_detr);
  expect_the_person({scores, labels, boxes}, Layout::rt_detr);
}

TEST(OutputLayout, RfDetr) {
  Tensor boxes = zeros("dets", {1, 300, 4}), logits = zeros("labels", {1, 300, 91}, -20);
  put(boxes, 7, {kX / 320, kY / 320, kW / 320, kH / 320});
  logits.values[7 * 91 + kRequired] = static_cast<float>(std::log(0.81 / 0.19));
  expect_the_person({boxes, logits}, Layout::rf_detr);
}

TEST(OutputLayout, NonDetectorHasNoLayout) {
  EXPECT_FALSE(layout_of(std::vector{zeros("prob", {1, 1000})}, kInput));
  EXPECT_FALSE(layout_of(std::vector{zeros("heat", {1, 17, 48, 64})}, kInput));
  EXPECT_FALSE(layout_of(std::vector<Tensor>{}, kInput));
}

TEST(OutputLayout, AContradictionIsSaid) {
  const auto refused = [](const std::vector<Tensor>& outputs, Layout layout, int required) -> std::string {
    try {
      candidates_of(outputs, layout, kInput, required, 0.5);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refused({zeros("a", {1, 77, 85})}, Layout::yolox, 0), "the network's outputs (1x77x85) are not of the layout yolox");
  EXPECT_EQ(refused({zeros("a", {1, 6300, 85})}, Layout::yolov5, 80),
            "the network's outputs (1x6300x85) are not of the layout yolov5");
  EXPECT_EQ(refused({zeros("a", {1, 10, 4}), zeros("b", {1, 9})}, Layout::ssd, 0),
            "the network's outputs (1x10x4, 1x9) are not of the layout ssd");
}

}  // namespace
}  // namespace marey::detect::network
