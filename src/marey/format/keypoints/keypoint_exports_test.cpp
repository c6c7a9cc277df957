#include "marey/format/keypoints/keypoint_exports.h"

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/core/keypoint_sets.h"
#include "marey/format/keypoints/keypoint_file.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"

#include "support/files.h"

namespace marey::format::keypoints {
namespace {

RecordingHeader image_header(const KeypointSet& set) {
  RecordingHeader header;
  header.frame.kind = FrameOfReference::Kind::image;
  header.rate_hz = 30;
  header.keypoints = set;
  header.rig.emplace().cameras.emplace_back().size = cv::Size(640, 480);
  return header;
}

/// Point i of a person lies at (100 person + 3 i, 50 + 7 i); every fifth is absent.
std::shared_ptr<Keypoints<2>> person_of(int person, std::size_t points) {
  auto body = std::make_shared<Keypoints<2>>();
  body->presence = 0.75;
  for (std::size_t i = 0; i < points; ++i) {
    auto& point = body->points.emplace_back();
    if (i % 5 == 4) continue;
    point = Keypoint<2>{.position = {100.0 * person + 3.0 * static_cast<double>(i), 50 + 7.0 * static_cast<double>(i)},
                        .covariance = 4 * Matrix<2>::Identity(),
                        .visibility = 0.5,
                        .presence = 0.8};
  }
  return body;
}

/// Two people in frame 0, none in frame 1, no frame 2, one person in frame 3; one box has no keypoints.
void write_through_register(const std::string& path, std::string_view name, const KeypointSet& set, bool finish = true) {
  const Format& format = format_to_write(path, name, Content::image);
  const auto sink = create_recording(path, format);
  sink->begin(image_header(set));
  for (const std::int64_t index : {0, 1, 3}) {
    Instant instant;
    instant.index = index;
    for (int person = 1; person <= (index == 0 ? 2 : index == 3 ? 1 : 0); ++person) {
      Sample& sample = instant.samples.emplace_back();
      sample.track = TrackId{person};
      sample.box = Box{100.0 * person, 50, 90, 200};
      sample.keypoints = person_of(person, set.points.size());
    }
    instant.samples.emplace_back().track = TrackId{9};
    sink->write(instant);
  }
  if (finish) sink->finish();
}

TEST(KeypointExports, CocoIsReadBackWithTheSamePoints) {
  const test::TemporaryFolder folder;
  const KeypointSet& set = keypoint_set_named("blazepose");
  write_through_register(folder / "people.json", "", set);
  const KeypointSequence read = read_keypoints(folder / "people.json");
  EXPECT_EQ(read.set.points, set.points);
  EXPECT_EQ(read.rate_hz, 30);
  EXPECT_EQ(read.size, cv::Size(640, 480));
  ASSERT_EQ(read.frames.size(), 4U);
  EXPECT_EQ(read.frames[0].size(), 2U);
  EXPECT_TRUE(read.frames[1].empty() && read.frames[2].empty());
  ASSERT_EQ(read.frames[3].size(), 1U);
  for (int person = 1; person <= 2; ++person) {
    const Keypoints<2>& body = read.frames[0][static_cast<std::size_t>(person) - 1];
    const auto written = person_of(person, set.points.size());
    EXPECT_NEAR(body.presence, 0.75, 1e-6);
    for (std::size_t i = 0; i < set.points.size(); ++i) {
      ASSERT_EQ(body.points[i].has_value(), written->points[i].has_value()) << set.points[i];
      if (!body.points[i]) continue;
      EXPECT_LT((body.points[i]->position - written->points[i]->position).norm(), 1e-3);
      EXPECT_NEAR(body.points[i]->visibility, 0.4, 1e-4);
    }
  }
}

TEST(KeypointExports, OpenPoseIsReadBackWithTheSamePoints) {
  const test::TemporaryFolder folder;
  const KeypointSet& set = keypoint_set_named("blazepose");
  write_through_register(folder / "people_json", "", set);
  EXPECT_TRUE(std::filesystem::exists(folder / "people_json/people_000000000002_keypoints.json"));
  const KeypointSequence read = read_keypoints(folder / "people_json");
  EXPECT_EQ(read.set.name, "body_25");
  ASSERT_EQ(read.frames.size(), 4U);
  EXPECT_TRUE(read.frames[1].empty() && read.frames[2].empty());
  ASSERT_EQ(read.frames[0].size(), 2U);
  const auto written = person_of(2, set.points.size());
  const auto point_of = [](const KeypointSet& of, const Keypoints<2>& body, std::string_view name) {
    return body.points[static_cast<std::size_t>(*point_named(of, name))];
  };
  int compared = 0;
  for (const std::string& name : read.set.points) {
    const auto point = point_of(read.set, read.frames[0][1], name);
    if (!point_named(set, name)) continue;
    const auto own = point_of(set, *written, name);
    ASSERT_EQ(point.has_value(), own.has_value()) << name;
    if (!point) continue;
    EXPECT_LT((point->position - own->position).norm(), 1e-3) << name;
    ++compared;
  }
  EXPECT_GE(compared, 15);
  const auto hips = point_of(read.set, read.frames[0][1], "mid_hip"), left = point_of(set, *written, "left_hip"),
             right = point_of(set, *written, "right_hip");
  ASSERT_EQ(hips.has_value(), left && right);
  if (hips) {
    EXPECT_LT((hips->position - (left->position + right->position) / 2).norm(), 1e-3);
  }
  EXPECT_FALSE(point_of(read.set, read.frames[0][1], "left_small_toe"));
}

TEST(KeypointExports, BlazePosesToesAreThoseOfBody25) {
  KeypointSet set = keypoint_set_named("blazepose");
  set.points[31] = "left_foot_index";  // as the network calls it
  const Keypoints<2> body = OpenPoseBody(set).of(*person_of(1, 33));
  const auto toe = body.points[static_cast<std::size_t>(*point_named(keypoint_set_named("body_25"), "left_big_toe"))];
  ASSERT_TRUE(toe);
  EXPECT_EQ(toe->position, Vector<2>(100 + 3 * 31, 50 + 7 * 31));
}

TEST(KeypointExports, LeaveNothingBehindWithoutFinish) {
  const test::TemporaryFolder folder;
  write_through_register(folder / "a.json", "coco", keypoint_set_named("coco"), false);
  write_through_register(folder / "a", "openpose", keypoint_set_named("coco"), false);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(KeypointExports, RefuseAFullFolderAndOtherRecordings) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder / "full_json");
  std::ofstream(folder / "full_json/note.txt") << "mine";
  EXPECT_THROW(write_through_register(folder / "full_json", "", keypoint_set_named("coco")), Error);
  EXPECT_TRUE(std::filesystem::exists(folder / "full_json/note.txt"));
  const auto sink = create_recording(folder / "a.json", format_to_write(folder / "a.json", "", Content::image));
  RecordingHeader boxes = image_header({});
  boxes.keypoints.reset();
  EXPECT_THROW(sink->begin(boxes), Error);
}

}  // namespace
}  // namespace marey::format::keypoints
