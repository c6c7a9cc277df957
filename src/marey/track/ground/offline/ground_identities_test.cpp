#include "marey/track/ground/offline/ground_identities.h"

#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace marey::track::ground::offline {
namespace {

constexpr double kSceneRate = 5;  // Hz

std::vector<Timestamp> scene_clock(int instants) {
  std::vector<Timestamp> times;
  for (int k = 0; k < instants; ++k) times.push_back(timestamp_from_seconds(k / kSceneRate));
  return times;
}

/// Where player `who` of six is: at a home of its own, which it strolls about; players 0 and 1 run side by side round 60 s.
Vector<2> position_of(int identity, int k) {
  const double t = k / kSceneRate;
  const Vector<2> home(15.0 * (identity % 3), 20.0 * (identity / 3));
  const Vector<2> about = home + Vector<2>(4 * std::sin(t / 7 + identity), 4 * std::cos(t / 9 + 2 * identity));
  if (identity > 1) return about;
  const double together = std::exp(-std::pow((t - 60) / 8, 4));
  const Vector<2> close_encounter(7.5, 2.0 + 0.35 * (identity == 0 ? 1 : -1));
  return (1 - together) * about + together * close_encounter;
}

GroundTracklet empty_track(int track) {
  return {.runs = {{TrackId{track}, 0}}, .confirmed = true, .samples = {}};
}

void observe_frame(GroundTracklet& tracklet, int identity, int k) {
  GroundSample sample;
  sample.instant = k;
  const Vector<2> location = position_of(identity, k);
  sample.location = {static_cast<float>(location.x()), static_cast<float>(location.y())};
  sample.covariance = {0.02F, 0, 0.02F};
  sample.cameras = 1;
  tracklet.samples.push_back(sample);
}

/// Six tracks over three minutes, of which 0 and 1 show each other's players from `exchanged` s on.
std::vector<GroundTracklet> six(double swapped, int instants) {
  std::vector<GroundTracklet> tracklets;
  for (int identity = 0; identity < 6; ++identity) {
    tracklets.push_back(empty_track(identity + 1));
    for (int k = 0; k < instants; ++k)
      observe_frame(tracklets.back(), identity < 2 && k / kSceneRate >= swapped ? 1 - identity : identity, k);
  }
  return tracklets;
}

std::vector<IdentityAnnotation> named_at_once(int people) {
  std::vector<IdentityAnnotation> namings;
  for (int identity = 0; identity < people; ++identity) namings.push_back({identity, 5, identity});
  return namings;
}

/// The name of each second of a tracklet: "000111".
std::string names_of(const GroundIdentities& found, int tracklet, int every_s, int instants) {
  std::string names;
  for (int k = 0; k < instants; k += static_cast<int>(every_s * kSceneRate)) {
    for (const GroundIdentities::TimeChunk& segment : found.segments) {
      if (segment.tracklet != tracklet || k < segment.first || k > segment.last) continue;
      const int name = found.paths[static_cast<std::size_t>(segment.path)].name;
      names += name < 0 ? '?' : static_cast<char>('0' + name);
    }
  }
  return names;
}

GroundIdentities identify_all(const std::vector<GroundTracklet>& tracklets, const std::vector<IdentityAnnotation>& namings,
                              int instants) {
  return identify(tracklets, std::vector<int>(tracklets.size(), -1), scene_clock(instants), namings);
}

TEST(GroundIdentities, NamesGoAlongTracks) {
  const auto found = identify_all(six(1e9, 900), named_at_once(6), 900);
  EXPECT_EQ(names_of(found, 0, 30, 900), "000000");
  EXPECT_EQ(names_of(found, 1, 30, 900), "111111");
  EXPECT_EQ(names_of(found, 5, 30, 900), "555555");
  for (const auto& close_encounter : found.close_encounters)
    EXPECT_LT(close_encounter.probability, 0.05) << "roles say that nothing was exchanged";
}

TEST(GroundIdentities, TwoWhoWereExchangedAreFoundByTheirRoles) {
  const auto found = identify_all(six(60, 900), named_at_once(6), 900);
  EXPECT_EQ(names_of(found, 0, 30, 900).substr(0, 2), "00");
  EXPECT_EQ(names_of(found, 0, 30, 900).substr(3), "111");
  EXPECT_EQ(names_of(found, 1, 30, 900).substr(3), "000");
}

TEST(GroundIdentities, AnExchangeOfWhichLittleIsSeenAfterwardsIsInDoubt) {
  const int instants = static_cast<int>(72 * kSceneRate);  // they have barely parted
  const auto found = identify_all(six(60, instants), named_at_once(6), instants);
  double maximum = 0;
  for (const auto& close_encounter : found.close_encounters) maximum = std::max(maximum, close_encounter.probability);
  EXPECT_GT(maximum, 0.03);
}

TEST(GroundIdentities, ReacquiredPersonKeepsName) {
  std::vector<GroundTracklet> tracklets = six(1e9, 900);
  tracklets[4].samples.resize(300);
  tracklets.push_back(empty_track(7));
  for (int k = 340; k < 900; ++k) observe_frame(tracklets.back(), 4, k);  // 8 s later
  const auto found = identify_all(tracklets, named_at_once(6), 900);
  EXPECT_EQ(names_of(found, 6, 30, 900), "444");
}

TEST(GroundIdentities, SwapsDoublyNamedTrackAtEncounter) {
  // Too little is seen for roles to decide: the given identities decide.
  const int instants = static_cast<int>(80 * kSceneRate);
  std::vector<IdentityAnnotation> namings = named_at_once(6);
  namings.push_back({0, instants - 10, 1});
  const auto found = identify_all(six(60, instants), namings, instants);
  EXPECT_EQ(names_of(found, 0, 10, instants).front(), '0');
  EXPECT_EQ(names_of(found, 0, 10, instants).back(), '1');
  EXPECT_EQ(names_of(found, 1, 10, instants).back(), '0');
}

TEST(GroundIdentities, TwoNamesWithNothingBetweenAreCutHalfWay) {
  const auto found = identify_all(six(1e9, 900), {{5, 100, 0}, {5, 700, 1}}, 900);
  EXPECT_EQ(names_of(found, 5, 30, 900), "000111");
}

TEST(GroundIdentities, OffersAbsentPeopleAsCandidates) {
  std::vector<GroundTracklet> tracklets = six(1e9, 900);
  tracklets[4].samples.resize(300);
  tracklets.push_back(empty_track(7));
  for (int k = 880; k < 900; ++k) observe_frame(tracklets.back(), 4, k);  // too long after to be joined, and brief
  const auto found = identify_all(tracklets, named_at_once(6), 900);
  const int path = found.segments.back().path;
  if (found.paths[static_cast<std::size_t>(path)].name >= 0) GTEST_SKIP() << "joined";
  ASSERT_FALSE(found.candidates.empty());
  for (const auto& candidate : found.candidates) {
    if (candidate.path == path) {
      EXPECT_EQ(candidate.name, 4);
    }
  }
}

}  // namespace
}  // namespace marey::track::ground::offline
