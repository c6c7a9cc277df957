// Background models on frames of the street video, resized: Marey's own, primed, against OpenCV's on BGR with their defaults. All
// run in this process with the same threads; `against_mog2` is MOG2's time over the model's.
#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/bgsegm.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/background_segm.hpp>

#include "marey/detect/appearance.h"
#include "marey/detect/background/background.h"
#include "marey/source/video_source.h"

namespace {

using namespace marey;

constexpr const char* kVideo = "/usr/share/doc/opencv-doc/examples/data/vtest.avi";
constexpr int kFrames = 40;

struct Clip {
  std::vector<Frame> frames;
  std::vector<cv::Mat> bgr;
};

const Clip& clip(int width, int height) {
  static std::map<int, Clip> clips;
  Clip& made = clips[width];
  if (!made.frames.empty()) return made;
  const auto source = source::open_video(kVideo);
  while (made.frames.size() < kFrames) {
    auto frame = source->next();
    if (!frame) break;
    cv::Mat resized;
    cv::resize(frame->image.bgr(), resized, {width, height}, 0, 0, cv::INTER_LINEAR);
    frame->image = Image::from_bgr(resized);
    made.bgr.push_back(resized);
    made.frames.push_back(*frame);
  }
  return made;
}

using Step = std::function<void(const Clip&, std::size_t)>;

/// ms a frame, the least of a few rounds over the clip: other programs only ever add to it.
double min_time(const Clip& clip, const Step& step) {
  double minimum = 1e9;
  for (int round = 0; round < 2; ++round) {
    for (std::size_t i = 0; i < clip.frames.size(); ++i) {
      const double begin = static_cast<double>(cv::getTickCount());
      step(clip, i);
      const double time = (static_cast<double>(cv::getTickCount()) - begin) / cv::getTickFrequency() * 1e3;
      if (round > 0) minimum = std::min(minimum, time);
    }
  }
  return minimum;
}

Step opencv(const cv::Ptr<cv::BackgroundSubtractor>& model) {
  return [model, mask = cv::Mat()](const Clip& clip, std::size_t i) mutable { model->apply(clip.bgr[i], mask); };
}

void run(benchmark::State& state, const Step& step) {
  const Clip& shown = clip(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  static std::map<std::int64_t, double> mog2_ms;
  double& mog2 = mog2_ms[state.range(0)];
  if (mog2 == 0) mog2 = min_time(shown, opencv(cv::createBackgroundSubtractorMOG2()));
  const double minimum = min_time(shown, step);
  std::size_t i = 0;
  for (auto _ : state) step(shown, i++ % shown.frames.size());
  state.counters["least_ms"] = minimum;
  state.counters["against_mog2"] = mog2 / minimum;
}

void marey_model(benchmark::State& state) {
  const Clip& shown = clip(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  const std::shared_ptr<detect::background::Background> model = detect::background::make_background();
  model->prime(shown.frames);
  run(state, [model](const Clip& clip, std::size_t i) { benchmark::DoNotOptimize(model->apply(clip.frames[i], {}).mask.data); });
}

void mog2_model(benchmark::State& state) {
  run(state, opencv(cv::createBackgroundSubtractorMOG2()));
}
void knn_model(benchmark::State& state) {
  run(state, opencv(cv::createBackgroundSubtractorKNN()));
}
void cnt_model(benchmark::State& state) {
  run(state, opencv(cv::bgsegm::createBackgroundSubtractorCNT()));
}

/// The colour of one upper body; `against_convert` is what converting the same part of the image to L*a*b* takes, over that.
void upper_body_colour(benchmark::State& state) {
  const Clip& shown = clip(3072, 1728);
  const double height = static_cast<double>(state.range(0));
  const cv::Mat mask(1728, 3072, CV_8UC1, cv::Scalar(255));
  Detection person;
  person.box = {1500, 800, height * 0.4, height};
  const cv::Rect part(1500, 800 + static_cast<int>(0.2 * height), static_cast<int>(0.4 * height), static_cast<int>(0.3 * height));
  const double ours = min_time(shown, [&](const Clip& clip, std::size_t i) {
    benchmark::DoNotOptimize(detect::upper_body(clip.frames[i].image, {.mask = mask}, {&person, 1}, 0));
  });
  const double theirs = min_time(shown, [&](const Clip& clip, std::size_t i) {
    cv::Mat lab;
    cv::cvtColor(clip.bgr[i](part), lab, cv::COLOR_BGR2Lab);
    benchmark::DoNotOptimize(cv::mean(lab));
  });
  for (auto _ : state) benchmark::DoNotOptimize(detect::upper_body(shown.frames[0].image, {.mask = mask}, {&person, 1}, 0));
  state.counters["us"] = ours * 1e3;
  state.counters["against_convert"] = theirs / ours;
}

void sizes(benchmark::internal::Benchmark* bench) {
  if (!std::filesystem::exists(kVideo)) return;
  bench->Args({768, 576})->Args({1920, 1080})->Args({3072, 1728})->Unit(benchmark::kMillisecond)->UseRealTime()->MinTime(0.2);
}
void heights(benchmark::internal::Benchmark* bench) {
  if (!std::filesystem::exists(kVideo)) return;
  bench->Arg(40)->Arg(80)->Arg(300)->Unit(benchmark::kMicrosecond);
}
BENCHMARK(upper_body_colour)->Apply(heights);
BENCHMARK(marey_model)->Apply(sizes);
BENCHMARK(mog2_model)->Apply(sizes);
BENCHMARK(knn_model)->Apply(sizes);
BENCHMARK(cnt_model)->Apply(sizes);

}  // namespace
