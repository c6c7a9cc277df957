#include "marey/solve/bodies/define_body.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/solve/bodies/moving_bodies_test.h"

namespace marey::solve::bodies {
namespace {

Recording recording_of(const std::vector<Vector<3>>& locations, double sigma, int loose = 0, double hidden = 0) {
  moving::Random random(11);
  const moving::Path path(random, {0, 0, 1});
  Recording recording;
  recording.header.name = "swing";
  recording.header.rate_hz = 100;
  for (int i = 0; i < 400; ++i) {
    Instant instant;
    instant.index = i;
    instant.time = timestamp_from_seconds(i / 100.0);
    for (int m = 0; m < std::ssize(locations); ++m) {
      if (random.chance(hidden)) continue;
      Sample sample;
      sample.track = TrackId{m + 1};
      const double its = m + 1 == loose ? 0.008 : sigma;
      sample.position = path.at(i / 100.0) * locations[static_cast<std::size_t>(m)] + random.gaussian(its);
      instant.samples.push_back(sample);
    }
    recording.add(instant);
  }
  for (int m = 0; m < std::ssize(locations); ++m)
    recording.set_name({.id = TrackId{m + 1}, .label = std::string(1, static_cast<char>('a' + m)), .team = {}});
  return recording;
}

const std::vector<Vector<3>> kRacket = {{0, 0, 0}, {0.1, 0.02, 0}, {-0.05, 0.09, 0.03}, {0.02, -0.08, 0.11}, {0.15, 0.1, -0.07}};

std::string refusal(const Recording& recording, DefineOptions options) {
  try {
    define_body(recording, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(DefineBody, FindsTheShapeToAFractionOfTheNoise) {
  const Recording recording = recording_of(kRacket, 0.0005);
  const DefinedBody defined =
      define_body(recording, {.name = "racket", .markers = {"a", "b", "c", "d", "e"}, .pivot = "a", .axes = {{"a", "b", "c"}}});
  EXPECT_EQ(defined.body.label, "racket");
  ASSERT_EQ(defined.body.markers.size(), 5U);
  EXPECT_TRUE(defined.symmetries.empty());
  EXPECT_NEAR(defined.body.markers[0].position.norm(), 0, 1e-12);
  EXPECT_NEAR(defined.body.markers[1].position.y(), 0, 1e-12);
  EXPECT_GT(defined.body.markers[2].position.y(), 0);
  EXPECT_NEAR(defined.body.markers[2].position.z(), 0, 1e-12);
  for (std::size_t a = 0; a < 5; ++a) {
    EXPECT_NEAR(defined.markers[a].deviation, 0.0005, 0.0002);
    for (std::size_t b = 0; b < a; ++b)
      EXPECT_NEAR((defined.body.markers[a].position - defined.body.markers[b].position).norm(), (kRacket[a] - kRacket[b]).norm(),
                  0.0002);
  }
}

TEST(DefineBody, NamesWhatIsLooseAndLeavesItOut) {
  const DefinedBody defined =
      define_body(recording_of(kRacket, 0.0003, 3), {.name = "racket", .markers = {"a", "b", "c", "d", "e"}});
  ASSERT_EQ(defined.body.markers.size(), 4U);
  for (const DefinedMarker& marker : defined.markers) EXPECT_EQ(marker.loose, marker.label == "c") << marker.label;
}

TEST(DefineBody, MarkersNeedNotBeSeenTogether) {
  const DefinedBody defined =
      define_body(recording_of(kRacket, 0.0003, 0, 0.5), {.name = "racket", .markers = {"a", "b", "c", "d", "e"}});
  EXPECT_NEAR((defined.body.markers[0].position - defined.body.markers[4].position).norm(), (kRacket[0] - kRacket[4]).norm(),
              0.0006);
}

TEST(DefineBody, SaysWhatCannotBe) {
  const Recording recording = recording_of(kRacket, 0.0003);
  EXPECT_NE(refusal(recording, {.markers = {"a", "b"}}).find("three"), std::string::npos);
  EXPECT_NE(refusal(recording, {.markers = {"a", "b", "x"}}).find("no marker \"x\"; it has a, b, c, d, e"), std::string::npos);
  const Recording line = recording_of({{0, 0, 0}, {0.1, 0, 0}, {0.25, 0, 0}}, 0.0001);
  EXPECT_NE(refusal(line, {.markers = {"a", "b", "c"}}).find("line"), std::string::npos);
  EXPECT_NE(refusal(recording, {.markers = {"a", "b", "c"}, .pivot = "e"}).find("\"e\""), std::string::npos);
}

}  // namespace
}  // namespace marey::solve::bodies
