#include "marey/pipeline/keypoints/body_keypoints.h"

#include <filesystem>
#include <map>
#include <memory>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/core/recording_sink.h"
#include "marey/detect/keypoints/blazepose.h"
#include "marey/detect/keypoints/model_folder.h"
#include "marey/pipeline/keypoints/keypoint_stage.h"
#include "marey/pipeline/people/image_stage.h"
#include "marey/pipeline/people/track_in_image.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::pipeline::keypoints {
namespace {

constexpr std::size_t kNose = 0, kLeftAnkle = 27, kRightAnkle = 28;

bool has_models() {
  try {
    detect::keypoints::landmark_model("lite");
    return std::filesystem::exists(test::vtest());
  } catch (const Error&) {
    return false;
  }
}
#define SKIP_WITHOUT_MODELS() \
  if (!has_models()) GTEST_SKIP() << "script/model has not made the networks, or the street video is not here"

struct Result {
  Recording recording;
  corridor::Summary summary;
};

Result keypoints_of_video(const std::string& video, people::ImagePeopleOptions options,
                          KeypointOptions keypoints = {.model = "lite"}) {
  options.keypoints = keypoints;
  RigCamera camera;
  camera.source = video;
  camera.rate_hz = 7;
  corridor::Feed feed(camera, CameraId{});
  const auto stage = people::people_in_image(feed, options);
  Result result;
  corridor::Sinks sinks;
  sinks.add(std::make_unique<RecordingSink>(result.recording));
  std::vector<corridor::Feed> feeds;
  feeds.push_back(std::move(feed));
  corridor::Clock clock(std::move(feeds));
  result.summary = corridor::run(*stage, clock, sinks);
  return result;
}

/// The first frames of the street video.
std::string street(const test::TemporaryFolder& folder, int frames) {
  test::ffmpeg("-i " + test::vtest() + " -frames:v " + std::to_string(frames) + " -c:v copy " + folder / "street.avi");
  return folder / "street.avi";
}

/// Of the samples with keypoints: noses that are in the upper third of the box, ankles in the lower.
struct Anatomy {
  int bodies = 0, noses = 0, ankles = 0;
};
Anatomy anatomy_of(const Recording& recording) {
  Anatomy anatomy;
  for (const TrackColumns& track : recording.tracks()) {
    for (std::size_t row = 0; row < track.size(); ++row) {
      const Sample sample = track.sample(row);
      if (!sample.keypoints || !sample.box) continue;
      ++anatomy.bodies;
      const auto fraction = [&](std::size_t point) {
        return (sample.keypoints->points[point]->position.y() - sample.box->top) / sample.box->height;
      };
      anatomy.noses += fraction(kNose) > -0.1 && fraction(kNose) < 0.35;
      anatomy.ankles +=
          fraction(kLeftAnkle) > 0.7 && fraction(kLeftAnkle) < 1.15 && fraction(kRightAnkle) > 0.7 && fraction(kRightAnkle) < 1.15;
    }
  }
  return anatomy;
}

TEST(BodyKeypoints, OfPeopleInAStreet) {
  SKIP_WITHOUT_MODELS();
  const test::TemporaryFolder folder;
  const Result result = keypoints_of_video(street(folder, 40), {});
  EXPECT_EQ(result.recording.header.keypoints, detect::keypoints::blazepose());
  EXPECT_EQ(result.summary.frames, 40);
  const Anatomy anatomy = anatomy_of(result.recording);
  EXPECT_EQ(anatomy.bodies, result.summary.keypoints);
  EXPECT_GT(anatomy.bodies, 0.7 * static_cast<double>(result.summary.samples));
  EXPECT_GT(anatomy.noses, 0.9 * anatomy.bodies);
  EXPECT_GT(anatomy.ankles, 0.85 * anatomy.bodies);
}

TEST(BodyKeypoints, LiveTellsEachFrameAsItComes) {
  SKIP_WITHOUT_MODELS();
  const test::TemporaryFolder folder;
  people::ImagePeopleOptions options;
  options.live = true;
  const Result result = keypoints_of_video(street(folder, 40), options);
  const Anatomy anatomy = anatomy_of(result.recording);
  EXPECT_GT(anatomy.bodies, 50);
  EXPECT_GT(anatomy.noses, 0.85 * anatomy.bodies);
}

TEST(BodyKeypoints, BetweenTheFramesThatAreLookedAtPointsGoOn) {
  SKIP_WITHOUT_MODELS();
  const test::TemporaryFolder folder;
  const std::string video = street(folder, 30);
  const Recording every = keypoints_of_video(video, {}).recording;
  const Recording third = keypoints_of_video(video, {}, {.model = "lite", .every = 3}).recording;
  ASSERT_EQ(third.tracks().size(), every.tracks().size());
  int rows = 0, with = 0, near = 0;
  for (std::size_t t = 0; t < every.tracks().size(); ++t) {
    const TrackColumns &a = every.tracks()[t], &b = third.tracks()[t];
    for (std::size_t row = 0; row < std::min(a.size(), b.size()); ++row) {
      const Sample one = a.sample(row), other = b.sample(row);
      if (!one.keypoints || b.at()[row] > 26) continue;
      ++rows;
      if (!other.keypoints) continue;
      ++with;
      near += (one.keypoints->points[kNose]->position - other.keypoints->points[kNose]->position).norm() < 0.1 * one.box->height;
    }
  }
  EXPECT_GT(with, 0.85 * rows);
  EXPECT_GT(near, 0.8 * with);
}

TEST(BodyKeypoints, AFilmWithoutPeopleHasNone) {
  SKIP_WITHOUT_MODELS();
  const test::TemporaryFolder folder;
  test::ffmpeg(
      "-f lavfi -i color=0x90a080:size=320x240:rate=7 -f lavfi -i color=0x303040:size=24x60:rate=7 -filter_complex "
      "\"[0][1]overlay=x='-20+15*t':y=60,noise=alls=4:allf=t:all_seed=7\" -t 20 -c:v mpeg4 -q:v 3 " +
      folder / "box.mp4");
  const Result result = keypoints_of_video(folder / "box.mp4", {});
  EXPECT_EQ(result.summary.keypoints, 0);
  EXPECT_GT(result.summary.dropped.no_person.value(), 20) << "a dark plate that moves is a person no longer than its patience";
}

TEST(BodyKeypoints, RejectsSourcesWithoutImages) {
  SKIP_WITHOUT_MODELS();
  const test::TemporaryFolder folder;
  test::write_file(folder / "det.txt", "1,-1,50,40,40,100,0.9\n2,-1,53,40,40,100,0.9\n");
  RigCamera camera;
  camera.detections = folder / "det.txt";
  camera.rate_hz = 25;
  people::ImagePeopleOptions options;
  options.keypoints = KeypointOptions{.model = "lite"};
  try {
    people::track_people(camera, {.tracks = folder / "out.csv"}, options);
    ADD_FAILURE() << "keypoints without images";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("keypoints are searched for in images"), std::string::npos) << error.what();
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "out.csv"));
}

}  // namespace
}  // namespace marey::pipeline::keypoints
