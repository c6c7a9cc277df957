// A detector of one's own in the place of Marey's: here, whatever is brighter than 200.
//   own_detector lights.mp4 tracks.csv
#include <cstdio>
#include <memory>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"
#include "marey/format/tracks/track_file.h"
#include "marey/pipeline/people/image_stage.h"

class BrightThings final : public marey::detect::Detector {
 public:
  marey::detect::Detections detect(const marey::Frame& frame, std::span<const marey::Expected>) override {
    cv::Mat labels, stats, centres;
    const int count = cv::connectedComponentsWithStats(frame.image.luma() > 200, labels, stats, centres);
    marey::detect::Detections found;
    for (int i = 1; i < count; ++i) {
      const auto at = [&](int what) { return static_cast<double>(stats.at<int>(i, what)); };
      marey::Detection& one = found.detections.emplace_back();
      one.box = {at(cv::CC_STAT_LEFT), at(cv::CC_STAT_TOP), at(cv::CC_STAT_WIDTH), at(cv::CC_STAT_HEIGHT)};
      one.centre = one.box.centre();
      one.area = at(cv::CC_STAT_AREA);
    }
    return found;
  }
};

int main(int argc, char** argv) try {
  if (argc != 3) return std::puts("usage: own_detector VIDEO TRACKS.csv"), 2;
  marey::RigCamera camera;
  camera.source = argv[1];
  std::vector<marey::pipeline::corridor::Feed> feeds;
  feeds.emplace_back(camera, marey::CameraId{});
  feeds.front().find(std::make_unique<BrightThings>());
  const auto stage = marey::pipeline::people::people_in_image(feeds.front(), {});
  marey::pipeline::corridor::Sinks sinks;
  sinks.add(std::make_unique<marey::format::tracks::TrackFile>(argv[2], marey::format::tracks::TrackText::csv));
  marey::pipeline::corridor::Clock clock(std::move(feeds));
  std::printf("%lld targets\n", static_cast<long long>(marey::pipeline::corridor::run(*stage, clock, sinks).tracks));
  return 0;
} catch (const marey::Error& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
