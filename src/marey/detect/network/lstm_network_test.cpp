#include "marey/detect/network/lstm_network.h"

#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::detect::network {
namespace {

constexpr int kFeatures = 5, kSize = 4, kOutputs = 3, kLayers = 2;

/// Weights at random; the graph as script/augmenter_model.py writes it.
OnnxGraph random_graph() {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  OnnxGraph graph;
  const auto weight = [&](const std::string& name, std::vector<int> shape, float low = 0) {
    std::size_t count = 1;
    for (const int size : shape) count *= static_cast<std::size_t>(size);
    std::vector<float> values(count);
    for (float& value : values) value = low > 0 ? low + std::abs(uniform(random)) : uniform(random);
    graph.weights[name] = {.shape = std::move(shape), .floats = std::move(values), .integers = {}};
  };
  const auto node = [&](const std::string& kind, const std::vector<std::string>& inputs, const std::string& output) {
    OnnxNode& made = graph.nodes.emplace_back();
    made.kind = kind, made.inputs = inputs, made.outputs = {output};
  };
  weight("mean", {kFeatures});
  weight("spread", {kFeatures}, 0.5F);
  node("Sub", {"inputs", "mean"}, "centred");
  node("Div", {"centred", "spread"}, "layer_0");
  for (int i = 0; i < kLayers; ++i) {
    const std::string n = std::to_string(i);
    weight("W_" + n, {1, 4 * kSize, i == 0 ? kFeatures : kSize});
    weight("R_" + n, {1, 4 * kSize, kSize});
    weight("B_" + n, {1, 8 * kSize});
    node("LSTM", {"layer_" + n, "W_" + n, "R_" + n, "B_" + n}, "states_" + n);
    node("Squeeze", {"states_" + n, "direction"}, "layer_" + std::to_string(i + 1));
  }
  weight("matrix", {kSize, kOutputs});
  weight("offset", {kOutputs});
  node("MatMul", {"layer_2", "matrix"}, "product");
  node("Add", {"product", "offset"}, "outputs");
  return graph;
}

double sigmoid(double x) {
  return 1 / (1 + std::exp(-x));
}

/// One sequence by the definition, number by number.
std::vector<std::vector<double>> by_definition(const OnnxGraph& graph, const Eigen::MatrixXf& inputs) {
  const auto w = [&](const std::string& name, int row, int column, int columns) {
    return static_cast<double>(graph.weights.at(name).floats[static_cast<std::size_t>(row * columns + column)]);
  };
  std::vector<std::vector<double>> state(kLayers, std::vector<double>(kSize, 0.0)), cell = state, outputs;
  for (Eigen::Index t = 0; t < inputs.cols(); ++t) {
    std::vector<double> x;
    for (int f = 0; f < kFeatures; ++f)
      x.push_back((static_cast<double>(inputs(f, t)) - w("mean", 0, f, kFeatures)) / w("spread", 0, f, kFeatures));
    for (std::size_t layer = 0; layer < kLayers; ++layer) {
      const std::string n = std::to_string(layer);
      std::vector<double> gate(4 * kSize);
      for (int g = 0; g < 4 * kSize; ++g) {
        double sum = w("B_" + n, 0, g, 0) + w("B_" + n, 0, 4 * kSize + g, 0);
        for (int i = 0; i < static_cast<int>(x.size()); ++i)
          sum += w("W_" + n, g, i, static_cast<int>(x.size())) * x[static_cast<std::size_t>(i)];
        for (int i = 0; i < kSize; ++i) sum += w("R_" + n, g, i, kSize) * state[layer][static_cast<std::size_t>(i)];
        gate[static_cast<std::size_t>(g)] = sum;
      }
      for (std::size_t i = 0; i < kSize; ++i) {
        cell[layer][i] = sigmoid(gate[2 * kSize + i]) * cell[layer][i] + sigmoid(gate[i]) * std::tanh(gate[3 * kSize + i]);
        state[layer][i] = sigmoid(gate[kSize + i]) * std::tanh(cell[layer][i]);
      }
      x = state[layer];
    }
    std::vector<double> out;
    for (int o = 0; o < kOutputs; ++o) {
      double sum = w("offset", 0, o, 0);
      for (int i = 0; i < kSize; ++i) sum += x[static_cast<std::size_t>(i)] * w("matrix", i, o, kOutputs);
      out.push_back(sum);
    }
    outputs.push_back(out);
  }
  return outputs;
}

/// In two parts, so that states go from one to the next.
TEST(LstmNetwork, ComputesWhatTheDefinitionSays) {
  constexpr Eigen::Index kSteps = 300, kSequences = 3;
  const OnnxGraph graph = random_graph();
  const LstmNetwork network(graph, "random");
  EXPECT_EQ(network.features(), kFeatures);
  EXPECT_EQ(network.outputs(), kOutputs);
  std::mt19937 random(4);
  std::normal_distribution<float> normal;
  const Eigen::MatrixXf inputs = Eigen::MatrixXf::NullaryExpr(kFeatures, kSteps * kSequences, [&] { return normal(random); });
  Eigen::MatrixXf outputs(kOutputs, inputs.cols());
  LstmNetwork::State state = network.start(kSequences);
  const Eigen::Index first = 200 * kSequences;
  outputs.leftCols(first) = network.run(inputs.leftCols(first), state);
  outputs.rightCols(inputs.cols() - first) = network.run(inputs.rightCols(inputs.cols() - first), state);
  for (Eigen::Index s = 0; s < kSequences; ++s) {
    Eigen::MatrixXf one(kFeatures, kSteps);
    for (Eigen::Index t = 0; t < kSteps; ++t) one.col(t) = inputs.col(t * kSequences + s);
    const auto expected = by_definition(graph, one);
    for (Eigen::Index t = 0; t < kSteps; ++t) {
      for (Eigen::Index o = 0; o < kOutputs; ++o)
        ASSERT_NEAR(static_cast<double>(outputs(o, t * kSequences + s)),
                    expected[static_cast<std::size_t>(t)][static_cast<std::size_t>(o)], 1e-5);
    }
  }
}

TEST(LstmNetwork, RefusesOtherNetworks) {
  EXPECT_THROW(LstmNetwork(OnnxGraph{}, "empty"), Error);
  for (const char* changed : {"mean", "W_1", "R_0", "B_1", "matrix", "offset"}) {
    OnnxGraph graph = random_graph();
    graph.weights.at(changed) = {.shape = {2, 3}, .floats = std::vector<float>(6, 1.0F), .integers = {}};
    EXPECT_THROW(LstmNetwork(graph, "other"), Error) << changed;
    graph.weights.erase(changed);
    EXPECT_THROW(LstmNetwork(graph, "cut off"), Error) << changed;
  }
  OnnxGraph still = random_graph();
  still.weights.at("spread").floats[2] = 0;
  EXPECT_THROW(LstmNetwork(still, "a feature without spread"), Error);
  OnnxGraph broken = random_graph();
  broken.weights.at("R_1").floats[5] = std::nanf("");
  EXPECT_THROW(LstmNetwork(broken, "not a number"), Error);
}

}  // namespace
}  // namespace marey::detect::network
