#include "marey/detect/network/layer_plan.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "marey/detect/network/layer_memory.h"

namespace marey::detect::network {
namespace {

constexpr int kLane = LayerKernels::kLane;
constexpr std::int64_t kMaxSide = 1 << 14;  // numerical: px or channels of a layer

std::vector<double> numbers_of(const OnnxNode& node, const std::string& name, std::vector<double> otherwise) {
  const auto found = node.numbers.find(name);
  return found == node.numbers.end() || found->second.empty() ? otherwise : found->second;
}

bool all_are(const std::vector<double>& values, double value) {
  return std::all_of(values.begin(), values.end(), [&](double one) { return one == value; });
}

/// The nodes that an output needs, in the file's order.
std::vector<const OnnxNode*> nodes_for(const OnnxGraph& graph, std::span<const std::string> required) {
  std::set<std::string> needed(required.begin(), required.end());
  std::vector<const OnnxNode*> nodes;
  for (auto node = graph.nodes.rbegin(); node != graph.nodes.rend(); ++node) {
    if (std::none_of(node->outputs.begin(), node->outputs.end(), [&](const auto& name) { return needed.contains(name); })) continue;
    needed.insert(node->inputs.begin(), node->inputs.end());
    nodes.push_back(&*node);
  }
  std::reverse(nodes.begin(), nodes.end());
  return nodes;
}

class Planner {
 public:
  Planner(const OnnxGraph& graph, std::span<const int> input, std::span<const std::string> required)
      : nodes_(nodes_for(graph, required)) {
    for (const auto& [name, tensor] : graph.weights) weights_[name] = &tensor;
    for (const OnnxNode* node : nodes_) {
      for (const std::string& name : node->inputs) ++uses_[name];
    }
    for (const std::string& name : required) ++uses_[name];
    plan_.values.push_back({input[2], input[3], input[1], input[1], {}, 0});
    made_by_.emplace_back();
    values_[graph.inputs.front()] = 0;
  }

  std::optional<LayerPlan> plan(std::span<const std::string> required) {
    for (const OnnxNode* node : nodes_) {
      if (!add(*node)) return std::nullopt;
    }
    for (const std::string& name : required) {
      if (!values_.contains(name)) return std::nullopt;
      plan_.outputs.push_back(name);
      plan_.required.push_back(values_.at(name));
    }
    return std::move(plan_);
  }

  using Add = bool (Planner::*)(const OnnxNode&);
  static const std::map<std::string, Add>& kinds() {
    static const std::map<std::string, Add> all{
        {"Conv", &Planner::convolution}, {"Clip", &Planner::clip},           {"Add", &Planner::sum},
        {"Pad", &Planner::pad},          {"Resize", &Planner::enlarge},      {"MaxPool", &Planner::pool},
        {"Sigmoid", &Planner::logistic}, {"Transpose", &Planner::transpose}, {"Reshape", &Planner::reshape},
        {"Concat", &Planner::join},      {"Identity", &Planner::same},       {"Cast", &Planner::convert},
    };
    return all;
  }

 private:
  struct Padded {
    std::size_t value = 0;
    int top = 0, left = 0, bottom = 0, right = 0;
  };

  bool add(const OnnxNode& node) {
    const auto kind = kinds().find(node.kind);
    return kind != kinds().end() && node.outputs.size() == 1 && !node.inputs.empty() && (this->*kind->second)(node);
  }

  const OnnxTensor* weight(const OnnxNode& node, std::size_t input) const {
    const auto found = input < node.inputs.size() ? weights_.find(node.inputs[input]) : weights_.end();
    return found == weights_.end() ? nullptr : found->second;
  }
  std::optional<std::size_t> value(const OnnxNode& node, std::size_t input) const {
    const auto found = input < node.inputs.size() ? values_.find(node.inputs[input]) : values_.end();
    return found == values_.end() ? std::nullopt : std::optional(found->second);
  }
  /// One that a layer other than a dense one reads: an image with its channels filled up.
  std::optional<std::size_t> image(const OnnxNode& node, std::size_t input) const {
    const auto found = value(node, input);
    return found && plan_.values[*found].shape.empty() && plan_.values[*found].step % kLane == 0 ? found : std::nullopt;
  }

  Layer& new_layer(const OnnxNode& node, Layer::Kind kind, std::vector<std::size_t> from, LayerValue made) {
    made.buffer = plan_.values.size();
    values_[node.outputs.front()] = plan_.values.size();
    plan_.values.push_back(std::move(made));
    made_by_.emplace_back(plan_.layers.size());
    Layer& layer = plan_.layers.emplace_back();
    layer.kind = kind, layer.from = std::move(from), layer.to = plan_.values.size() - 1;
    return layer;
  }

  bool convolution(const OnnxNode& node);
  bool clip(const OnnxNode& node);
  bool sum(const OnnxNode& node);
  bool pad(const OnnxNode& node);
  bool enlarge(const OnnxNode& node);
  bool pool(const OnnxNode& node);
  bool logistic(const OnnxNode& node);
  bool transpose(const OnnxNode& node);
  bool reshape(const OnnxNode& node);
  bool join(const OnnxNode& node);
  bool same(const OnnxNode& node);
  bool convert(const OnnxNode& node);
  /// The layer that makes this input, where no other node reads it.
  Layer* only_for(const OnnxNode& node, std::size_t input);

  std::vector<const OnnxNode*> nodes_;
  std::map<std::string, const OnnxTensor*> weights_;
  std::map<std::string, int> uses_;
  std::map<std::string, std::size_t> values_;
  std::map<std::string, Padded> padded_;
  std::vector<std::optional<std::size_t>> made_by_;  // layer of each value; none where it is known by several names
  LayerPlan plan_;
};

Layer* Planner::only_for(const OnnxNode& node, std::size_t input) {
  const auto from = value(node, input);
  if (!from || uses_[node.inputs[input]] != 1 || !made_by_[*from]) return nullptr;
  return &plan_.layers[*made_by_[*from]];
}

bool Planner::convolution(const OnnxNode& node) {
  const OnnxTensor *weights = weight(node, 1), *bias = weight(node, 2);
  if (weights == nullptr || weights->shape.size() != 4 || weights->floats.empty() || node.texts.contains("auto_pad")) return false;
  if (node.inputs.size() > 2 && (bias == nullptr || std::ssize(bias->floats) != weights->shape[0])) return false;
  Padded from;
  if (const auto padded = padded_.find(node.inputs[0]); padded != padded_.end()) {
    from = padded->second;
  } else if (const auto plain = value(node, 0)) {
    from.value = *plain;
  } else {
    return false;
  }
  const LayerValue& input = plan_.values[from.value];
  const std::vector<double> pads = numbers_of(node, "pads", {0, 0, 0, 0}), strides = numbers_of(node, "strides", {1, 1});
  const double groups = numbers_of(node, "group", {1}).front();
  const bool by_channel = groups > 1;
  if (!input.shape.empty() || pads.size() != 4 || strides.size() != 2 || strides[0] != strides[1] || strides[0] < 1 ||
      strides[0] > 8 || !all_are(numbers_of(node, "dilations", {1, 1}), 1))
    return false;
  if (by_channel &&
      (groups != input.channels || weights->shape[0] != input.channels || weights->shape[1] != 1 || input.step % kLane != 0))
    return false;
  if (!by_channel && weights->shape[1] != input.channels) return false;

  Layer layer;
  layer.size_y = weights->shape[2], layer.size_x = weights->shape[3], layer.stride = static_cast<int>(strides[0]);
  layer.top = from.top + static_cast<int>(pads[0]), layer.left = from.left + static_cast<int>(pads[1]);
  layer.bottom = from.bottom + static_cast<int>(pads[2]), layer.right = from.right + static_cast<int>(pads[3]);
  const int height = input.rows + layer.top + layer.bottom - layer.size_y,
            width = input.columns + layer.left + layer.right - layer.size_x;
  if (std::min({layer.top, layer.left, layer.bottom, layer.right, height, width}) < 0) return false;
  layer.weights = by_channel ? weights_by_channel(*weights) : dense_weights(*weights, input.step);
  layer.bias.assign(static_cast<std::size_t>(in_lanes(weights->shape[0])), 0);
  if (bias != nullptr) std::copy(bias->floats.begin(), bias->floats.end(), layer.bias.begin());
  const LayerValue made{height / layer.stride + 1, width / layer.stride + 1, weights->shape[0], in_lanes(weights->shape[0]), {}, 0};
  Layer& added = new_layer(node, by_channel ? Layer::Kind::by_channel : Layer::Kind::dense, {from.value}, made);
  layer.kind = added.kind, layer.from = added.from, layer.to = added.to;
  added = std::move(layer);
  return true;
}

bool Planner::clip(const OnnxNode& node) {
  const auto limit = [&](const char* name, std::size_t input, double otherwise) {
    if (const OnnxTensor* given = weight(node, input); given != nullptr && given->floats.size() == 1) return given->floats[0];
    return static_cast<float>(numbers_of(node, name, {otherwise}).front());
  };
  const LayerKernels::Limits limits{limit("min", 1, -std::numeric_limits<float>::max()),
                                    limit("max", 2, std::numeric_limits<float>::max())};
  Layer* maker = only_for(node, 0);
  const bool fused =
      maker != nullptr && !maker->limited() &&
      (maker->kind == Layer::Kind::dense || maker->kind == Layer::Kind::by_channel || maker->kind == Layer::Kind::sum);
  if (!fused) return false;
  maker->limits = limits;
  values_[node.outputs.front()] = maker->to;
  return true;
}

bool Planner::sum(const OnnxNode& node) {
  const auto a = image(node, 0), b = image(node, 1);
  if (!a || !b || node.inputs.size() != 2) return false;
  const LayerValue &first = plan_.values[*a], &second = plan_.values[*b];
  if (first.rows != second.rows || first.columns != second.columns || first.channels != second.channels) return false;
  for (const std::size_t of : {std::size_t{0}, std::size_t{1}}) {
    Layer* maker = only_for(node, of);
    const std::size_t other = of == 0 ? *b : *a;
    if (maker == nullptr || maker->kind != Layer::Kind::dense || maker->limited() || maker->from.size() != 1) continue;
    if (other == maker->to || (made_by_[other] && *made_by_[other] >= *made_by_[maker->to])) continue;
    if (!made_by_[other] && other != 0) continue;
    maker->from.push_back(other);
    values_[node.outputs.front()] = maker->to;
    return true;
  }
  new_layer(node, Layer::Kind::sum, {*a, *b}, first);
  return true;
}

bool Planner::pad(const OnnxNode& node) {
  const OnnxTensor *by = weight(node, 1), *with = weight(node, 2);
  const auto from = value(node, 0);
  if (!from || by == nullptr || by->integers.size() != 8) return false;
  if (with != nullptr && !(with->floats.size() == 1 && with->floats[0] == 0)) return false;
  const std::vector<std::int64_t>& n = by->integers;
  if (std::any_of(n.begin(), n.end(), [](std::int64_t one) { return one < 0 || one > kMaxSide; })) return false;
  if (n[0] != 0 || n[1] != 0 || n[4] != 0) return false;
  if (n[5] > 0) {  // channels behind the others
    const auto image = this->image(node, 0);
    if (!image || n[2] + n[3] + n[6] + n[7] > 0) return false;
    LayerValue made = plan_.values[*image];
    made.channels += static_cast<int>(n[5]);
    made.step = in_lanes(made.channels);
    new_layer(node, Layer::Kind::widen, {*image}, made);
    return true;
  }
  padded_[node.outputs.front()] = {*from, static_cast<int>(n[2]), static_cast<int>(n[3]), static_cast<int>(n[6]),
                                   static_cast<int>(n[7])};
  return true;
}

bool Planner::enlarge(const OnnxNode& node) {
  const OnnxTensor* scales = weight(node, 2);
  const auto from = image(node, 0);
  const auto text = [&](const char* name) {
    const auto found = node.texts.find(name);
    return found == node.texts.end() ? std::string() : found->second;
  };
  if (!from || scales == nullptr || scales->floats != std::vector<float>{1, 1, 2, 2} || text("mode") != "linear" ||
      text("coordinate_transformation_mode") != "half_pixel")
    return false;
  LayerValue made = plan_.values[*from];
  made.rows *= 2, made.columns *= 2;
  new_layer(node, Layer::Kind::enlarge, {*from}, made);
  return true;
}

bool Planner::pool(const OnnxNode& node) {
  const auto from = image(node, 0);
  if (!from || !all_are(numbers_of(node, "kernel_shape", {0}), 2) || !all_are(numbers_of(node, "strides", {0}), 2) ||
      !all_are(numbers_of(node, "pads", {0}), 0) || !all_are(numbers_of(node, "ceil_mode", {0}), 0) ||
      node.texts.contains("auto_pad"))
    return false;
  LayerValue made = plan_.values[*from];
  made.rows /= 2, made.columns /= 2;
  new_layer(node, Layer::Kind::pool, {*from}, made);
  return true;
}

bool Planner::logistic(const OnnxNode& node) {
  const auto from = value(node, 0);
  if (!from) return false;
  new_layer(node, Layer::Kind::logistic, {*from}, plan_.values[*from]);
  return true;
}

/// Channels last, which is how images lie here.
bool Planner::transpose(const OnnxNode& node) {
  const auto from = image(node, 0);
  if (!from || numbers_of(node, "perm", {}) != std::vector<double>{0, 2, 3, 1}) return false;
  LayerValue made = plan_.values[*from];
  made.shape = {1, made.rows, made.columns, made.channels};
  new_layer(node, Layer::Kind::numbers, {*from}, made);
  return true;
}

bool Planner::reshape(const OnnxNode& node) {
  const auto from = value(node, 0);
  const OnnxTensor* sizes = weight(node, 1);
  if (!from || sizes == nullptr || plan_.values[*from].shape.empty()) return false;
  const auto count = static_cast<std::int64_t>(plan_.values[*from].floats());
  std::int64_t known = 1;
  std::vector<int> shape;
  for (const std::int64_t size : sizes->integers) {
    if (size == 0 || size < -1 || size > count) return false;
    known *= size == -1 ? 1 : size;
    if (known > count) return false;
    shape.push_back(static_cast<int>(size));
  }
  if (std::count(shape.begin(), shape.end(), -1) > 1 || shape.empty()) return false;
  if (const auto open = std::find(shape.begin(), shape.end(), -1); open != shape.end()) {
    *open = static_cast<int>(count / known);
    known *= *open;
  }
  if (known != count) return false;
  LayerValue made = plan_.values[*from];
  made.shape = std::move(shape);
  new_layer(node, Layer::Kind::join, {*from}, made);  // of one
  return true;
}

bool Planner::join(const OnnxNode& node) {
  std::vector<std::size_t> from;
  LayerValue made;
  for (std::size_t i = 0; i < node.inputs.size(); ++i) {
    const auto one = value(node, i);
    if (!one || plan_.values[*one].shape.size() < 2) return false;
    std::vector<int> shape = plan_.values[*one].shape;
    if (i > 0) shape[1] += made.shape[1];
    std::vector<int> but_rows = made.shape;
    if (i > 0) but_rows[1] = shape[1];
    if (shape[0] != 1 || (i > 0 && shape != but_rows)) return false;
    made.shape = std::move(shape);
    from.push_back(*one);
  }
  const double axis = numbers_of(node, "axis", {0}).front(), rank = static_cast<double>(made.shape.size());
  if (axis != 1 && axis + rank != 1) return false;
  new_layer(node, Layer::Kind::join, std::move(from), made);
  return true;
}

bool Planner::same(const OnnxNode& node) {
  const auto from = value(node, 0);
  if (!from) return false;
  values_[node.outputs.front()] = *from;
  if (*from != 0) made_by_[*from].reset();
  return true;
}

/// Weights of 16 bits are floats already.
bool Planner::convert(const OnnxNode& node) {
  const OnnxTensor* from = weight(node, 0);
  if (from == nullptr || from->floats.empty() || !all_are(numbers_of(node, "to", {0}), 1)) return false;
  weights_[node.outputs.front()] = from;
  return true;
}

}  // namespace

std::size_t LayerValue::floats() const {
  std::size_t count = 1;
  if (shape.empty()) return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns) * static_cast<std::size_t>(step);
  for (const int size : shape) count *= static_cast<std::size_t>(size);
  return count;
}

bool has_known_layers(const OnnxGraph& graph) {
  return std::all_of(graph.nodes.begin(), graph.nodes.end(),
                     [](const OnnxNode& node) { return Planner::kinds().contains(node.kind); });
}

std::optional<LayerPlan> layer_plan(const OnnxGraph& graph, std::span<const int> input, std::span<const std::string> required) {
  if (graph.inputs.size() != 1 || input.size() != 4 || input[0] != 1) return std::nullopt;
  if (std::any_of(input.begin(), input.end(), [](int size) { return size < 1 || size > kMaxSide; })) return std::nullopt;
  auto plan = Planner(graph, input, required).plan(required);
  if (plan) assign_buffers(*plan);
  return plan;
}

}  // namespace marey::detect::network
