// People in a simulated room as several cameras' networks see them, and who they truly are.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "marey/reconstruct/keypoints/people_in_views.h"
#include "marey/reconstruct/keypoints/person_path.h"
#include "marey/simulate/room/room_keypoints.h"

namespace marey::pipeline::keypoints {

namespace rk = reconstruct::keypoints;

struct ObservedRoom {
  marey::simulate::room::RoomScene scene;
  const KeypointSet& set = marey::simulate::room::room_keypoint_set();
  std::vector<std::optional<Camera>> cameras;
  std::vector<KeypointSequence> detected;  // by camera
  std::map<int, rk::PersonTrack> tracks;
  std::int64_t views_observed = 0, views_located = 0;

  ObservedRoom(const marey::simulate::room::RoomOptions& options, const marey::simulate::room::KeypointErrors& errors)
      : scene(options) {
    for (int c = 0; c < options.cameras; ++c) {
      cameras.push_back(scene.rig().cameras[static_cast<std::size_t>(c)].camera());
      detected.push_back(marey::simulate::room::keypoints_of_camera(scene, c, errors));
    }
  }

  double step_s() const { return 1 / scene.options().rate_hz; }

  /// `camera_of` says whose calibration each camera is given.
  void run_tracker(double noise = 1.4, const std::vector<std::size_t>& camera_of = {}) {
    rk::PeopleInViews people(set, static_cast<int>(cameras.size()));
    for (std::size_t t = 0; t < static_cast<std::size_t>(scene.options().frames); ++t) {
      std::vector<rk::PersonView> views;
      for (std::size_t c = 0; c < cameras.size(); ++c) {
        for (std::size_t i = 0; i < detected[c].frames[t].size(); ++i)
          views.push_back(rk::view_of(*cameras[camera_of.empty() ? c : camera_of[c]], static_cast<int>(c), static_cast<int>(i),
                                      detected[c].frames[t][i], noise));
      }
      for (const rk::LocatedPerson& person : people.step(t == 0 ? 0 : step_s(), views)) {
        rk::PersonTrack& track = tracks[person.id];
        if (track.instants.empty()) track = {.id = person.id, .first = t, .instants = {}};
        track.instants.resize(t - track.first + 1);
        track.instants.back() = person;
      }
    }
    views_observed = people.views_observed();
    views_located = people.views_located();
  }

  rk::PersonPath path(rk::PersonTrack& track, double noise = 1.1) const {
    rk::PersonPathOptions how;
    how.noise = noise;
    const rk::FindKeypoints find = [this](std::size_t instant, int camera, int index) {
      return &detected[static_cast<std::size_t>(camera)].frames[instant][static_cast<std::size_t>(index)];
    };
    return rk::path_of(track, set, cameras, find, step_s(), how);
  }

  std::vector<std::vector<Vector<3>>> truth(std::size_t instant) const {
    return marey::simulate::room::true_keypoints(scene, static_cast<double>(instant) * step_s());
  }

  /// Who a placed person is: the actor whose points are nearest.
  int actor_of(const rk::LocatedPerson& person, std::size_t instant) const {
    const auto people = truth(instant);
    int nearest = -1;
    double minimum = 0;
    for (std::size_t a = 0; a < people.size(); ++a) {
      double sum = 0;
      for (std::size_t i = 0; i < person.points.size(); ++i) {
        if (person.points[i]) sum += std::min(1.0, (person.points[i]->position - people[a][i]).norm());
      }
      if (nearest >= 0 && sum >= minimum) continue;
      minimum = sum;
      nearest = static_cast<int>(a);
    }
    return nearest;
  }
};

}  // namespace marey::pipeline::keypoints
