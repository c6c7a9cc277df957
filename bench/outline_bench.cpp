// 25 outlines a frame, 24 lines and 24 control points each, beside what else could be done to get them in the same run: OpenCV's
// contours of the same mask, each approximated; and the bound, reading as many bytes as the lines do. Relevant figures: ms a frame,
// which must stay below 5.
#include <cmath>
#include <numeric>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/imgproc.hpp>

#include "marey/detect/silhouette.h"
#include "marey/geometry/bspline.h"
#include "marey/simulate/people/people_video.h"
#include "marey/track/contour/contour_tracker.h"

namespace marey {
namespace {

constexpr int kTargets = 25, kFrames = 40, kLines = 24, kPoints = 24, kLinePixels = 24;

/// True silhouettes of a video, 60 px tall, each person's in a tile of its own: nothing but the outlines is measured.
struct Scene {
  std::vector<cv::Mat> masks;
  std::vector<std::vector<Detection>> detections;
};

const Scene& scene() {
  static const Scene made = [] {
    Scene result;
    simulate::people::PeopleVideoOptions options;
    options.frames = kFrames;
    options.people = 1;
    const simulate::people::PeopleVideo video(simulate::people::PeopleSituation::apart, 1, options);
    for (int k = 0; k < kFrames; ++k) {
      const simulate::people::RenderedFrame rendered = video.render(k);
      cv::Mat mask = cv::Mat::zeros(720, 1280, CV_8UC1);
      std::vector<Detection> detections;
      if (!rendered.people.empty()) {
        const cv::Mat person = rendered.people[0].visible.pixel_mask(video.options().size);
        const cv::Rect box = cv::boundingRect(person);
        for (int i = 0; i < kTargets; ++i) {
          const cv::Point location(60 + i % 5 * 240 + 2 * k, 20 + i / 5 * 140);
          person(box).copyTo(mask(cv::Rect(location, box.size())));
        }
      }
      for (const detect::Region& region : detect::find_regions(mask, {.min_area = 100})) {
        Detection& one = detections.emplace_back();
        one.centre = region.centre;
        one.box = region.box;
        one.outline = detect::outline_of(region.runs);
      }
      result.masks.push_back(mask);
      result.detections.push_back(std::move(detections));
    }
    return result;
  }();
  return made;
}

/// With silhouettes, every target is seen by the detector and its outline taken from there; without, lines alone follow it.
void track_outlines(benchmark::State& state) {
  const bool always = state.range(0) != 0;
  track::contour::OutlineOptions options;
  options.control_points = kPoints;
  options.lines = kLines;
  track::contour::ContourTracker tracker(options);
  std::vector<Track<2>> tracks;
  int frame = 0;
  const auto step = [&](bool all) {
    const auto k = static_cast<std::size_t>(frame) % kFrames;
    const std::vector<Detection>& detected = scene().detections[k];
    tracks.resize(detected.size());
    for (std::size_t i = 0; i < detected.size(); ++i) {
      tracks[i].id = TrackId{static_cast<int>(i) + 1};
      tracks[i].observation = all ? std::optional<int>(static_cast<int>(i)) : std::nullopt;
    }
    Frame now;
    now.index = frame;
    now.time = timestamp_from_seconds(frame / 25.0);
    ++frame;
    tracker.observe(now, Foreground{scene().masks[k], {}}, detected);
    benchmark::DoNotOptimize(tracker.attach(tracks, detected));
  };
  for (int k = 0; k < 4; ++k) step(true);
  for (auto _ : state) step(always || frame % kFrames < 3);
}
BENCHMARK(track_outlines)->ArgName("silhouettes")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void opencv_contours(benchmark::State& state) {
  std::size_t k = 0;
  std::vector<std::vector<cv::Point>> contours;
  std::vector<cv::Point> corners;
  for (auto _ : state) {
    cv::findContours(scene().masks[k++ % kFrames], contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    for (const auto& contour : contours) cv::approxPolyDP(contour, corners, 1, true);
    benchmark::DoNotOptimize(corners.data());
  }
}
BENCHMARK(opencv_contours)->Unit(benchmark::kMillisecond);

/// Four bytes for each pixel of each line, in order.
void bytes_of_the_lines(benchmark::State& state) {
  const std::vector<std::uint8_t> bytes(kTargets * kLines * kLinePixels * 4, 1);
  for (auto _ : state) benchmark::DoNotOptimize(std::accumulate(bytes.begin(), bytes.end(), 0));
}
BENCHMARK(bytes_of_the_lines)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace marey
