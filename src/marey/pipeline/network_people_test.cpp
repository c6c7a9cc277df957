// A detection network on frames of real videos: what it finds, and how often it runs.
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "marey/detect/network/network_detector.h"
#include "marey/source/open_source.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::pipeline {
namespace {

/// A detector of people with the real network alone, and frames of a real video.
class RealNetwork : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(test::data("models/person_ssd_mobilenetv2.onnx")))
      GTEST_SKIP() << test::data("models/person_ssd_mobilenetv2.onnx") << " is not here";
    test::write_file(folder_ / "person.toml", fmt::format("network = \"{}\"\ninput = [300, 300]\nperson = 4\n",
                                                          test::data("models/person_ssd_mobilenetv2.onnx")));
    options_.model = folder_ / "person.toml";
    options_.background = false;
  }

  /// The frame with this index of a video, as if it came at that time.
  static Frame frame_of(const std::string& video, int index) {
    const auto source = source::open_source(video);
    std::optional<Frame> frame;
    for (int i = 0; i <= index; ++i) frame = source->next();
    return *frame;
  }
  static Frame at(Frame frame, double time_s) {
    frame.time = timestamp_from_seconds(time_s);
    return frame;
  }

  test::TemporaryFolder folder_;
  detect::network::NetworkDetectorOptions options_;
};

TEST_F(RealNetwork, RunsOnlyWhereSomethingChanged) {
  if (!std::filesystem::exists(test::vtest())) GTEST_SKIP() << test::vtest() << " is not here: install opencv-doc";
  detect::network::NetworkDetector detector(options_);
  const Frame first = frame_of(test::vtest(), 20);
  const auto found = detector.detect(at(first, 0), {}).detections;
  const auto tiles = detector.tiles_searched();
  EXPECT_GE(found.size(), 4u);
  const auto again = detector.detect(at(first, 0.1), {}).detections;
  EXPECT_EQ(again.size(), found.size()) << "they stand where they stood";
  EXPECT_EQ(detector.tiles_searched(), tiles) << "and cost nothing";
  std::vector<Expected> expected;
  for (const Detection& one : found) expected.push_back({one.box});
  const auto later = detector.detect(at(frame_of(test::vtest(), 22), 0.2), expected).detections;
  EXPECT_GE(later.size() + 2, found.size()) << "they walked on";
  EXPECT_LE(detector.tiles_searched() - tiles, std::ssize(found)) << "a tile round each at most";
}

TEST_F(RealNetwork, FindsAPersonWhoFillsThePicture) {
  const std::string video = test::data("clips/walk_in_room.mp4");
  if (!std::filesystem::exists(video)) GTEST_SKIP() << video << " is not here";
  detect::network::NetworkDetector detector(options_);
  const auto found = detector.detect(at(frame_of(video, 300), 0), {}).detections;
  ASSERT_EQ(found.size(), 1u);
  EXPECT_GT(found[0].box.height, 250);
}

}  // namespace
}  // namespace marey::pipeline
