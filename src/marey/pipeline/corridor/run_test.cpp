#include "marey/pipeline/corridor/run.h"

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/tracks/track_file.h"

#include "support/files.h"

namespace marey::pipeline::corridor {
namespace {

/// MOT text of one person who walks through `frames` frames; every third is omitted.
std::string boxes(int frames) {
  std::string text;
  for (int frame = 1; frame <= frames; ++frame) {
    if (frame % 3 == 0 && frame != frames) continue;
    text += std::to_string(frame) + ",-1," + std::to_string(3 * frame) + ",40,20,50,0.9\n";
  }
  return text;
}

Clock clock_over(const std::string& path) {
  RigCamera camera;
  camera.detections = path;
  camera.rate_hz = 25;
  std::vector<Feed> feeds;
  feeds.emplace_back(camera, CameraId{});
  return Clock(std::move(feeds));
}

/// Reports every detection as a track; says the last `late` instants only at the end.
class Echo final : public Stage {
 public:
  explicit Echo(bool all_at_the_end = false) : at_the_end_(all_at_the_end) {}

  RecordingHeader header() const override {
    RecordingHeader header;
    header.name = "echo";
    header.frame.kind = FrameOfReference::Kind::image;
    return header;
  }
  std::span<const Instant> step(const FrameSet& frames) override {
    Instant& instant = known_.emplace_back();
    instant.index = frames.index;
    instant.time = frames.time;
    for (const Detection& detection : *frames.cameras.front()->detections) {
      Sample& sample = instant.samples.emplace_back();
      sample.track = TrackId{1};
      sample.position.head<2>() = detection.box.centre();
      sample.box = detection.box;
    }
    if (at_the_end_) return {};
    return std::span(known_).last(1);
  }
  std::unique_ptr<InstantSource> finish(const Hooks&) override {
    if (!at_the_end_) return nullptr;
    struct All final : InstantSource {
      explicit All(std::vector<Instant> of) : instants(std::move(of)) {}
      std::optional<Instant> next() override {
        if (at == instants.size()) return std::nullopt;
        return instants[at++];
      }
      std::vector<Instant> instants;
      std::size_t at = 0;
    };
    return std::make_unique<All>(std::move(known_));
  }
  void report(Summary& summary) const override { summary.dropped.noise = 0; }

 private:
  bool at_the_end_;
  std::vector<Instant> known_;
};

/// Keeps what it is given; fails at the n-th instant.
class Keeper final : public Sink {
 public:
  struct Kept {
    std::vector<std::int64_t> indices;
    bool finished = false;
  };
  Keeper(Kept& kept, int fails_at = -1) : kept_(kept), fails_at_(fails_at) {}
  std::string name() const override { return "keeper"; }
  SinkRequirements begin(const RecordingHeader&) override { return {}; }
  void write(const Instant& instant) override {
    if (std::ssize(kept_.indices) == fails_at_) throw Error("{}", "keeper: no space left");
    kept_.indices.push_back(instant.index);
  }
  void finish() override { kept_.finished = true; }

 private:
  Kept& kept_;
  int fails_at_;
};

TEST(Run, EveryMomentReachesEverySinkInOrderLiveAndAfterASecondPass) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "boxes.txt", boxes(100));
  for (const bool at_the_end : {false, true}) {
    Keeper::Kept one, other;
    Sinks sinks;
    sinks.add(std::make_unique<Keeper>(one));
    sinks.add(std::make_unique<Keeper>(other));
    Echo stage(at_the_end);
    Clock clock = clock_over(folder / "boxes.txt");
    const Summary summary = run(stage, clock, sinks);
    EXPECT_EQ(summary.frames, 100);
    EXPECT_EQ(summary.samples, 67);
    EXPECT_EQ(summary.tracks, 1);
    EXPECT_NEAR(summary.seconds, 99 / 25.0, 1e-9);
    ASSERT_EQ(one.indices.size(), 100u);
    for (int i = 0; i < 100; ++i) EXPECT_EQ(one.indices[static_cast<std::size_t>(i)], i);
    EXPECT_EQ(one.indices, other.indices);
    EXPECT_TRUE(one.finished && other.finished);
  }
}

TEST(Run, ASinkThatFailsEndsTheRunAndTheOthersKeepWhatTheyHave) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "boxes.txt", boxes(3000));
  Keeper::Kept whole, broken;
  Sinks sinks;
  sinks.add(std::make_unique<Keeper>(whole));
  sinks.add(std::make_unique<Keeper>(broken, 5));
  sinks.add(std::make_unique<format::tracks::TrackFile>(folder / "out.txt", format::tracks::TrackText::mot));
  Echo stage;
  Clock clock = clock_over(folder / "boxes.txt");
  try {
    run(stage, clock, sinks);
    FAIL() << "nothing was said";
  } catch (const Error& error) {
    const std::string_view stated = error.what();
    EXPECT_TRUE(stated.starts_with("keeper: no space left; the run ended there, and what was known until then is in keeper, "))
        << stated;
    EXPECT_TRUE(stated.ends_with("out.txt")) << stated;
  }
  EXPECT_EQ(broken.indices.size(), 5u);
  EXPECT_FALSE(broken.finished);
  EXPECT_TRUE(whole.finished);
  EXPECT_GE(whole.indices.size(), 6u);
  EXPECT_LT(whole.indices.size(), 3000u) << "the run continued";
  EXPECT_TRUE(std::filesystem::exists(folder / "out.txt"));
}

TEST(Run, StoppedHalfWayItFinishesWhatItHas) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "boxes.txt", boxes(100));
  for (const bool at_the_end : {false, true}) {
    Keeper::Kept kept;
    Sinks sinks;
    sinks.add(std::make_unique<Keeper>(kept));
    Echo stage(at_the_end);
    Clock clock = clock_over(folder / "boxes.txt");
    std::stop_source stop;
    const Hooks hooks{.progress =
                          [&](const Progress& at) {
                            if (at.done == 40) stop.request_stop();
                          },
                      .stop = stop.get_token()};
    const Summary summary = run(stage, clock, sinks, hooks);
    EXPECT_TRUE(summary.stopped);
    EXPECT_EQ(kept.indices.size(), 40u);
    EXPECT_TRUE(kept.finished);
  }
}

TEST(Run, StageErrorLeavesNoFile) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "boxes.txt", boxes(20));
  struct Throws final : Stage {
    RecordingHeader header() const override {
      RecordingHeader header;
      header.frame.kind = FrameOfReference::Kind::image;
      return header;
    }
    std::span<const Instant> step(const FrameSet& frames) override {
      if (frames.index == 10) throw Error("{}", "the camera melted");
      return {};
    }
    void report(Summary&) const override {}
  } stage;
  {
    Sinks sinks;
    sinks.add(std::make_unique<format::tracks::TrackFile>(folder / "out.txt", format::tracks::TrackText::mot));
    Clock clock = clock_over(folder / "boxes.txt");
    EXPECT_THROW(run(stage, clock, sinks), Error);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1) << "the input alone";
}

}  // namespace
}  // namespace marey::pipeline::corridor
