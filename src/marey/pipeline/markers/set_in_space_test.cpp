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

using labelled::kTestedRate;
using labelled::named_in;
using labelled::NamedShare;
using labelled::person;
using labelled::Seen;
using labelled::set_of;
using labelled::Spoiler;
using labelled::taught_by;
using marey::simulate::room::RoomMotion;
using marey::simulate::room::RoomScene;

void print_share(const char* what, std::uint64_t seed, const NamedShare& share) {
  const double all = static_cast<double>(std::max<std::int64_t>(share.points, 1)) / 100;
  std::printf("%s, seed %d: right %.2f %%, wrong %.2f %%; found at %.2f s\n", what, static_cast<int>(seed),
              static_cast<double>(share.right) / all, static_cast<double>(share.wrong) / all, share.found_at_s);
}

void expect_named(const NamedShare& share, double right, double wrong) {
  EXPECT_GT(share.points, 0);
  EXPECT_TRUE(share.is_consistent);
  EXPECT_GT(static_cast<double>(share.right), right * static_cast<double>(share.points));
  EXPECT_LT(static_cast<double>(share.wrong), wrong * static_cast<double>(share.points));
}

TEST(SetInSpace, NamesAWalkWithinTheFrame) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const RoomScene scene = person(RoomMotion::walk, 40, seed, 2000);
    const auto set = set_of({taught_by(scene, 15, 400)});
    const NamedShare share = named_in(scene, Spoiler(scene, seed).seen(800), set);
    print_share("walk", seed, share);
    expect_named(share, 0.99, 0.003);
    EXPECT_LT(share.found_at_s, 1.1);
  }
}

TEST(SetInSpace, NamesWhoWaves) {
  const RoomScene scene = person(RoomMotion::wave, 40, 3, 1000);
  const auto set = set_of({taught_by(person(RoomMotion::walk, 40, 3, 1000), 2, 400), taught_by(scene, 7, 200)});
  const NamedShare share = named_in(scene, Spoiler(scene, 3).seen(600), set);
  print_share("wave", 3, share);
  expect_named(share, 0.99, 0.003);
}

/// Arms over the head, where the set knows them hanging: they go without names rather than with wrong ones.
TEST(SetInSpace, GivesNoNamesToPosturesThatItDoesNotKnow) {
  const RoomScene scene = person(RoomMotion::wave, 40, 3, 1000);
  const auto set = set_of({taught_by(person(RoomMotion::walk, 40, 3, 1000), 2, 400)});
  const NamedShare share = named_in(scene, Spoiler(scene, 3).seen(600), set);
  print_share("wave by a walk", 3, share);
  expect_named(share, 0.6, 0.01);
}

TEST(SetInSpace, PutsRightWhatATrackerExchanged) {
  const RoomScene scene = person(RoomMotion::walk, 40, 5, 2000);
  const NamedShare share = named_in(scene, Spoiler(scene, 5, 0.05, 15).seen(800), set_of({taught_by(scene, 15, 400)}));
  print_share("exchanged", 5, share);
  expect_named(share, 0.99, 0.003);
}

TEST(SetInSpace, OneWhoStoodStillTeachesMost) {
  const RoomScene scene = person(RoomMotion::walk, 40, 31, 2000);
  const NamedShare share =
      named_in(scene, Spoiler(scene, 31).seen(800), set_of({taught_by(person(RoomMotion::still, 40, 31, 1000), 0, 200)}));
  print_share("by one who stood still", 31, share);
  expect_named(share, 0.9, 0.03);
}

TEST(SetInSpace, SaysWhatDoesNotFit) {
  const RoomScene scene = person(RoomMotion::walk, 40, 6, 1000);
  const auto set = set_of({taught_by(scene, 5, 300)});
  std::vector<std::string> warnings;
  const RoomScene few = person(RoomMotion::walk, 10, 6, 1000);
  EXPECT_EQ(named_in(few, Spoiler(few, 6).seen(200), set, &warnings).found_at_s, -1);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("markers were seen at once, of the set's 40"), std::string::npos) << warnings[0];
  LearnedMarkers none;
  EXPECT_THROW(SetInSpace(std::make_shared<const LearnedMarkers>(none), 100), Error);
}

/// Two neighbours whose distances are taught the same, and no sides: each could as well be the other, whatever comes.
TEST(SetInSpace, DoesNotReportWhatCouldAsWellBeExchanged) {
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
  alike.places[one] = alike.places[other] = Vector<3>::Zero();
  const NamedShare share = named_in(scene, Spoiler(scene, 9).seen(800), std::make_shared<const LearnedMarkers>(alike));
  print_share("two that are alike", 9, share);
  expect_named(share, 0.93, 0.001);
  EXPECT_LT(static_cast<double>(share.right), 0.952 * static_cast<double>(share.points)) << "38 of 40 are decided";
}

TEST(SetInSpace, ReportsASetOfAnotherPerson) {
  const RoomScene scene = person(RoomMotion::walk, 40, 10, 2000);
  const auto of_size = [&](double size) {
    LearnedMarkers learned = *set_of({taught_by(scene, 15, 400)});
    for (std::size_t a = 1; a < learned.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) learned.between(a, b).mean *= size;
    }
    for (Vector<3>& place : learned.places) place *= size;
    std::vector<std::string> warnings;
    const NamedShare share =
        named_in(scene, Spoiler(scene, 10).seen(600), std::make_shared<const LearnedMarkers>(learned), &warnings);
    EXPECT_EQ(share.news.size(), size == 1 ? 0u : 1u) << "once, while it goes on";
    std::string said;
    for (const std::string& warning : warnings) said += warning + "\n";
    return said;
  };
  EXPECT_EQ(of_size(1), "");
  const std::string said = of_size(1.1);
  EXPECT_NE(said.find("the set does not fit: distances that it knows as rigid are off by"), std::string::npos) << said;
}

/// Names that tracks have hold where they may: the set gives the others.
TEST(SetInSpace, KeepsNamesThatAreThere) {
  const RoomScene scene = person(RoomMotion::walk, 40, 7, 1000);
  Seen seen = Spoiler(scene, 7, 0).seen(300);
  std::map<int, TrackId> track_of;
  for (std::size_t p = 0; p < seen.truth[0].size(); ++p) track_of[seen.truth[0][p]] = seen.instants[0].samples[p].track;
  seen.instants[0].named.push_back({track_of.at(4), scene.labels()[5], {}});
  seen.instants[0].named.push_back({track_of.at(8), "Bob", {}});
  SetInSpaceOptions options;
  options.wait = true;
  SetInSpace named(set_of({taught_by(scene, 5, 300)}), kTestedRate, options);
  std::map<TrackId, std::string> labels;
  const Instant* last = nullptr;
  for (Instant& instant : seen.instants) {
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
