// Reads crops with the network for shirt numbers, for numbers_test.py to compare with another program.
//
//   shirt_digits NETWORK.onnx CROPS.bin OUTPUT.bin
//
// CROPS.bin holds crops of 48 × 96 × 3 bytes, blue first; OUTPUT.bin gets what the network says of each, 12 × 6,625 floats.
#include <fstream>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/detect/shirts/shirt_network.h"

int main(int argc, char** argv) {
  if (argc != 4) {
    fmt::print(stderr, "usage: shirt_digits NETWORK.onnx CROPS.bin OUTPUT.bin\n");
    return 2;
  }
  try {
    marey::detect::shirts::ShirtNetwork network(argv[1]);
    std::ifstream crops(argv[2], std::ios::binary);
    std::ofstream output(argv[3], std::ios::binary);
    cv::Mat crop(48, 96, CV_8UC3);
    while (crops.read(crop.ptr<char>(), static_cast<std::streamsize>(crop.total() * crop.elemSize()))) {
      const auto values = network.raw(crop).values;
      output.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(float)));
    }
  } catch (const marey::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
