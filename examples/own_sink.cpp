// A sink of one's own: says when a person enters the left half of the image.
//   own_sink boxes.txt 25
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <set>
#include <vector>

#include "marey/core/error.h"
#include "marey/pipeline/people/image_stage.h"

class LeftHalf final : public marey::Sink {
 public:
  explicit LeftHalf(double middle) : middle_(middle) {}
  std::string name() const override { return "the left half"; }
  SinkRequirements begin(const marey::RecordingHeader&) override { return {}; }
  void write(const marey::Instant& instant) override {
    for (const marey::Sample& sample : instant.samples) {
      const bool left = sample.position.x() < middle_;
      if (!left) inside_.erase(sample.track);
      if (left && inside_.insert(sample.track).second)
        std::printf("%8.3f s: %d enters\n", marey::seconds(instant.time), marey::number(sample.track));
    }
  }
  void finish() override { std::puts("that was all"); }

 private:
  double middle_;
  std::set<marey::TrackId> inside_;
};

int main(int argc, char** argv) try {
  if (argc != 3) return std::puts("usage: own_sink DETECTIONS RATE"), 2;
  marey::RigCamera camera;
  camera.detections = argv[1];
  camera.rate_hz = std::atof(argv[2]);
  std::vector<marey::pipeline::corridor::Feed> feeds;
  feeds.emplace_back(camera, marey::CameraId{});
  marey::pipeline::people::ImagePeopleOptions options;
  options.live = true;  // each instant as it comes
  const auto stage = marey::pipeline::people::people_in_image(feeds.front(), options);
  marey::pipeline::corridor::Sinks sinks;
  sinks.add(std::make_unique<LeftHalf>(320));
  marey::pipeline::corridor::Clock clock(std::move(feeds));
  marey::pipeline::corridor::run(*stage, clock, sinks);
  return 0;
} catch (const marey::Error& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
