#include "marey/detect/network/lstm_network.h"

#include <optional>

#include "marey/core/error.h"

namespace marey::detect::network {
namespace {

constexpr std::size_t kGates = 4;  // format: of an LSTM in ONNX

using ByRows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A weight by its name as a matrix, its leading dimensions of 1 omitted; nothing if it has another shape.
std::optional<Eigen::MatrixXf> matrix_of(const OnnxGraph& graph, const std::string& name) {
  const auto found = graph.weights.find(name);
  if (found == graph.weights.end()) return std::nullopt;
  std::vector<int> shape = found->second.shape;
  while (shape.size() > 2 && shape.front() == 1) shape.erase(shape.begin());
  if (shape.size() == 1) shape.insert(shape.begin(), 1);
  if (shape.size() != 2 || shape[0] == 0 || shape[1] == 0 || found->second.floats.empty()) return std::nullopt;
  const Eigen::MatrixXf matrix = Eigen::Map<const ByRows>(found->second.floats.data(), shape[0], shape[1]);
  if (!matrix.allFinite()) return std::nullopt;
  return matrix;
}

/// The same of the weight that is the node's input of this number.
std::optional<Eigen::MatrixXf> weight_of(const OnnxGraph& graph, const OnnxNode& node, std::size_t input) {
  return input < node.inputs.size() ? matrix_of(graph, node.inputs[input]) : std::nullopt;
}

Eigen::ArrayXXf openings_of(const Eigen::ArrayXXf& x) {
  return (1 + (-x).exp()).inverse();
}

}  // namespace

LstmNetwork::LstmNetwork(const OnnxGraph& graph, const std::string& file) {
  const auto refuse = [&]() -> Error { return Error("{}: is another network than LSTM layers with a matrix behind them", file); };
  for (const OnnxNode& node : graph.nodes) {
    if (node.kind == "Squeeze") continue;
    const auto first = weight_of(graph, node, 1);
    const bool one_row = node.kind == "Sub" || node.kind == "Div" || node.kind == "Add";
    if (!first || (one_row && first->rows() != 1)) throw refuse();
    if (node.kind == "Sub") mean_ = first->transpose();
    if (node.kind == "Div") spread_ = first->transpose();
    if (node.kind == "MatMul") matrix_ = first->transpose();
    if (node.kind == "Add") offset_ = first->transpose();
    if (node.kind != "LSTM") continue;
    const auto recurrent = weight_of(graph, node, 2), offsets = weight_of(graph, node, 3);
    if (!recurrent || !offsets || offsets->rows() != 1 || offsets->cols() != 2 * first->rows()) throw refuse();
    const Eigen::VectorXf both = offsets->transpose();
    layers_.push_back({*first, *recurrent, both.head(first->rows()) + both.tail(first->rows())});
  }
  Eigen::Index inputs = mean_.size();
  bool fits = !layers_.empty() && inputs > 0 && spread_.size() == inputs && (spread_.array() > 0).all();
  for (const Layer& layer : layers_) {
    const Eigen::Index gates = static_cast<Eigen::Index>(kGates) * layer.size();
    fits = fits && layer.kernel.cols() == inputs && layer.kernel.rows() == gates && layer.recurrent.rows() == gates;
    inputs = layer.size();
  }
  if (!fits || matrix_.cols() != inputs || offset_.size() != matrix_.rows()) throw refuse();
}

Eigen::MatrixXf LstmNetwork::run_layer(const Layer& layer, const Eigen::MatrixXf& inputs, LayerState& state) {
  const Eigen::Index n = layer.size(), sequences = state.output.cols();
  Eigen::MatrixXf gates = layer.kernel * inputs;
  gates.colwise() += layer.offset;
  Eigen::MatrixXf outputs(n, inputs.cols());
  for (Eigen::Index at = 0; at < inputs.cols(); at += sequences) {
    auto step = gates.middleCols(at, sequences);
    step.noalias() += layer.recurrent * state.output;
    const Eigen::ArrayXXf open = openings_of(step.topRows(3 * n).array());
    state.cell = (open.middleRows(2 * n, n) * state.cell.array() + open.topRows(n) * step.bottomRows(n).array().tanh()).matrix();
    state.output = (open.middleRows(n, n) * state.cell.array().tanh()).matrix();
    outputs.middleCols(at, sequences) = state.output;
  }
  return outputs;
}

LstmNetwork::State LstmNetwork::start(Eigen::Index sequences) const {
  State state;
  for (const Layer& layer : layers_)
    state.push_back({Eigen::MatrixXf::Zero(layer.size(), sequences), Eigen::MatrixXf::Zero(layer.size(), sequences)});
  return state;
}

Eigen::MatrixXf LstmNetwork::run(const Eigen::MatrixXf& inputs, State& state) const {
  Eigen::MatrixXf values = inputs.colwise() - mean_;
  values.array().colwise() /= spread_.array();
  for (std::size_t i = 0; i < layers_.size(); ++i) values = run_layer(layers_[i], values, state[i]);
  return (matrix_ * values).colwise() + offset_;
}

}  // namespace marey::detect::network
