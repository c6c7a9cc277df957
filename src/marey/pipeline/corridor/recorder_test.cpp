#include "marey/pipeline/corridor/recorder.h"

#include <filesystem>
#include <set>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/core/recording_reader.h"
#include "marey/core/recording_sink.h"
#include "marey/format/recording_file.h"

#include "support/files.h"

namespace marey::pipeline::corridor {
namespace {

RecordingHeader space_header() {
  RecordingHeader header;
  header.name = "test";
  header.frame.kind = FrameOfReference::Kind::space;
  header.rate_hz = 10;
  return header;
}

/// One marker, named at the first instant only.
Instant instant_at(std::int64_t index) {
  Instant instant;
  instant.index = index;
  instant.time = timestamp_from_seconds(0.1 * static_cast<double>(index));
  instant.samples.emplace_back().track = TrackId{1};
  if (index == 0) instant.named.push_back({TrackId{1}, "knee", {}});
  return instant;
}

std::set<std::int64_t> indices(const std::string& path) {
  std::set<std::int64_t> all;
  const auto reader = format::open_recording(path);
  while (auto instant = reader->next()) all.insert(instant->index);
  return all;
}

TEST(Recorder, BeginsWithTheSecondsBeforeAndGoesOnAfterAPause) {
  const test::TemporaryFolder folder;
  const auto record = std::make_shared<RecordSwitch>(false);
  Recorder recorder(folder / "take.marey", record, 0.5);
  recorder.begin(space_header());
  for (int i = 0; i < 60; ++i) {
    if (i == 20 || i == 30 || i == 50) record->toggle();
    recorder.write(instant_at(i));
  }
  recorder.finish();
  std::set<std::int64_t> required;
  for (int i = 15; i < 30; ++i) required.insert(i);
  for (int i = 45; i < 60; ++i) required.insert(i);
  EXPECT_EQ(indices(folder / "take.marey"), required);
  Recording take;
  RecordingSink sink(take);
  replay(*format::open_recording(folder / "take.marey"), sink);
  ASSERT_EQ(take.tracks().size(), 1u);
  EXPECT_EQ(take.tracks().front().name.label, "knee") << "it was reported before recording began";
}

TEST(Recorder, LeavesNothingWhereItWasNeverOn) {
  const test::TemporaryFolder folder;
  Recorder recorder(folder / "take.marey", std::make_shared<RecordSwitch>(false), 5);
  recorder.begin(space_header());
  for (int i = 0; i < 10; ++i) recorder.write(instant_at(i));
  recorder.finish();
  EXPECT_FALSE(std::filesystem::exists(folder / "take.marey"));
}

TEST(Recorder, APlaceThatIsNotThereIsToldAtOnce) {
  Recorder recorder("/nowhere/take.marey", std::make_shared<RecordSwitch>(true), 5);
  EXPECT_THROW(recorder.begin(space_header()), Error);
}

}  // namespace
}  // namespace marey::pipeline::corridor
