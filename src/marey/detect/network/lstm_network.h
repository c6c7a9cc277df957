// A network of LSTM layers over sequences, as script/model --augmenter writes it: inputs less their mean, divided by their spread,
// the layers (Hochreiter & Schmidhuber 1997, with forget gates), and a matrix with an offset at the end. A loop of its own, because
// OpenCV's dnn does not compute it. Cost: about a million multiplications a step and sequence for five layers of 128.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "marey/detect/network/onnx_graph.h"

namespace marey::detect::network {

class LstmNetwork {
 public:
  /// Throws Error, with `file` for the name, if the graph is another network.
  LstmNetwork(const OnnxGraph& graph, const std::string& file);

  Eigen::Index features() const { return mean_.size(); }
  Eigen::Index outputs() const { return matrix_.rows(); }

  /// A layer's outputs and cells after one step, a column a sequence.
  struct LayerState {
    Eigen::MatrixXf output, cell;
  };
  using State = std::vector<LayerState>;
  /// Before the first step, of as many sequences: all is 0.
  State start(Eigen::Index sequences) const;

  /// The next steps of several sequences: a column a step and sequence, those of one step together (step · sequences + sequence).
  /// `features()` rows come, `outputs()` go. Memory: 2 kB a column.
  Eigen::MatrixXf run(const Eigen::MatrixXf& inputs, State& state) const;

 private:
  /// Gates by rows: input, output, forget, cell, `size` of each.
  struct Layer {
    Eigen::MatrixXf kernel, recurrent;  ///< 4 size × inputs, 4 size × size
    Eigen::VectorXf offset;
    Eigen::Index size() const { return recurrent.cols(); }
  };

  static Eigen::MatrixXf run_layer(const Layer& layer, const Eigen::MatrixXf& inputs, LayerState& state);

  Eigen::VectorXf mean_, spread_, offset_;
  Eigen::MatrixXf matrix_;
  std::vector<Layer> layers_;
};

}  // namespace marey::detect::network
