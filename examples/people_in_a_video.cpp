// People in a video, as a recording in memory: how far did each of them walk, in the image?
//   people_in_a_video street.mp4
#include <cstdio>
#include <memory>
#include <vector>

#include "marey/core/error.h"
#include "marey/core/recording_sink.h"
#include "marey/pipeline/people/image_stage.h"

int main(int argc, char** argv) try {
  if (argc != 2) return std::puts("usage: people_in_a_video VIDEO"), 2;
  marey::RigCamera camera;
  camera.source = argv[1];
  std::vector<marey::pipeline::corridor::Feed> feeds;
  feeds.emplace_back(camera, marey::CameraId{});
  const auto stage = marey::pipeline::people::people_in_image(feeds.front(), {});

  marey::Recording recording;
  marey::pipeline::corridor::Sinks sinks;
  sinks.add(std::make_unique<marey::RecordingSink>(recording));
  marey::pipeline::corridor::Clock clock(std::move(feeds));
  const marey::pipeline::corridor::Summary summary = marey::pipeline::corridor::run(*stage, clock, sinks);

  std::printf("%lld people in %.1f s\n", static_cast<long long>(summary.tracks), summary.seconds);
  for (const marey::TrackColumns& track : recording.tracks()) {
    double length = 0;
    for (std::size_t i = 1; i < track.size(); ++i) length += (track.location(i) - track.location(i - 1)).norm();
    std::printf("%3d: %4zu frames, %6.0f px\n", marey::number(track.id()), track.size(), length);
  }
  return 0;
} catch (const marey::Error& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
