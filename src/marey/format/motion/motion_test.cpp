#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <tuple>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/format.h"
#include "marey/format/motion/c3d.h"
#include "marey/format/motion/motion_csv.h"
#include "marey/format/motion/trc.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/format/take/take_file.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::format::motion {
namespace {

namespace fs = std::filesystem;

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// A recording with gaps, whose values are floats of whole micrometres.
Recording walk(int markers = 5, int frames = 40, int first = 3) {
  RecordingHeader header;
  header.name = "walk";
  header.rate_hz = 120;
  Recording recording(header);
  for (int m = 1; m <= markers; ++m) recording.set_name({TrackId(m), fmt::format("marker, \"{}\"", m), {}});
  for (int i = 0; i < frames; ++i) {
    Instant instant;
    instant.index = first + i;
    instant.time = timestamp_from_seconds(static_cast<double>(instant.index) / 120);
    for (int m = 1; m <= markers; ++m) {
      if ((i + m) % 7 == 0) continue;
      Sample sample;
      sample.track = TrackId(m);
      sample.position = {0.25 * m, -0.5 + 0.015625 * i, 1.0 / 1024 * (i * m)};
      sample.provenance = (i + m) % 5 == 0 ? Provenance::filled : Provenance::measured;
      if (sample.measured()) {
        sample.cameras = static_cast<CameraMask>(1 + (i + m) % 127);
        sample.residual_m = 0.0005;
      }
      instant.samples.push_back(sample);
    }
    recording.add(instant);
  }
  return recording;
}

const Format& of_points(const char* name) {
  return *format_named(name, Content::space);
}

void write_motion(const std::string& path, const char* format, const Recording& recording, UpAxis up = UpAxis::z) {
  match::GroundMatch whole;
  whole.recording = recording;
  write_whole(path, of_points(format), whole, up);
}

struct Read {
  FileInfo info;
  std::vector<Instant> frames;
  std::vector<std::string> warnings;
};

Read read_all(FileReader& reader) {
  Read read;
  while (auto frame = reader.next()) read.frames.push_back(std::move(*frame));
  read.info = reader.info();
  read.warnings = reader.warnings();
  return read;
}

Read read_all(const std::string& path, UpAxis up = UpAxis::z) {
  return read_all(*open_recording(path, {.metadata = {}, .pitch = {}, .up = up}));
}

void convert(const std::string& from, const std::string& to, const char* format, UpAxis from_up = UpAxis::z,
             UpAxis to_up = UpAxis::z) {
  const ReadOptions how{.metadata = {}, .pitch = {}, .up = from_up};
  WritePlan plan = plan_of(*open_recording(from, how), from);
  plan.up = to_up;
  const auto reader = open_recording(from, how);
  replay(*reader, *create_recording(to, of_points(format), plan));
}

using Location = std::pair<std::int64_t, std::string>;
std::map<Location, Sample> by_label(const Read& read) {
  std::map<TrackId, std::string> labels;
  for (const TrackName& track : read.info.tracks) labels[track.id] = track.label;
  std::map<Location, Sample> points;
  for (const Instant& frame : read.frames) {
    for (const Sample& point : frame.samples) points[{frame.index, labels[point.track]}] = point;
  }
  return points;
}

/// The same markers at the same places, to `tolerance_m`.
void expect_same(const Read& a, const Read& b, double tolerance_m) {
  const auto points = by_label(a), others = by_label(b);
  ASSERT_FALSE(points.empty());
  ASSERT_EQ(points.size(), others.size());
  for (const auto& [location, point] : points) {
    const auto found = others.find(location);
    ASSERT_NE(found, others.end()) << location.first << " " << location.second;
    ASSERT_LE((point.position - found->second.position).cwiseAbs().maxCoeff(), tolerance_m)
        << location.first << " " << location.second;
  }
}

class Motion : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
};

TEST_F(Motion, EveryFormatGivesBackWhatItWasGiven) {
  const std::string take = folder_ / "walk.marey";
  take::write_recording(take, walk());
  const Read truth = read_all(take);
  const std::pair<const char*, const char*> formats[] = {
      {"c3d", "walk.c3d"}, {"trc", "walk.trc"}, {"csv", "walk.csv"}, {"motive", "walk_motive.csv"}, {"take", "copy.marey"}};
  for (const auto& [format, name] : formats) {
    SCOPED_TRACE(name);
    const std::string path = folder_ / name;
    convert(take, path, format);
    ASSERT_EQ(format_of_content(path)->name, format);
    const Read read = read_all(path);
    EXPECT_TRUE(read.warnings.empty()) << read.warnings.front();
    EXPECT_DOUBLE_EQ(read.info.header.rate_hz, 120);
    ASSERT_EQ(read.info.tracks.size(), 5U);
    EXPECT_EQ(read.info.tracks[1].label, "marker, \"2\"");
    expect_same(truth, read, 1e-9);
    EXPECT_EQ(read.frames.front().index, 3);
    EXPECT_EQ(read.frames.back().index, 42);
    EXPECT_NEAR(seconds(read.frames.front().time), 3.0 / 120, 1e-6);
    // And on from there, with the other axis up.
    const std::string rotated = folder_ / (std::string("turned_") + name), back = folder_ / "back.csv";
    if (std::string_view(format) == "take") continue;
    convert(path, rotated, format, UpAxis::z, UpAxis::y);
    const auto first = read_all(rotated).frames.front().samples.front().position;
    const auto plain = read.frames.front().samples.front().position;
    EXPECT_NEAR(first.y(), plain.z(), 1e-9) << "what was up is y now";
    EXPECT_NEAR(first.z(), -plain.y(), 1e-9);
    convert(rotated, back, "csv", UpAxis::y, UpAxis::z);
    expect_same(truth, read_all(back), 1e-9);
  }
}

/// A live take begins at any time and lacks the instants that its computer had no time for.
TEST_F(Motion, TimesOfInstantsThatAreMissingLieBetweenTheirNeighbours) {
  Recording recording(walk(1, 0).header);
  recording.set_name({TrackId(1), "A", {}});
  for (const auto& [index, time] : {std::pair(0, 5.0), std::pair(3, 5.027), std::pair(4, 5.034), std::pair(8, 5.067)}) {
    Sample sample;
    sample.track = TrackId(1);
    sample.provenance = Provenance::measured;
    Instant instant;
    instant.index = index;
    instant.time = timestamp_from_seconds(time);
    instant.samples = {sample};
    recording.add(instant);
  }
  const std::string take = folder_ / "live.marey";
  take::write_recording(take, recording);
  for (const auto& [format, name] : {std::pair("trc", "live.trc"), std::pair("motive", "live_motive.csv")}) {
    SCOPED_TRACE(name);
    convert(take, folder_ / name, format);
    const Read read = read_all(folder_ / name);
    ASSERT_EQ(read.frames.size(), 9U);
    const double required[] = {5, 5.009, 5.018, 5.027, 5.034, 5.04225, 5.0505, 5.05875, 5.067};
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(seconds(read.frames[i].time), required[i], 1e-6) << i;
  }
}

TEST_F(Motion, C3dKeepsResidualsCamerasAndWhatWasFilled) {
  const std::string take = folder_ / "walk.marey", path = folder_ / "walk.c3d";
  take::write_recording(take, walk());
  convert(take, path, "c3d");
  const auto truth = by_label(read_all(take)), read = by_label(read_all(path));
  for (const auto& [location, point] : truth) {
    const Sample& found = read.at(location);
    EXPECT_EQ(found.provenance, point.provenance);
    EXPECT_EQ(found.cameras, point.cameras);
    ASSERT_EQ(found.residual_m.has_value(), point.residual_m.has_value());
    EXPECT_NEAR(found.residual_m.value_or(0), point.residual_m.value_or(0), 0.00003);
  }
}

TEST_F(Motion, C3dHoldsMoreThan255Markers) {
  const std::string take = folder_ / "many.marey", path = folder_ / "many.c3d";
  take::write_recording(take, walk(600, 5));
  convert(take, path, "c3d");
  const Read read = read_all(path);
  ASSERT_EQ(read.info.tracks.size(), 600U);
  EXPECT_EQ(read.info.tracks[599].label, "marker, \"600\"");
  expect_same(read_all(take), read, 1e-9);
}

TEST_F(Motion, C3dHoldsMoreThan65535Frames) {
  const std::string take = folder_ / "long.marey", path = folder_ / "long.c3d";
  for (const int first : {0, 70'000}) {
    take::write_recording(take, walk(1, 70'001, first));
    convert(take, path, "c3d");
    const Read read = read_all(path);
    EXPECT_EQ(read.frames.size(), 70'001U);
    EXPECT_EQ(read.frames.front().index, first);
    expect_same(read_all(take), read, 1e-9);
  }
}

TEST_F(Motion, C3dThatIsCutOffIsReadAsFarAsItGoes) {
  const std::string take = folder_ / "walk.marey", path = folder_ / "walk.c3d";
  take::write_recording(take, walk());
  convert(take, path, "c3d");
  const std::string whole = test::read_file(path);
  const Read all = read_all(path);
  for (const double fraction : {0.0, 0.01, 0.2, 0.5, 0.99}) {
    test::write_file(path, whole);
    test::cut_file(path, fraction);
    std::size_t frames = 0;
    const std::string error = error_of([&] {
      const Read read = read_all(path);
      frames = read.frames.size();
      ASSERT_LE(frames, all.frames.size());
      for (std::size_t i = 0; i < frames; ++i) EXPECT_EQ(read.frames[i].samples.size(), all.frames[i].samples.size());
      EXPECT_EQ(read.warnings.size(), frames < all.frames.size() ? 1U : 0U);
    });
    EXPECT_TRUE(fraction < 0.9 || frames >= 38) << frames;
    EXPECT_TRUE(fraction > 0.3 || error != "no error") << fraction;
  }
}

TEST_F(Motion, EmptyTakesCanBeWritten) {
  const std::string take = folder_ / "empty.marey";
  Recording empty;
  empty.header.rate_hz = 50;
  take::write_recording(take, empty);
  for (const char* name : {"empty.c3d", "empty.trc", "empty.csv"}) {
    const std::string path = folder_ / name;
    convert(take, path, format_of_name(name, Content::space)->name.data());
    EXPECT_TRUE(read_all(path).frames.empty()) << name;
  }
}

TEST_F(Motion, FinishedRecordingsAreWrittenAsTheyAre) {
  const Recording recording = walk();
  take::write_recording(folder_ / "walk.marey", recording);
  for (const char* format : {"c3d", "trc", "csv", "motive"}) {
    convert(folder_ / "walk.marey", folder_ / "converted", format);
    write_motion(folder_ / "written", format, recording);
    if (std::string_view(format) == "trc") continue;  // says its own name
    EXPECT_EQ(test::read_file(folder_ / "written"), test::read_file(folder_ / "converted")) << format;
  }
}

TEST_F(Motion, TidyCsvIsWrittenWhileRecording) {
  EXPECT_TRUE(of_points("csv").while_recording);
  EXPECT_FALSE(of_points("c3d").while_recording);
  const Recording recording = walk();
  const auto sink = create_recording(folder_ / "live.csv", of_points("csv"));
  sink->begin(recording.header);
  InstantsOf instants(recording);
  while (const auto instant = instants.next()) sink->write(*instant);
  sink->finish();
  write_motion(folder_ / "whole.csv", "csv", recording);
  EXPECT_EQ(test::read_file(folder_ / "live.csv"), test::read_file(folder_ / "whole.csv"));
}

TEST_F(Motion, RejectsNonSpatialRecording) {
  Recording recording = walk();
  recording.header.frame.kind = FrameOfReference::Kind::ground;
  for (const char* format : {"c3d", "trc", "csv", "motive"}) {
    const std::string path = folder_ / "ground";
    EXPECT_NE(error_of([&] { write_motion(path, format, recording); }).find("points in space"), std::string::npos);
    EXPECT_FALSE(fs::exists(path));
  }
}

TEST_F(Motion, TakesAreNeverTurned) {
  Recording recording(walk().header);
  Instant instant;
  Sample& sample = instant.samples.emplace_back();
  sample.track = TrackId{1};
  sample.position = {1, 2, 3};
  recording.add(instant);
  const auto take = folder_ / "walk.marey", csv = folder_ / "walk.csv";
  write_motion(take, "take", recording, UpAxis::y);
  EXPECT_EQ(take::read_recording(take).tracks().at(0).position(0), Vector<3>(1, 2, 3)) << "a take is never turned";
  write_motion(csv, "csv", recording, UpAxis::y);
  EXPECT_EQ(read_all(csv).frames.at(0).samples.at(0).position, Vector<3>(1, 3, -2));
  EXPECT_EQ(read_all(csv, UpAxis::y).frames.at(0).samples.at(0).position, Vector<3>(1, 2, 3));
}

TEST_F(Motion, TheAxisThatAC3dFileSaysIsUpIsTakenForUp) {
  const std::string z_up = folder_ / "z.c3d", y_up = folder_ / "y.c3d";
  write_motion(z_up, "c3d", walk(), UpAxis::z);
  write_motion(y_up, "c3d", walk(), UpAxis::y);
  const Read truth = read_all(*open_recording(z_up)), read = read_all(*open_recording(y_up));
  EXPECT_TRUE(truth.warnings.empty());
  expect_same(truth, read, 1e-9);
  ASSERT_EQ(read.warnings.size(), 1U);
  EXPECT_NE(read.warnings.front().find("its y is taken for up, as the file says; if z is up in it, say --up z"), std::string::npos);
  // Who says otherwise is trusted.
  const Read as_it_stands = read_all(y_up, UpAxis::z), reported = read_all(y_up, UpAxis::y);
  EXPECT_TRUE(as_it_stands.warnings.empty() && reported.warnings.empty());
  expect_same(truth, reported, 1e-9);
  const auto up = truth.frames.front().samples.front().position.z();
  EXPECT_NEAR(as_it_stands.frames.front().samples.front().position.y(), up, 1e-9);
}

TEST_F(Motion, GapsOfMillionsOfFramesAreAMistake) {
  const std::string path = folder_ / "slip.csv";
  test::write_file(path, "frame,time,id,label,x,y,z\n0,0,1,a,1,2,3\n400000000,1,1,a,1,2,3\n");
  EXPECT_NE(error_of([&] { plan_of(*open_recording(path), path); }).find("a number must be wrong"), std::string::npos);
}

// ----- text

TEST(Trc, ReadsWhatProgramsWrite) {
  const std::string text =
      "PathFileType\t4\t(X/Y/"
      "Z)\ta.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n"
      "50\t50\t3\t2\tm\t50\t1\t3\nFrame#\tTime\tA\t\t\tB\t\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n1\t0\t1\t2\t3\t\t\t\n2\t0."
      "02\t1\t2\t3\t4\t5\t6\r\n3\t0.04\tNaN\tNan\t-nan";
  const Read read = read_all(*read_trc(text + "\t7\t8\t9", "a.trc"));
  EXPECT_TRUE(read.warnings.empty());
  ASSERT_EQ(read.frames.size(), 3U);
  ASSERT_EQ(read.frames[0].samples.size(), 1U);
  EXPECT_EQ(read.frames[0].samples[0].position, Vector<3>(1, 2, 3));
  ASSERT_EQ(read.frames[2].samples.size(), 1U);
  EXPECT_EQ(read.frames[2].samples[0].track, TrackId(2));
  EXPECT_NEAR(seconds(read.frames[1].time), 0.02, 1e-12);
  EXPECT_NE(error_of([&] { read_all(*read_trc(text, "a.trc")); }).find("a.trc:9: ends within its row"), std::string::npos);
}

TEST(Trc, SaysWhatIsWrongAndWhere) {
  const std::string head = "PathFileType,4,(X/Y/Z),a\nDataRate,NumFrames,NumMarkers,Units\n";
  const std::string names = "Frame#,Time,A,,\n,,X1,Y1,Z1\n";
  EXPECT_NE(error_of([&] { read_trc("hello", "a"); }).find("a:1: begins not with PathFileType"), std::string::npos);
  EXPECT_NE(error_of([&] { read_trc(head, "a"); }).find("cut off"), std::string::npos);
  EXPECT_NE(error_of([&] { read_trc(head + "0,1,1,mm\n" + names, "a"); }).find("a:3: DataRate is \"0\""), std::string::npos);
  const auto rows = [&](const std::string& text) {
    return error_of([&] { read_all(*read_trc(head + "10,1,1,mm\n" + names + text, "a")); });
  };
  EXPECT_NE(rows("1,0,1,x,3\n").find("a:6: \"x\" in column 4 is no number"), std::string::npos);
  EXPECT_NE(rows("1,0,1,,3\n").find("2 of its 3 coordinates"), std::string::npos);
  EXPECT_NE(rows("2,0,1,2,3\n2,0,1,2,3\n").find("must come in order"), std::string::npos);
  EXPECT_NE(rows("one,0,1,2,3\n").find("no number of a frame"), std::string::npos);
}

TEST(TidyCsv, TakesRowsInAnyOrderAndColumnsInAnyOrder) {
  const Read read = read_all(*read_tidy_csv("label,z,y,x,frame,note\nb,3,2,1,1,?\na,3,2,1,0,?\nb,6,5,4,0,\"x, y\"\n", "t"));
  ASSERT_EQ(read.frames.size(), 2U);
  EXPECT_EQ(read.frames[0].samples.size(), 2U);
  EXPECT_EQ(read.frames[1].samples[0].position, Vector<3>(1, 2, 3));
  ASSERT_EQ(read.info.tracks.size(), 2U);
}

TEST(TidyCsv, SaysWhatIsWrongAndWhere) {
  const auto stated = [](const std::string& text) { return error_of([&] { read_all(*read_tidy_csv(text, "t")); }); };
  EXPECT_NE(stated("frame,id,x,y\n").find("t:1: has no column \"z\""), std::string::npos);
  EXPECT_NE(stated("frame,x,y,z\n").find("neither a column \"id\" nor \"label\""), std::string::npos);
  EXPECT_NE(stated("frame,id,x,y,z\n0,1,1,2,oops\n").find("t:2: z is \"oops\""), std::string::npos);
  EXPECT_NE(stated("frame,id,x,y,z\n0,1,1,2,3\n0,1,1,2,3\n").find("stands twice in frame 0"), std::string::npos);
  EXPECT_NE(stated("frame,id,x,y,z\n0,1,1,2,3\n1,1,2").find("it is cut off"), std::string::npos);
}

TEST(MotiveCsv, PassesOverBodiesAndRotations) {
  const Read read = read_all(*read_motive_csv(
      "Format Version,1.23,Take Name,t,Export Frame Rate,100.0,Total Exported Frames,2,Length Units,Millimeters\n\n"
      ",Type,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Marker,Marker,Marker\n"
      ",Name,B,B,B,B,B,B,B,\"a\",a,a\n,ID,1,1,1,1,1,1,1,2,2,2\n"
      ",,Rotation,Rotation,Rotation,Rotation,Position,Position,Position,Position,Position,Position\n"
      "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,X,Y,Z\n0,0,1,2,3,4,5,6,7,1000,2000,3000\n1,0.01,1,2,3,4,5,6,7,,,\n",
      "m"));
  ASSERT_EQ(read.info.tracks.size(), 1U);
  EXPECT_EQ(read.info.tracks[0].label, "a");
  ASSERT_EQ(read.frames.size(), 2U);
  EXPECT_EQ(read.frames[0].samples[0].position, Vector<3>(1, 2, 3));
  EXPECT_TRUE(read.frames[1].samples.empty());
}

// ----- files of other systems

Read mocap_file(const std::string& name) {
  return read_all(test::data("mocap_files/" + name));
}

#define REQUIRE_MOCAP_FILES() \
  if (!fs::exists(test::data("mocap_files"))) GTEST_SKIP() << test::data("mocap_files") << " is not here"

TEST(MocapFiles, EveryProcessorsTwinsAreEqual) {
  REQUIRE_MOCAP_FILES();
  const std::string folder = "kineticstoolkit/c3d_test_suite/Sample02/";
  const Read real = mocap_file(folder + "pc_real.c3d");
  EXPECT_EQ(real.frames.size(), 89U);
  EXPECT_EQ(real.info.tracks.size(), 36U);
  EXPECT_EQ(real.info.tracks[0].label, "RFT1");
  expect_same(real, mocap_file(folder + "dec_real.c3d"), 0);
  expect_same(real, mocap_file(folder + "sgi_real.c3d"), 0);
  for (const char* name : {"pc_int.c3d", "dec_int.c3d", "sgi_int.c3d"}) expect_same(real, mocap_file(folder + name), 0.00028119);
}

TEST(MocapFiles, RejectsNonFinitePosition) {
  const std::string path = test::data("gait_children/HC002D/straight_HC002D06.c3d");
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not here";
  const Read read = read_all(path);
  const auto has = [&](std::string_view label) {
    return std::any_of(read.info.tracks.begin(), read.info.tracks.end(),
                       [&](const TrackName& track) { return track.label == label; });
  };
  EXPECT_TRUE(has("LKNE"));
  for (const char* other : {"LKneeAngles", "LKneeForce", "LKneeMoment", "LKneePower"}) EXPECT_FALSE(has(other)) << other;
  ASSERT_EQ(read.warnings.size(), 1U);
  EXPECT_NE(read.warnings[0].find("51 angles, 20 forces, 18 moments, 16 powers, 2 scalars stand among its points"),
            std::string::npos);
  EXPECT_EQ(read.info.auxiliary.channels, 24);
  EXPECT_EQ(read.info.auxiliary.events, 12);
}

TEST(MocapFiles, HeadersAtOddPlacesReadTheSame) {
  REQUIRE_MOCAP_FILES();
  const std::string folder = "kineticstoolkit/c3d_test_suite/";
  const Read plain = mocap_file(folder + "Sample01/Eb015pi.c3d");
  for (const char* name : {"Sample01/Eb015vi.c3d", "Sample08/EB015PI.c3d", "Sample08/TESTAPI.c3d", "Sample08/TESTBPI.c3d",
                           "Sample08/TESTCPI.c3d", "Sample08/TESTDPI.c3d"}) {
    expect_same(plain, mocap_file(folder + name), 0);
  }
  for (const char* name : {"Sample01/Eb015pr.c3d", "Sample01/Eb015vr.c3d"})
    expect_same(plain, mocap_file(folder + name), 0.0000834);
}

TEST(MocapFiles, TheRestReadsAsItsMakersWroteIt) {
  REQUIRE_MOCAP_FILES();
  const std::tuple<const char*, std::size_t, std::size_t, double> files[] = {
      {"auto_marker_label/data/S09_KneeltoRun02.c3d", 1479, 75, 240},
      {"kineticstoolkit/c3d_test_suite/ezc3d/BTS.c3d", 675, 22, 100},
      {"kineticstoolkit/c3d_test_suite/ezc3d/Qualisys.c3d", 340, 55, 200},
      {"kineticstoolkit/kinematics_racing_static.c3d", 700, 41, 69.9},
      {"kineticstoolkit/kinematics_tennis_serve.c3d", 1092, 39, 50},
      {"pyomeca/markers.trc", 93, 51, 100}};
  for (const auto& [name, frames, tracks, rate] : files) {
    const Read read = mocap_file(name);
    EXPECT_EQ(read.frames.size(), frames) << name;
    EXPECT_EQ(read.info.tracks.size(), tracks) << name;
    EXPECT_NEAR(read.info.header.rate_hz, rate, 1e-5) << name;
  }
  // The C3D with its CSV twin, which has six digits.
  expect_same(mocap_file("pyomeca/markers_analogs.c3d"), mocap_file("pyomeca/markers.csv"), 0.000006);
}

}  // namespace
}  // namespace marey::format::motion
