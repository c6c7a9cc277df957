// Runs a network of LSTM layers on a file of numbers, for augmenter_test.py.
//   augmented_markers NETWORK.onnx INPUT OUTPUT SEQUENCES    both files: float32, a row of features or outputs a step and sequence
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include <Eigen/Core>

#include "marey/detect/network/lstm_network.h"
#include "marey/detect/network/onnx_graph.h"
#include "marey/format/read_file.h"

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  try {
    const auto graph = marey::detect::network::onnx_graph(marey::format::read_file(argv[1]));
    if (!graph) return 1;
    const marey::detect::network::LstmNetwork network(*graph, argv[1]);
    const std::string bytes = marey::format::read_file(argv[2]);
    const Eigen::Index columns = static_cast<Eigen::Index>(bytes.size() / sizeof(float)) / network.features();
    const Eigen::MatrixXf inputs =
        Eigen::Map<const Eigen::MatrixXf>(reinterpret_cast<const float*>(bytes.data()), network.features(), columns);
    auto state = network.start(std::atoi(argv[4]));
    const Eigen::MatrixXf outputs = network.run(inputs, state);
    std::FILE* file = std::fopen(argv[3], "wb");
    if (file == nullptr) return 1;
    const auto count = static_cast<std::size_t>(outputs.size());
    const bool written = std::fwrite(outputs.data(), sizeof(float), count, file) == count;
    return std::fclose(file) == 0 && written ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
