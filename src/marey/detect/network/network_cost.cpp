#include "marey/detect/network/network_cost.h"

#include <algorithm>
#include <chrono>
#include <vector>

#include <opencv2/core/mat.hpp>
#include <opencv2/core/utility.hpp>

#include "marey/detect/network/run_network.h"
#include "marey/detect/network/tiles.h"

namespace marey::detect::network {

NetworkCost network_cost(const NetworkDetectorOptions& options, cv::Size image) {
  constexpr int kRounds = 2;  // numerical: the first warms up
  LoadedNetwork network(read_network_model(options.model));
  NetworkCost cost;
  cost.threads = std::max(1, cv::getNumThreads());
  cost.tiles = static_cast<int>(tiles_over(image, {}, options.first_height).size());
  const std::vector<cv::Mat> tiles(static_cast<std::size_t>(cost.threads), cv::Mat(300, 300, CV_8UC3, cv::Scalar(90, 120, 110)));
  for (int round = 0; round < kRounds; ++round) {
    const auto begin = std::chrono::steady_clock::now();
    network.find_all(tiles);
    cost.tile_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / static_cast<double>(tiles.size());
  }
  return cost;
}

}  // namespace marey::detect::network
