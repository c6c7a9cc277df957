// The live stage in a simulated room, its networks replaced by what they would see: no model and no data are needed.
#include "marey/pipeline/keypoints/keypoints_live.h"

#include <bit>
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/core/keypoint_sets.h"
#include "marey/simulate/room/room_keypoints.h"

namespace marey::pipeline::keypoints {
namespace {

using marey::simulate::room::KeypointErrors;
using marey::simulate::room::RoomMotion;
using marey::simulate::room::RoomOptions;
using marey::simulate::room::RoomScene;

constexpr double kRate = 25;

RoomOptions small_room(int actors, std::int64_t frames, std::uint64_t seed) {
  RoomOptions options;
  options.motion = RoomMotion::walk;
  options.actors = actors;
  options.cameras = 4;
  options.markers = 4;
  options.rate_hz = kRate;
  options.frames = frames;
  options.image = {1080, 1920};
  options.volume = {2.8, 2.8, 2.5};
  options.zoom = 1.3;
  options.seed = seed;
  return options;
}

/// An image that only says which camera and frame it is of.
Image numbered(int camera, std::int64_t frame) {
  cv::Mat luma(1, 8, CV_16UC1, cv::Scalar(0));
  luma.at<std::uint16_t>(0, 0) = static_cast<std::uint16_t>(camera);
  luma.at<std::uint16_t>(0, 1) = static_cast<std::uint16_t>(frame);
  return Image(luma);
}

struct Body2D {
  Keypoints<2> points;
  Box hull;
  Vector<2> hips, rim;
};

/// A room of people whose networks make the errors of `errors`; hidden are the frames in which no camera sees a person.
struct LiveRoom {
  RoomScene scene;
  KeypointErrors errors;
  std::vector<int> detected_in{0, 1, 2, 3};  // cameras whose people the detector finds
  std::int64_t hidden_from = -1, hidden_to = -1;
  std::vector<std::size_t> image_of{0, 1, 2, 3};  // which camera's images each one delivers

  LiveRoom(const RoomOptions& options, KeypointErrors given) : scene(options), errors(given) { errors.missing = 0; }

  std::vector<Body2D> bodies(const Image& image) const {
    const int camera = image.luma().at<std::uint16_t>(0, 0);
    const std::int64_t frame = image.luma().at<std::uint16_t>(0, 1);
    std::vector<Body2D> bodies;
    if (frame >= hidden_from && frame < hidden_to) return bodies;
    for (Keypoints<2>& person :
         keypoints_observed(scene, camera, static_cast<double>(frame) / kRate, static_cast<std::uint64_t>(frame), errors)) {
      Vector<2> low = Vector<2>::Constant(1e9), high = -low, hips = Vector<2>::Zero();
      for (const auto& point : person.points) {
        if (point) low = low.cwiseMin(point->position), high = high.cwiseMax(point->position);
      }
      int count = 0;
      for (const char* hip : {"left_hip", "right_hip"}) {
        const auto& point = person.points[static_cast<std::size_t>(*point_named(marey::simulate::room::room_keypoint_set(), hip))];
        if (point) hips += point->position, ++count;
      }
      if (count == 0) continue;
      hips /= count;
      bodies.push_back({std::move(person),
                        {low.x(), low.y(), high.x() - low.x(), high.y() - low.y()},
                        hips,
                        Vector<2>(hips.x(), hips.y() - (high.y() - low.y()) / 2)});
    }
    return bodies;
  }

  KeypointsLiveOptions options() const {
    KeypointsLiveOptions options;
    options.set = marey::simulate::room::room_keypoint_set();
    options.find_people = [this](const Image& image) {
      std::vector<Box> boxes;
      if (std::count(detected_in.begin(), detected_in.end(), image.luma().at<std::uint16_t>(0, 0)) == 0) return boxes;
      for (const Body2D& body : bodies(image)) boxes.push_back(body.hull);
      return boxes;
    };
    options.find_bodies = [this](std::span<const detect::keypoints::ImageRegion> searched) {
      std::vector<detect::keypoints::Body> found;
      for (const detect::keypoints::ImageRegion& crop : searched) {
        const std::vector<Body2D> all = bodies(crop.image);
        detect::keypoints::Body body;
        body.keypoints.points.resize(marey::simulate::room::room_keypoint_set().points.size());
        body.keypoints.presence = 0;
        double nearest = crop.region.side / 2;
        for (const Body2D& one : all) {
          const double distance = (one.hips - crop.region.centre).norm();
          if (distance >= nearest) continue;
          nearest = distance;
          body.keypoints = one.points;
          body.next = detect::keypoints::region_of(one.hips, one.rim);
        }
        found.push_back(std::move(body));
      }
      return found;
    };
    return options;
  }

  FrameSet frames(std::int64_t index, const std::vector<int>& without = {}) const {
    FrameSet set;
    set.index = index;
    set.time = timestamp_from_seconds(static_cast<double>(index) / kRate);
    for (int c = 0; c < 4; ++c) {
      set.states.push_back(FeedState::live);
      if (std::count(without.begin(), without.end(), c) > 0) {
        set.cameras.emplace_back();
        continue;
      }
      CameraFrame frame;
      frame.frame = {CameraId{c}, index, set.time, numbered(static_cast<int>(image_of[static_cast<std::size_t>(c)]), index)};
      set.cameras.emplace_back(std::move(frame));
    }
    return set;
  }
};

/// Where each person's points are, by "P1" and so on.
std::map<std::string, std::vector<std::pair<std::size_t, Vector<3>>>> people_of(const Instant& instant,
                                                                                std::map<TrackId, std::string>& labels) {
  for (const TrackName& track : instant.named) labels[track.id] = track.label;
  const KeypointSet& set = marey::simulate::room::room_keypoint_set();
  std::map<std::string, std::vector<std::pair<std::size_t, Vector<3>>>> people;
  for (const Sample& sample : instant.samples) {
    const std::string& label = labels.at(sample.track);
    const std::size_t colon = label.find(':');
    people[label.substr(0, colon)].emplace_back(static_cast<std::size_t>(*point_named(set, label.substr(colon + 1))),
                                                sample.position);
  }
  return people;
}

/// The actor whose points are nearest, and the mean distance to them, m.
std::pair<int, double> nearest_actor(const RoomScene& scene, double time_s,
                                     const std::vector<std::pair<std::size_t, Vector<3>>>& points) {
  std::pair<int, double> nearest{-1, 1e9};
  const auto truth = true_keypoints(scene, time_s);
  for (std::size_t a = 0; a < truth.size(); ++a) {
    double sum = 0;
    for (const auto& [i, location] : points) sum += (location - truth[a][i]).norm() / static_cast<double>(points.size());
    if (sum < nearest.second) nearest = {static_cast<int>(a), sum};
  }
  return nearest;
}

TEST(KeypointsLive, KeepsEverybodysNumberAndRarelyRunsTheDetector) {
  LiveRoom room(small_room(3, 150, 1), {});
  const auto stage = keypoints_live(room.scene.rig(), kRate, room.options());
  std::map<TrackId, std::string> labels;
  std::map<std::string, int> actor_of;
  double sum = 0, count = 0;
  for (std::int64_t k = 0; k < 150; ++k) {
    const auto instants = stage->step(room.frames(k));
    ASSERT_EQ(instants.size(), 1U);
    const auto people = people_of(instants[0], labels);
    if (k < 25) continue;
    EXPECT_EQ(people.size(), 3U) << k;
    for (const auto& [name, points] : people) {
      const auto [actor, error] = nearest_actor(room.scene, static_cast<double>(k) / kRate, points);
      const auto [known, is_new] = actor_of.emplace(name, actor);
      EXPECT_EQ(known->second, actor) << name << " at " << k;
      sum += error, ++count;
    }
  }
  EXPECT_LT(sum / count, 0.035) << "m, with a network's bias of 20 mm and noise of 8 px";
  corridor::Summary summary;
  stage->report(summary);
  EXPECT_LE(summary.body_points.value().person_searches, 4 + 4 * 6 / 2 + 4) << "in 4 cameras and 6 s";
  EXPECT_EQ(summary.body_points.value().people, 3);
  EXPECT_TRUE(summary.warnings.empty()) << summary.warnings.front();
}

TEST(KeypointsLive, LooksForAPersonWhereOtherCamerasSeeThem) {
  LiveRoom room(small_room(1, 50, 2), {});
  room.detected_in = {0, 1};
  const auto stage = keypoints_live(room.scene.rig(), kRate, room.options());
  CameraMask cameras = 0;
  for (std::int64_t k = 0; k < 50; ++k) {
    for (const Sample& sample : stage->step(room.frames(k))[0].samples) cameras |= sample.cameras;
  }
  EXPECT_EQ(cameras, 0b1111U) << "the detector found no person in cameras 3 and 4";
}

TEST(KeypointsLive, KeepsTheNumberOfAPersonThatReturns) {
  LiveRoom room(small_room(1, 200, 3), {});
  room.hidden_from = 60, room.hidden_to = 120;
  const auto stage = keypoints_live(room.scene.rig(), kRate, room.options());
  std::map<TrackId, std::string> labels;
  for (std::int64_t k = 0; k < 200; ++k) {
    const auto people = people_of(stage->step(room.frames(k))[0], labels);
    if (k > 10 && k < 60) {
      EXPECT_TRUE(people.size() == 1 && people.contains("P1")) << k;
    }
    if (k >= 60 + static_cast<std::int64_t>(0.3 * kRate) && k < 120) {
      EXPECT_TRUE(people.empty()) << k;
    }
    if (k >= 150) {
      EXPECT_TRUE(people.size() == 1 && people.contains("P1")) << k;
    }
  }
}

TEST(KeypointsLive, ACameraWithoutAFrameCostsOnlyItself) {
  LiveRoom room(small_room(1, 80, 4), {});
  const auto stage = keypoints_live(room.scene.rig(), kRate, room.options());
  std::map<TrackId, std::string> labels;
  for (std::int64_t k = 0; k < 80; ++k) {
    const std::vector<int> without = k < 30 ? std::vector<int>{} : k < 55 ? std::vector<int>{0} : std::vector<int>{1, 2};
    const Instant& instant = stage->step(room.frames(k, without))[0];
    const auto people = people_of(instant, labels);
    if (k < 20) continue;
    ASSERT_EQ(people.size(), 1U) << k;
    EXPECT_LT(nearest_actor(room.scene, static_cast<double>(k) / kRate, people.at("P1")).second, 0.1) << k;
    for (const Sample& sample : instant.samples) {
      for (const int camera : without) EXPECT_EQ(sample.cameras >> camera & 1U, 0U);
    }
  }
  corridor::Summary summary;
  stage->report(summary);
  EXPECT_EQ(summary.cameras[0].missed, 25);
}

TEST(KeypointsLive, SaysThatCamerasAreExchanged) {
  LiveRoom room(small_room(2, 150, 5), {});
  room.image_of = {0, 2, 1, 3};
  const auto stage = keypoints_live(room.scene.rig(), kRate, room.options());
  for (std::int64_t k = 0; k < 150; ++k) stage->step(room.frames(k));
  corridor::Summary summary;
  stage->report(summary);
  const bool stated = std::any_of(summary.warnings.begin(), summary.warnings.end(),
                                  [](const std::string& warning) { return warning.find("exchange them") != std::string::npos; });
  EXPECT_TRUE(stated) << summary.body_points.value().people_located << " of " << summary.body_points.value().people_in_images
                      << ", noise " << summary.body_points.value().noise;
}

TEST(KeypointsLive, SaysThatNoPersonWasSeen) {
  LiveRoom room(small_room(1, 20, 6), {});
  room.hidden_from = 0, room.hidden_to = 20;
  const auto stage = keypoints_live(room.scene.rig(), kRate, room.options());
  for (std::int64_t k = 0; k < 20; ++k) EXPECT_TRUE(stage->step(room.frames(k))[0].samples.empty());
  corridor::Summary summary;
  stage->report(summary);
  ASSERT_EQ(summary.warnings.size(), 1U);
  EXPECT_NE(summary.warnings[0].find("no person"), std::string::npos);
}

TEST(KeypointsLive, NeedsTwoCalibratedCameras) {
  LiveRoom room(small_room(1, 2, 7), {});
  Rig rig = room.scene.rig();
  rig.cameras.resize(1);
  EXPECT_THROW(keypoints_live(rig, kRate, room.options()), Error);
}

TEST(KeypointsLive, TracksAtMostSoManyPeople) {
  LiveRoom room(small_room(3, 60, 8), {});
  KeypointsLiveOptions options = room.options();
  options.people.maximum = 2;
  const auto stage = keypoints_live(room.scene.rig(), kRate, options);
  std::map<TrackId, std::string> labels;
  for (std::int64_t k = 0; k < 60; ++k) {
    const auto people = people_of(stage->step(room.frames(k))[0], labels);
    EXPECT_LE(people.size(), 2U);
    if (k > 20) {
      EXPECT_EQ(people.size(), 2U);
    }
  }
}

TEST(KeypointsLive, DoesNotSearchThoseWhoAreNotWanted) {
  LiveRoom room(small_room(3, 100, 8), {});
  KeypointsLiveOptions options = room.options();
  options.people.maximum = 1;
  std::size_t regions = 0;
  const FindBodies find = options.find_bodies;
  options.find_bodies = [&](std::span<const detect::keypoints::ImageRegion> searched) {
    regions += searched.size();
    return find(searched);
  };
  const auto stage = keypoints_live(room.scene.rig(), kRate, options);
  std::map<TrackId, std::string> labels;
  std::size_t settled = 0;
  for (std::int64_t k = 0; k < 100; ++k) {
    if (k == 50) settled = regions;
    const auto people = people_of(stage->step(room.frames(k))[0], labels);
    if (k > 20) {
      EXPECT_EQ(people.size(), 1U) << k;
    }
  }
  EXPECT_GT(settled, 50U * 4) << "three people at the beginning";
  EXPECT_LT(regions - settled, 50U * 4 + 10) << "then one in each camera";
}

}  // namespace
}  // namespace marey::pipeline::keypoints
