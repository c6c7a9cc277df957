// Whole runs on a street video, decode to written tracks, against what others pay before they have found any person: decoding by
// cv::VideoCapture and OpenCV's MOG2, and decoding alone. All in one process on the same cores; the counters give ratios of
// frames per second, from the rounds' minimum time, rounds taken in turn so that a busy machine slows all alike.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <opencv2/video/background_segm.hpp>
#include <opencv2/videoio.hpp>
#include <unistd.h>

#include "marey/pipeline/people/track_in_image.h"
#include "marey/source/open_source.h"

namespace {

constexpr int kRounds = 5;

template <typename Work>
double seconds_of(Work work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void opencv_decode(const std::string& video, bool with_mog2) {
  cv::VideoCapture capture(video);
  const auto model = cv::createBackgroundSubtractorMOG2();
  for (cv::Mat frame, mask; capture.read(frame);) {
    if (with_mog2) model->apply(frame, mask);
  }
}

void marey_decode(const std::string& video) {
  const auto source = marey::source::open_source(video);
  while (source->next()) continue;
}

}  // namespace

int main(int argc, char** argv) {
  // Options of Google Benchmark, which script/bench hands to every benchmark, are not any of a video.
  const bool named = argc > 1 && argv[1][0] != '-';
  const std::string video = named ? argv[1] : "/usr/share/doc/opencv-doc/examples/data/vtest.avi";
  if (!std::filesystem::exists(video)) {
    std::printf("%s is not here: install opencv-doc, or name a video\n", video.c_str());
    return 0;
  }
  const std::string tracks = (std::filesystem::temp_directory_path() / fmt::format("marey_end_to_end_{}.txt", ::getpid())).string();
  double whole = std::numeric_limits<double>::infinity(), mog2 = whole, decode = whole, own_decode = whole;
  double frames = 0;
  marey::RigCamera camera;
  camera.source = video;
  for (int round = 0; round < kRounds; ++round) {
    whole = std::min(whole, seconds_of([&] {
                       frames = static_cast<double>(marey::pipeline::people::track_people(camera, {.tracks = tracks}).frames);
                     }));
    mog2 = std::min(mog2, seconds_of([&] { opencv_decode(video, true); }));
    decode = std::min(decode, seconds_of([&] { opencv_decode(video, false); }));
    own_decode = std::min(own_decode, seconds_of([&] { marey_decode(video); }));
  }
  std::filesystem::remove(tracks);
  const auto print = [&](const char* what, double time) {
    std::printf("%-44s %8.3f ms/frame %8.0f frames/s   whole run is %5.2f times as fast\n", what, 1000 * time / frames,
                frames / time, time / whole);
  };
  std::printf("%s, %.0f frames, best of %d rounds\n", video.c_str(), frames, kRounds);
  print("marey track, decode to written tracks", whole);
  print("cv::VideoCapture and MOG2 alone", mog2);
  print("cv::VideoCapture alone", decode);
  print("Marey's decoding alone", own_decode);
  return 0;
}
