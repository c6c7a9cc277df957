#include "marey/solve/labels/check_names.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "marey/assign/no_index.h"
#include "marey/geometry/rigid.h"
#include "marey/solve/labels/learn_markers.h"

namespace marey::solve::labels {
namespace {

/// A trunk of four markers, a flat plate of four that turns on it (its corners keep their distances if it is turned over), and a
/// limb of six whose joints bend.
class Doll {
 public:
  static constexpr int kMarkers = 14;

  explicit Doll(double size = 1) : size_(size) {}

  Vector<3> at(int marker, double time) const {
    static const Vector<3> kTrunk[4] = {{0, 0, 0}, {0.3, 0.02, 0.05}, {0.1, 0.25, 0.1}, {0.05, 0.1, 0.4}};
    static const Vector<3> kPlate[4] = {{0.06, 0.04, 0}, {-0.06, 0.04, 0}, {-0.06, -0.04, 0}, {0.06, -0.04, 0}};
    const Rigid3 trunk{geometry::rotation_from({0, 0, 0.4 * time}), {std::cos(time), std::sin(time), 1}};
    if (marker < 4) return trunk * Vector<3>(size_ * kTrunk[marker]);
    if (marker < 8) {
      const Rigid3 plate{geometry::rotation_from({0.25 * std::sin(3 * time), 0.2 * std::cos(2 * time), 0}), {0.22, -0.16, 0.2}};
      return trunk * Vector<3>(size_ * (plate * kPlate[marker - 4]));
    }
    const int along = marker - 8;  // two markers a segment, which bend against each other
    Vector<3> location(0.3, 0.3, 0.3);
    for (int segment = 0; segment <= along / 2; ++segment) {
      const double angle = 0.4 * segment + 0.5 * std::sin(4 * time + segment);
      const double length = segment < along / 2 ? 0.2 : 0.05 + 0.1 * (along % 2);
      location += length * Vector<3>(std::cos(angle), 0.2 * std::sin(angle), std::sin(angle));
    }
    return trunk * Vector<3>(size_ * location);
  }

 private:
  double size_;
};

std::string doll_label(int marker) {
  return (marker < 10 ? "d0" : "d") + std::to_string(marker);  // by their letters as by their numbers
}

Recording doll_recording(const Doll& doll, double from, const std::vector<int>& excluded = {}) {
  Recording recording;
  recording.header.name = "doll";
  recording.header.rate_hz = 50;
  for (int i = 0; i < 150; ++i) {
    Instant instant;
    instant.index = i;
    instant.time = timestamp_from_seconds(i / 50.0);
    for (int m = 0; m < Doll::kMarkers; ++m) {
      if (std::find(excluded.begin(), excluded.end(), m) != excluded.end()) continue;
      Sample sample;
      sample.track = TrackId{m + 1};
      sample.position = doll.at(m, from + i / 50.0);
      instant.samples.push_back(sample);
    }
    recording.add(instant);
  }
  for (int m = 0; m < Doll::kMarkers; ++m) recording.set_name({.id = TrackId{m + 1}, .label = doll_label(m), .team = {}});
  return recording;
}

/// The doll's tracks under these names; kNoIndex has none.
NamedChains named_doll(const Recording& recording, const std::vector<int>& names) {
  auto tracklets = tracklets_of(recording);
  const auto chain_of = chains_of(tracklets, recording.header.rate_hz);
  std::vector<int> name_of;  // by chain
  for (std::size_t t = 0; t < tracklets.size(); ++t) {
    const auto chain = static_cast<std::size_t>(chain_of[t]);
    if (chain >= name_of.size()) name_of.resize(chain + 1, assign::kNoIndex);
    name_of[chain] = names[static_cast<std::size_t>(number(tracklets[t].track)) - 1];
  }
  NamedChains chains(std::move(tracklets), chain_of, recording.instants().size(), Doll::kMarkers);
  for (int chain = 0; chain < std::ssize(name_of); ++chain) chains.set_name(chain, name_of[static_cast<std::size_t>(chain)]);
  chains.gather();
  return chains;
}

std::vector<int> right_names() {
  std::vector<int> names(Doll::kMarkers);
  std::iota(names.begin(), names.end(), 0);
  return names;
}

class CheckNames : public testing::Test {
 protected:
  CheckNames() : learned_(learn_markers(std::vector{doll_recording(Doll(), 10)}, {})), model_(learned_, 1) {}

  CheckedNames check(const NamedChains& chains) const { return check_names(chains, learned_, model_, {}, 8, 3); }
  /// Which marker each name has after the check, where `names` are those of the markers before.
  std::vector<int> markers_of(const CheckedNames& checked, const std::vector<int>& names) const {
    std::vector<int> markers(Doll::kMarkers, assign::kNoIndex);
    for (int name = 0; name < Doll::kMarkers; ++name) {
      const int holder = checked.holder_of[static_cast<std::size_t>(name)];
      if (holder == assign::kNoIndex) continue;
      const auto found = std::find(names.begin(), names.end(), holder);
      markers[static_cast<std::size_t>(name)] = static_cast<int>(found - names.begin());
    }
    return markers;
  }

  LearnedMarkers learned_;
  DistanceModel model_;
};

TEST_F(CheckNames, RightOnesStayAndAreDecided) {
  const Recording recording = doll_recording(Doll(), 1);
  const CheckedNames checked = check(named_doll(recording, right_names()));
  EXPECT_EQ(checked.holder_of, right_names());
  EXPECT_EQ(checked.undecided, std::vector<int>(Doll::kMarkers, assign::kNoIndex));
}

TEST_F(CheckNames, AFlatClusterThatIsTurnedOverIsTurnedBack) {
  const Recording recording = doll_recording(Doll(), 1);
  std::vector<int> names = right_names();
  std::swap(names[4], names[5]);
  std::swap(names[6], names[7]);
  EXPECT_EQ(markers_of(check(named_doll(recording, names)), names), right_names());
}

TEST_F(CheckNames, ARowThatIsShiftedByOneIsShiftedBack) {
  const Recording recording = doll_recording(Doll(), 1, {13});  // the last of the limb is hidden throughout
  std::vector<int> names = right_names();
  for (int m = 10; m < 13; ++m) names[static_cast<std::size_t>(m)] = m + 1;
  std::vector<int> right = right_names();
  right[13] = assign::kNoIndex;
  EXPECT_EQ(markers_of(check(named_doll(recording, names)), names), right);
}

TEST_F(CheckNames, LeavesAmbiguousSwapUndecided) {
  LearnedMarkers alike = learned_;  // two of the trunk, whose distances are reported the same
  for (std::size_t other = 0; other < alike.size(); ++other) {
    if (other == 1 || other == 2) continue;
    const double mean = 0.5 * (alike.between(1, other).mean + alike.between(2, other).mean);
    alike.between(1, other) = alike.between(2, other) = {mean, 0.1};
  }
  alike.locations.assign(alike.size(), Vector<3>::Zero());  // and no sides
  const Recording recording = doll_recording(Doll(), 1);
  const CheckedNames checked = check_names(named_doll(recording, right_names()), alike, DistanceModel(alike, 1), {}, 8, 3);
  EXPECT_EQ(checked.undecided[1], 2);
  EXPECT_EQ(checked.undecided[2], 1);
}

TEST_F(CheckNames, APlateTurnedByHalfIsDecidedByThePosture) {
  // The plate is a rectangle: turned by half about its height all distances within it are the same, and those to the trunk barely.
  std::vector<int> names = right_names();
  std::swap(names[4], names[6]);
  std::swap(names[5], names[7]);
  LearnedMarkers no_posture = learned_;
  for (Vector<3>& location : no_posture.locations) location.setZero();
  LearnedMarkers only_within = learned_;  // distances from the plate to all others say nothing
  for (std::size_t plate = 4; plate < 8; ++plate) {
    for (std::size_t other = 0; other < learned_.size(); ++other) {
      if (other < 4 || other > 7) only_within.between(plate, other).deviation = no_posture.between(plate, other).deviation = 1;
    }
  }
  const DistanceModel model(only_within, 1);
  const NamedChains chains = named_doll(doll_recording(Doll(), 3), names);
  const CheckedNames with = check_names(chains, only_within, model, {}, 8, 3);
  EXPECT_EQ(markers_of(with, names), right_names());
  const CheckedNames without = check_names(chains, no_posture, model, {}, 8, 3);
  EXPECT_TRUE(without.undecided[4] != assign::kNoIndex || markers_of(without, names) != right_names());
}

TEST_F(CheckNames, TheMisfitIsThatOfRigidDistances) {
  const auto of = [&](double size) {
    const Recording recording = doll_recording(Doll(size), 1);
    return misfit_of(named_doll(recording, right_names()).named_distances(), model_);
  };
  EXPECT_LT(of(1).ratio, 1);
  EXPECT_GT(of(1.2).ratio, 2);
  EXPECT_GT(of(1.2).off_m, 0.015);
}

}  // namespace
}  // namespace marey::solve::labels
