#include "marey/track/roster/gap_filler.h"

#include <gtest/gtest.h>

namespace marey::track::roster {
namespace {

TEST(GapFiller, FillsWithTheCubicThroughBothEnds) {
  GapFiller filler(10, 2);
  const auto at = [](double t) { return Vector<3>(t * t * t, 1 - t * t, 2 * t); };
  const auto speed = [](double t) { return Vector<3>(3 * t * t, -2 * t, 2); };
  Vector<3> location, velocity;
  for (int i = 0; i < 20; ++i) {
    const double t = 0.1 * i;
    const bool detected = i < 5 || i > 9;
    if (detected) location = at(t), velocity = speed(t);
    Track<3> track;
    track.id = TrackId{1};
    track.position = detected ? location : Vector<3>(location + (t - 0.4) * velocity);
    track.velocity = velocity;
    track.provenance = detected ? Provenance::measured : Provenance::predicted;
    Instant frame;
    frame.index = i;
    frame.time = timestamp_from_seconds(t);
    if (detected) {
      frame.samples.emplace_back();
      frame.samples.back().track = track.id;
      frame.samples.back().position = track.position;
    }
    filler.add(frame, std::span(&track, 1));
  }
  filler.finish();
  for (int i = 0; i < 20; ++i) {
    const auto frame = filler.next();
    ASSERT_TRUE(frame);
    ASSERT_EQ(frame->samples.size(), 1) << i;
    EXPECT_EQ(frame->samples[0].provenance, i < 5 || i > 9 ? Provenance::measured : Provenance::filled) << i;
    EXPECT_LT((frame->samples[0].position - at(0.1 * i)).norm(), 1e-9) << i;
  }
}

TEST(GapFiller, OfALongGapTheBeginningIsPredicted) {
  GapFiller filler(4, 2);
  for (int i = 0; i < 20; ++i) {
    const bool detected = i < 5 || i > 14;
    Track<3> track;
    track.id = TrackId{1};
    track.provenance = detected ? Provenance::measured : Provenance::predicted;
    Instant frame;
    frame.index = i;
    frame.time = timestamp_from_seconds(0.1 * i);
    if (detected) frame.samples.emplace_back().track = track.id;
    filler.add(frame, std::span(&track, 1));
  }
  filler.finish();
  for (int i = 0; i < 20; ++i) {
    const auto frame = filler.next();
    ASSERT_TRUE(frame);
    const bool predicted = i == 5 || i == 6;
    ASSERT_EQ(frame->samples.size(), i < 7 || i > 14 ? 1U : 0U) << i;
    if (!predicted) continue;
    EXPECT_EQ(frame->samples[0].provenance, Provenance::predicted) << i;
  }
  EXPECT_FALSE(filler.next());
}

}  // namespace
}  // namespace marey::track::roster
