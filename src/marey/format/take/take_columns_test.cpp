// What lies in a take's columns: random recordings of every kind come back, a track that is read alone is what row by row SQL says,
// schema 1 is refused, and so is what no writer wrote.
#include <cstring>
#include <functional>
#include <memory>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/take/take_file.h"
#include "marey/format/take/take_schema.h"
#include "marey/format/take/take_testing.h"

#include "support/files.h"

namespace marey::format::take {
namespace {

using Kind = FrameOfReference::Kind;

class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double between(double low, double high) { return std::uniform_real_distribution(low, high)(engine_); }
  int below(int end) { return std::uniform_int_distribution(0, end - 1)(engine_); }
  bool with(double probability) { return between(0, 1) < probability; }

 private:
  std::mt19937 engine_;
};

std::shared_ptr<const Outline> outline_of(Dice& dice) {
  auto outline = std::make_shared<Outline>();
  outline->state = static_cast<Outline::State>(dice.below(3));
  const auto pair = [&] { return Vector<2>(dice.between(0, 800), dice.between(0, 600)); };
  outline->control_points.resize(static_cast<std::size_t>(4 + dice.below(12)));
  for (auto& point : outline->control_points) point = pair();
  if (dice.with(0.5)) outline->deviations.resize(outline->control_points.size(), Vector<2>(0.5, 0.25));
  outline->centre = pair();
  outline->velocity = pair();
  outline->scale_rate_deviation = dice.between(0, 1);
  if (dice.with(0.5)) outline->silhouette = pair();
  return outline;
}

const KeypointSet& three_points() {
  static const KeypointSet set{
      .name = "three", .points = {"nose", "left \"eye\"", "right_eye"}, .bones = {{0, 1}, {0, 2}}, .mirrored = {0, 2, 1}};
  return set;
}

std::shared_ptr<const Keypoints<2>> keypoints_of(Dice& dice) {
  auto body = std::make_shared<Keypoints<2>>();
  body->presence = dice.between(0, 1);
  for (std::size_t i = 0; i < three_points().points.size(); ++i) {
    std::optional<Keypoint<2>>& point = body->points.emplace_back();
    if (dice.with(0.2)) continue;
    point = Keypoint<2>{.position = {dice.between(-20, 800), dice.between(0, 600)},
                        .visibility = dice.between(0, 1),
                        .presence = dice.between(0, 1)};
    point->covariance << 4, dice.between(-1, 1), 0, 3;
    point->covariance(1, 0) = point->covariance(0, 1);
  }
  return body;
}

/// With gaps in indices, tracks that come and go, and optional columns that some tracks have always, some now and then, some never.
Recording random_recording(Kind kind, unsigned seed) {
  Dice dice(seed);
  RecordingHeader header;
  header.name = "random";
  header.frame.kind = kind;
  if (kind == Kind::image) header.frame.camera = CameraId{2};
  header.rate_hz = 25;
  header.smoothed = dice.with(0.5);
  header.track_kind = static_cast<TrackKind>(dice.below(static_cast<int>(kTrackKindNames.size())));
  header.time_base.kind = static_cast<TimeBase::Kind>(dice.below(3));
  if (header.time_base.kind == TimeBase::Kind::camera) header.time_base.camera = CameraId{dice.below(64)};
  if (kind == Kind::image) header.keypoints = three_points();
  Recording recording(header);
  const int tracks = 1 + dice.below(9), dimensions = recording.dimensions();
  std::int64_t index = dice.below(5);
  for (int i = 0; i < 400; ++i, index += dice.with(0.05) ? 1 + dice.below(3'000) : 1) {
    Instant instant;
    instant.index = index;
    instant.time = timestamp_from_seconds(static_cast<double>(index) / 25 + dice.between(0, 0.001));
    for (int t = 1; t <= tracks; ++t) {
      if (i < 20 * t || i > 400 - 10 * t || dice.with(0.1)) continue;
      const auto has = [&](int column) { return (t + column) % 3 == 0 || ((t + column) % 3 == 1 && dice.with(0.3)); };
      Sample sample;
      sample.track = TrackId{7 * t};
      for (int k = 0; k < dimensions; ++k) sample.position[k] = t == 2 ? dice.below(1000) : dice.between(-50, 50);
      sample.provenance = t == 3 ? Provenance::measured : static_cast<Provenance>(dice.below(4));
      sample.cameras = t == 4 ? ~CameraMask{0} : CameraMask{1} << dice.below(t == 5 ? 64 : 4);
      if (has(0)) sample.velocity = Vector<3>(dice.between(-9, 9), dice.between(-9, 9), dimensions == 3 ? 1 : 0);
      if (has(1)) {
        sample.covariance = Matrix<3>::Zero();
        for (int k = 0; k < dimensions; ++k) {
          for (int m = k; m < dimensions; ++m) (*sample.covariance)(k, m) = (*sample.covariance)(m, k) = dice.between(0, 1);
        }
      }
      if (has(2)) sample.score = dice.between(0, 1);
      if (kind == Kind::image && has(0)) sample.box = Box{dice.between(0, 800), dice.between(0, 600), 20, 40.5};
      if (kind == Kind::image && t % 3 == 1 && dice.with(0.7)) sample.outline = outline_of(dice);
      if (kind == Kind::image && t % 3 == 2 && dice.with(0.8)) sample.keypoints = keypoints_of(dice);
      if (has(3)) sample.residual_px = dice.between(0, 1);
      if (has(4)) sample.residual_m = dice.between(0, 1);
      instant.samples.push_back(sample);
    }
    for (int camera = 0; camera < 3; ++camera) {
      for (int n = dice.below(4); n > 0; --n) {
        ImageObservation point{CameraId{camera}, {dice.between(0, 800), dice.between(0, 600)}, {}, {}, {}};
        if (camera != 1) point.sigma = dice.between(0, 1);
        if (dice.with(0.5)) point.area = dice.between(0, 100);
        if (dice.with(0.5)) point.track = TrackId{7 * (1 + dice.below(tracks))};
        instant.detected.push_back(point);
      }
    }
    recording.add(instant);
  }
  return recording;
}

class TakeColumnsTest : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
  std::string path_ = folder_ / "some.marey";

  static std::string error_of(const std::function<void()>& action) {
    try {
      action();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  void read_everything() const {
    TakeReader reader(path_);
    const auto summary = reader.summary();
    while (reader.next()) {
    }
    reader.time_steps();
    for (const auto& track : summary.tracks) reader.read_track(track.name.id);
  }
};

TEST_F(TakeColumnsTest, RecordingsOfEveryKindComeBack) {
  for (const Kind kind : {Kind::image, Kind::ground, Kind::user_ground, Kind::space}) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      SCOPED_TRACE(fmt::format("kind {}, seed {}", static_cast<int>(kind), seed));
      const Recording recording = random_recording(kind, seed);
      write_recording(path_, recording);
      const Recording read = read_recording(path_);
      EXPECT_EQ(read.header.frame, recording.header.frame);
      EXPECT_EQ(read.header.smoothed, recording.header.smoothed);
      EXPECT_EQ(read.header.track_kind, recording.header.track_kind);
      EXPECT_EQ(read.header.time_base, recording.header.time_base);
      EXPECT_EQ(read.header.keypoints, recording.header.keypoints);
      testing_take::expect_same(read, recording);
      if (HasFailure()) return;
    }
  }
}

TEST_F(TakeColumnsTest, KindsComeBackAndOldTakesKnowTheBallByItsLabel) {
  RecordingHeader header;
  header.name = "kinds";
  header.frame.kind = Kind::user_ground;
  header.rate_hz = 25;
  header.track_kind = TrackKind::person;
  Recording recording(header);
  Instant instant;
  instant.named = {{.id = TrackId{1}, .label = "ball", .team = {}, .kind = TrackKind::person},
                   {.id = TrackId{2}, .label = "round", .team = {}, .kind = TrackKind::ball}};
  for (const int id : {1, 2, 3}) {
    Sample& sample = instant.samples.emplace_back();
    sample.track = TrackId{id};
    sample.position = {1, 2, id == 2 ? 0.5 : 0};
  }
  recording.add(instant);
  write_recording(path_, recording);
  const Recording read = read_recording(path_);
  ASSERT_EQ(read.tracks().size(), 3U);
  EXPECT_EQ(read.tracks()[0].name.kind, TrackKind::person);
  EXPECT_EQ(read.tracks()[1].name.kind, TrackKind::ball);
  EXPECT_EQ(read.tracks()[1].position(0), Vector<3>(1, 2, 0.5));
  EXPECT_EQ(read.tracks()[2].name.kind, TrackKind::person);
  EXPECT_EQ(TakeReader(path_).read_track(TrackId{3}).name.kind, TrackKind::person);

  Database(path_, Database::Mode::create)
      .run(
          "UPDATE track SET label = CASE id WHEN 2 THEN 'ball' ELSE '' END; ALTER TABLE track DROP COLUMN kind; "
          "DELETE FROM take WHERE key = 'track_kind'");
  const Recording old = read_recording(path_);
  EXPECT_EQ(old.tracks()[0].name.kind, TrackKind::unspecified);
  EXPECT_EQ(old.tracks()[1].name.kind, TrackKind::ball);
  EXPECT_EQ(old.tracks()[1].position(0), Vector<3>(1, 2, 0.5));
}

/// The coordinates of a track by SQL alone, number by number.
std::vector<std::array<double, 4>> rows_by_sql(const std::string& path, int track) {
  std::vector<std::array<double, 4>> found;
  Database database(path, Database::Mode::read);
  Statement rows(database,
                 "SELECT s.rows, s.at, s.x, s.y, s.z, c.times FROM samples s JOIN chunk c ON c.id = s.id >> 32 WHERE "
                 "s.id & 0xFFFFFFFF = ? ORDER BY c.last_index");
  rows.bind(0, std::int64_t{track});
  while (rows.step()) {
    const auto count = static_cast<std::size_t>(rows.integer(0));
    const auto coordinate = [&](int column, std::size_t row) {
      const auto blob = rows.blob(column);
      double wide = 0;
      float narrow = 0;
      if (blob.empty()) return 0.0;
      if (blob.size() == 4 * count) return static_cast<double>((std::memcpy(&narrow, blob.data() + 4 * row, 4), narrow));
      return std::memcpy(&wide, blob.data() + 8 * row, 8), wide;
    };
    for (std::size_t row = 0; row < count; ++row) {
      std::uint32_t at = 0;
      if (rows.is_number(1)) {
        at = static_cast<std::uint32_t>(rows.integer(1)) + static_cast<std::uint32_t>(row);
      } else {
        std::memcpy(&at, rows.blob(1).data() + 4 * row, 4);
      }
      std::int64_t time = 0;
      std::memcpy(&time, rows.blob(5).data() + 8 * std::size_t{at}, 8);
      found.push_back({static_cast<double>(time) * 1e-9, coordinate(2, row), coordinate(3, row), coordinate(4, row)});
    }
  }
  return found;
}

TEST_F(TakeColumnsTest, ReadsTrackAsRowByRow) {
  for (const Kind kind : {Kind::image, Kind::space}) {
    const Recording recording = random_recording(kind, 9);
    write_recording(path_, recording);
    const TakeReader reader(path_);
    const auto time_steps = reader.time_steps();
    ASSERT_EQ(time_steps.size(), recording.instants().size());
    for (const auto& track : recording.tracks()) {
      const auto alone = reader.read_track(track.id());
      testing_take::expect_same(alone, track);
      const auto slow = rows_by_sql(path_, number(track.id()));
      ASSERT_EQ(slow.size(), alone.size());
      for (std::size_t row = 0; row < slow.size(); ++row) {
        EXPECT_EQ(alone.position(row), Vector<3>(slow[row][1], slow[row][2], slow[row][3]));
        EXPECT_NEAR(seconds(time_steps[static_cast<std::size_t>(alone.at()[row])].time), slow[row][0], 1e-9);
      }
    }
    EXPECT_TRUE(reader.read_track(TrackId{4}).empty());
  }
}

TEST_F(TakeColumnsTest, ColumnsThatNobodyFillsAreNotThere) {
  RecordingHeader header;
  header.rate_hz = 25;
  header.frame.kind = Kind::ground;
  Recording recording(header);
  for (int i = 0; i < 1000; ++i) {
    Instant instant;
    instant.index = i;
    instant.time = timestamp_from_seconds(0.04 * i);
    Sample& sample = instant.samples.emplace_back();
    sample.track = TrackId{1};
    sample.position = {0.1 * i, 0.25 * i, 0};
    sample.cameras = 3;
    recording.add(instant);
  }
  write_recording(path_, recording);
  EXPECT_EQ(testing_take::number_in(path_,
                                    "SELECT count(*) FROM samples WHERE typeof(at) = 'integer' AND typeof(cameras) = 'integer' "
                                    "AND typeof(provenance) = 'integer' AND z IS NULL AND velocity IS NULL AND covariance IS "
                                    "NULL AND box IS NULL AND outline IS NULL"),
            1);
  EXPECT_EQ(testing_take::number_in(path_, "SELECT length(x) FROM samples"), 8000);
  EXPECT_EQ(testing_take::number_in(path_, "SELECT length(y) FROM samples"), 4000) << "quarters are floats without a loss";
}

TEST_F(TakeColumnsTest, RefusesSchema1AndNamesTheCommitThatReadsIt) {
  write_recording(path_, random_recording(Kind::space, 1));
  Database(path_, Database::Mode::create).run("PRAGMA user_version = 1");
  const std::string message = error_of([&] { TakeReader reader(path_); });
  EXPECT_NE(message.find("schema 1"), std::string::npos) << message;
  EXPECT_NE(message.find("6ee6ccf74"), std::string::npos) << message;
}

TEST_F(TakeColumnsTest, LaterSchemasAndOtherProgramsFilesAreRefused) {
  write_recording(path_, random_recording(Kind::space, 1));
  Database(path_, Database::Mode::create).run("PRAGMA user_version = 3");
  EXPECT_NE(error_of([&] { TakeReader reader(path_); }).find("later version of Marey"), std::string::npos);
  Database(path_, Database::Mode::create).run("PRAGMA application_id = 42");
  EXPECT_NE(error_of([&] { TakeReader reader(path_); }).find("is not a take"), std::string::npos);
}

TEST_F(TakeColumnsTest, HostileTablesAreRefused) {
  const char* const changes[] = {
      "UPDATE samples SET rows = rows + 1",
      "UPDATE samples SET rows = -1",
      "UPDATE samples SET rows = 2000000000",
      "UPDATE samples SET rows = 2000000000, at = 0, provenance = 0, cameras = 0",
      "UPDATE samples SET x = zeroblob(3)",
      "UPDATE samples SET z = NULL",
      "UPDATE samples SET x = CAST(replace(hex(x), '0', 'F') AS BLOB)",
      "UPDATE samples SET (rows, at, provenance, cameras, x, y, z) = (1, 0, 0, 0, x'0000c07f', x'00000000', x'00000000')",
      "UPDATE samples SET at = 1000000",
      "UPDATE samples SET at = -1",
      "UPDATE samples SET at = zeroblob(4 * rows) WHERE rows > 1",
      "UPDATE samples SET provenance = 9",
      "UPDATE samples SET velocity = zeroblob(5)",
      "UPDATE samples SET outline = zeroblob(5)",
      "UPDATE samples SET outline = x'ffffffff'",
      "UPDATE samples SET id = id | 0xC0000000",
      "UPDATE seen SET rows = rows + 1",
      "UPDATE seen SET at = zeroblob(4)",
      "UPDATE seen SET track = 3000000000",
      "UPDATE seen SET id = id | 64",
      "UPDATE chunk SET instants = instants + 1",
      "UPDATE chunk SET instants = 2000000000, last_index = 4000000000, indices = NULL WHERE id = (SELECT max(id) FROM chunk)",
      "UPDATE chunk SET times = zeroblob(16)",
      "UPDATE chunk SET indices = zeroblob(4 * instants)",
      "UPDATE chunk SET first_index = last_index + 1",
      "UPDATE chunk SET last_index = 9223372036854775807 WHERE id = (SELECT max(id) FROM chunk)",
      "UPDATE chunk SET id = 9223372036854775807 WHERE id = 1",
      "UPDATE track SET id = -1 WHERE id = 7",
      "UPDATE track SET kind = 'dog' WHERE id = 7",
      "INSERT OR REPLACE INTO take VALUES ('track_kind', 'dog')",
      "INSERT OR REPLACE INTO take VALUES ('clock', 64)",
      "UPDATE take SET value = 'elsewhere' WHERE key = 'frame'",
      "UPDATE take SET value = 0 WHERE key = 'rate_hz'",
      "UPDATE take SET value = 'nonsense = [' WHERE key = 'rig'",
      "DROP TABLE seen",
  };
  Recording recording = random_recording(Kind::space, 3);
  recording.header.rig = Rig{};
  recording.header.rig->cameras.emplace_back().name = "left";
  write_recording(folder_ / "whole.marey", recording);
  for (const char* change : changes) {
    SCOPED_TRACE(change);
    std::filesystem::copy_file(folder_ / "whole.marey", path_, std::filesystem::copy_options::overwrite_existing);
    Database(path_, Database::Mode::create).run(change);
    const std::string error = error_of([&] { read_everything(); });
    EXPECT_TRUE(error.starts_with(path_)) << error;
  }
}

}  // namespace
}  // namespace marey::format::take
