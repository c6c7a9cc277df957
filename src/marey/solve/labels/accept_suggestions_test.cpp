#include "marey/solve/labels/accept_suggestions.h"

#include <gtest/gtest.h>

namespace marey::solve::labels {
namespace {

TrackColumns track_of(int id, const std::string& label, std::vector<std::pair<int, int>> pieces) {
  TrackColumns track({.id = TrackId{id}, .label = label, .team = {}}, 3);
  for (const auto& [first, last] : pieces) {
    for (int at = first; at <= last; ++at) {
      Sample sample;
      sample.track = track.id();
      sample.position = {static_cast<double>(id), static_cast<double>(at), 0};
      track.add(at, sample);
    }
  }
  return track;
}

/// C7 is seen but in 10 to 19 and from 30 on; T10 all the time; a point without a name in 10 to 19 and 30 to 34.
Labelled labelled() {
  Labelled labelled;
  labelled.recording = Recording(RecordingHeader{});
  for (int i = 0; i < 40; ++i) labelled.recording.add_time_step({i, timestamp_from_seconds(0.01 * i)});
  labelled.recording.put(track_of(1, "C7", {{0, 9}, {20, 29}}));
  labelled.recording.put(track_of(2, "T10", {{0, 39}}));
  labelled.recording.put(track_of(3, "", {{10, 19}, {30, 34}}));
  labelled.health = {{.label = "C7", .detected = 20}, {.label = "T10", .detected = 40}};
  labelled.unnamed = {{TrackId{3}, 30, 34, "T10", "C7"}, {TrackId{3}, 10, 19, "C7", "T10"}};
  return labelled;
}

TEST(AcceptSuggestions, APieceGetsItsBestNameWhereNobodyElseBearsIt) {
  Labelled result = labelled();
  EXPECT_EQ(accept_suggestions(result, {}), 1);
  const TrackColumns& c7 = *result.recording.find(TrackId{1});
  ASSERT_EQ(c7.size(), 30u);
  EXPECT_EQ(c7.at()[10], 10);
  EXPECT_EQ(c7.position(10), Vector<3>(3, 10, 0)) << "where the point without a name was";
  EXPECT_EQ(result.recording.find(TrackId{2})->size(), 40u);
  EXPECT_EQ(result.recording.find(TrackId{3})->size(), 5u) << "T10 was there: it stays";
  ASSERT_EQ(result.unnamed.size(), 1u);
  EXPECT_EQ(result.unnamed.front().best, "T10");
  EXPECT_EQ(result.health.front().detected, 30);
}

TEST(AcceptSuggestions, OnlyTheNamesThatAreAskedFor) {
  Labelled result = labelled();
  EXPECT_EQ(accept_suggestions(result, {"T10"}), 0);
  EXPECT_EQ(result.unnamed.size(), 2u);
  EXPECT_EQ(result.recording.find(TrackId{1})->size(), 20u);
}

}  // namespace
}  // namespace marey::solve::labels
