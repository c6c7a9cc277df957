#include "marey/format/take/take_file.h"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <thread>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "marey/core/error.h"

#include "support/files.h"

namespace marey::format::take {
namespace {

namespace fs = std::filesystem;

TakeFrame frame_of(std::int64_t index, int markers = 3) {
  TakeFrame frame;
  frame.index = index;
  frame.time = timestamp_from_seconds(static_cast<double>(index) / 120);
  for (int m = 1; m <= markers; ++m) {
    TakePoint point;
    point.track = TrackId(m);
    point.position = {0.1 * m, static_cast<double>(index) / 7, -1.0 / m};
    point.cameras = CameraMask{0b101} << m;
    point.provenance = static_cast<Provenance>((index + m) % 3);
    if (m % 2 == 1) point.covariance = Matrix<3>{{4, 1, 0.5}, {1, 3, 0.25}, {0.5, 0.25, 2}};
    if (m % 3 == 0) point.residual_px = 0.125;
    if (m % 3 == 1) point.residual_m = 0.0625;
    frame.points.push_back(point);
    frame.observations.push_back({CameraId(m), {100.0 / m, static_cast<double>(index)}, 0.0625, 12.5, TrackId(m)});
  }
  frame.observations.push_back({CameraId(0), {1, 2}, 0, 0, std::nullopt});
  return frame;
}

TakeHeader header() {
  TakeHeader header;
  header.name = "walk";
  header.made_by = "test";
  header.recorded_at = "2026-01-01T00:00:00Z";
  header.rate_hz = 120;
  return header;
}

/// Runs `body` in a process of its own; returns how it ended, as waitpid says.
template <typename Body>
int in_child(Body body, int kill_after_ms = 0) {
  const pid_t child = fork();
  if (child == 0) {
    body();
    _exit(0);
  }
  if (kill_after_ms > 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(kill_after_ms));
    kill(child, SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

class TakeFile : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
  std::string path_ = folder_ / "walk.marey";

  std::string error_of(const std::function<void()>& action) {
    try {
      action();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
};

TEST_F(TakeFile, ComesBackAsItWasWritten) {
  Take take;
  take.header = header();
  take.tracks = {{TrackId(1), "head"}, {TrackId(2), ""}, {TrackId(3), "left \"knee\""}, {TrackId(9), "never seen"}};
  take.header.rig = Rig{};
  take.header.rig->cameras.emplace_back();
  take.header.rig->cameras.back().name = "left";
  take.header.rig->cameras.back().source = "left.mp4";
  for (const int i : {0, 1, 2, 100, 1000}) take.frames.push_back(frame_of(i));
  take.edits = {{"2026-01-02T00:00:00Z", "head renamed"}};
  write_take(path_, take);
  const Take read = read_take(path_);
  EXPECT_EQ(read.header.name, "walk");
  EXPECT_EQ(read.header.made_by, "test");
  EXPECT_EQ(read.header.recorded_at, "2026-01-01T00:00:00Z");
  EXPECT_EQ(read.header.rate_hz, 120);
  ASSERT_TRUE(read.header.rig);
  ASSERT_EQ(read.header.rig->cameras.size(), 1U);
  EXPECT_EQ(read.header.rig->cameras[0].source, "left.mp4");
  EXPECT_EQ(read.tracks, take.tracks);
  EXPECT_EQ(read.edits, take.edits);
  EXPECT_EQ(read.frames, take.frames);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1) << "a take is one file";
}

TEST_F(TakeFile, SummaryCountsWhatIsThere) {
  Take take;
  take.header = header();
  for (int i = 10; i < 19; ++i) take.frames.push_back(frame_of(i));
  write_take(path_, take);
  const TakeSummary summary = TakeReader(path_).summary();
  EXPECT_TRUE(summary.complete);
  EXPECT_EQ(summary.frames, 9);
  EXPECT_EQ(summary.points, 27);
  EXPECT_EQ(summary.observations, 36);
  EXPECT_EQ(summary.first_frame, 10);
  EXPECT_EQ(summary.last_frame, 18);
  ASSERT_EQ(summary.tracks.size(), 3U);
  for (const auto& track : summary.tracks) {
    EXPECT_EQ(track.measured, 3);
    EXPECT_EQ(track.filled, 3);
    EXPECT_EQ(track.predicted, 3);
    EXPECT_EQ(track.first_frame, 10);
    EXPECT_EQ(track.last_frame, 18);
  }
}

TEST_F(TakeFile, SeeksAndLeavesObservationsOut) {
  Take take;
  take.header = header();
  for (int i = 0; i < 500; i += 2) take.frames.push_back(frame_of(i));
  write_take(path_, take);
  TakeReader reader(path_, {.observations = false});
  reader.seek(301);
  const auto frame = reader.next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->index, 302);
  EXPECT_EQ(frame->points, frame_of(302).points);
  EXPECT_TRUE(frame->observations.empty());
}

TEST_F(TakeFile, IsReadWhileItIsWritten) {
  TakeWriter writer(path_, header());
  TakeReader reader(path_);
  EXPECT_FALSE(reader.next());
  for (int i = 0; i < 200; ++i) writer.write(frame_of(i));
  writer.flush();
  for (int i = 0; i < 200; ++i) ASSERT_EQ(reader.next()->index, i);
  EXPECT_FALSE(reader.next());
  EXPECT_FALSE(reader.summary().complete);
  writer.write(frame_of(200));
  writer.finish();
  EXPECT_EQ(reader.next()->index, 200);
  EXPECT_TRUE(reader.summary().complete);
}

TEST_F(TakeFile, TakesOneWriter) {
  TakeWriter writer(path_, header());
  writer.write(frame_of(0));
  EXPECT_NE(error_of([&] { TakeWriter second(path_, header()); }).find("is being written by another run"), std::string::npos);
  const int status =
      in_child([&] { _exit(error_of([&] { TakeWriter third(path_, header()); }).find("recorded") != std::string::npos); });
  EXPECT_EQ(WEXITSTATUS(status), 1);
  writer.finish();
  EXPECT_EQ(read_take(path_).frames.size(), 1U);
  TakeWriter(path_, header()).finish();
  EXPECT_EQ(read_take(path_).frames.size(), 0U) << "the second replaces the first";
}

// At 2,000 frames a second, so that several transactions end before the kill.
TEST_F(TakeFile, SurvivesSigkillAndLosesLessThanASecond) {
  for (const int after_ms : {900, 1350, 1600}) {
    const std::string ticks = folder_ / "ticks";
    const int status = in_child(
        [&] {
          TakeWriter writer(path_, header());
          writer.set_label(TrackId(1), "head");
          std::ofstream count(ticks, std::ios::binary);
          for (int i = 0;; ++i) {
            writer.write(frame_of(i));
            count << '.' << std::flush;
            std::this_thread::sleep_for(std::chrono::microseconds(500));
          }
        },
        after_ms);
    ASSERT_TRUE(WIFSIGNALED(status));
    const auto written = static_cast<double>(fs::file_size(ticks));
    TakeReader reader(path_);
    const TakeSummary summary = reader.summary();
    EXPECT_FALSE(summary.complete);
    std::int64_t next = 0;
    while (const auto frame = reader.next()) ASSERT_EQ(*frame, frame_of(next++));
    EXPECT_EQ(summary.frames, next);
    EXPECT_EQ(reader.tracks().front().label, "head");
    EXPECT_GE(static_cast<double>(next), written * (1 - 1000.0 / after_ms));
    EXPECT_GT(next, 0);
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 2) << "the take and the ticks";
}

TEST_F(TakeFile, KeepsWhatWasWrittenWhenTheDiskIsFull) {
  const std::string said = folder_ / "said";
  in_child([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{2 << 20, 2 << 20};
    setrlimit(RLIMIT_FSIZE, &limit);
    const std::string error = error_of([&] {
      TakeWriter writer(path_, header());
      for (int i = 0; i < 100'000; ++i) {
        writer.write(frame_of(i, 50));
        if (i % 50 == 0) writer.flush();
      }
    });
    test::write_file(said, error);
  });
  EXPECT_NE(test::read_file(said).find("cannot be written to the end"), std::string::npos) << test::read_file(said);
  TakeReader reader(path_);
  const TakeSummary summary = reader.summary();
  std::int64_t next = 0;
  while (const auto frame = reader.next()) ASSERT_EQ(*frame, frame_of(next++, 50));
  EXPECT_EQ(summary.frames, next);
  EXPECT_GT(next, 200) << "2 MB hold more";
}

TEST_F(TakeFile, RefusesWhatIsNotATake) {
  test::write_file(path_, "name,x,y\n");
  EXPECT_NE(error_of([&] { TakeReader reader(path_); }).find("is no take"), std::string::npos);
  EXPECT_NE(error_of([&] { TakeWriter writer(path_, header()); }).find("is not overwritten"), std::string::npos);
  EXPECT_EQ(test::read_file(path_), "name,x,y\n");
  EXPECT_NE(error_of([&] { TakeReader reader(folder_ / "none"); }).find("no such file"), std::string::npos);
  EXPECT_NE(error_of([&] { TakeReader reader(folder_.path()); }).find("is no file"), std::string::npos);
}

TEST_F(TakeFile, RefusesFramesThatCannotBe) {
  TakeWriter writer(path_, header());
  writer.write(frame_of(5));
  EXPECT_NE(error_of([&] { writer.write(frame_of(5)); }).find("out of order"), std::string::npos);
  TakeFrame twins = frame_of(6);
  twins.points[1].track = twins.points[0].track;
  EXPECT_NE(error_of([&] { writer.write(twins); }).find("two points"), std::string::npos);
  TakeFrame nowhere = frame_of(7);
  nowhere.points[0].position.x() = std::nan("");
  EXPECT_NE(error_of([&] { writer.write(nowhere); }).find("nowhere"), std::string::npos);
  writer.write(frame_of(8));
  writer.finish();
  EXPECT_EQ(read_take(path_).frames.size(), 2U);
}

TEST_F(TakeFile, DamagedTakesAreRefused) {
  Take take;
  take.header = header();
  for (int i = 0; i < 300; ++i) take.frames.push_back(frame_of(i));
  write_take(path_, take);
  const std::string whole = test::read_file(path_);
  for (const double share : {0.001, 0.1, 0.5, 0.9, 0.999}) {
    test::write_file(path_, whole);
    test::cut_file(path_, share);
    EXPECT_THROW(read_take(path_), Error) << share;
  }
}

}  // namespace
}  // namespace marey::format::take
