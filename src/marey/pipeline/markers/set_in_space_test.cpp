// Names within the frame, on simulated people whose markers' names are known: hidden, in pieces, among ghosts, exchanged.
#include "marey/pipeline/markers/set_in_space.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "marey/core/error.h"

#include "support/labelled_person.h"

namespace marey::pipeline::markers {
namespace {

using labelled::Detected;
using labelled::kTestedRate;
using labelled::named_in;
using labelled::NamedFraction;
using labelled::person;
using labelled::set_of;
using labelled::Spoiler;
using labelled::taught_by;
using marey::simulate::room::RoomMotion;
using marey::simulate::room::RoomScene;

void print_fraction(const char* what, std::uint64_t seed, const NamedFraction& fraction) {
  const double all = static_cast<double>(std::max<std::int64_t>(fraction.points, 1)) / 100;
  std::printf("%s, seed %d: right %.2f %%, wrong %.2f %%; found at %.2f s\n", what, static_cast<int>(seed),
              static_cast<double>(fraction.right) / all, static_cast<double>(fraction.wrong) / all, fraction.found_at_s);
}

void expect_named(const NamedFraction& fraction, double right, double wrong) {
  EXPECT_GT(fraction.points, 0);
  EXPECT_TRUE(fraction.is_consistent);
  EXPECT_GT(static_cast<double>(fraction.right), right * static_cast<double>(fraction.points));
  EXPECT_LT(static_cast<double>(fraction.wrong), wrong * static_cast<double>(fraction.points));
}

TEST(LiveLabelling, NamesAWalkWithinTheFrame) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const RoomScene scene = person(RoomMotion::walk, 40, seed, 2000);
    const auto set = set_of({taught_by(scene, 15, 400)});
    const NamedFraction fraction = named_in(scene, Spoiler(scene, seed).detected(800), set);
    print_fraction("walk", seed, fraction);
    expect_named(fraction, 0.99, 0.003);
    EXPECT_LT(fraction.found_at_s, 1.1);
  }
}

TEST(LiveLabelling, NamesWhoWaves) {
  const RoomScene scene = person(RoomMotion::wave, 40, 3, 1000);
  const auto set = set_of({taught_by(person(RoomMotion::walk, 40, 3, 1000), 2, 400), taught_by(scene, 7, 200)});
  const NamedFraction fraction = named_in(scene, Spoiler(scene, 3).detected(600), set);
  print_fraction("wave", 3, fraction);
  expect_named(fraction, 0.99, 0.003);
}

/// Arms over the head, where the set knows them hanging: they go without names rather than with wrong ones.
TEST(LiveLabelling, GivesNoNamesToPosturesThatItDoesNotKnow) {
  const RoomScene scene = person(RoomMotion::wave, 40, 3, 1000);
  const auto set = set_of({taught_by(person(RoomMotion::walk, 40, 3, 1000), 2, 400)});
  const NamedFraction fraction = named_in(scene, Spoiler(scene, 3).detected(600), set);
  print_fraction("wave by a walk", 3, fraction);
  expect_named(fraction, 0.6, 0.01);
}

TEST(LiveLabelling, PutsRightWhatATrackerExchanged) {
  const RoomScene scene = person(RoomMotion::walk, 40, 5, 2000);
  const NamedFraction fraction = named_in(scene, Spoiler(scene, 5, 0.05, 15).detected(800), set_of({taught_by(scene, 15, 400)}));
  print_fraction("exchanged", 5, fraction);
  expect_named(fraction, 0.99, 0.003);
}

TEST(LiveLabelling, LearnsMostFromStandingPerson) {
  const RoomScene scene = person(RoomMotion::walk, 40, 31, 2000);
  const NamedFraction fraction =
      named_in(scene, Spoiler(scene, 31).detected(800), set_of({taught_by(person(RoomMotion::still, 40, 31, 1000), 0, 200)}));
  print_fraction("by one who stood still", 31, fraction);
  expect_named(fraction, 0.9, 0.03);
}

TEST(LiveLabelling, SaysWhatDoesNotFit) {
  const RoomScene scene = person(RoomMotion::walk, 40, 6, 1000);
  const auto set = set_of({taught_by(scene, 5, 300)});
  std::vector<std::string> warnings;
  const RoomScene few = person(RoomMotion::walk, 10, 6, 1000);
  EXPECT_EQ(named_in(few, Spoiler(few, 6).detected(200), set, &warnings).found_at_s, -1);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("markers were seen at once, of the set's 40"), std::string::npos) << warnings[0];
  LearnedMarkers none;
  EXPECT_THROW(LiveLabelling(std::make_shared<const LearnedMarkers>(none), 100), Error);
}

/// Two neighbours whose distances are taught the same, and no sides: each could as well be the other, whatever comes.
TEST(LiveLabelling, DoesNotReportWhatCouldAsWellBeExchanged) {
  const RoomScene scene = person(RoomMotion::walk, 40, 9, 2000);
  LearnedMarkers alike = *set_of({taught_by(scene, 15, 400)});
  std::size_t one = 20, other = 0;
  for (std::size_t m = 1; m < alike.size(); ++m) {
    if (m != one && (other == one || alike.between(one, m).mean < alike.between(one, other).mean)) other = m;
  }
  for (std::size_t m = 0; m < alike.size(); ++m) {
    if (m == one || m == other) continue;
    auto& first = alike.between(one, m);
    auto& second = alike.between(other, m);
    first.mean = second.mean = (first.mean + second.mean) / 2;
    first.deviation = second.deviation = std::max({first.deviation, second.deviation, 0.03});
  }
  alike.locations[one] = alike.locations[other] = Vector<3>::Zero();
  const NamedFraction fraction = named_in(scene, Spoiler(scene, 9).detected(800), std::make_shared<const LearnedMarkers>(alike));
  print_fraction("two that are alike", 9, fraction);
  expect_named(fraction, 0.93, 0.001);
  EXPECT_LT(static_cast<double>(fraction.right), 0.952 * static_cast<double>(fraction.points)) << "38 of 40 are decided";
}

TEST(LiveLabelling, ReportsASetOfAnotherPerson) {
  const RoomScene scene = person(RoomMotion::walk, 40, 10, 2000);
  const auto of_size = [&](double size) {
    LearnedMarkers learned = *set_of({taught_by(scene, 15, 400)});
    for (std::size_t a = 1; a < learned.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) learned.between(a, b).mean *= size;
    }
    for (Vector<3>& location : learned.locations) location *= size;
    std::vector<std::string> warnings;
    const NamedFraction fraction =
        named_in(scene, Spoiler(scene, 10).detected(600), std::make_shared<const LearnedMarkers>(learned), &warnings);
    EXPECT_EQ(fraction.news.size(), size == 1 ? 0u : 1u) << "once, while it continues";
    std::string stated;
    for (const std::string& warning : warnings) stated += warning + "\n";
    return stated;
  };
  EXPECT_EQ(of_size(1), "");
  const std::string stated = of_size(1.1);
  EXPECT_NE(stated.find("the set does not fit: distances that it knows as rigid are off by"), std::string::npos) << stated;
}

/// Names that tracks have hold where they may: the set gives the others.
TEST(LiveLabelling, KeepsNamesThatAreThere) {
  const RoomScene scene = person(RoomMotion::walk, 40, 7, 1000);
  Detected detected = Spoiler(scene, 7, 0).detected(300);
  std::map<int, TrackId> track_of;
  for (std::size_t p = 0; p < detected.truth[0].size(); ++p) track_of[detected.truth[0][p]] = detected.instants[0].samples[p].track;
  detected.instants[0].named.push_back({track_of.at(4), scene.labels()[5], {}});
  detected.instants[0].named.push_back({track_of.at(8), "Bob", {}});
  SetInSpaceOptions options;
  options.wait = true;
  LiveLabelling named(set_of({taught_by(scene, 5, 300)}), kTestedRate, options);
  std::map<TrackId, std::string> labels;
  const Instant* last = nullptr;
  for (Instant& instant : detected.instants) {
    named.add_to(instant);
    for (const TrackName& name : instant.named) labels[name.id] = name.label;
    last = &instant;
  }
  std::map<std::string, int> bearers;
  for (const Sample& sample : last->samples) {
    if (!labels[sample.track].empty()) ++bearers[labels[sample.track]];
  }
  EXPECT_EQ(bearers[scene.labels()[5]], 1) << "given by hand to another marker, and to no second one";
  EXPECT_EQ(bearers.count(scene.labels()[12]), 1u);
  EXPECT_GT(bearers.size(), 36u);
}

}  // namespace
}  // namespace marey::pipeline::markers
