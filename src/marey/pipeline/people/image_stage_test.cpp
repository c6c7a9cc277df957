#include "marey/pipeline/people/image_stage.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/filter/filters.h"
#include "marey/pipeline/people/track_in_image.h"

#include "support/files.h"

namespace marey::pipeline::people {
namespace {

/// Two dark figures on a noisy lawn, 8 s at 10 frames a second: one walks right, one left, on different rows.
void video_two_walkers(const std::string& path) {
  test::ffmpeg(
      "-f lavfi -i color=0x90a080:size=320x240:rate=10 -f lavfi -i color=0x303040:size=16x44:rate=10 "
      "-f lavfi -i color=0x402020:size=16x44:rate=10 -filter_complex "
      "\"[0][1]overlay=x='-20+45*t':y=60[a];[a][2]overlay=x='330-45*t':y=150,noise=alls=4:allf=t:all_seed=7\" "
      "-t 8 -c:v mpeg4 -q:v 3 " +
      path);
}

/// Rows of MOT text as id → frames.
std::map<int, std::set<int>> frames_by_id(const std::string& path) {
  std::map<int, std::set<int>> result;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    int frame = 0, id = 0;
    EXPECT_EQ(std::sscanf(line.c_str(), "%d,%d,", &frame, &id), 2) << line;
    EXPECT_TRUE(result[id].insert(frame).second) << "twice in a frame: " << line;
  }
  return result;
}

/// MOT detections of three people who walk side by side, with one false alarm in every fifth frame.
std::string walking_detections(int frames) {
  std::ostringstream out;
  for (int frame = 1; frame <= frames; ++frame) {
    for (int person = 0; person < 3; ++person)
      out << frame << ",-1," << 50 + 3 * frame << ',' << 40 + 150 * person << ",40,100,0.9\n";
    if (frame % 5 == 0) out << frame << ",-1," << (frame * 37) % 600 << ',' << (frame * 91) % 400 << ",40,100,0.6\n";
  }
  return out.str();
}

RigCamera images(const std::string& path, std::optional<double> rate_hz = {}) {
  RigCamera camera;
  camera.source = path;
  camera.rate_hz = rate_hz;
  return camera;
}

RigCamera detections(const std::string& path, std::optional<double> rate_hz = {}) {
  RigCamera camera;
  camera.detections = path;
  camera.rate_hz = rate_hz;
  return camera;
}

TEST(ImagePeopleStage, DetectionsOfAnotherProgramAreFollowed) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "det.txt", walking_detections(100));
  const corridor::Summary summary = track_people(detections(folder / "det.txt", 25), {.tracks = folder / "out.txt"});
  EXPECT_EQ(summary.frames, 100);
  EXPECT_EQ(summary.tracks, 3);
  EXPECT_NEAR(summary.seconds, 99 / 25.0, 1e-9);
  EXPECT_GT(summary.dropped.too_short.value(), 0);
  EXPECT_TRUE(summary.warnings.empty());
  const auto tracks = frames_by_id(folder / "out.txt");
  ASSERT_EQ(tracks.size(), 3u);
  for (const auto& [id, frames] : tracks) EXPECT_GE(frames.size(), 98u) << id;
}

TEST(ImagePeopleStage, ScoresOfAnyScaleAreRanked) {
  const test::TemporaryFolder folder;
  std::string text = walking_detections(100);
  for (std::size_t at = 0; (at = text.find(",0.9\n", at)) != std::string::npos;) text.replace(at, 5, ",87.5\n");
  test::write_file(folder / "det.txt", text);
  const corridor::Summary summary = track_people(detections(folder / "det.txt", 25), {.tracks = folder / "out.txt"});
  EXPECT_EQ(summary.tracks, 3);
  ASSERT_EQ(summary.warnings.size(), 1u);
  EXPECT_NE(summary.warnings[0].find("ranked"), std::string::npos);
}

TEST(ImagePeopleStage, PeopleInAFilmAreFoundFollowedAndDrawn) {
  const test::TemporaryFolder folder;
  video_two_walkers(folder / "film.avi");
  const RigCamera input = images(folder / "film.avi");
  const TrackOutput output{.tracks = folder / "out.txt", .overlay = folder / "out.mp4"};
  int tracked = 0, drawn = 0;
  Hooks hooks;
  hooks.progress = [&](const Progress& progress) {
    ++(progress.step == "tracking" ? tracked : drawn);
    EXPECT_EQ(progress.total, 80);
  };
  const corridor::Summary summary = track_people(input, output, {}, hooks);
  EXPECT_EQ(summary.frames, 80);
  EXPECT_EQ(tracked, 80);
  EXPECT_EQ(drawn, 80);
  EXPECT_EQ(summary.tracks, 2);
  for (const auto& [id, frames] : frames_by_id(folder / "out.txt")) EXPECT_GT(frames.size(), 50u) << id;
  EXPECT_TRUE(std::filesystem::exists(folder / "out.mp4"));
}

TEST(ImagePeopleStage, TheSameFilmGivesTheSameBytes) {
  const test::TemporaryFolder folder;
  video_two_walkers(folder / "film.avi");
  const RigCamera input = images(folder / "film.avi", 10);
  for (const bool live : {false, true}) {
    ImagePeopleOptions options;
    options.live = live;
    track_people(input, {.tracks = folder / "a.csv", .format = "csv"}, options);
    track_people(input, {.tracks = folder / "b.csv", .format = "csv", .overlay = folder / "b.mp4"}, options);
    EXPECT_EQ(test::read_file(folder / "a.csv"), test::read_file(folder / "b.csv"));
  }
}

TEST(ImagePeopleStage, StoppedHalfWayItWritesWhatItHas) {
  const test::TemporaryFolder folder;
  video_two_walkers(folder / "film.avi");
  const RigCamera input = images(folder / "film.avi");
  for (const bool live : {false, true}) {
    std::stop_source stop;
    const Hooks hooks{.progress =
                          [&](const Progress& at) {
                            if (at.done == 40) stop.request_stop();
                          },
                      .stop = stop.get_token()};
    ImagePeopleOptions options;
    options.live = live;
    const corridor::Summary summary =
        track_people(input, {.tracks = folder / "out.txt", .overlay = folder / "out.mp4"}, options, hooks);
    EXPECT_TRUE(summary.stopped);
    EXPECT_EQ(summary.frames, 40);
    const auto tracks = frames_by_id(folder / "out.txt");
    EXPECT_FALSE(tracks.empty());
    for (const auto& [id, detected] : tracks) EXPECT_LE(*detected.rbegin(), 40);
    EXPECT_EQ(std::filesystem::exists(folder / "out.mp4"), live) << "its images would have to be read again";
    std::filesystem::remove(folder / "out.mp4");
  }
}

TEST(ImagePeopleStage, EveryBackgroundFindsBothWalkers) {
  const test::TemporaryFolder folder;
  video_two_walkers(folder / "film.avi");
  std::set<std::string> outputs;
  for (const char* name : {"marey", "mog2", "knn"}) {
    ImagePeopleOptions options;
    options.detector = detect::people::PeopleDetectorOptions{.background = detect::background::parse_background(name)};
    track_people(images(folder / "film.avi"), {.tracks = folder / "out.txt"}, options);
    outputs.insert(test::read_file(folder / "out.txt"));
    int found = 0;
    for (const auto& [id, frames] : frames_by_id(folder / "out.txt")) found += frames.size() > 30;
    EXPECT_GE(found, 2) << name;
  }
  EXPECT_EQ(outputs.size(), 3U) << "each was used: they do not agree to the hundredth of a pixel";
}

TEST(ImagePeopleStage, EveryFilterFollowsThreeWalkers) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "det.txt", walking_detections(100));
  std::set<std::string> outputs;
  for (const filter::NamedFilter& filter : filter::named_filters()) {
    ImagePeopleOptions options;
    options.tracker.filter = filter::scaled(filter.options, 0.01);  // parameters in px, people 100 px high
    options.live = true;                                            // what the filter says, not what is smoothed later
    track_people(detections(folder / "det.txt", 25), {.tracks = folder / "out.txt"}, options);
    outputs.insert(test::read_file(folder / "out.txt"));
    int tracked = 0;
    for (const auto& [id, frames] : frames_by_id(folder / "out.txt"))
      tracked += frames.size() >= 88;  // of 100: held back until confirmed
    EXPECT_EQ(tracked, 3) << filter.name;
  }
  EXPECT_GE(outputs.size(), filter::named_filters().size() / 2) << "the filter that was asked for is not the one that ran";
}

TEST(ImagePeopleStage, RejectsImpossibleOptionsBeforeWriting) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "det.txt", walking_detections(10));
  test::write_file(folder / "bad.txt", "1,-1,10,10,nan,20,1\n");
  test::write_file(folder / "none.txt", "\n");
  const std::string out = folder / "out.txt";
  RigCamera both = images("a");
  both.detections = "b";
  EXPECT_THROW(track_people({}, {.tracks = out}), Error);
  EXPECT_THROW(track_people(both, {.tracks = out}), Error);
  EXPECT_THROW(track_people(detections(folder / "det.txt", -1), {.tracks = out}), Error);
  EXPECT_THROW(track_people(detections(folder / "det.txt"), {.tracks = out, .overlay = folder / "x.mp4"}), Error);
  EXPECT_THROW(track_people(detections(folder / "bad.txt"), {.tracks = out}), Error);
  EXPECT_THROW(track_people(detections(folder / "none.txt"), {.tracks = out}), Error);
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace marey::pipeline::people
