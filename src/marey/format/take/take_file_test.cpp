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
#include "marey/format/take/take_edits.h"
#include "marey/format/take/take_testing.h"

#include "support/files.h"

namespace marey::format::take {
namespace {

namespace fs = std::filesystem;

Instant instant_of(std::int64_t index, int markers = 3) {
  Instant instant;
  instant.index = index;
  instant.time = timestamp_from_seconds(static_cast<double>(index) / 120);
  instant.detected.push_back({CameraId(0), {1, 2}, {}, {}, std::nullopt});
  for (int m = 1; m <= markers; ++m) {
    Sample sample;
    sample.track = TrackId(m);
    sample.position = {0.1 * m, static_cast<double>(index) / 7, -1.0 / m};
    sample.cameras = CameraMask{0b101} << m;
    sample.provenance = static_cast<Provenance>((index + m) % 3);
    if (m % 2 == 1) sample.covariance = Matrix<3>{{4, 1, 0.5}, {1, 3, 0.25}, {0.5, 0.25, 2}};
    if (m % 3 == 0) sample.residual_px = 0.125;
    if (m % 3 == 1) sample.residual_m = 0.0625;
    instant.samples.push_back(sample);
    instant.detected.push_back({CameraId(m), {100.0 / m, static_cast<double>(index)}, 0.0625, 12.5, TrackId(m)});
  }
  return instant;
}

RecordingHeader header() {
  RecordingHeader header;
  header.name = "walk";
  header.made_by = {.program = "test 1.0", .options = {{"noise", "0.1"}, {"tracker", "roster"}}, .inputs = {{"a.mp4", "12ab"}}};
  header.recorded_at = "2026-01-01T00:00:00Z";
  header.rate_hz = 120;
  return header;
}

Recording recording_of(std::vector<std::int64_t> indices, int markers = 3) {
  Recording recording(header());
  for (const std::int64_t index : indices) recording.add(instant_of(index, markers));
  return recording;
}

std::vector<std::int64_t> every(std::int64_t from, std::int64_t to, std::int64_t step = 1) {
  std::vector<std::int64_t> indices;
  for (std::int64_t i = from; i < to; i += step) indices.push_back(i);
  return indices;
}

/// Runs `body` in a process of its own; returns how it ended, as waitpid says. `until_killed` runs in the meantime, and ends it.
template <typename Body>
int in_child(Body body, const std::function<void()>& until_killed = {}) {
  const pid_t child = fork();
  if (child == 0) {
    body();
    _exit(0);
  }
  if (until_killed) {
    until_killed();
    kill(child, SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

bool has_instants(const std::string& path) {
  return is_take(path) && TakeReader(path).next().has_value();
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
  Recording take = recording_of({0, 1, 2, 100, 1000});
  for (const TrackName& name : {TrackName{TrackId(1), "head", "red"}, TrackName{TrackId(2), "", ""},
                                TrackName{TrackId(3), "left \"knee\"", ""}, TrackName{TrackId(9), "never seen", "blue"}}) {
    take.set_name(name);
  }
  take.header.rig = Rig{};
  take.header.rig->cameras.emplace_back();
  take.header.rig->cameras.back().name = "left";
  take.header.rig->cameras.back().source = "left.mp4";
  take.edits = {{1, {}, "rename", R"({"track":1})"}, {2, 1, "note", "{}"}, {3, 1, "swap", "{}"}};
  take.head = 3;
  write_recording(path_, take);
  const Recording read = read_recording(path_);
  EXPECT_EQ(read.header.name, "walk");
  EXPECT_EQ(read.header.made_by, take.header.made_by);
  EXPECT_EQ(read.header.recorded_at, "2026-01-01T00:00:00Z");
  EXPECT_EQ(read.header.rate_hz, 120);
  EXPECT_EQ(read.header.frame, take.header.frame);
  ASSERT_TRUE(read.header.rig);
  ASSERT_EQ(read.header.rig->cameras.size(), 1U);
  EXPECT_EQ(read.header.rig->cameras[0].source, "left.mp4");
  EXPECT_EQ(read.edits, take.edits);
  EXPECT_EQ(read.head, take.head);
  testing_take::expect_same(read, take);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1) << "a take is one file";
}

/// Two bodies, of which the second comes and goes; the first is a segment of a skeleton.
Recording bodies_moving(std::int64_t instants) {
  Recording take(header());
  Body hip{.id = BodyId{1}, .label = "Hip", .skeleton = "anna", .parent = {}, .offset = {}, .end = {}, .markers = {}};
  Body racket{.id = BodyId{7},
              .label = "racket",
              .skeleton = {},
              .parent = BodyId{1},
              .offset = {0.1, 0, -1.0 / 3},
              .end = {{0, 0, 0.4}},
              .markers = {}};
  racket.markers = {{"grip", {0, 0, 1.0 / 7}}, {"\"tip\"", {0.1, 0.2, 0.3}}};
  take.header.bodies = {hip, racket};
  for (std::int64_t i = 0; i < instants; ++i) {
    Instant instant = instant_of(3 * i);
    for (const int id : {1, 7}) {
      if (id == 7 && i % 5 == 2) continue;
      BodyPose pose{.body = BodyId{id}, .world_from_body = {}, .covariance = {}, .residual_m = {}, .tracked = (i + id) % 3 != 0};
      pose.world_from_body = {geometry::rotation_from({0.01 * static_cast<double>(i), 0.3, -1.0 / id}),
                              {1.0 / 3, static_cast<double>(i) / 7, static_cast<double>(id)}};
      if (i % 4 != 1) pose.covariance = Matrix<6>::Identity() / static_cast<double>(i + 1);
      if (i % 3 != 1) pose.residual_m = 1e-4 * static_cast<double>(i);
      if (id == 7 && i > 900) pose.other = {{geometry::rotation_from({0, 0, 0.1 * static_cast<double>(i)}), {0, 1.0 / 3, 1}}, 0.31};
      instant.bodies.push_back(pose);
    }
    take.add(instant);
  }
  return take;
}

TEST_F(TakeFile, BodiesComeBackAsTheyWereWritten) {
  const Recording take = bodies_moving(2000);
  write_recording(path_, take);
  const Recording read = read_recording(path_);
  EXPECT_EQ(read.header.bodies, take.header.bodies);
  ASSERT_EQ(read.bodies().size(), 2U);
  testing_take::expect_same(read, take);
  TakeReader reader(path_);
  reader.seek(3 * 777);
  const auto instant = reader.next();
  ASSERT_TRUE(instant);
  ASSERT_EQ(instant->bodies.size(), 1U) << "the racket is away in every fifth instant";
  EXPECT_EQ(instant->bodies[0].body, BodyId{1});
  InstantsOf instants(take);
  for (int i = 0; i < 777; ++i) instants.next();
  testing_take::expect_same(*instant, instants.next().value());
}

TEST_F(TakeFile, BodiesThatCannotBeAreRefused) {
  Recording take = bodies_moving(3);
  write_recording(path_, take);
  {
    Database database(path_, Database::Mode::create);
    database.run("UPDATE body SET definition = '{\"markers\":[{\"label\":1}]}' WHERE id = 7");
  }
  EXPECT_NE(error_of([&] { read_recording(path_); }).find("damaged"), std::string::npos);
  Instant instant = instant_of(100);
  BodyPose pose;
  pose.body = BodyId{1};
  pose.world_from_body.rotation *= 2;
  instant.bodies.push_back(pose);
  TakeWriter writer(folder_ / "other.marey");
  writer.begin(take.header);
  EXPECT_NE(error_of([&] { writer.write(instant); }).find("body 1"), std::string::npos);
}

TEST_F(TakeFile, PosesOfEarlierVersionsHaveNoOther) {
  Recording take = bodies_moving(20);
  write_recording(path_, take);
  Database(path_, Database::Mode::create).run("ALTER TABLE poses DROP COLUMN other");
  testing_take::expect_same(read_recording(path_), take);
}

TEST_F(TakeFile, SaysWhichEditsItCannotDoAndKeepsThem) {
  Recording take = recording_of({0});
  take.edits = {{1, {}, "note", "{}"}, {2, 1, "paint", R"({"colour":"red"})"}};
  write_recording(path_, take);
  const TakeReader reader(path_);
  ASSERT_EQ(reader.warnings().size(), 1U);
  EXPECT_NE(reader.warnings()[0].find("\"paint\""), std::string::npos);
  EXPECT_EQ(reader.edits(), take.edits);
}

TEST_F(TakeFile, EditsThatWereDecidedOnOthersAreRefused) {
  write_recording(path_, recording_of(every(0, 10)));
  const auto edit = [](std::int64_t id, std::optional<std::int64_t> parent) {
    return Edit{.id = id, .parent = parent, .operation = "note", .payload = "{}"};
  };
  const std::vector<Edit> first{edit(1, {})}, second{edit(2, 1)}, blind{edit(2, {})};
  add_edits(path_, first, 1, {});
  add_edits(path_, second, 2, {.head = 1, .newest = 1});
  EXPECT_THROW(add_edits(path_, blind, 2, {}), Error);
  EXPECT_THROW(add_edits(path_, {}, {}, {.head = 1, .newest = 2}), Error);
  EXPECT_THROW(add_edits(path_, {}, {}, {.head = 2, .newest = 1}), Error);
  const TakeReader take(path_);
  EXPECT_EQ(take.edits(), (std::vector{first[0], second[0]}));
  EXPECT_EQ(take.head(), 2);
  EXPECT_EQ(edit_state(take.edits(), take.head()), (EditState{.head = 2, .newest = 2}));
}

TEST_F(TakeFile, SummaryCountsWhatIsThere) {
  write_recording(path_, recording_of(every(10, 19)));
  const RecordingSummary summary = TakeReader(path_).summary();
  EXPECT_TRUE(summary.complete);
  EXPECT_EQ(summary.instants, 9);
  EXPECT_EQ(summary.samples, 27);
  EXPECT_EQ(summary.detected, 36);
  EXPECT_EQ(summary.first_index, 10);
  EXPECT_EQ(summary.last_index, 18);
  ASSERT_EQ(summary.tracks.size(), 3U);
  for (const auto& track : summary.tracks) {
    EXPECT_EQ(track.of(Provenance::measured), 3);
    EXPECT_EQ(track.of(Provenance::filled), 3);
    EXPECT_EQ(track.of(Provenance::predicted), 3);
    EXPECT_EQ(track.first_index, 10);
    EXPECT_EQ(track.last_index, 18);
  }
}

TEST_F(TakeFile, SeeksAndLeavesOutWhatWasSeen) {
  write_recording(path_, recording_of(every(0, 500, 2)));
  TakeReader reader(path_, {.detected = false});
  for (const std::int64_t index : {301, 7, 498, 0}) {
    reader.seek(index);
    const auto instant = reader.next();
    ASSERT_TRUE(instant);
    Instant expected = instant_of(index + index % 2);
    expected.detected.clear();
    testing_take::expect_same(*instant, expected);
  }
  reader.seek(499);
  EXPECT_FALSE(reader.next());
}

TEST_F(TakeFile, IsReadWhileItIsWritten) {
  TakeWriter writer(path_);
  writer.begin(header());
  writer.flush();
  TakeReader reader(path_);
  EXPECT_FALSE(reader.next());
  for (int i = 0; i < 200; ++i) writer.write(instant_of(i));
  writer.flush();
  for (int i = 0; i < 200; ++i) ASSERT_EQ(reader.next()->index, i);
  EXPECT_FALSE(reader.next());
  EXPECT_FALSE(reader.summary().complete);
  writer.write(instant_of(200));
  writer.flush();
  writer.write(instant_of(201));
  writer.finish();
  for (int i = 200; i < 202; ++i) testing_take::expect_same(reader.next().value(), instant_of(i));
  EXPECT_TRUE(reader.summary().complete);
}

TEST_F(TakeFile, ShortChunksAreJoined) {
  TakeWriter writer(path_);
  writer.begin(header());
  for (int i = 0; i < 9000; ++i) {  // 75 s: a chunk of a minute, and the rest
    writer.write(instant_of(i));
    if (i % 60 == 59) writer.flush();
  }
  EXPECT_EQ(testing_take::number_in(path_, "SELECT count(*) FROM chunk"), 31) << "the first minute is one already";
  const Recording before = read_recording(path_);
  const TrackColumns path_before = TakeReader(path_).read_track(TrackId(2));
  writer.finish();
  EXPECT_EQ(testing_take::number_in(path_, "SELECT count(*) FROM chunk"), 2);
  EXPECT_EQ(testing_take::number_in(path_, "SELECT count(*) FROM samples"), 6);
  EXPECT_EQ(testing_take::number_in(path_, "PRAGMA freelist_count"), 0) << "the pages of the short ones are given back";
  testing_take::expect_same(read_recording(path_), before);
  testing_take::expect_same(TakeReader(path_).read_track(TrackId(2)), path_before);
  testing_take::expect_same(before, recording_of(every(0, 9000)));
}

TEST_F(TakeFile, TakesOneWriter) {
  TakeWriter writer(path_);
  writer.begin(header());
  writer.write(instant_of(0));
  EXPECT_NE(error_of([&] { TakeWriter(path_).begin(header()); }).find("is being written by another run"), std::string::npos);
  const int status =
      in_child([&] { _exit(error_of([&] { TakeWriter(path_).begin(header()); }).find("written") != std::string::npos); });
  EXPECT_EQ(WEXITSTATUS(status), 1);
  writer.finish();
  EXPECT_EQ(read_recording(path_).instants().size(), 1U);
  TakeWriter second(path_);
  second.begin(header());
  second.finish();
  EXPECT_EQ(read_recording(path_).instants().size(), 0U) << "the second replaces the first";
}

TEST_F(TakeFile, StaysAsItWasWhereNothingIsWritten) {
  {
    TakeWriter writer(path_);
    writer.begin(header());
  }
  EXPECT_FALSE(fs::exists(path_));
  {
    TakeWriter writer(path_);
    writer.begin(header());
    writer.write(instant_of(0));
    writer.finish();
  }
  const std::string before = test::read_file(path_);
  {
    TakeWriter writer(path_);
    writer.begin(header());
    EXPECT_NE(error_of([&] { TakeWriter(path_).begin(header()); }).find("is being written by another run"), std::string::npos);
  }
  EXPECT_EQ(test::read_file(path_), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1);
}

// At 2,000 frames a second, so that several transactions end before the kill. All data written before is in the file.
TEST_F(TakeFile, SurvivesSigkillAndLosesLessThanASecond) {
  using namespace std::chrono_literals;
  for (const auto after : {0ms, 350ms, 600ms}) {
    fs::remove(path_);
    const std::string ticks = folder_ / "ticks";
    std::uintmax_t written = 0;
    const int status = in_child(
        [&] {
          TakeWriter writer(path_);
          writer.begin(header());
          writer.set_name({TrackId(1), "head", ""});
          std::ofstream count(ticks, std::ios::binary);
          for (int i = 0;; ++i) {
            writer.write(instant_of(i));
            count << '.' << std::flush;
            std::this_thread::sleep_for(500us);
          }
        },
        [&] {
          for (int tries = 0; tries < 1000 && !has_instants(path_); ++tries) std::this_thread::sleep_for(20ms);
          std::this_thread::sleep_for(after);
          written = fs::file_size(ticks);
          std::this_thread::sleep_for(2s);  // of which one is for a machine that is busy
        });
    ASSERT_TRUE(WIFSIGNALED(status));
    TakeReader reader(path_);
    const RecordingSummary summary = reader.summary();
    EXPECT_FALSE(summary.complete);
    std::int64_t next = 0;
    while (const auto instant = reader.next()) testing_take::expect_same(*instant, instant_of(next++));
    EXPECT_EQ(summary.instants, next);
    ASSERT_FALSE(reader.tracks().empty());
    EXPECT_EQ(reader.tracks().front().label, "head");
    EXPECT_GE(next, static_cast<std::int64_t>(written));
    EXPECT_GT(next, 0);
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 2) << "the take and the ticks";
}

TEST_F(TakeFile, KeepsWhatWasWrittenWhenTheDiskIsFull) {
  const std::string stated = folder_ / "said";
  in_child([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{2 << 20, 2 << 20};
    setrlimit(RLIMIT_FSIZE, &limit);
    const std::string error = error_of([&] {
      TakeWriter writer(path_);
      writer.begin(header());
      for (int i = 0; i < 100'000; ++i) {
        writer.write(instant_of(i, 50));
        if (i % 50 == 0) writer.flush();
      }
    });
    test::write_file(stated, error);
  });
  EXPECT_NE(test::read_file(stated).find("cannot be written to the end"), std::string::npos) << test::read_file(stated);
  TakeReader reader(path_);
  const RecordingSummary summary = reader.summary();
  std::int64_t next = 0;
  while (const auto frame = reader.next()) testing_take::expect_same(*frame, instant_of(next++, 50));
  EXPECT_EQ(summary.instants, next);
  EXPECT_GT(next, 200) << "2 MB hold more";
}

TEST_F(TakeFile, RefusesWhatIsNotATake) {
  test::write_file(path_, "name,x,y\n");
  EXPECT_NE(error_of([&] { TakeReader reader(path_); }).find("is not a take"), std::string::npos);
  EXPECT_NE(error_of([&] { TakeWriter(path_).begin(header()); }).find("is not overwritten"), std::string::npos);
  EXPECT_EQ(test::read_file(path_), "name,x,y\n");
  EXPECT_NE(error_of([&] { TakeReader reader(folder_ / "none"); }).find("no such file"), std::string::npos);
  EXPECT_NE(error_of([&] { TakeReader reader(folder_.path()); }).find("is not a file"), std::string::npos);
}

TEST_F(TakeFile, RefusesFramesThatCannotBe) {
  TakeWriter writer(path_);
  writer.begin(header());
  writer.write(instant_of(5));
  EXPECT_NE(error_of([&] { writer.write(instant_of(5)); }).find("out of order"), std::string::npos);
  Instant twins = instant_of(6);
  twins.samples[1].track = twins.samples[0].track;
  EXPECT_NE(error_of([&] { writer.write(twins); }).find("two samples"), std::string::npos);
  Instant nowhere = instant_of(7);
  nowhere.samples[0].position.x() = std::nan("");
  EXPECT_NE(error_of([&] { writer.write(nowhere); }).find("nowhere"), std::string::npos);
  writer.write(instant_of(8));
  writer.finish();
  EXPECT_EQ(read_recording(path_).instants().size(), 2U);
}

TEST_F(TakeFile, DamagedTakesAreRefused) {
  write_recording(path_, recording_of(every(0, 300)));
  const std::string whole = test::read_file(path_);
  for (const double fraction : {0.001, 0.1, 0.5, 0.9, 0.999}) {
    test::write_file(path_, whole);
    test::cut_file(path_, fraction);
    EXPECT_THROW(read_recording(path_), Error) << fraction;
  }
}

}  // namespace
}  // namespace marey::format::take
