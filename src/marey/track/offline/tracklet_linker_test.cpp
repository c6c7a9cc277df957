#include "marey/track/offline/tracklet_linker.h"

#include <cmath>
#include <map>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace marey::track::offline {
namespace {

constexpr double kFrameRate = 10;  // Hz

struct Shown {
  int id = 0;
  double x = 0, y = 200;
  int clothing = 0;  // 0 nothing that is seen
};

image::Clothes worn(int which) {
  if (which == 0) return {};
  const Appearance colour{
      .lightness = 20.0F + 20.0F * static_cast<float>(which), .a = which % 2 == 0 ? 20.0F : -20.0F, .b = 0, .deviation = 3};
  return {colour, colour};
}

template <typename ShownAt>
TrackletLog record(int frames, ShownAt&& shown_at) {
  TrackletLog log;
  for (int k = 0; k < frames; ++k) {
    std::vector<Track<2>> tracks;
    std::vector<image::Clothes> clothes;
    for (const Shown& one : shown_at(k)) {
      Track<2> track;
      track.id = TrackId{one.id};
      track.position = {one.x, one.y};
      track.box = Box::from_centre(track.position, 32, 80);
      track.score = 0.9;
      track.observation = static_cast<int>(clothes.size());
      clothes.push_back(worn(one.clothing));
      tracks.push_back(track);
    }
    log.add(k, timestamp_from_seconds(k / kFrameRate), tracks, clothes);
  }
  return log;
}

/// The number that a row near x has in a frame; 0 if there is no row.
int number_at(const std::vector<TrackRow>& rows, int frame, double x) {
  for (const TrackRow& row : rows) {
    if (row.frame == frame && std::abs(row.x - x) < 20) return row.id;
  }
  return 0;
}

/// Two meet in mid image, stop, and each goes back to where it came from; the tracker takes them for two who passed.
std::vector<Shown> rotated_back(int k, int left_wears, int right_wears) {
  const double walked = k < 30 ? 5.0 * k : k < 36 ? 150 : 150 - 5.0 * (k - 36);
  const bool swapped = k >= 33;
  const Shown left{swapped ? 2 : 1, 150 + walked, 200, left_wears}, right{swapped ? 1 : 2, 460 - walked, 203, right_wears};
  return swapped ? std::vector{right, left} : std::vector{left, right};
}

TEST(Linker, ClothingDistinguishesPeopleTurningBack) {
  TrackletLog log = record(70, [](int k) { return rotated_back(k, 1, 2); });
  const auto rows = join(log);
  EXPECT_EQ(number_at(rows, 5, 175), number_at(rows, 65, 155)) << "the left one came back";
  EXPECT_EQ(number_at(rows, 5, 435), number_at(rows, 65, 455)) << "and the right one";
  EXPECT_NE(number_at(rows, 5, 175), number_at(rows, 5, 435));
}

TEST(Linker, CrossingPeopleKeepIds) {
  for (const bool dressed : {false, true}) {
    TrackletLog log = record(70, [&](int k) {
      return std::vector<Shown>{{1, 100 + 5.0 * k, 200, dressed ? 1 : 0}, {2, 460 - 5.0 * k, 203, dressed ? 2 : 0}};
    });
    const auto rows = join(log);
    EXPECT_EQ(number_at(rows, 5, 125), number_at(rows, 65, 425)) << dressed;
    EXPECT_EQ(number_at(rows, 5, 435), number_at(rows, 65, 135)) << dressed;
  }
}

/// A person walks out of the sun into shade; just there no person sees them for half a second, or another passes. Others stand far
/// away, in clothes of many colours.
int cut_in_two_although_alone(int cases, unsigned first_seed) {
  int cut = 0;
  for (int i = 0; i < cases; ++i) {
    std::mt19937 random(first_seed + static_cast<unsigned>(i));
    const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    const double speed = uniform(1, 6), darker = uniform(10, 45);
    const int shade = static_cast<int>(uniform(25, 45)), meets_at = shade + static_cast<int>(uniform(-3, 3));
    std::vector<Appearance> clothe;
    for (int k = 0; k < 7; ++k) {
      clothe.push_back({.lightness = static_cast<float>(uniform(55, 90)),
                        .a = static_cast<float>(uniform(-30, 30)),
                        .b = static_cast<float>(uniform(-30, 30)),
                        .deviation = 2});
    }
    TrackletLog log;
    for (int k = 0; k < 80; ++k) {
      std::vector<Track<2>> tracks;
      std::vector<image::Clothes> clothes;
      const auto show = [&](int id, double x, double y, Appearance colour) {
        Track<2> track;
        track.id = TrackId{id};
        track.position = {x + uniform(-1, 1), y + uniform(-1, 1)};
        track.box = Box::from_centre(track.position, 32, 80);
        track.score = 0.9;
        track.observation = static_cast<int>(clothes.size());
        for (float* part : {&colour.lightness, &colour.a, &colour.b}) *part += static_cast<float>(uniform(-2, 2));
        clothes.push_back({colour, colour});
        tracks.push_back(track);
      };
      Appearance colour = clothe[0];
      if (k >= shade) colour.lightness -= static_cast<float>(darker), colour.b -= 8;
      show(1, 100 + speed * k, 200, colour);
      if (i % 2 == 0 && k >= meets_at && k < meets_at + 6) {
        tracks.back().provenance = Provenance::predicted;
        tracks.back().observation.reset();
        clothes.pop_back();
      }
      for (int other = 1; other < 6; ++other) show(1 + other, 100 + 150.0 * other, 600, clothe[static_cast<std::size_t>(other)]);
      if (i % 2 == 1) show(7, 100 + speed * meets_at + 5.0 * (meets_at - k), 206, clothe[6]);
      log.add(k, timestamp_from_seconds(k / kFrameRate), tracks, clothes);
    }
    std::set<int> numbers;
    for (const TrackRow& row : join(log)) {
      if (row.first_id == 1) numbers.insert(row.id);
    }
    if (numbers.size() > 1) ++cut;
  }
  return cut;
}

TEST(Linker, LinksLonePersonDespiteLightChange) {
  EXPECT_EQ(cut_in_two_although_alone(100, 3300), 0) << "seeds 3300 to 3399";
}

TEST(Linker, LeavingPersonIsNotEnteringPerson) {
  TrackletLog log = record(90, [](int k) {
    std::vector<Shown> shown;
    if (k < 30) shown.push_back({1, 460 + 5.0 * k, 200, 0});
    if (k >= 55) shown.push_back({2, 607 - 5.0 * (k - 55), 200, 0});
    return shown;
  });
  TrackletLog again = log;
  std::set<int> with_view, without;
  for (const TrackRow& row : join(log, {.view = Box{0, 0, 625, 480}})) with_view.insert(row.id);
  for (const TrackRow& row : join(again)) without.insert(row.id);
  EXPECT_EQ(with_view.size(), 2U);
  EXPECT_EQ(without.size(), 1U) << "the scene must tempt: in mid image it would be one";
}

TEST(IdentityDoubt, CutsWhereBoxesOverlapAndNamesTheMeeting) {
  TrackletLog log = record(
      70, [](int k) { return std::vector<Shown>{{1, 100 + 5.0 * k, 200, 0}, {2, 460 - 5.0 * k, 203, 0}, {3, 300, 500, 0}}; });
  const auto pieces = cut_where_in_ambiguity(log.take_tracklets(), log);
  ASSERT_EQ(pieces.size(), 5U);
  for (const int first : {0, 2}) {
    EXPECT_FALSE(pieces[first].head_encounter);
    ASSERT_TRUE(pieces[first].tail_encounter);
    EXPECT_EQ(pieces[first].tail_encounter, pieces[first + 1].head_encounter);
    EXPECT_EQ(pieces[first].tail_encounter, pieces[0].tail_encounter) << "one meeting";
    EXPECT_TRUE(pieces[first].rows.back().ambiguous);
    EXPECT_FALSE(pieces[first].rows.front().ambiguous);
    EXPECT_EQ(pieces[first].rows.size() + pieces[first + 1].rows.size(), 70U) << "no row is lost";
  }
  EXPECT_EQ(pieces[4].rows.size(), 70U) << "no person came near the third";
}

}  // namespace
}  // namespace marey::track::offline
