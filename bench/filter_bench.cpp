// What one target costs a frame: predict and correct of every filter, in the plane and in space, beside cv::KalmanFilter with
// a state of the same size in the same run. `ratio` is OpenCV's time over ours: how many times as fast.
#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/video/tracking.hpp>

#include "marey/filter/filters.h"

namespace marey {
namespace {

constexpr int kTargets = 256;  // more than stay in the first cache for the largest, as with a real tracker
constexpr double kStep = 1.0 / 30;

/// Where target `i` is seen in frame `k`: wavy lines.
template <int D>
Vector<D> location(int i, int k) {
  const double t = kStep * k;
  Vector<D> p = Vector<D>::Constant(10.0 * i + 100 * t);
  p[0] += 20 * std::sin(3 * t + i);
  return p;
}

/// OpenCV's filter with the blocks of a polynomial motion of `order` derivatives.
template <int D>
cv::KalmanFilter opencv_filter(int order) {
  cv::KalmanFilter filter(D * order, D, 0, CV_64F);
  cv::setIdentity(filter.transitionMatrix);
  for (int i = 0; i + D < D * order; ++i) filter.transitionMatrix.at<double>(i, i + D) = kStep;
  cv::setIdentity(filter.measurementMatrix);
  cv::setIdentity(filter.processNoiseCov, cv::Scalar(0.1));
  cv::setIdentity(filter.measurementNoiseCov, cv::Scalar(0.1));
  cv::setIdentity(filter.errorCovPost, cv::Scalar(100));
  return filter;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The least time of one predict and correct over a few rounds, s.
template <int D>
double opencv_cost(int order) {
  std::vector<cv::KalmanFilter> filters;
  for (int i = 0; i < kTargets; ++i) filters.push_back(opencv_filter<D>(order));
  cv::Mat z(D, 1, CV_64F);
  double minimum = 1e9;
  for (int k = 1; k < 30; ++k) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < kTargets; ++i) {
      const Vector<D> p = location<D>(i, k);
      std::copy(p.data(), p.data() + D, z.ptr<double>());
      filters[static_cast<std::size_t>(i)].predict();
      benchmark::DoNotOptimize(filters[static_cast<std::size_t>(i)].correct(z));
    }
    minimum = std::min(minimum, seconds_since(start) / kTargets);
  }
  return minimum;
}

/// How many derivatives OpenCV's filter needs to hold a state of the same size (the next larger, where none is).
int order_of(const std::string& name) {
  if (name == "ekf" || name == "ukf" || name == "kalman-acceleration" || name == "imm") return 3;
  return name == "condensation" ? 1 : 2;
}

template <int D>
struct Run {
  benchmark::State& state;
  int order;

  template <typename F>
  void operator()(const typename F::Options& options) const {
    const Matrix<D> R = 0.01 * Matrix<D>::Identity();
    std::vector<F> filters;
    for (int i = 0; i < kTargets; ++i) filters.emplace_back(options, location<D>(i, 0), R);
    std::vector<Vector<D>> detected(kTargets);
    double minimum = 1e9;
    int k = 0;
    for (auto _ : state) {
      ++k;
      for (int i = 0; i < kTargets; ++i) detected[static_cast<std::size_t>(i)] = location<D>(i, k);
      const auto start = std::chrono::steady_clock::now();
      for (int i = 0; i < kTargets; ++i) {
        filters[static_cast<std::size_t>(i)].predict(kStep);
        filters[static_cast<std::size_t>(i)].correct(detected[static_cast<std::size_t>(i)], R);
      }
      benchmark::ClobberMemory();
      minimum = std::min(minimum, seconds_since(start) / kTargets);
    }
    state.counters["ns_per_target"] = 1e9 * minimum;
    const double opencv = opencv_cost<D>(order);
    state.counters["opencv_ns"] = 1e9 * opencv;
    state.counters["ratio"] = opencv / minimum;
    state.SetItemsProcessed(state.iterations() * kTargets);
  }
};

template <int D>
void run(benchmark::State& state, const filter::NamedFilter& filter) {
  filter::with_filter<D>(filter.options, Run<D>{state, order_of(std::string(filter.name))});
}

const int registered = [] {
  for (const filter::NamedFilter& filter : filter::named_filters()) {
    const std::string name(filter.name);
    benchmark::RegisterBenchmark((name + "/2D").c_str(), [&filter](benchmark::State& state) { run<2>(state, filter); });
    benchmark::RegisterBenchmark((name + "/3D").c_str(), [&filter](benchmark::State& state) { run<3>(state, filter); });
  }
  return 0;
}();

}  // namespace
}  // namespace marey
