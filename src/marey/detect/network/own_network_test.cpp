#include "marey/detect/network/own_network.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "marey/detect/kernel_targets.h"
#include "marey/detect/network/layer_plan.h"

namespace marey::detect::network {
namespace {

/// Nodes as ONNX has them, and what they are by definition, term by term, planes of channels.
class PlainNetwork {
 public:
  PlainNetwork(int channels, int rows, int columns) : sizes_{1, channels, rows, columns} {
    graph_.inputs = {"image"};
    made_["image"] = {.shape = sizes_, .floats = random_values(channels * rows * columns), .integers = {}};
  }

  OnnxGraph& graph() { return graph_; }
  std::span<const int> sizes() const { return sizes_; }
  const OnnxTensor& value(const std::string& name) const { return made_.at(name); }

  std::vector<float> random_values(int count) {
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<float> values(static_cast<std::size_t>(count));
    for (float& value : values) value = uniform(random_);
    return values;
  }

  OnnxNode& node(const std::string& kind, const std::vector<std::string>& inputs, const std::string& output) {
    OnnxNode& node = graph_.nodes.emplace_back();
    node.kind = kind, node.inputs = inputs, node.outputs = {output};
    return node;
  }

  void convolve(const std::string& from, const std::string& to, int outputs, int groups, int size, int stride,
                const std::vector<int>& pads) {
    const OnnxTensor& input = made_.at(from);
    const int inputs = input.shape[1] / groups, columns = input.shape[3], rows = input.shape[2];
    OnnxTensor weights{{outputs, inputs, size, size}, random_values(outputs * inputs * size * size), {}};
    const OnnxTensor bias{{outputs}, random_values(outputs), {}};
    OnnxTensor made{
        {1, outputs, (rows + pads[0] + pads[2] - size) / stride + 1, (columns + pads[1] + pads[3] - size) / stride + 1}, {}, {}};
    for (int o = 0; o < outputs; ++o) {
      for (int y = 0; y < made.shape[2]; ++y) {
        for (int x = 0; x < made.shape[3]; ++x) {
          double sum = bias.floats[static_cast<std::size_t>(o)];
          for (int i = 0; i < inputs * size * size; ++i) {
            const int row = y * stride + i / size % size - pads[0], column = x * stride + i % size - pads[1];
            const int channel = o / (outputs / groups) * inputs + i / (size * size);
            if (row < 0 || column < 0 || row >= rows || column >= columns) continue;
            sum += static_cast<double>(weights.floats[static_cast<std::size_t>(o * inputs * size * size + i)]) *
                   static_cast<double>(input.floats[static_cast<std::size_t>((channel * rows + row) * columns + column)]);
          }
          made.floats.push_back(static_cast<float>(sum));
        }
      }
    }
    const auto wide = [](const std::vector<int>& all) { return std::vector<double>(all.begin(), all.end()); };
    OnnxNode& node = this->node("Conv", {from, to + " w", to + " b"}, to);
    node.numbers = {
        {"group", {static_cast<double>(groups)}}, {"pads", wide(pads)}, {"strides", wide({stride, stride})}, {"dilations", {1, 1}}};
    graph_.weights[to + " w"] = std::move(weights);
    graph_.weights[to + " b"] = bias;
    made_[to] = std::move(made);
  }

  void clip(const std::string& from, const std::string& to, float low, float high) {
    node("Clip", {from}, to).numbers = {{"min", {low}}, {"max", {high}}};
    OnnxTensor made = made_.at(from);
    for (float& value : made.floats) value = std::clamp(value, low, high);
    made_[to] = std::move(made);
  }

  void add(const std::string& a, const std::string& b, const std::string& to) {
    node("Add", {a, b}, to);
    OnnxTensor made = made_.at(a);
    for (std::size_t i = 0; i < made.floats.size(); ++i) made.floats[i] += made_.at(b).floats[i];
    made_[to] = std::move(made);
  }

  /// Zeros below and to the right.
  void pad(const std::string& from, const std::string& to, int by) {
    const OnnxTensor& input = made_.at(from);
    graph_.weights[to + " p"] = {{8}, {}, {0, 0, 0, 0, 0, 0, by, by}};
    node("Pad", {from, to + " p"}, to);
    OnnxTensor made{{1, input.shape[1], input.shape[2] + by, input.shape[3] + by}, {}, {}};
    for (int i = 0; i < made.shape[1] * made.shape[2]; ++i) {
      const int c = i / made.shape[2], y = i % made.shape[2];
      for (int x = 0; x < made.shape[3]; ++x)
        made.floats.push_back(y < input.shape[2] && x < input.shape[3] ? at(input, c, y, x) : 0);
    }
    made_[to] = std::move(made);
  }

  /// More channels, of zeros.
  void widen(const std::string& from, const std::string& to, int by) {
    graph_.weights[to + " p"] = {{8}, {}, {0, 0, 0, 0, 0, by, 0, 0}};
    node("Pad", {from, to + " p"}, to);
    OnnxTensor made = made_.at(from);
    made.floats.resize(made.floats.size() + static_cast<std::size_t>(by * made.shape[2] * made.shape[3]), 0);
    made.shape[1] += by;
    made_[to] = std::move(made);
  }

  void enlarge(const std::string& from, const std::string& to) {
    graph_.weights[to + " s"] = {{4}, {1, 1, 2, 2}, {}};
    node("Resize", {from, "", to + " s"}, to).texts = {{"mode", "linear"}, {"coordinate_transformation_mode", "half_pixel"}};
    const OnnxTensor& input = made_.at(from);
    OnnxTensor made{{1, input.shape[1], 2 * input.shape[2], 2 * input.shape[3]}, {}, {}};
    for (int i = 0; i < made.shape[1] * made.shape[2] * made.shape[3]; ++i) {
      const int c = i / (made.shape[2] * made.shape[3]);
      const double y = std::clamp((i / made.shape[3] % made.shape[2] + 0.5) / 2 - 0.5, 0.0, input.shape[2] - 1.0);
      const double x = std::clamp((i % made.shape[3] + 0.5) / 2 - 0.5, 0.0, input.shape[3] - 1.0);
      const int row = static_cast<int>(y), column = static_cast<int>(x);
      const auto get = [&](int r, int k) {
        return static_cast<double>(at(input, c, std::min(r, input.shape[2] - 1), std::min(k, input.shape[3] - 1)));
      };
      const double v = y - row, u = x - column;
      made.floats.push_back(static_cast<float>((1 - v) * ((1 - u) * get(row, column) + u * get(row, column + 1)) +
                                               v * ((1 - u) * get(row + 1, column) + u * get(row + 1, column + 1))));
    }
    made_[to] = std::move(made);
  }

  void pool(const std::string& from, const std::string& to) {
    node("MaxPool", {from}, to).numbers = {{"kernel_shape", {2, 2}}, {"strides", {2, 2}}, {"pads", {0, 0, 0, 0}}};
    const OnnxTensor& input = made_.at(from);
    OnnxTensor made{{1, input.shape[1], input.shape[2] / 2, input.shape[3] / 2}, {}, {}};
    for (int i = 0; i < made.shape[1] * made.shape[2] * made.shape[3]; ++i) {
      const int c = i / (made.shape[2] * made.shape[3]), y = 2 * (i / made.shape[3] % made.shape[2]), x = 2 * (i % made.shape[3]);
      made.floats.push_back(
          std::max({at(input, c, y, x), at(input, c, y, x + 1), at(input, c, y + 1, x), at(input, c, y + 1, x + 1)}));
    }
    made_[to] = std::move(made);
  }

  /// Rows of `width` numbers, channels last.
  void rows_of(const std::string& from, const std::string& to, int width) {
    node("Transpose", {from}, to + " t").numbers = {{"perm", {0, 2, 3, 1}}};
    graph_.weights[to + " s"] = {{3}, {}, {1, -1, width}};
    node("Reshape", {to + " t", to + " s"}, to);
    const OnnxTensor& input = made_.at(from);
    const int count = static_cast<int>(input.floats.size()), channels = input.shape[1], plane = count / channels;
    OnnxTensor made{{1, count / width, width}, {}, {}};
    for (int i = 0; i < count; ++i)
      made.floats.push_back(input.floats[static_cast<std::size_t>(i % channels * plane + i / channels)]);
    made_[to] = std::move(made);
  }

  void join(const std::string& a, const std::string& b, const std::string& to) {
    node("Concat", {a, b}, to).numbers = {{"axis", {1}}};
    OnnxTensor made = made_.at(a);
    made.shape[1] += made_.at(b).shape[1];
    made.floats.insert(made.floats.end(), made_.at(b).floats.begin(), made_.at(b).floats.end());
    made_[to] = std::move(made);
  }

  void logistic(const std::string& from, const std::string& to) {
    node("Sigmoid", {from}, to);
    OnnxTensor made = made_.at(from);
    for (float& value : made.floats) value = 1 / (1 + std::exp(-value));
    made_[to] = std::move(made);
  }

 private:
  static float at(const OnnxTensor& tensor, int c, int y, int x) {
    return tensor.floats[static_cast<std::size_t>((c * tensor.shape[2] + y) * tensor.shape[3] + x)];
  }

  std::vector<int> sizes_;
  OnnxGraph graph_;
  std::map<std::string, OnnxTensor> made_;
  std::mt19937 random_{3};
};

void expect_agreement(PlainNetwork& plain, const std::vector<std::string>& required) {
  auto plan = layer_plan(plain.graph(), plain.sizes(), required);
  ASSERT_TRUE(plan) << "of " << required.front();
  OwnNetwork network(std::move(*plan));
  for (int again = 0; again < 2; ++again) {  // what the first run leaves behind changes nothing
    const std::vector<Tensor> outputs = network.run(plain.value("image").floats.data());
    ASSERT_EQ(outputs.size(), required.size());
    for (const Tensor& output : outputs) {
      const OnnxTensor& due = plain.value(output.name);
      ASSERT_EQ(output.shape, due.shape) << output.name;
      for (std::size_t i = 0; i < due.floats.size(); ++i)
        ASSERT_NEAR(output.values[i], due.floats[i], 2e-4) << output.name << " at " << i;
    }
  }
}

/// A block as such networks have them: wider, by channel, narrower, and what came in is added.
PlainNetwork small_network() {
  PlainNetwork plain(3, 21, 30);
  plain.pad("image", "padded", 1);
  plain.convolve("padded", "first raw", 24, 1, 3, 2, {0, 0, 0, 0});
  plain.clip("first raw", "first", 0, 6);
  plain.convolve("first", "wide raw", 40, 1, 1, 1, {0, 0, 0, 0});
  plain.clip("wide raw", "wide", 0, 6);
  plain.convolve("wide", "channels raw", 40, 40, 5, 1, {2, 2, 2, 2});
  plain.clip("channels raw", "channels", -1, 2);
  plain.convolve("channels", "narrow", 24, 1, 1, 1, {0, 0, 0, 0});
  plain.add("narrow", "first", "block raw");
  plain.clip("block raw", "block", 0, 6);
  plain.pad("block", "block padded", 2);
  plain.convolve("block padded", "half", 24, 24, 5, 2, {1, 0, 1, 1});
  plain.enlarge("half", "double");
  plain.pool("double", "half again");
  plain.add("half", "half again", "both");
  plain.widen("both", "more", 21);
  plain.convolve("more", "of more", 45, 1, 1, 1, {0, 0, 0, 0});
  plain.add("of more", "more", "sum of more");
  plain.convolve("both", "end", 7, 1, 2, 1, {0, 1, 0, 1});
  plain.logistic("end", "certain");
  plain.rows_of("certain", "certain rows", 7);
  plain.rows_of("narrow", "narrow rows", 7 * 24);
  return plain;
}

TEST(OwnNetwork, MakesWhatTheDefinitionSays) {
  PlainNetwork plain = small_network();
  for (const char* name : {"first", "wide", "channels", "narrow", "block", "half", "double", "half again", "both", "more",
                           "sum of more", "end", "certain", "certain rows"})
    expect_agreement(plain, {name});
  expect_agreement(plain, {"certain rows", "block", "both"});
  expect_agreement(plain, {"narrow", "block"});
}

TEST(OwnNetwork, JoinsRows) {
  PlainNetwork plain(16, 4, 6);
  plain.convolve("image", "a", 32, 1, 1, 1, {0, 0, 0, 0});
  plain.convolve("image", "b", 8, 1, 3, 2, {1, 1, 1, 1});
  plain.rows_of("a", "a rows", 4);
  plain.rows_of("b", "b rows", 4);
  plain.join("a rows", "b rows", "all");
  expect_agreement(plain, {"all"});
}

TEST(OwnNetwork, SameOnEveryLevelOfTheProcessor) {
  const auto all = kernels_of_every_target(layer_kernels);
  ASSERT_FALSE(all.empty());
  PlainNetwork plain = small_network();
  const std::vector<std::string> required{"certain rows"};
  std::vector<float> first;
  for (const auto& [name, table] : all) {
    auto plan = layer_plan(plain.graph(), plain.sizes(), required);
    ASSERT_TRUE(plan);
    const std::vector<Tensor> outputs = OwnNetwork(std::move(*plan), *table).run(plain.value("image").floats.data());
    if (first.empty()) first = outputs[0].values;
    for (std::size_t i = 0; i < first.size(); ++i) ASSERT_NEAR(outputs[0].values[i], first[i], 1e-4) << name << " at " << i;
  }
}

TEST(LayerPlan, HasNoneForOtherLayers) {
  const auto has_plan = [](const auto& change) {
    PlainNetwork plain(16, 8, 8);
    plain.convolve("image", "a", 16, 1, 3, 1, {1, 1, 1, 1});
    change(plain.graph());
    const std::vector<std::string> required{"a"};
    return layer_plan(plain.graph(), plain.sizes(), required).has_value();
  };
  EXPECT_TRUE(has_plan([](OnnxGraph&) {}));
  EXPECT_FALSE(has_plan([](OnnxGraph& graph) { graph.nodes[0].kind = "ConvTranspose"; }));
  EXPECT_FALSE(has_plan([](OnnxGraph& graph) { graph.nodes[0].numbers["dilations"] = {2, 2}; }));
  EXPECT_FALSE(has_plan([](OnnxGraph& graph) { graph.nodes[0].numbers["strides"] = {0, 0}; }));
  EXPECT_FALSE(has_plan([](OnnxGraph& graph) { graph.nodes[0].numbers["group"] = {4}; }));
  EXPECT_FALSE(has_plan([](OnnxGraph& graph) { graph.nodes[0].texts["auto_pad"] = "SAME_UPPER"; }));
  EXPECT_FALSE(has_plan([](OnnxGraph& graph) { graph.nodes[0].inputs[0] = "another"; }));
  EXPECT_FALSE(has_plan([](OnnxGraph& graph) { graph.weights.erase("a w"); }));
  EXPECT_FALSE(has_plan([](OnnxGraph& graph) { graph.weights["a b"].floats.pop_back(); }));
  EXPECT_FALSE(has_plan([](OnnxGraph& graph) { graph.nodes[0].outputs = {"b"}; }));
}

}  // namespace
}  // namespace marey::detect::network
