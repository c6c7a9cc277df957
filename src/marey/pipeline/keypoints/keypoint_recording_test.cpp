#include "marey/pipeline/keypoints/keypoint_recording.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/core/keypoint_sets.h"
#include "marey/format/take/take_file.h"

#include "support/files.h"

namespace marey::pipeline::keypoints {
namespace {

Recording people_in_image() {
  RecordingHeader header;
  header.name = "dance";
  header.frame.kind = FrameOfReference::Kind::image;
  header.rate_hz = 50;
  header.keypoints = keypoint_set_named("coco");
  header.rig.emplace().cameras.emplace_back().name = "left";
  header.rig->cameras.front().size = cv::Size(640, 480);
  Recording recording(header);
  for (const int index : {1, 2, 4}) {
    Instant instant;
    instant.index = index;
    instant.time = timestamp_from_seconds(index / 50.0);
    for (int person = 1; person <= index; ++person) {
      auto body = std::make_shared<Keypoints<2>>();
      body->presence = 1;
      body->points.resize(header.keypoints->points.size());
      body->points[3] = Keypoint<2>{.position = {10.0 * index, person}, .visibility = 0.5, .presence = 1};
      Sample& sample = instant.samples.emplace_back();
      sample.track = TrackId{person};
      if (person < 4) sample.keypoints = body;  // the fourth has a box alone
    }
    recording.add(instant);
  }
  return recording;
}

TEST(KeypointRecording, GivesATakesPeopleFrameByFrame) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "dance.marey";
  format::take::write_recording(path, people_in_image());
  const KeypointSequence read = keypoints_of_take(path);
  EXPECT_EQ(read.set.name, "coco");
  EXPECT_EQ(read.rate_hz, 50);
  EXPECT_EQ(read.size, cv::Size(640, 480));
  EXPECT_EQ(read.from, path);
  ASSERT_EQ(read.frames.size(), 5U);  // counted from 0: the first and the fourth are not in the take
  EXPECT_EQ(read.frames[0].size(), 0U);
  EXPECT_EQ(read.frames[2].size(), 2U);
  EXPECT_EQ(read.frames[3].size(), 0U);
  ASSERT_EQ(read.frames[4].size(), 3U);
  ASSERT_TRUE(read.frames[4][1].points[3]);
  EXPECT_EQ(read.frames[4][1].points[3]->position, Vector<2>(40, 2));
  EXPECT_FALSE(read.frames[4][1].points[2]);
}

TEST(KeypointRecording, RefusesOtherRecordings) {
  KeypointSequence into;
  into.from = "some.marey";
  KeypointCollector collector(into);
  RecordingHeader header = people_in_image().header;
  header.frame.kind = FrameOfReference::Kind::space;
  EXPECT_THROW(collector.begin(header), Error);
  header.frame.kind = FrameOfReference::Kind::image;
  header.keypoints.reset();
  EXPECT_THROW(collector.begin(header), Error);
  collector.begin(people_in_image().header);
  Instant far;
  far.index = 1'000'000'000;
  EXPECT_THROW(collector.write(far), Error);
}

}  // namespace
}  // namespace marey::pipeline::keypoints
