// The marker detector beside what OpenCV offers, and beside copying the image once. One core; 50 markers of radius 2–4 px, noise 3.
#include <cstring>
#include <map>
#include <random>
#include <tuple>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "marey/detect/markers/marker_detector.h"
#include "marey/simulate/markers/discs.h"

namespace {

using namespace marey;

constexpr double kThreshold = 60;

/// Cached, because every benchmark is set up several times.
const cv::Mat& scene(int width, int height, int depth, int markers = 50) {
  static std::map<std::tuple<int, int, int, int>, cv::Mat> scenes;
  cv::Mat& image = scenes[{width, height, depth, markers}];
  if (!image.empty()) return image;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> x(10, width - 10), y(10, height - 10), radius(2, 4);
  const double scale = depth == CV_8U ? 1 : 16;
  cv::Mat clean(height, width, CV_32FC1, cv::Scalar(12 * scale));
  for (int i = 0; i < markers; ++i) {
    const double px = x(random), py = y(random);
    const simulate::markers::Disc disc{{px, py}, radius(random), 202 * scale};
    simulate::markers::draw_discs(clean, std::span(&disc, 1));
  }
  image = simulate::markers::expose(clean, 3 * scale, 1, depth);
  return image;
}

const cv::Mat& scene(const benchmark::State& state) {
  cv::setNumThreads(1);
  return scene(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), state.range(2) == 8 ? CV_8U : CV_16U);
}

void marey_detector(benchmark::State& state) {
  Frame frame;
  frame.image = Image(scene(state));
  detect::markers::MarkerDetector detector;
  std::size_t found = 0;
  for (auto _ : state) found = detector.detect(frame, {}).detections.size();
  state.counters["found"] = static_cast<double>(found);
}

void copy(benchmark::State& state) {
  const cv::Mat& image = scene(state);
  cv::Mat target(image.size(), image.type());
  for (auto _ : state) {
    std::memcpy(target.data, image.data, image.total() * image.elemSize());
    benchmark::DoNotOptimize(target.data);
    benchmark::ClobberMemory();
  }
}

void opencv_components(benchmark::State& state) {
  const cv::Mat& image = scene(state);
  const double threshold = image.depth() == CV_8U ? kThreshold : 16 * kThreshold;
  cv::Mat above, bytes, labels, statistics, centroids;
  int found = 0;
  for (auto _ : state) {
    cv::threshold(image, above, threshold, 255, cv::THRESH_BINARY);
    if (above.depth() != CV_8U) above.convertTo(bytes, CV_8U);
    found = cv::connectedComponentsWithStats(above.depth() == CV_8U ? above : bytes, labels, statistics, centroids) - 1;
  }
  state.counters["found"] = found;
}

void opencv_blob_detector(benchmark::State& state) {
  cv::Mat image = scene(state);
  if (image.depth() != CV_8U) image.convertTo(image, CV_8U, 1.0 / 16);
  cv::SimpleBlobDetector::Params options;
  options.filterByColor = true;
  options.blobColor = 255;
  options.filterByArea = true;
  options.minArea = 4;
  options.filterByConvexity = options.filterByInertia = false;
  options.minDistBetweenBlobs = 3;
  const auto detector = cv::SimpleBlobDetector::create(options);
  std::vector<cv::KeyPoint> points;
  for (auto _ : state) detector->detect(image, points);
  state.counters["found"] = static_cast<double>(points.size());
}

void sizes(benchmark::internal::Benchmark* bench) {
  for (const int bits : {8, 16}) {
    for (const auto& [width, height] : {std::pair(640, 480), std::pair(1280, 1024), std::pair(2048, 2048)}) {
      bench->Args({width, height, bits});
    }
  }
  bench->Unit(benchmark::kMicrosecond);
}

BENCHMARK(copy)->Apply(sizes);
BENCHMARK(marey_detector)->Apply(sizes);
BENCHMARK(opencv_components)->Apply(sizes);
BENCHMARK(opencv_blob_detector)->Apply(sizes);

/// 5,000 spots of glare, and a frame of nothing but noise about the threshold.
void glare(benchmark::State& state) {
  Frame frame;
  frame.image = Image(scene(1280, 1024, CV_8U, 5000));
  detect::markers::MarkerDetector detector;
  for (auto _ : state) benchmark::DoNotOptimize(detector.detect(frame, {}));
}
BENCHMARK(glare)->Unit(benchmark::kMicrosecond);

}  // namespace
