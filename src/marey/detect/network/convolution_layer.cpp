// Two kinds of convolution, which make up most of networks for small processors, faster than OpenCV 4.6 does them.
//
// By channel each value is read 9 or 25 times and nothing else is to be done: what counts is that the sums stay in registers. Each
// channel is copied once into rows with the padding round them, with a stride of two into its even and its odd columns, so that
// every tap of neighbouring outputs lies side by side.
//
// 1 × 1 is a product of matrices. Blocks of pixels are copied together, all channels of a block one after the other, so that they
// stay in the cache while all output channels are computed of them, six at a time.
#include "marey/detect/network/convolution_layer.h"

#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <mutex>
#include <optional>
#include <vector>

#include <opencv2/dnn.hpp>
#include <opencv2/dnn/all_layers.hpp>
#include <opencv2/dnn/layer.details.hpp>

#include "marey/detect/network/convolution_kernel.h"

namespace marey::detect::network {
namespace {

constexpr int kBlock = ConvolutionKernels::kBlock, kRows = ConvolutionKernels::kRows;
using PlainLayer = cv::Ptr<cv::dnn::BaseConvolutionLayer>;

/// What both have: shapes as OpenCV's own layer knows them, and an activation after it.
class OwnConvolution : public cv::dnn::Layer {
 public:
  OwnConvolution(const cv::dnn::LayerParams& params, const PlainLayer& plain) : cv::dnn::Layer(params), plain_(plain) {
    blobs = plain->blobs;
  }

  bool supportBackend(int backend) override { return backend == cv::dnn::DNN_BACKEND_OPENCV; }

  bool getMemoryShapes(const std::vector<cv::dnn::MatShape>& inputs, const int required, std::vector<cv::dnn::MatShape>& outputs,
                       std::vector<cv::dnn::MatShape>& internals) const override {
    return plain_->getMemoryShapes(inputs, required, outputs, internals);
  }

  bool setActivation(const cv::Ptr<cv::dnn::ActivationLayer>& layer) override {
    activation_ = {};
    low_ = -std::numeric_limits<float>::max(), high_ = std::numeric_limits<float>::max();
    if (const auto clip = layer.dynamicCast<cv::dnn::ReLU6Layer>()) {
      low_ = clip->minValue, high_ = clip->maxValue;
    } else if (const auto relu = layer.dynamicCast<cv::dnn::ReLULayer>(); relu && relu->negativeSlope == 0) {
      low_ = 0;
    } else {
      activation_ = layer;
    }
    return !layer.empty();
  }

  void forward(cv::InputArrayOfArrays given, cv::OutputArrayOfArrays made, cv::OutputArrayOfArrays /*internals*/) override {
    std::vector<cv::Mat> inputs, outputs;
    given.getMatVector(inputs);
    made.getMatVector(outputs);
    const int plane = outputs[0].size[2] * outputs[0].size[3];
    for (int image = 0; image < inputs[0].size[0]; ++image) {
      convolve(inputs[0], outputs[0], image);
      if (activation_)
        activation_->forwardSlice(outputs[0].ptr<float>(image), outputs[0].ptr<float>(image), plane,
                                  static_cast<std::size_t>(plane), 0, outputs[0].size[1]);
    }
  }

 protected:
  virtual void convolve(const cv::Mat& input, cv::Mat& output, int image) = 0;
  float bias(int channel) const { return blobs.size() > 1 ? blobs[1].ptr<float>()[channel] : 0; }

  const ConvolutionKernels& kernels_ = convolution_kernels();
  float low_ = -std::numeric_limits<float>::max(), high_ = std::numeric_limits<float>::max();

 private:
  PlainLayer plain_;
  cv::Ptr<cv::dnn::ActivationLayer> activation_;  // one that is not one of the two that the kernels do
};

class DepthwiseConvolution final : public OwnConvolution {
 public:
  DepthwiseConvolution(const cv::dnn::LayerParams& params, const PlainLayer& plain)
      : OwnConvolution(params, plain),
        size_(static_cast<int>(plain->kernel_size[0])),
        stride_(static_cast<int>(plain->strides[0])),
        top_(static_cast<int>(plain->pads_begin[0])),
        left_(static_cast<int>(plain->pads_begin[1])) {}

 private:
  void convolve(const cv::Mat& input, cv::Mat& output, int image) override {
    for (int channel = 0; channel < output.size[1]; ++channel)
      convolve(input.ptr<float>(image, channel), input.size[2], input.size[3], channel, output.ptr<float>(image, channel),
               output.size[2], output.size[3]);
  }

  /// One channel's values with zeros round them, a stride of two as all even columns of a row and then all odd ones.
  void lay_out(const float* values, int rows, int columns, int padded_rows) {
    lane_ = (columns + 2 * size_) / stride_ + 2 * kBlock;
    padded_.assign(static_cast<std::size_t>(padded_rows) * static_cast<std::size_t>(stride_ * lane_), 0);
    for (int y = 0; y < rows && y + top_ < padded_rows; ++y) {
      const float* from = values + static_cast<std::ptrdiff_t>(y) * columns;
      float* to = padded_.data() + static_cast<std::ptrdiff_t>(y + top_) * stride_ * lane_;
      if (stride_ == 1) {
        std::memcpy(to + left_, from, static_cast<std::size_t>(columns) * sizeof(float));
        continue;
      }
      for (int x = 0; x < columns; ++x) {
        const int at = x + left_;
        to[(at & 1) * lane_ + at / 2] = from[x];
      }
    }
  }

  void convolve(const float* values, int rows, int columns, int channel, float* out, int out_rows, int out_columns) {
    lay_out(values, rows, columns, (out_rows - 1) * stride_ + size_);
    line_.resize(static_cast<std::size_t>(out_columns + kBlock));
    const float* weights = blobs[0].ptr<float>() + static_cast<std::ptrdiff_t>(channel) * size_ * size_;
    DepthwiseRows taps;
    for (int y = 0; y < out_rows; ++y) {
      for (int r = 0; r < size_; ++r) {
        const float* row = padded_.data() + static_cast<std::ptrdiff_t>(y * stride_ + r) * stride_ * lane_;
        for (int k = 0; k < size_; ++k) taps.taps[r][k] = stride_ == 1 ? row + k : row + (k & 1) * lane_ + k / 2;
      }
      kernels_.by_channel(taps, weights, size_, bias(channel), low_, high_, out_columns, line_.data());
      std::memcpy(out + static_cast<std::ptrdiff_t>(y) * out_columns, line_.data(),
                  static_cast<std::size_t>(out_columns) * sizeof(float));
    }
  }

  int size_, stride_, top_, left_;
  int lane_ = 0;  // values from one row, or half of a row, to the next
  std::vector<float> padded_, line_;
};

class PointConvolution final : public OwnConvolution {
 public:
  PointConvolution(const cv::dnn::LayerParams& params, const PlainLayer& plain)
      : OwnConvolution(params, plain), outputs_(plain->numOutput), inputs_(plain->blobs[0].size[1]) {
    const auto groups = static_cast<std::size_t>((outputs_ + kRows - 1) / kRows);
    weights_.assign(groups * static_cast<std::size_t>(inputs_ * kRows), 0);
    biases_.assign(groups * kRows, 0);
    for (int o = 0; o < outputs_; ++o) {
      biases_[static_cast<std::size_t>(o)] = bias(o);
      for (int i = 0; i < inputs_; ++i)
        weights_[static_cast<std::size_t>((o / kRows * inputs_ + i) * kRows + o % kRows)] = blobs[0].ptr<float>()[o * inputs_ + i];
    }
  }

 private:
  void convolve(const cv::Mat& input, cv::Mat& output, int image) override {
    const int pixels = output.size[2] * output.size[3];
    block_.resize(static_cast<std::size_t>(inputs_ * kBlock));
    std::vector<float> rest(static_cast<std::size_t>(kRows * kBlock));
    for (int begin = 0; begin < pixels; begin += kBlock) {
      const int width = std::min(kBlock, pixels - begin);
      for (int i = 0; i < inputs_; ++i)
        std::memcpy(block_.data() + static_cast<std::ptrdiff_t>(i) * kBlock, input.ptr<float>(image, i) + begin,
                    static_cast<std::size_t>(width) * sizeof(float));
      for (int o = 0; o < outputs_; o += kRows) {
        const int rows = std::min(kRows, outputs_ - o);
        const bool whole = rows == kRows && width == kBlock;
        float* out = output.ptr<float>(image, o) + begin;
        kernels_.point(block_.data(), weights_.data() + static_cast<std::ptrdiff_t>(o) * inputs_, inputs_, biases_.data() + o, low_,
                       high_, whole ? out : rest.data(), whole ? pixels : kBlock);
        for (int r = 0; !whole && r < rows; ++r)
          std::memcpy(out + static_cast<std::ptrdiff_t>(r) * pixels, rest.data() + static_cast<std::ptrdiff_t>(r) * kBlock,
                      static_cast<std::size_t>(width) * sizeof(float));
      }
    }
  }

  int outputs_, inputs_;
  std::vector<float> weights_, biases_;  // six output channels together, zeros behind the last
  std::vector<float> block_;
};

bool all_in(const std::vector<std::size_t>& values, std::initializer_list<std::size_t> allowed) {
  return values.size() == 2 && values[0] == values[1] && std::find(allowed.begin(), allowed.end(), values[0]) != allowed.end();
}

cv::Ptr<cv::dnn::Layer> make_convolution(cv::dnn::LayerParams& params) {
  const PlainLayer plain = cv::dnn::ConvolutionLayer::create(params);
  if (plain->blobs.empty() || !plain->padMode.empty() || !all_in(plain->dilations, {1}) || plain->pads_begin.size() != 2)
    return plain;
  const cv::Mat& weights = plain->blobs[0];
  if (weights.dims != 4 || weights.type() != CV_32F || !weights.isContinuous() || weights.size[0] != plain->numOutput) return plain;
  if (plain->blobs.size() > 1 && plain->blobs[1].type() != CV_32F) return plain;
  const int groups = params.get<int>("group", 1);
  if (groups > 1 && groups == plain->numOutput && weights.size[1] == 1 && all_in(plain->kernel_size, {3, 5}) &&
      all_in(plain->strides, {1, 2}))
    return cv::makePtr<DepthwiseConvolution>(params, plain);
  const bool padded = plain->pads_begin[0] + plain->pads_begin[1] + plain->pads_end[0] + plain->pads_end[1] > 0;
  if (groups == 1 && !padded && all_in(plain->kernel_size, {1}) && all_in(plain->strides, {1}))
    return cv::makePtr<PointConvolution>(params, plain);
  return plain;
}

}  // namespace

void use_own_convolutions() {
  static std::once_flag once;
  std::call_once(once, [] { cv::dnn::LayerFactory::registerLayer("Convolution", make_convolution); });
}

}  // namespace marey::detect::network
