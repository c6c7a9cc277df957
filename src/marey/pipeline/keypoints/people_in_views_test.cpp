#include <algorithm>
#include <bit>
#include <cmath>

#include <gtest/gtest.h>

#include "marey/pipeline/keypoints/observed_room_test.h"

namespace marey::pipeline::keypoints {
namespace {

using marey::simulate::room::KeypointErrors;
using marey::simulate::room::RoomMotion;
using marey::simulate::room::RoomOptions;

RoomOptions people_room(int actors, int cameras, std::int64_t frames, std::uint64_t seed) {
  RoomOptions options;
  options.motion = RoomMotion::walk;
  options.actors = actors;
  options.cameras = cameras;
  options.markers = 4;
  options.rate_hz = 50;
  options.frames = frames;
  options.image = {1080, 1920};
  options.volume = {2.8, 2.8, 2.5};
  options.zoom = 1.3;
  options.seed = seed;
  return options;
}

double mean_error_of(const ObservedRoom& room, rk::PersonTrack& track, const rk::PersonPath& path) {
  double sum = 0, count = 0;
  for (std::size_t k = 0; k < track.instants.size(); ++k) {
    const auto& person = track.instants[k];
    if (person.points.empty()) continue;
    const auto truth = room.truth(track.first + k)[static_cast<std::size_t>(room.actor_of(person, track.first + k))];
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (path.points[i].empty()) continue;
      sum += (path.points[i][k].position - truth[i]).norm();
      ++count;
    }
  }
  return sum / count;
}

TEST(PeopleInViews, PlacesExactKeypointsExactly) {
  KeypointErrors none{.bias_m = 0, .noise_px = 0, .outliers = 0, .missing = 0};
  ObservedRoom room(people_room(3, 4, 20, 1), none);
  room.run_tracker();
  ASSERT_EQ(room.tracks.size(), 3U);
  for (auto& [id, track] : room.tracks) {
    for (std::size_t k = 0; k < track.instants.size(); ++k) {
      const auto truth = room.truth(k)[static_cast<std::size_t>(room.actor_of(track.instants[k], k))];
      for (std::size_t i = 0; i < truth.size(); ++i) {
        ASSERT_TRUE(track.instants[k].points[i]);
        EXPECT_LT((track.instants[k].points[i]->position - truth[i]).norm(), 1e-4);
        EXPECT_GE(std::popcount(track.instants[k].points[i]->used), 2);
      }
    }
  }
}

TEST(PeopleInViews, KeepsPeopleApartWhoStandAMetreFromEachOther) {
  for (const int actors : {2, 4, 6}) {
    for (const std::uint64_t seed : {1U, 2U}) {
      SCOPED_TRACE(testing::Message() << actors << " people, seed " << seed);
      ObservedRoom room(people_room(actors, 4, 300, seed), {});
      room.run_tracker();
      ASSERT_EQ(static_cast<int>(room.tracks.size()), actors);
      for (const auto& [id, track] : room.tracks) {
        const int actor = room.actor_of(track.instants.front(), track.first);
        for (std::size_t k = 0; k < track.instants.size(); ++k) {
          if (track.instants[k].points.empty()) continue;
          EXPECT_EQ(room.actor_of(track.instants[k], track.first + k), actor);
        }
      }
      EXPECT_EQ(room.views_located, room.views_observed);
    }
  }
}

TEST(PeopleInViews, PlacesACrowd) {
  RoomOptions options = people_room(60, 5, 8, 5);
  options.volume = {14, 14, 2.5};
  ObservedRoom room(options, {});
  room.run_tracker();
  std::vector<int> placed(60, 0);
  int instants = 0;
  for (const auto& [id, track] : room.tracks) {
    for (std::size_t k = 0; k < track.instants.size(); ++k) {
      if (track.instants[k].points.empty()) continue;
      ++instants;
      ++placed[static_cast<std::size_t>(room.actor_of(track.instants[k], track.first + k))];
    }
  }
  EXPECT_GT(std::count_if(placed.begin(), placed.end(), [](int count) { return count >= 7; }), 48);
  EXPECT_LT(instants, 8 * 60 * 1.1) << "few who are put together of two people's views";
}

TEST(PeopleInViews, TakesNobodyTwiceInACamera) {
  ObservedRoom room(people_room(6, 5, 40, 3), {});
  room.run_tracker();
  for (std::size_t t = 0; t < 40; ++t) {
    for (std::size_t c = 0; c < 5; ++c) {
      std::vector<int> taken;
      for (const auto& [id, track] : room.tracks) {
        if (t < track.first || t >= track.first + track.instants.size() || track.instants[t - track.first].views.empty()) continue;
        const int view = track.instants[t - track.first].views[c];
        if (view < 0) continue;
        EXPECT_EQ(std::count(taken.begin(), taken.end(), view), 0);
        taken.push_back(view);
      }
    }
  }
}

TEST(PeopleInViews, PlacesNobodyWhereEachCameraSeesAnother) {
  ObservedRoom room(people_room(2, 2, 40, 4), {});
  for (auto& frame : room.detected[0].frames) frame.resize(std::min<std::size_t>(frame.size(), 1));
  // The other camera's image is turned upside down: nothing there is what the first one sees.
  for (auto& frame : room.detected[1].frames) {
    for (auto& person : frame) {
      for (auto& point : person.points) {
        if (point) point->position.y() = 1919 - point->position.y();
      }
    }
  }
  room.run_tracker();
  EXPECT_TRUE(room.tracks.empty());
}

TEST(PersonPath, IsNearerThanTheNoiseOfSingleInstants) {
  ObservedRoom room(people_room(1, 4, 250, 5), {});
  room.run_tracker();
  ASSERT_EQ(room.tracks.size(), 1U);
  rk::PersonTrack& track = room.tracks.begin()->second;
  const rk::PersonPath path = room.path(track);
  EXPECT_LT(mean_error_of(room, track, path), 0.022);
}

TEST(PersonPath, ReadsExchangedLimbsTheOtherWayRound) {
  KeypointErrors errors;
  errors.swapped = 0.1;
  ObservedRoom room(people_room(1, 4, 400, 6), errors);
  room.run_tracker();
  ASSERT_EQ(room.tracks.size(), 1U);
  rk::PersonTrack& track = room.tracks.begin()->second;
  const rk::PersonPath path = room.path(track);
  EXPECT_LT(mean_error_of(room, track, path), 0.025);
  std::int64_t wrong = 0, all = 0;
  for (std::size_t k = 0; k < track.instants.size(); ++k) {
    const auto truth = room.truth(track.first + k)[0];
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const auto other = static_cast<std::size_t>(room.set.mirrored[i]);
      const double distance = (path.points[i][k].position - truth[i]).norm();
      ++all;
      wrong += distance > 0.1 && (path.points[i][k].position - truth[other]).norm() < distance ? 1 : 0;
    }
  }
  EXPECT_LT(static_cast<double>(wrong), 0.01 * static_cast<double>(all));
}

}  // namespace
}  // namespace marey::pipeline::keypoints
