// The messages where cameras and keypoints do not belong together.
#include "marey/pipeline/keypoints/keypoint_misfit.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/keypoints/keypoint_file.h"
#include "marey/geometry/camera.h"
#include "marey/geometry/rigid.h"
#include "marey/pipeline/keypoints/keypoints_in_space.h"
#include "marey/simulate/room/room_keypoints.h"

#include "support/files.h"

namespace marey::pipeline::keypoints {
namespace {

namespace room = marey::simulate::room;

/// The keypoints of a room's cameras, and its rig.
struct MisfitRoom {
  explicit MisfitRoom(int actors) : scene(options_of(actors)), rig(scene.rig()) {
    for (int c = 0; c < 4; ++c) detected.push_back(room::keypoints_of_camera(scene, c, {}));
  }

  static room::RoomOptions options_of(int actors) {
    room::RoomOptions options;
    options.cameras = 4;
    options.actors = actors;
    options.markers = 4;
    options.rate_hz = 50;
    options.frames = 150;
    options.image = {1080, 1920};
    options.zoom = 1.3;
    return options;
  }

  void rotate(std::size_t camera, const Vector<3>& axis, double angle) {
    Rigid3& pose = *rig.cameras[camera].camera_from_world;
    const Rigid3 by{Eigen::AngleAxisd(angle, axis).toRotationMatrix(), Vector<3>::Zero()};
    pose = by * pose;
  }

  /// All that is said, whether it ends well or not.
  std::string stated() {
    const test::TemporaryFolder folder;
    for (std::size_t c = 0; c < 4; ++c) {
      rig.cameras[c].source = folder / (rig.cameras[c].name + ".json");
      format::keypoints::write_coco_keypoints(detected[c], rig.cameras[c].source);
    }
    KeypointsSummary summary;
    std::string text;
    try {
      keypoints_in_space(rig, {}, summary);
    } catch (const Error& error) {
      text = error.what();
    }
    for (const std::string& warning : summary.warnings) text += warning + "\n";
    return text;
  }

  /// Of the people that a camera shows, the one who is `actor`.
  void keep_only(std::size_t camera, std::size_t actor) {
    const Camera view = *scene.rig().cameras[camera].camera();
    for (std::size_t t = 0; t < detected[camera].frames.size(); ++t) {
      const auto truth = room::true_keypoints(scene, static_cast<double>(t) / 50)[actor];
      std::vector<Keypoints<2>> kept;
      double nearest = 60;  // px, on average
      for (const Keypoints<2>& person : detected[camera].frames[t]) {
        double sum = 0, count = 0;
        for (std::size_t i = 0; i < truth.size(); ++i) {
          const auto pixel = view.project(truth[i]);
          if (!pixel || !person.points[i]) continue;
          sum += (*pixel - person.points[i]->position).norm(), ++count;
        }
        if (count == 0 || sum / count >= nearest) continue;
        nearest = sum / count;
        kept = {person};
      }
      detected[camera].frames[t] = std::move(kept);
    }
  }

  room::RoomScene scene;
  Rig rig;
  std::vector<KeypointSequence> detected;
};

TEST(KeypointMisfit, NothingIsSaidWhereAllFits) {
  EXPECT_EQ(MisfitRoom(1).stated(), "");
}

TEST(KeypointMisfit, ARigThatDoesNotFitIsSaid) {
  MisfitRoom room(1);
  for (std::size_t c = 0; c < 4; ++c) room.rotate(c, c < 2 ? Vector<3>::UnitX() : Vector<3>::UnitY(), c % 2 == 0 ? 0.06 : -0.06);
  const std::string stated = room.stated();
  EXPECT_NE(stated.find("the rig does not fit these keypoints: they lie "), std::string::npos) << stated;
}

TEST(KeypointMisfit, ACameraThatWasMovedIsNamed) {
  MisfitRoom room(1);
  room.rotate(1, Vector<3>::UnitY(), 0.06);
  const std::string stated = room.stated();
  EXPECT_NE(stated.find("camera \"cam2\": keypoints lie "), std::string::npos) << stated;
}

TEST(KeypointMisfit, AnotherResolutionIsSaid) {
  MisfitRoom room(1);
  for (KeypointSequence& camera : room.detected) {
    for (auto& frame : camera.frames) {
      for (auto& person : frame) {
        for (auto& point : person.points) {
          if (point) point->position *= 2;
        }
      }
    }
  }
  const std::string stated = room.stated();
  EXPECT_TRUE(stated.find("no person is placed") != std::string::npos || stated.find("does not fit") != std::string::npos)
      << stated;
}

TEST(KeypointMisfit, CamerasThatSeeDifferentPeopleAreSaid) {
  MisfitRoom room(4);
  for (std::size_t c = 0; c < 4; ++c) room.keep_only(c, c);
  const std::string stated = room.stated();
  EXPECT_TRUE(stated.find("see the same person") != std::string::npos ||
              stated.find("does not fit these keypoints") != std::string::npos)
      << stated;
}

}  // namespace
}  // namespace marey::pipeline::keypoints
