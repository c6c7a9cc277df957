#include "stored_recording.h"

#include <cstring>
#include <map>
#include <random>
#include <thread>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "command_tokens.h"
#include "scene.h"

namespace marey::viewer {
namespace {

RecordingHeader header_in(FrameOfReference::Kind kind) {
  RecordingHeader header;
  header.frame.kind = kind;
  header.rate_hz = 100;
  return header;
}

Sample stored_row(int track, const Vector<3>& position) {
  Sample row;
  row.track = TrackId{track};
  row.position = position;
  row.box = Box{1, 2, 3, 4};
  return row;
}

struct SlowCourse {
  std::vector<double> time;
  std::vector<float> x, y, z;
};

TEST(StoredRecording, CoursesAreWhatWasAdded) {
  std::random_device random;
  const unsigned seed = random();
  std::mt19937 dice(seed);
  for (const auto kind : {FrameOfReference::Kind::space, FrameOfReference::Kind::image}) {
    StoredRecording stored(header_in(kind), {});
    std::map<int, SlowCourse> slow;
    for (int index = 0; index < 700; ++index) {
      Instant instant;
      instant.index = index;
      instant.time = timestamp_from_seconds(index / 100.0);
      for (int track = 1; track <= 12; ++track) {
        if (dice() % 3 == 0 || (track == 5 && index < 300)) continue;
        const Vector<3> at(dice() % 1000, dice() % 1000, kind == FrameOfReference::Kind::space ? dice() % 1000 : 0);
        instant.samples.push_back(stored_row(track, at));
        SlowCourse& course = slow[track];
        course.time.push_back(index / 100.0);
        course.x.push_back(static_cast<float>(at.x()));
        course.y.push_back(static_cast<float>(at.y()));
        course.z.push_back(static_cast<float>(at.z()));
      }
      if (dice() % 10 == 0) instant.bodies.push_back({});
      stored.add(instant);
    }
    stored.finish({});
    for (const auto& [track, course] : slow) {
      const std::string bytes = stored.course(TrackId{track});
      const std::size_t n = course.time.size();
      const bool space = kind == FrameOfReference::Kind::space;
      ASSERT_EQ(bytes.size(), 40 + n * (space ? 21 : 17)) << "seed " << seed;
      EXPECT_EQ(std::memcmp(bytes.data() + 40, course.time.data(), 8 * n), 0) << "seed " << seed;
      EXPECT_EQ(std::memcmp(bytes.data() + 40 + 8 * n, course.x.data(), 4 * n), 0) << "seed " << seed;
      EXPECT_EQ(std::memcmp(bytes.data() + 40 + 12 * n, course.y.data(), 4 * n), 0) << "seed " << seed;
      if (space) {
        EXPECT_EQ(std::memcmp(bytes.data() + 40 + 16 * n, course.z.data(), 4 * n), 0) << "seed " << seed;
      }
    }
    EXPECT_EQ(stored.course(TrackId{99}).size(), 40U);
    EXPECT_EQ(stored.state().instants, 700);
    EXPECT_GT(stored.segment(0)->size(), 40U);
    EXPECT_EQ(stored.segment(1000), nullptr);
  }
}

TEST(StoredRecording, TracksThatArePutAreAsIfTheyHadBeenAddedSo) {
  std::mt19937 dice(5);
  for (const auto kind : {FrameOfReference::Kind::space, FrameOfReference::Kind::image}) {
    StoredRecording edited(header_in(kind), {}), fresh(header_in(kind), {});
    std::vector<TrackColumns> others;
    for (const int track : {2, 3, 7})
      others.emplace_back(TrackName{.id = TrackId{track}, .label = "other", .team = {}}, header_in(kind).frame.dimensions());
    for (int index = 0; index < 400; ++index) {
      Instant was;
      was.index = 2 * index;
      was.time = timestamp_from_seconds(index / 100.0);
      Instant now = was;
      for (int track = 1; track <= 7; ++track) {
        Sample row = stored_row(track, Vector<3>(dice() % 99, dice() % 99, 0));
        if (dice() % 2 == 0) row.box.reset();
        const bool before = track < 7 && dice() % 3 != 0;
        if (before) was.samples.push_back(row);
        const bool another = track == 2 || track == 7 || (track == 3 && index > 300);
        if (another) row.position.x() += 0.5;
        if (another ? dice() % 3 != 0 : before) now.samples.push_back(row);
      }
      edited.add(was);
      fresh.add(now);
      for (TrackColumns& track : others) {
        for (const Sample& row : now.samples) {
          if (row.track == track.id()) track.add(index, row);
        }
      }
    }
    edited.finish({});
    fresh.finish({});
    edited.put(others);
    for (std::size_t n = 0; n < 4; ++n) EXPECT_TRUE(*edited.segment(n) == *fresh.segment(n)) << n;
    for (std::size_t i = 0; i < 7; ++i) {
      const RecordingState::Course one = edited.state().tracks[i], other = fresh.state().tracks[i];
      EXPECT_EQ(std::tuple(one.rows, one.measured, one.first_s, one.last_s, one.first_instant, one.last_instant),
                std::tuple(other.rows, other.measured, other.first_s, other.last_s, other.first_instant, other.last_instant));
    }
    EXPECT_EQ(edited.state().segments[3].rows, fresh.state().segments[3].rows);
  }
}

TEST(StoredRecording, MayBeAskedWhileItGrows) {
  StoredRecording stored(header_in(FrameOfReference::Kind::space), {});
  std::jthread asks([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      const RecordingState state = stored.state();
      std::int64_t instants = 0;
      for (std::size_t i = 0; i < state.segments.size(); ++i) instants += state.segments[i].instants;
      EXPECT_EQ(instants, state.instants);
      stored.course(TrackId{1});
    }
  });
  for (int index = 0; index < 5000; ++index) {
    Instant instant;
    instant.index = index;
    instant.time = timestamp_from_seconds(index / 100.0);
    instant.samples.push_back(stored_row(1, {1, 2, 3}));
    stored.add(instant);
  }
  stored.finish({"one warning"});
  EXPECT_TRUE(stored.state().complete);
  EXPECT_EQ(stored.state().warnings.size(), 1U);
}

TEST(StoredRecording, AFewThatAreFarOffDoNotStretchTheScene) {
  StoredRecording stored(header_in(FrameOfReference::Kind::space), {});
  std::mt19937 dice(1);
  for (int index = 0; index < 3000; ++index) {
    Instant instant;
    instant.index = index;
    const double far = index % 1000 == 7 ? 500 : 1;
    instant.samples.push_back(stored_row(1, {far * (dice() % 100) / 100.0, 0, 1}));
    stored.add(instant);
  }
  EXPECT_LE(stored.state().extent->high.x(), 1);
  EXPECT_GE(stored.state().extent->high.x(), 0.9);
}

RecordingState state_between(const Vector<3>& low, const Vector<3>& high) {
  RecordingState state;
  state.extent = Extent{low, high};
  return state;
}

TEST(Scene, APitchIsDrawnWherePeopleMoveOnOne) {
  const RecordingHeader header = header_in(FrameOfReference::Kind::user_ground);
  const auto text = [&](const Vector<3>& low, const Vector<3>& high, const GroundChoice& choice) {
    return scene_text(header, state_between(low, high), choice, {});
  };
  EXPECT_NE(text({2, 3, 0}, {101, 66, 0}, {}).find(R"("pitch":{"length":105.0,"width":68.0,"x":0.0,"y":0.0})"), std::string::npos);
  EXPECT_NE(text({-50, -30, 0}, {50, 31, 0}, {}).find(R"("x":-52.5,"y":-34.0})"), std::string::npos);
  EXPECT_NE(text({-9, -9, 0}, {12, 12, 0}, {}).find(R"("pitch":null)"), std::string::npos);
  EXPECT_NE(text({-9, -9, 0}, {12, 12, 0}, {.pitch = geometry::PitchSize{40, 20}}).find(R"("pitch":{"length":40.0)"),
            std::string::npos);
}

TEST(Scene, NamesFromOutsideStayText) {
  RecordingHeader header = header_in(FrameOfReference::Kind::space);
  header.name = "a\"b\\\xff</script>\n";
  const std::string text = scene_text(header, RecordingState{}, {}, {});
  EXPECT_NE(text.find(R"("name":"a\"b\\)"), std::string::npos) << text;
  EXPECT_EQ(text.find('\xff'), std::string::npos);
  EXPECT_EQ(text.find('\n'), std::string::npos);
}

TEST(PageWords, TakeNumbersAndNothingElse) {
  std::string_view line = "  video 12 640x";
  EXPECT_EQ(next_word(line), "video");
  EXPECT_EQ(whole_in(next_word(line), 0, 100), 12);
  EXPECT_EQ(whole_in(next_word(line), 0, 1000), std::nullopt);
  EXPECT_EQ(next_word(line), "");
  for (const char* wrong : {"", "-1", "101", "1e2", "99999999999999999999", "+5", "0x1"})
    EXPECT_EQ(whole_in(wrong, 0, 100), std::nullopt) << wrong;
}

}  // namespace
}  // namespace marey::viewer
