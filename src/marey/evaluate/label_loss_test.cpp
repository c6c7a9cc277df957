#include "marey/evaluate/label_loss.h"

#include <gtest/gtest.h>

namespace marey::evaluate {
namespace {

using Frames = std::vector<std::vector<NamedPosition>>;

/// Marker A walks right along y = 0, B along y = 100.
Frames walk(int frames) {
  Frames truth(frames);
  for (int i = 0; i < frames; ++i) truth[i] = {{"A", {10.0 * i, 0}}, {"B", {10.0 * i, 100}}};
  return truth;
}

Frames named(Frames frames, const std::string& a, const std::string& b) {
  for (auto& frame : frames) {
    frame[0].name = a;
    frame[1].name = b;
  }
  return frames;
}

TEST(LabelLoss, NamesThatStayAreKept) {
  const Frames truth = walk(20);
  for (const LabelFate& fate : evaluate_labels(truth, named(truth, "one", "two"), 5)) {
    EXPECT_FALSE(fate.lost());
    EXPECT_EQ(fate.named, 20);
  }
}

TEST(LabelLoss, NamesThatChangePlacesForGoodAreBothLost) {
  const Frames truth = walk(20);
  Frames tracks = named(truth, "one", "two");
  for (int i = 15; i < 20; ++i) std::swap(tracks[i][0].name, tracks[i][1].name);
  for (const LabelFate& fate : evaluate_labels(truth, tracks, 5)) EXPECT_TRUE(fate.lost());
}

TEST(LabelLoss, AMissOfOneFrameInTwentyIsForgivenAndOfThreeIsNot) {
  const Frames truth = walk(20);
  Frames tracks = named(truth, "one", "two");
  tracks[7][0].location.y() = 50;
  EXPECT_FALSE(evaluate_labels(truth, tracks, 5)[0].lost());
  tracks[8][0].location.y() = 50;
  tracks[9][0].location.y() = 50;
  EXPECT_TRUE(evaluate_labels(truth, tracks, 5)[0].lost());
}

TEST(LabelLoss, AMarkerThatWasNeverNamedIsLost) {
  const Frames truth = walk(3);
  const LabelFate fate = evaluate_labels(truth, Frames(3), 5)[0];
  EXPECT_TRUE(fate.lost());
  EXPECT_EQ(fate.given, "");
}

}  // namespace
}  // namespace marey::evaluate
