// What a C3D file holds beside its points: analog channels, force plates, events, angles, and matrices of bodies.
#include "marey/format/motion/c3d_auxiliary.h"

#include <filesystem>
#include <fstream>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/motion/c3d.h"
#include "marey/format/motion/c3d_section.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::format::motion {
namespace {

namespace fs = std::filesystem;

constexpr int kChannels = 3, kSamples = 4, kFrames = 10, kFirst = 123;  // the file counts frames from 1

/// What stands in the file for this sample of a channel; the channel counts from −100, a step is 0.5 V.
int raw_value(int frame, int sample, int channel) {
  return 100 * frame + 10 * sample + channel;
}

struct AnalogFile {
  bool real = true, is_unsigned = false;
  std::int64_t used = kChannels;
};

/// One point and three channels, in m with y up, from frame 124 on.
void write_analog(const std::string& path, const AnalogFile& how) {
  const double scale = how.real ? -0.001 : 0.001;
  const auto parameters = [&](std::int64_t block) {
    C3dSection section;
    section.group("POINT");
    section.word("USED", 1);
    section.real("SCALE", scale);
    section.real("RATE", 50);
    section.word("DATA_START", block);
    section.text("UNITS", "m");
    section.texts("LABELS", std::array<std::string, 1>{"A"});
    section.group("ANALOG");
    section.word("USED", how.used);
    section.real("GEN_SCALE", 0.5);
    section.real("RATE", 50 * kSamples);
    section.words("OFFSET", how.is_unsigned ? std::array<std::int64_t, 3>{-32768, -32768, -32768}
                                            : std::array<std::int64_t, 3>{-100, -100, -100});
    section.text("FORMAT", how.is_unsigned ? "UNSIGNED" : "SIGNED");
    section.texts("UNITS", std::array<std::string, 3>{"N", "Nmm", "V"});
    section.group("FORCE_PLATFORM");
    section.word("USED", 1);
    section.reals("CORNERS", std::array<double, 12>{0, 0, 0, 0.5, 0, 0, 0.5, 0, -0.25, 0, 0, -0.25}, {3, 4, 1});
    section.reals("ORIGIN", std::array<double, 3>{0, 0, -0.0625}, {3, 1});
    section.group("EVENT");
    section.word("USED", 1);
    section.texts("LABELS", std::array<std::string, 1>{"Foot Strike"});
    section.reals("TIMES", std::array<double, 2>{0, 2.5}, {2, 1});
    return section.blocks(path);
  };
  const auto block = static_cast<std::int64_t>(2 + parameters(2).size() / kC3dBlock);
  std::string bytes("\x02\x50", 2);
  for (const int word : {1, kChannels * kSamples, kFirst + 1, kFirst + kFrames, 0}) put_word(bytes, word);
  put_real(bytes, scale);
  put_word(bytes, block);
  put_word(bytes, kSamples);
  put_real(bytes, 50);
  bytes.resize(kC3dBlock, '\0');
  bytes += parameters(block);
  const auto put = [&](double value) { how.real ? put_real(bytes, value) : put_word(bytes, static_cast<std::int64_t>(value)); };
  for (int frame = 0; frame < kFrames; ++frame) {
    for (const double value : {0.25 * (how.real ? 1 : 1000), 1.0 * (how.real ? 1 : 1000), 0.5 * (how.real ? 1 : 1000), 0.0})
      put(value);
    for (int sample = 0; sample < kSamples; ++sample) {
      for (int channel = 0; channel < kChannels; ++channel)
        put(raw_value(frame, sample, channel) + (how.is_unsigned ? 32768 : -100));
    }
  }
  std::ofstream(path, std::ios::binary) << bytes;
}

/// From C3D to C3D, frames `first` to `last` alone.
void copy_part(const std::string& from, const std::string& to, std::int64_t first, std::int64_t last, UpAxis from_up,
               UpAxis to_up) {
  const Format& c3d = *format_named("c3d", Content::space);
  ReadOptions how;
  how.up = from_up;
  const auto reader = open_recording(from, c3d, how);
  WritePlan plan = plan_of(*open_recording(from, c3d, how), from);
  plan.first_frame = first;
  plan.last_frame = last;
  plan.up = to_up;
  const auto sink = create_recording(to, c3d, plan);
  sink->begin(plan.info.header);
  while (const auto instant = reader->next()) {
    if (instant->index >= first && instant->index <= last) sink->write(*instant);
  }
  sink->finish();
}

/// V of a channel, as the C3D user guide has it.
double volts(C3dAuxiliary& file, std::int64_t index, int sample, int channel) {
  const double raw = file.frame(index)[static_cast<std::size_t>(kChannels * sample + channel)];
  double offset = 0;
  for (const C3dParameter& parameter : file.group("ANALOG", UpAxis::z)) {
    if (parameter.name == "OFFSET") offset = parameter.numbers.at(static_cast<std::size_t>(channel));
  }
  return (raw - offset) * 0.5;
}

std::vector<double> numbers_of(C3dAuxiliary& file, const char* group, const char* name) {
  for (const C3dParameter& parameter : file.group(group, UpAxis::z)) {
    if (parameter.name == name) return parameter.numbers;
  }
  return {};
}

class C3dAuxiliaryTest : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
};

TEST_F(C3dAuxiliaryTest, AnalogChannelsGoAlongFrameByFrame) {
  for (const AnalogFile& how : {AnalogFile{}, AnalogFile{.real = false}, AnalogFile{.real = false, .is_unsigned = true}}) {
    write_analog(folder_ / "a.c3d", how);
    copy_part(folder_ / "a.c3d", folder_ / "b.c3d", kFirst + 2, kFirst + 6, UpAxis::z, UpAxis::z);
    const auto written = open_c3d(folder_ / "b.c3d");
    EXPECT_EQ(written->info().frame_count, 5);
    EXPECT_EQ(written->info().auxiliary.channels, kChannels);
    EXPECT_EQ(written->info().auxiliary.events, 1);
    const auto instant = written->next();
    EXPECT_EQ(instant->index, kFirst + 2);
    EXPECT_LT((instant->samples.at(0).position - Vector<3>(0.25, 1, 0.5)).norm(), 1e-6);
    C3dAuxiliary file({.path = folder_ / "b.c3d"});
    ASSERT_EQ(file.channels(), 3U);
    ASSERT_EQ(file.samples(), 4U);
    for (int frame = 2; frame <= 6; ++frame) {
      for (int sample = 0; sample < kSamples; ++sample) {
        for (int channel = 0; channel < kChannels; ++channel)
          EXPECT_DOUBLE_EQ(volts(file, kFirst + frame, sample, channel), 0.5 * raw_value(frame, sample, channel));
      }
    }
    EXPECT_DOUBLE_EQ(volts(file, kFirst, 0, 0), 0) << "a frame that is not in it";
    EXPECT_EQ(numbers_of(file, "ANALOG", "RATE"), std::vector<double>{200});
    EXPECT_EQ(numbers_of(file, "EVENT", "TIMES"), (std::vector<double>{0, 2.5})) << "they count from frame 1, whatever is cut off";
  }
}

TEST_F(C3dAuxiliaryTest, PlatesFollowTheUnitAndTheAxes) {
  write_analog(folder_ / "a.c3d", {});
  copy_part(folder_ / "a.c3d", folder_ / "same.c3d", kFirst, kFirst + 9, UpAxis::y, UpAxis::y);
  C3dAuxiliary same({.path = folder_ / "same.c3d"});
  EXPECT_EQ(numbers_of(same, "FORCE_PLATFORM", "ORIGIN"), (std::vector<double>{0, 0, -62.5}));
  EXPECT_EQ(numbers_of(same, "FORCE_PLATFORM", "CORNERS"), (std::vector<double>{0, 0, 0, 500, 0, 0, 500, 0, -250, 0, 0, -250}));
  copy_part(folder_ / "a.c3d", folder_ / "turned.c3d", kFirst, kFirst + 9, UpAxis::y, UpAxis::z);
  C3dAuxiliary rotated({.path = folder_ / "turned.c3d"});
  EXPECT_EQ(numbers_of(rotated, "FORCE_PLATFORM", "CORNERS"), (std::vector<double>{0, 0, 0, 500, 0, 0, 500, 250, 0, 0, 250, 0}));
  copy_part(folder_ / "turned.c3d", folder_ / "back.c3d", kFirst, kFirst + 9, UpAxis::z, UpAxis::y);
  C3dAuxiliary back({.path = folder_ / "back.c3d"});
  EXPECT_EQ(numbers_of(back, "FORCE_PLATFORM", "CORNERS"), numbers_of(same, "FORCE_PLATFORM", "CORNERS"));
}

TEST_F(C3dAuxiliaryTest, ChannelsThatDoNotFitAreLeftOut) {
  write_analog(folder_ / "a.c3d", {.used = 7});  // but for the first block, which says 4 samples of 3 channels
  EXPECT_EQ(open_c3d(folder_ / "a.c3d")->info().auxiliary.channels, kChannels);
  std::string bytes = test::read_file(folder_ / "a.c3d");
  bytes[18] = 5;  // samples of a frame
  test::write_file(folder_ / "a.c3d", bytes);
  const auto reader = open_c3d(folder_ / "a.c3d");
  EXPECT_EQ(reader->info().auxiliary.channels, 0);
  EXPECT_EQ(reader->info().frame_count, kFrames);
  EXPECT_NE(reader->warnings().back().find("it names 7 analog channels, and has 12 values"), std::string::npos);
}

TEST_F(C3dAuxiliaryTest, ChannelsOfAnotherRateAreRefused) {
  write_analog(folder_ / "a.c3d", {});
  WritePlan plan = plan_of(*open_c3d(folder_ / "a.c3d"), "a.c3d");
  plan.info.header.rate_hz = 60;
  const auto sink = create_c3d(folder_ / "b.c3d", plan);
  EXPECT_THROW(sink->begin(plan.info.header), Error);
  EXPECT_FALSE(fs::exists(folder_ / "b.c3d"));
}

TEST_F(C3dAuxiliaryTest, OtherFormatsSayWhatTheyLeaveOut) {
  write_analog(folder_ / "a.c3d", {});
  const auto info = open_c3d(folder_ / "a.c3d")->info();
  EXPECT_EQ(auxiliary_lost(info.auxiliary, "b.c3d", *format_named("c3d", Content::space)), std::nullopt);
  EXPECT_NE(auxiliary_lost(info.auxiliary, "b.trc", *format_named("trc", Content::space))
                ->find("3 analog channels (forces, EMG) and 1 events"),
            std::string::npos);
}

/// Two bodies; the second one is missing in every third frame.
Recording bodies_that_turn() {
  RecordingHeader header;
  header.rate_hz = 50;
  for (const int id : {1, 2}) {
    Body body;
    body.id = BodyId(id);
    body.label = id == 1 ? "pelvis" : "racket";
    header.bodies.push_back(body);
  }
  Recording recording(header);
  recording.set_name({TrackId(1), "A", {}});
  for (int i = 0; i < 20; ++i) {
    Instant instant;
    instant.index = 7 + i;
    instant.time = timestamp_from_seconds(instant.index / 50.0);
    Sample sample;
    sample.track = TrackId(1);
    sample.position = {1, 0.5, 0.25 * i};
    instant.samples.push_back(sample);
    for (const int id : {1, 2}) {
      if (id == 2 && i % 3 == 0) continue;
      BodyPose pose;
      pose.body = BodyId(id);
      pose.world_from_body.rotation = Eigen::AngleAxisd(0.3 * i + id, Vector<3>(1, 2, 3).normalized()).toRotationMatrix();
      pose.world_from_body.translation = {0.1 * i, -0.5 * id, 1};
      instant.bodies.push_back(pose);
    }
    recording.add(instant);
  }
  return recording;
}

TEST_F(C3dAuxiliaryTest, BodiesGoThroughRotations) {
  match::GroundMatch whole;
  whole.recording = bodies_that_turn();
  for (const UpAxis up : {UpAxis::z, UpAxis::y}) {
    write_whole(folder_ / "a.c3d", *format_named("c3d", Content::space), whole, up);
    ReadOptions how;
    how.up = up;
    const auto reader = open_recording(folder_ / "a.c3d", how);
    ASSERT_EQ(reader->header().bodies.size(), 2U);
    EXPECT_EQ(reader->header().bodies[1].label, "racket");
    InstantsOf truth(whole.recording);
    int poses = 0;
    while (const auto required = truth.next()) {
      const auto found = reader->next();
      ASSERT_TRUE(found);
      EXPECT_EQ(found->index, required->index);
      ASSERT_EQ(found->bodies.size(), required->bodies.size());
      for (std::size_t i = 0; i < found->bodies.size(); ++i) {
        const Rigid3 &a = found->bodies[i].world_from_body, &b = required->bodies[i].world_from_body;
        EXPECT_EQ(found->bodies[i].body, required->bodies[i].body);
        EXPECT_LT((a.rotation - b.rotation).norm(), 1e-6);
        EXPECT_LT((a.translation - b.translation).norm(), 1e-6);
        ++poses;
      }
    }
    EXPECT_FALSE(reader->next());
    EXPECT_EQ(poses, 33);
  }
}

TEST_F(C3dAuxiliaryTest, MatricesThatAreCutOffAreReadAsFarAsTheyGo) {
  match::GroundMatch whole;
  whole.recording = bodies_that_turn();
  write_whole(folder_ / "a.c3d", *format_named("c3d", Content::space), whole);
  std::string bytes = test::read_file(folder_ / "a.c3d");
  test::write_file(folder_ / "b.c3d", bytes.substr(0, bytes.size() - 4));
  const auto short_by_one = open_c3d(folder_ / "b.c3d");
  EXPECT_EQ(short_by_one->info().frame_count, *open_c3d(folder_ / "a.c3d")->info().frame_count - 1);
  EXPECT_NE(short_by_one->warnings().back().find("is cut off"), std::string::npos);
  // Nothing but the points: their places are reported, and that there are no bodies.
  test::write_file(folder_ / "c.c3d", bytes.substr(0, bytes.size() - 20 * 2 * 17 * 4));
  const auto reader = open_c3d(folder_ / "c.c3d");
  EXPECT_TRUE(reader->header().bodies.empty());
  EXPECT_NE(reader->warnings().back().find("where the matrices of its bodies begin there is nothing"), std::string::npos);
  EXPECT_TRUE(reader->next());
}

TEST_F(C3dAuxiliaryTest, AnglesAndEventsStandWhereC3dHasThem) {
  write_analog(folder_ / "a.c3d", {});
  WritePlan plan = plan_of(*open_c3d(folder_ / "a.c3d"), "a.c3d");
  plan.found.emplace();
  for (int i = 0; i < 300; ++i)
    plan.found->events.push_back({i % 2 == 0 ? "Left" : "Right", i < 5 ? "Foot Off" : "Foot Strike", 0.5 * i});
  AngleTriple triple{.label = "LKneeAngles", .description = "flexion, adduction, rotation", .rows = {}};
  for (int row = 0; row < kFrames; ++row)
    triple.rows.push_back(row == 4 ? std::optional<Vector<3>>() : Vector<3>(60.0 + row, -2.5, 190));
  plan.found->angles.push_back(triple);
  replay(*open_c3d(folder_ / "a.c3d"), *create_c3d(folder_ / "b.c3d", plan));

  const MappedFile file(folder_ / "b.c3d");
  const C3dHead head = read_c3d_head(file.bytes(), "b.c3d");
  EXPECT_EQ(head.texts("POINT:ANGLES"), std::vector<std::string>{"LKneeAngles"});
  EXPECT_EQ(head.text("POINT:ANGLE_UNITS"), "deg");
  EXPECT_EQ(head.texts("POINT:DESCRIPTIONS").at(1), "flexion, adduction, rotation");
  EXPECT_EQ(head.number("EVENT:USED"), 300);
  EXPECT_EQ(head.texts("EVENT:CONTEXTS").size(), 300U);
  EXPECT_EQ(head.texts("EVENT:LABELS").at(5), "Foot Strike");
  const std::vector<double> times = head.numbers("EVENT:TIMES");
  ASSERT_EQ(times.size(), 600U);
  EXPECT_EQ(times[2 * 141], 1);
  EXPECT_EQ(times[2 * 141 + 1], 10.5);
  EXPECT_EQ(head.parameters.find("EVENT:TIMES")->second.dimensions, (std::vector<std::size_t>{2, 255}));
  EXPECT_EQ(head.parameters.find("EVENT:TIMES2")->second.dimensions, (std::vector<std::size_t>{2, 45}));

  const auto points = open_c3d(folder_ / "b.c3d", C3dPoints::all);
  for (int row = 0; const auto instant = points->next(); ++row) {
    ASSERT_EQ(instant->samples.size(), row == 4 ? 1U : 2U);
    if (row != 4) {
      EXPECT_LT((1000 * instant->samples[1].position - Vector<3>(60.0 + row, -2.5, 190)).norm(), 1e-5);
    }
  }
  EXPECT_EQ(open_c3d(folder_ / "b.c3d")->tracks().size(), 1U) << "angles are not places";
}

TEST(C3dKinds, OthersFilesKeepTheirChannelsAndBodies) {
  const std::string many = test::data("c3d_kinds/many_analogs.c3d"), bodies = test::data("c3d_kinds/C3DRotationExample.c3d");
  if (!fs::exists(many)) GTEST_SKIP() << many << " is not here";
  const test::TemporaryFolder folder;
  EXPECT_EQ(open_c3d(many)->info().auxiliary.channels, 922);
  const auto info = open_c3d(many)->info();
  const std::int64_t first = open_c3d(many)->next()->index;
  copy_part(many, folder / "b.c3d", first, first + *info.frame_count - 1, UpAxis::z, UpAxis::z);
  C3dAuxiliary before({.path = many}), after({.path = folder / "b.c3d"});
  ASSERT_EQ(after.channels(), before.channels());
  for (std::int64_t frame = first; frame < first + *info.frame_count; ++frame) {
    const auto a = before.frame(frame), b = after.frame(frame);
    ASSERT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end())) << frame;
  }
  const auto reader = open_c3d(bodies);
  EXPECT_EQ(reader->info().frame_count, 340);
  ASSERT_EQ(reader->header().bodies.size(), 21U);
  EXPECT_EQ(reader->header().bodies[1].label, "pelvis");
  EXPECT_EQ(reader->header().bodies[2].parent, reader->header().bodies[1].id) << "a thigh hangs on it";
  EXPECT_TRUE(reader->header().bodies[0].skeleton.empty()) << "worldbody is by itself";
  std::size_t poses = 0;
  while (const auto instant = reader->next()) poses += instant->bodies.size();
  EXPECT_EQ(poses, 340U * 21 - 78) << "78 are NaN in the file";
}

}  // namespace
}  // namespace marey::format::motion
