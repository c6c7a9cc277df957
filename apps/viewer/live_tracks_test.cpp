#include "live_tracks.h"

#include <gtest/gtest.h>

namespace marey::viewer {
namespace {

Instant instant_at(double seconds, std::vector<int> tracks, double x = 0) {
  Instant instant;
  instant.time = Timestamp(duration_from_seconds(seconds));
  for (const int track : tracks) {
    Sample& sample = instant.samples.emplace_back();
    sample.track = TrackId{track};
    sample.position = {x, 2 * x, 0};
  }
  return instant;
}

TEST(LiveTracks, ListsUnnamedTracks) {
  LiveTracks tracks;
  EXPECT_TRUE(tracks.add(instant_at(0, {3, 5})));
  EXPECT_FALSE(tracks.add(instant_at(0.1, {3, 5})));
  ASSERT_EQ(tracks.names().size(), 2U);
  EXPECT_EQ(tracks.names()[0].id, TrackId{3});
  EXPECT_EQ(tracks.names()[0].label, "");
  Instant named = instant_at(0.2, {3, 5});
  named.named.push_back({TrackId{5}, "left knee", ""});
  EXPECT_TRUE(tracks.add(named));
  EXPECT_EQ(tracks.names()[1].label, "left knee");
}

TEST(LiveTracks, ReportsGrowingExtent) {
  LiveTracks tracks;
  EXPECT_FALSE(tracks.extent());
  tracks.add(instant_at(0, {1}, 1));
  EXPECT_TRUE(tracks.add(instant_at(1, {1}, 11)));
  EXPECT_FALSE(tracks.add(instant_at(2, {1}, 11.2)));
  EXPECT_TRUE(tracks.add(instant_at(3, {1}, 13)));
  ASSERT_TRUE(tracks.extent());
  EXPECT_EQ(tracks.extent()->low.y(), 2);
  EXPECT_EQ(tracks.extent()->high.y(), 26);
  Instant predicted = instant_at(4, {1}, 500);
  predicted.samples[0].provenance = Provenance::predicted;
  EXPECT_FALSE(tracks.add(predicted));
}

TEST(LiveTracks, ForgetsUnnamedTracksThatLeft) {
  LiveTracks tracks;
  Instant named = instant_at(0, {0});
  named.named.push_back({TrackId{0}, "goalkeeper", ""});
  tracks.add(named);
  for (int i = 1; i < 20000; ++i) tracks.add(instant_at(i, {i}));
  EXPECT_LE(tracks.names().size(), LiveTracks::kMaxUnnamed + 1);
  EXPECT_EQ(tracks.names().front().label, "goalkeeper");
  EXPECT_EQ(tracks.names().back().id, TrackId{19999});
  tracks.clear();
  EXPECT_TRUE(tracks.names().empty());
}

}  // namespace
}  // namespace marey::viewer
