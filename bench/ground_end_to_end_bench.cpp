// Images to places on the ground, decode to written tracks, over a simulated match seen by one camera at 1920 × 1080 and at
// 3072 × 1728, against what others pay before they have found any person: decoding by cv::VideoCapture and OpenCV's MOG2, and
// decoding alone. All in one process on the same cores; counters are ratios of frames per second, from the rounds' minimum time,
// rounds taken in turn so that a busy machine slows all alike. Rendering the videos comes first and takes a minute.
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

#include "marey/format/rig/rig_file.h"
#include "marey/pipeline/people/ground/track_ground.h"
#include "marey/pipeline/simulate/match_files.h"
#include "marey/source/open_source.h"

namespace {

constexpr int kRounds = 3;
constexpr double kSeconds = 4;  // of video

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

void compare(const std::string& folder, cv::Size size) {
  marey::pipeline::simulate::MatchFilesOptions match;
  match.cameras.cameras = 1, match.cameras.size = size;
  match.seconds = kSeconds, match.boxes = false, match.videos = true;
  marey::pipeline::simulate::write_match(match, folder);
  const marey::Rig rig = marey::format::rig::read_rig(folder + "/rig.toml");
  marey::pipeline::people::ground::GroundOutput output;
  output.tracks = folder + "/out.csv";
  marey::pipeline::people::ground::PeopleOnGroundOptions options;
  options.pitch.emplace();
  double whole = std::numeric_limits<double>::infinity(), mog2 = whole, decode = whole, own_decode = whole;
  double frames = 0;
  for (int round = 0; round < kRounds; ++round) {
    whole = std::min(whole, seconds_of([&] {
                       frames = static_cast<double>(marey::pipeline::people::ground::track_ground(rig, output, options).frames);
                     }));
    mog2 = std::min(mog2, seconds_of([&] { opencv_decode(rig.cameras[0].source, true); }));
    decode = std::min(decode, seconds_of([&] { opencv_decode(rig.cameras[0].source, false); }));
    own_decode = std::min(own_decode, seconds_of([&] { marey_decode(rig.cameras[0].source); }));
  }
  const auto print = [&](const char* what, double time) {
    std::printf("%-44s %8.3f ms/frame %8.0f frames/s   whole run is %5.2f times as fast\n", what, 1000 * time / frames,
                frames / time, time / whole);
  };
  std::printf("%d x %d, %.0f frames, best of %d rounds\n", size.width, size.height, frames, kRounds);
  print("marey track --ground, to written places", whole);
  print("cv::VideoCapture and MOG2 alone", mog2);
  print("cv::VideoCapture alone", decode);
  print("Marey's decoding alone", own_decode);
  std::fflush(stdout);
}

}  // namespace

int main() {
  const std::string folder = (std::filesystem::temp_directory_path() / fmt::format("marey_ground_{}", ::getpid())).string();
  for (const cv::Size size : {cv::Size(1920, 1080), cv::Size(3072, 1728)}) {
    std::filesystem::create_directories(folder);
    compare(folder, size);
    std::filesystem::remove_all(folder);
  }
  return 0;
}
