#include "marey/detect/network/own_network.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace marey::detect::network {
namespace {

constexpr int kBlockPixels = 64;  // numerical: pixels of which all channels are written together: they stay in the cache
constexpr LayerKernels::Limits kUnlimited{-std::numeric_limits<float>::max(), std::numeric_limits<float>::max()};

/// The first and the one behind the last output of which all taps lie within `length` values.
std::pair<int, int> inner(int length, int before, int size, int stride, int outputs) {
  const int first = std::min(outputs, (before + stride - 1) / stride);
  const int room = length + before - size;
  return {first, std::max(first, room < 0 ? 0 : std::min(outputs, room / stride + 1))};
}

}  // namespace

OwnNetwork::OwnNetwork(LayerPlan plan, const LayerKernels& kernels) : plan_(std::move(plan)), kernels_(&kernels) {
  for (const std::size_t size : plan_.buffer_sizes) buffers_.emplace_back(size, 0.0F);
}

void OwnNetwork::take(const float* planes) {
  const LayerValue& input = plan_.values[0];
  const std::size_t plane = static_cast<std::size_t>(input.rows) * static_cast<std::size_t>(input.columns);
  const auto channels = static_cast<std::size_t>(input.channels);
  float* to = at(0);
  for (std::size_t i = 0; i < plane; ++i) {
    for (std::size_t c = 0; c < channels; ++c) to[i * channels + c] = planes[c * plane + i];
  }
}

void OwnNetwork::dense(const Layer& layer) {
  const LayerValue &from = plan_.values[layer.from[0]], &to = plan_.values[layer.to];
  const float* values = at(layer.from[0]);
  std::ptrdiff_t row_step = from.row_step();
  if (layer.top + layer.left + layer.bottom + layer.right > 0) {
    row_step = static_cast<std::ptrdiff_t>(from.columns + layer.left + layer.right) * from.step;
    padded_.assign(static_cast<std::size_t>(row_step * (from.rows + layer.top + layer.bottom)), 0.0F);
    for (int y = 0; y < from.rows; ++y)
      std::copy_n(values + y * from.row_step(), from.row_step(),
                  padded_.data() + (y + layer.top) * row_step + static_cast<std::ptrdiff_t>(layer.left) * from.step);
    values = padded_.data();
  }
  const int lanes = to.step / LayerKernels::kLane;
  const float* added = layer.from.size() > 1 ? at(layer.from[1]) : nullptr;
  const bool by_pixel = layer.size_y == 1 && layer.size_x == 1 && layer.stride == 1;
  LayerKernels::Pixels pixels{values, static_cast<std::ptrdiff_t>(layer.stride) * from.step, layer.size_x * from.step, layer.size_y,
                              row_step};
  if (by_pixel && row_step == from.row_step()) {
    kernels_->product(pixels, to.rows * to.columns, layer.weights.data(), layer.bias.data(), lanes, layer.limits, added,
                      at(layer.to), to.step);
    return;
  }
  for (int y = 0; y < to.rows; ++y) {
    pixels.values = values + y * layer.stride * row_step;
    kernels_->product(pixels, to.columns, layer.weights.data(), layer.bias.data(), lanes, layer.limits,
                      added == nullptr ? nullptr : added + y * to.row_step(), at(layer.to) + y * to.row_step(), to.step);
  }
}

void OwnNetwork::by_channel(const Layer& layer) {
  const LayerValue &from = plan_.values[layer.from[0]], &to = plan_.values[layer.to];
  const int stride = layer.stride, lanes = to.step / LayerKernels::kLane;
  const auto [begin, end] = inner(from.columns, layer.left, layer.size_x, stride, to.columns);
  for (int y = 0; y < to.rows; ++y) {
    const int above = y * stride - layer.top, first_row = std::max(0, -above), last_row = std::min(layer.size_y, from.rows - above);
    const auto run = [&](int x, int count) {  // all of them have the same taps within the image
      const int before = x * stride - layer.left, first = std::max(0, -before);
      const int last = std::min(layer.size_x, from.columns - before);
      LayerKernels::Taps taps{};
      taps.down = from.row_step(), taps.across = from.step, taps.next = static_cast<std::ptrdiff_t>(stride) * from.step;
      taps.weights_down = static_cast<std::ptrdiff_t>(layer.size_x) * from.step;
      taps.rows = std::max(0, last_row - first_row), taps.columns = std::max(0, last - first);
      taps.values =
          at(layer.from[0]) + (above + first_row) * from.row_step() + static_cast<std::ptrdiff_t>(before + first) * from.step;
      taps.weights = layer.weights.data() + first_row * taps.weights_down + static_cast<std::ptrdiff_t>(first) * from.step;
      kernels_->by_channel(taps, layer.bias.data(), count, lanes, layer.limits,
                           at(layer.to) + y * to.row_step() + static_cast<std::ptrdiff_t>(x) * to.step);
    };
    for (int x = 0; x < begin; ++x) run(x, 1);
    if (end > begin) run(begin, end - begin);
    for (int x = end; x < to.columns; ++x) run(x, 1);
  }
}

void OwnNetwork::pool(const Layer& layer) {
  const LayerValue &from = plan_.values[layer.from[0]], &to = plan_.values[layer.to];
  const auto step = static_cast<std::size_t>(to.step);
  for (int y = 0; y < to.rows; ++y) {
    for (int x = 0; x < to.columns; ++x) {
      const float* upper = at(layer.from[0]) + 2 * y * from.row_step() + static_cast<std::ptrdiff_t>(2 * x) * from.step;
      const float* lower = upper + from.row_step();
      float* out = at(layer.to) + y * to.row_step() + static_cast<std::ptrdiff_t>(x) * to.step;
      kernels_->larger(upper, upper + from.step, step, out);
      kernels_->larger(out, lower, step, out);
      kernels_->larger(out, lower + from.step, step, out);
    }
  }
}

/// A new pixel's centre lies a quarter of a pixel from the nearer old one's; the border's pixels continue beyond it.
void OwnNetwork::enlarge(const Layer& layer) {
  const LayerValue &from = plan_.values[layer.from[0]], &to = plan_.values[layer.to];
  const auto row = static_cast<std::size_t>(from.row_step());
  const auto step = static_cast<std::size_t>(to.step);
  line_.resize(row);
  for (int y = 0; y < to.rows; ++y) {
    const int near = y / 2, far = std::clamp(y % 2 == 0 ? near - 1 : near + 1, 0, from.rows - 1);
    kernels_->sum(at(layer.from[0]) + near * from.row_step(), 0.75F, at(layer.from[0]) + far * from.row_step(), 0.25F, row,
                  kUnlimited, line_.data());
    for (int x = 0; x < to.columns; ++x) {
      const int across = std::clamp(x % 2 == 0 ? x / 2 - 1 : x / 2 + 1, 0, from.columns - 1);
      kernels_->sum(line_.data() + static_cast<std::size_t>(x / 2) * step, 0.75F,
                    line_.data() + static_cast<std::size_t>(across) * step, 0.25F, step, kUnlimited,
                    at(layer.to) + y * to.row_step() + static_cast<std::ptrdiff_t>(x) * to.step);
    }
  }
}

void OwnNetwork::widen(const Layer& layer) {
  const LayerValue &from = plan_.values[layer.from[0]], &to = plan_.values[layer.to];
  const std::ptrdiff_t pixels = static_cast<std::ptrdiff_t>(from.rows) * from.columns;
  for (std::ptrdiff_t i = 0; i < pixels; ++i) {
    float* zeros = std::copy_n(at(layer.from[0]) + i * from.step, from.channels, at(layer.to) + i * to.step);
    std::fill_n(zeros, to.step - from.channels, 0.0F);
  }
}

void OwnNetwork::numbers(const Layer& layer) {
  const LayerValue& from = plan_.values[layer.from[0]];
  const std::ptrdiff_t pixels = static_cast<std::ptrdiff_t>(from.rows) * from.columns;
  for (std::ptrdiff_t i = 0; i < pixels; ++i)
    std::copy_n(at(layer.from[0]) + i * from.step, from.channels, at(layer.to) + i * from.channels);
}

void OwnNetwork::compute(const Layer& layer) {
  using Kind = Layer::Kind;
  float* out = at(layer.to);
  if (layer.kind == Kind::dense) return dense(layer);
  if (layer.kind == Kind::by_channel) return by_channel(layer);
  if (layer.kind == Kind::pool) return pool(layer);
  if (layer.kind == Kind::enlarge) return enlarge(layer);
  if (layer.kind == Kind::widen) return widen(layer);
  if (layer.kind == Kind::numbers) return numbers(layer);
  if (layer.kind == Kind::sum)
    return kernels_->sum(at(layer.from[0]), 1, at(layer.from[1]), 1, plan_.values[layer.to].floats(), layer.limits, out);
  if (layer.kind == Kind::logistic) {
    const float* from = at(layer.from[0]);
    std::transform(from, from + plan_.values[layer.to].floats(), out, [](float logit) { return 1 / (1 + std::exp(-logit)); });
    return;
  }
  for (const std::size_t from : layer.from) out = std::copy_n(at(from), plan_.values[from].floats(), out);
}

Tensor OwnNetwork::tensor(std::size_t output) {
  const LayerValue& value = plan_.values[plan_.required[output]];
  const float* from = at(plan_.required[output]);
  Tensor tensor;
  tensor.name = plan_.outputs[output];
  tensor.shape = value.shape;
  if (!value.shape.empty()) {
    tensor.values.assign(from, from + value.floats());
    return tensor;
  }
  tensor.shape = {1, value.channels, value.rows, value.columns};
  const int pixels = value.rows * value.columns;
  tensor.values.resize(static_cast<std::size_t>(pixels) * static_cast<std::size_t>(value.channels));
  for (int begin = 0; begin < pixels; begin += kBlockPixels) {
    const int end = std::min(pixels, begin + kBlockPixels);
    for (int c = 0; c < value.channels; ++c) {
      float* to = tensor.values.data() + static_cast<std::ptrdiff_t>(c) * pixels;
      for (int i = begin; i < end; ++i) to[i] = from[static_cast<std::ptrdiff_t>(i) * value.step + c];
    }
  }
  return tensor;
}

std::vector<Tensor> OwnNetwork::run(const float* planes) {
  take(planes);
  for (const Layer& layer : plan_.layers) compute(layer);
  std::vector<Tensor> tensors;
  for (std::size_t i = 0; i < plan_.required.size(); ++i) tensors.push_back(tensor(i));
  return tensors;
}

}  // namespace marey::detect::network
