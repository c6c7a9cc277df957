#include "marey/pipeline/keypoints/keypoint_misfit.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "marey/reconstruct/keypoints/people_in_views.h"

namespace marey::pipeline::keypoints {
namespace {

constexpr std::size_t kTriedInstants = 60;
constexpr double kTriedNoise = 1.5;      // times what the files state
constexpr double kDistinctlyMore = 0.2;  // of all views, beyond those that are placed as things are
constexpr double kMajority = 0.6;        // of all views

/// One camera's calibration and whether its images are mirrored.
struct TriedCamera {
  std::optional<Camera> camera;
  bool mirrored = false;
};

Keypoints<2> mirrored(const Keypoints<2>& person, const KeypointSet& set, int width) {
  Keypoints<2> result = person;
  for (std::size_t i = 0; i < person.points.size(); ++i) {
    auto& point = result.points[i];
    point = person.points[static_cast<std::size_t>(set.mirrored[i])];
    if (point) point->position.x() = width - 1 - point->position.x();
  }
  return result;
}

struct Located {
  std::int64_t views = 0, located = 0;
};

/// How many people in images find a partner, each instant by itself.
Located located_with(const std::vector<TriedCamera>& cameras, const KeypointFrames& frames, const KeypointSet& set) {
  namespace rk = reconstruct::keypoints;
  constexpr double kCut_s = 10;
  rk::PeopleInViews people(set, static_cast<int>(cameras.size()));
  std::vector<rk::PersonView> views;
  for (std::size_t t = 0; t < frames.size(); t += std::max<std::size_t>(1, frames.size() / kTriedInstants)) {
    views.clear();
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      if (!cameras[c].camera) continue;
      int index = 0;
      for (const Keypoints<2>& person : frames.at(t, c)) {
        const auto& camera = *cameras[c].camera;
        views.push_back(rk::view_of(camera, static_cast<int>(c), index++,
                                    cameras[c].mirrored ? mirrored(person, set, camera.size().width) : person, kTriedNoise));
      }
    }
    people.step(kCut_s, views);
  }
  return {people.views_observed(), people.views_located()};
}

}  // namespace

std::vector<std::string> reasons_of_misfit(const Rig& rig, const KeypointFrames& frames, const KeypointSet& set) {
  std::vector<TriedCamera> cameras;
  for (const RigCamera& camera : rig.cameras) cameras.push_back({camera.camera()});
  const Located before = located_with(cameras, frames, set);
  const auto is_better = [&](const Located& located) {
    return static_cast<double>(located.located - before.located) > kDistinctlyMore * static_cast<double>(located.views) &&
           static_cast<double>(located.located) > kMajority * static_cast<double>(located.views);
  };
  std::vector<std::string> reasons;
  for (std::size_t a = 0; a < cameras.size(); ++a) {
    for (std::size_t b = a + 1; b < cameras.size(); ++b) {
      if (!cameras[a].camera || !cameras[b].camera) continue;
      std::swap(cameras[a], cameras[b]);
      if (is_better(located_with(cameras, frames, set)))
        reasons.push_back(
            fmt::format("with the keypoints of \"{}\" and \"{}\" exchanged the cameras see the same people: exchange them",
                        rig.cameras[a].name, rig.cameras[b].name));
      std::swap(cameras[a], cameras[b]);
    }
  }
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    if (!cameras[c].camera) continue;
    cameras[c].mirrored = true;
    if (is_better(located_with(cameras, frames, set)))
      reasons.push_back(fmt::format("with the images of \"{}\" mirrored the cameras see the same people: its video was mirrored",
                                    rig.cameras[c].name));
    cameras[c].mirrored = false;
  }
  return reasons;
}

}  // namespace marey::pipeline::keypoints
