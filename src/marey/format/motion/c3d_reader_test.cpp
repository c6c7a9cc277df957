// C3D files that are not as the format asks: missing points written as zeros, counts that contradict each other, files that end
// early.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/motion/c3d.h"
#include "marey/format/motion/c3d_auxiliary.h"
#include "marey/format/motion/c3d_section.h"
#include "marey/format/recording_file.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::format::motion {
namespace {

namespace fs = std::filesystem;

struct MadePoint {
  Vector<3> at{0, 0, 0};  // in mm
  double fourth = 0;
};

struct MadeC3d {
  std::vector<std::string> labels;
  std::vector<std::vector<MadePoint>> frames;
  bool real = true;
  double step_mm = 0.1;
  std::string maker = "Another program";
  // Analog channels: the existing ones, and what the first block and the rates make of it.
  int channels = 0, samples = 1, header_samples = 1;
  double rate_hz = 100, analog_rate_hz = 100;
  std::vector<std::string> angles = {};
};

std::string made_parameters(const MadeC3d& made, std::int64_t block) {
  C3dSection section;
  section.group("POINT");
  section.word("USED", static_cast<std::int64_t>(made.labels.size()));
  section.real("SCALE", made.real ? -made.step_mm : made.step_mm);
  section.real("RATE", made.rate_hz);
  section.word("DATA_START", block);
  section.word("FRAMES", static_cast<std::int64_t>(made.frames.size()));
  section.text("UNITS", "mm");
  section.texts("LABELS", made.labels);
  if (!made.angles.empty()) section.texts("ANGLES", made.angles);
  if (made.channels > 0) {
    section.group("ANALOG");
    section.word("USED", made.channels);
    section.real("RATE", made.analog_rate_hz);
  }
  section.group("MANUFACTURER");
  section.text("SOFTWARE", made.maker);
  return section.blocks("made");
}

std::string bytes_of(const MadeC3d& made) {
  const auto block = static_cast<std::int64_t>(2 + made_parameters(made, 2).size() / kC3dBlock);
  std::string bytes("\x02\x50", 2);
  put_word(bytes, static_cast<std::int64_t>(made.labels.size()));
  put_word(bytes, made.channels * made.header_samples);
  put_word(bytes, 1);
  put_word(bytes, static_cast<std::int64_t>(made.frames.size()));
  put_word(bytes, 0);
  put_real(bytes, made.real ? -made.step_mm : made.step_mm);
  put_word(bytes, block);
  put_word(bytes, made.header_samples);
  put_real(bytes, made.rate_hz);
  bytes.resize(kC3dBlock, '\0');
  bytes += made_parameters(made, block);
  const auto put = [&](double value) { made.real ? put_real(bytes, value) : put_word(bytes, std::llround(value)); };
  for (std::size_t frame = 0; frame < made.frames.size(); ++frame) {
    for (const MadePoint& word : made.frames[frame]) {
      for (int axis = 0; axis < 3; ++axis) put(word.at[axis] / (made.real ? 1 : made.step_mm));
      put(word.fourth);
    }
    for (int i = 0; i < made.channels * made.samples; ++i) put(1000 * static_cast<double>(frame % 30) + i);
  }
  bytes.resize((bytes.size() + kC3dBlock - 1) / kC3dBlock * kC3dBlock, '\0');
  return bytes;
}

struct ReadC3d {
  FileInfo info;
  std::vector<Instant> frames;
  std::vector<std::string> warnings;

  bool has(std::size_t frame, std::size_t point) const {
    const auto& samples = frames.at(frame).samples;
    return std::any_of(samples.begin(), samples.end(),
                       [&](const Sample& sample) { return sample.track == TrackId(static_cast<int>(point) + 1); });
  }
  std::size_t points() const {
    std::size_t count = 0;
    for (const Instant& frame : frames) count += frame.samples.size();
    return count;
  }
  bool warns(const std::string& words) const {
    return std::any_of(warnings.begin(), warnings.end(),
                       [&](const std::string& warning) { return warning.find(words) != std::string::npos; });
  }
};

ReadC3d read_made(const std::string& bytes) {
  const auto reader = read_c3d(std::as_bytes(std::span(bytes)), "file");
  ReadC3d read;
  while (auto frame = reader->next()) read.frames.push_back(std::move(*frame));
  read.info = reader->info();
  read.warnings = reader->warnings();
  return read;
}

/// A walk a metre beside the origin.
MadeC3d walk_off_origin(std::size_t markers = 4, std::size_t frames = 60) {
  MadeC3d made;
  for (std::size_t i = 0; i < markers; ++i) made.labels.push_back(fmt::format("M{}", i + 1));
  for (std::size_t t = 0; t < frames; ++t) {
    auto& row = made.frames.emplace_back();
    for (std::size_t i = 0; i < markers; ++i)
      row.push_back({.at = {1000 + 12.0 * static_cast<double>(t), 100.0 * static_cast<double>(i), 900}});
  }
  return made;
}

const char* const kReadAsMissing = "are read as missing";
const char* const kKept = "kept as a marker of the origin";

TEST(C3dZeros, OfAMarkerThatLeapsAreMissing) {
  for (const bool real : {true, false}) {
    for (const double word : {0.0, 65535.0}) {
      if (!real && word > 32767) continue;  // the same word as −1
      SCOPED_TRACE(fmt::format("{} {}", real, word));
      MadeC3d made = walk_off_origin();
      made.real = real;
      std::set<std::pair<std::size_t, std::size_t>> holes;
      for (std::size_t t = 0; t < 7; ++t) holes.insert({{t, 0U}, {20 + t, 1U}, {53 + t, 2U}});
      holes.insert({30, 3});
      for (auto& row : made.frames) {
        for (MadePoint& each : row) each.fourth = word;
      }
      for (const auto& [t, i] : holes) made.frames[t][i].at.setZero();
      const ReadC3d read = read_made(bytes_of(made));
      for (std::size_t t = 0; t < 60; ++t) {
        for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(read.has(t, i), !holes.contains({t, i})) << t << " " << i;
      }
      ASSERT_EQ(read.warnings.size(), 1U);
      EXPECT_NE(read.warnings[0].find("22 of its 240 points, of 4 markers, are exactly (0, 0, 0)"), std::string::npos);
    }
  }
}

TEST(C3dZeros, OfAMarkerThatPassesTheOriginArePositions) {
  MadeC3d made = walk_off_origin(2);
  for (std::size_t t = 0; t < made.frames.size(); ++t) {
    made.frames[t][0].at = {8.0 * (static_cast<double>(t) - 30), 0, 0};
    made.frames[t][1].at = {8.0 * (static_cast<double>(t) - 30), 4.0 * (static_cast<double>(t) - 30), 0};
  }
  const ReadC3d read = read_made(bytes_of(made));
  EXPECT_EQ(read.points(), 120U);
  EXPECT_TRUE(read.warnings.empty());
}

TEST(C3dZeros, OfCoarseNumbersAroundTheOriginArePositions) {
  MadeC3d made = walk_off_origin(2);
  made.real = false;
  made.step_mm = 1;
  for (std::size_t t = 0; t < made.frames.size(); ++t)
    made.frames[t][0].at = {static_cast<double>(t / 3 % 2), 0, -static_cast<double>(t / 7 % 2)};
  const ReadC3d read = read_made(bytes_of(made));
  EXPECT_EQ(read.points(), 120U);
  EXPECT_TRUE(read.warnings.empty());
}

void put_at_origin(MadeC3d& made, std::size_t point, double fourth = 0) {
  for (auto& row : made.frames) row[point] = {.at = {0, 0, 0}, .fourth = fourth};
}

TEST(C3dZeros, OfALoneMarkerThroughoutArePositionsAndAreSaid) {
  MadeC3d made = walk_off_origin();
  put_at_origin(made, 2);
  const ReadC3d read = read_made(bytes_of(made));
  EXPECT_EQ(read.points(), 240U);
  ASSERT_EQ(read.warnings.size(), 1U);
  EXPECT_NE(read.warnings[0].find("\"M3\" is at exactly (0, 0, 0) throughout and kept"), std::string::npos);
}

TEST(C3dZeros, ThroughoutAreMissingWhereTheProgramWritesZeros) {
  MadeC3d several = walk_off_origin();
  put_at_origin(several, 1);
  put_at_origin(several, 2);
  EXPECT_EQ(read_made(bytes_of(several)).points(), 120U) << "two markers cannot be at one place";

  MadeC3d leaping = walk_off_origin();
  put_at_origin(leaping, 1);
  for (std::size_t t = 20; t < 30; ++t) leaping.frames[t][0].at.setZero();
  EXPECT_EQ(read_made(bytes_of(leaping)).points(), 170U);

  // Signs of a marker that is the origin.
  leaping.labels[1] = "Subject:Origin";
  ReadC3d read = read_made(bytes_of(leaping));
  EXPECT_EQ(read.points(), 230U);
  EXPECT_TRUE(read.warns(kReadAsMissing) && read.warns(kKept));
  leaping.labels[1] = "M2";
  put_at_origin(leaping, 1, 0x0301);
  EXPECT_EQ(read_made(bytes_of(leaping)).points(), 230U) << "it has a residual and cameras";
}

TEST(C3dZeros, ThroughoutArePositionsWhereMissingPointsAreMarked) {
  MadeC3d made = walk_off_origin();
  put_at_origin(made, 1);
  for (std::size_t t = 20; t < 30; ++t) made.frames[t][0] = {.at = {0, 0, 0}, .fourth = -1};
  const ReadC3d read = read_made(bytes_of(made));
  EXPECT_EQ(read.points(), 230U);
  EXPECT_TRUE(read.warns(kKept));
}

TEST(C3dZeros, OfAnglesAreAngles) {
  MadeC3d made = walk_off_origin();
  made.labels[0] = "LKneeAngles";
  made.angles = {"LKneeAngles"};
  made.frames[30][0].at.setZero();
  test::TemporaryFolder folder;
  test::write_file(folder / "a.c3d", bytes_of(made));
  const auto reader = open_c3d(folder / "a.c3d", C3dPoints::all);
  std::size_t count = 0;
  while (const auto frame = reader->next()) count += frame->samples.size();
  EXPECT_EQ(count, 240U);
}

TEST(C3dZeros, OfMareysOwnFilesArePositions) {
  MadeC3d made = walk_off_origin();
  made.maker = "Marey";
  made.frames[30][0].at.setZero();
  EXPECT_EQ(read_made(bytes_of(made)).points(), 240U);
}

/// Real files whose missing points are marked, written as programs do that mark none: the same points must be missing.
TEST(C3dZeros, OfRealFilesAreMissing) {
  for (const char* name : {"vicon_skeleton/nick_freeform_001.c3d", "mocap_files/kineticstoolkit/c3d_test_suite/ezc3d/BTS.c3d",
                           "mocap_files/kineticstoolkit/c3d_test_suite/Sample02/pc_real.c3d", "cmu_02_05/cmu_02_05.c3d",
                           "c3d_kinds/duplicate_labels.c3d", "gait_children/HC033A/straight_HC033A10.c3d"}) {
    const std::string path = test::data(name);
    if (!fs::exists(path)) GTEST_SKIP() << path << " is not here";
    SCOPED_TRACE(name);
    std::string bytes = test::read_file(path);
    const ReadC3d marked = read_made(bytes);
    const auto span = std::as_bytes(std::span(bytes));
    const C3dHead head = read_c3d_head(span, "file");
    const C3dLayout layout = c3d_layout(head, bytes.size(), "file");
    const C3dBytes words(span, head.processor);
    for (const float fourth : {0.0F, 65535.0F}) {
      for (std::size_t frame = 0; frame < layout.frames; ++frame) {
        for (std::size_t i = 0; i < layout.points; ++i) {
          const std::size_t at = layout.begin + frame * layout.frame_bytes() + 16 * i + 12;
          if (words.real(at) < 0 || words.real(at) == 65535.0F) std::memcpy(bytes.data() + at, &fourth, 4);
        }
      }
      const ReadC3d read = read_made(bytes);
      EXPECT_EQ(read.points(), marked.points()) << fourth;
      EXPECT_TRUE(read.warns(kReadAsMissing));
    }
  }
}

TEST(C3dCounts, OfAnalogValuesThatFitTheLengthAreRead) {
  test::TemporaryFolder folder;
  struct Case {
    int header;
    double rate_hz;
    const char* stated;
  };
  // Ten samples a frame are there.
  for (const auto& [header, rate_hz, stated] :
       {Case{1, 1000, "its first block names 6 analog values a frame"}, Case{20, 1000, "its length fits 60"},
        Case{10, 2000, "make 120; its length fits 60"}, Case{10, 1000, ""}}) {
    SCOPED_TRACE(fmt::format("{} {}", header, rate_hz));
    MadeC3d made = walk_off_origin();
    made.channels = 6;
    made.samples = 10;
    made.header_samples = header;
    made.analog_rate_hz = rate_hz;
    const ReadC3d read = read_made(bytes_of(made));
    ASSERT_EQ(read.frames.size(), 60U);
    for (std::size_t t = 0; t < 60; ++t) {
      ASSERT_EQ(read.frames[t].samples.size(), 4U);
      EXPECT_NEAR(read.frames[t].samples[3].position.x(), 1 + 0.012 * static_cast<double>(t), 1e-6);
    }
    EXPECT_EQ(read.warnings.empty(), *stated == 0);
    EXPECT_TRUE(*stated == 0 || read.warns(stated));
    test::write_file(folder / "a.c3d", bytes_of(made));
    C3dAuxiliary auxiliary(AuxiliaryData{.path = folder / "a.c3d"});
    ASSERT_EQ(auxiliary.channels() * auxiliary.samples(), 60U);
    EXPECT_EQ(auxiliary.samples(), 10U);
    EXPECT_EQ(auxiliary.frame(7)[59], 7059);
  }
}

TEST(C3dCounts, OfFramesThatAreCutOffAreWhatIsThere) {
  MadeC3d made = walk_off_origin(4, 152);
  made.channels = 2;
  made.samples = made.header_samples = 10;
  made.analog_rate_hz = 1000;
  const std::string whole = bytes_of(made);
  const std::size_t frame_bytes = 4 * (16 + 20), begin = whole.size() - (152 * frame_bytes + 511) / 512 * 512;
  const ReadC3d read = read_made(whole.substr(0, begin + 145 * frame_bytes + 70));
  ASSERT_EQ(read.frames.size(), 145U);
  EXPECT_EQ(read.info.frame_count, 145);
  EXPECT_NEAR(read.frames[144].samples[0].position.x(), 1 + 0.012 * 144, 1e-6);
  EXPECT_TRUE(read.warns("is cut off: it names 152 frames and holds 145, which are read"));
  EXPECT_TRUE(read_made(whole).warnings.empty());
  EXPECT_THROW(read_made(whole.substr(0, begin + 20)), Error) << "of no frame there is nothing to read";
}

TEST(C3dCounts, OfMatricesThatAreCutOffAreWhatIsThere) {
  const std::string path = test::data("c3d_kinds/C3DRotationExample.c3d");
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not here";
  const std::string whole = test::read_file(path);
  const ReadC3d all = read_made(whole), part = read_made(whole.substr(0, whole.size() - 100'000));
  EXPECT_EQ(all.frames.size(), 340U);
  EXPECT_GT(part.frames.size(), 250U);
  EXPECT_LT(part.frames.size(), 340U);
  EXPECT_EQ(part.frames.back().bodies.size(), 21U);
  EXPECT_TRUE(part.warns("is cut off"));
}

}  // namespace
}  // namespace marey::format::motion
