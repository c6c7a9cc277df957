#include "marey/pipeline/keypoints/keypoints_in_space.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/keypoints/keypoint_file.h"
#include "marey/format/rig/imported_rig.h"
#include "marey/pipeline/corridor/feed.h"
#include "marey/pipeline/keypoints/keypoint_frames.h"
#include "marey/simulate/room/room_keypoints.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::pipeline::keypoints {
namespace {

using marey::simulate::room::KeypointErrors;
using marey::simulate::room::RoomOptions;
using marey::simulate::room::RoomScene;

RoomOptions recorded_room(int actors) {
  RoomOptions options;
  options.cameras = 4;
  options.actors = actors;
  options.markers = 4;
  options.rate_hz = 50;
  options.frames = 150;
  options.image = {1080, 1920};
  options.zoom = 1.3;
  return options;
}

/// A room's keypoints as files, and its rig that names them.
class KeypointsInSpace : public ::testing::Test {
 protected:
  Rig rig_of(const RoomScene& scene, const KeypointErrors& errors = {}) {
    Rig rig = scene.rig();
    for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
      RigCamera& camera = rig.cameras[c];
      camera.source = folder_ / (camera.name + ".json");
      sequences_.push_back(marey::simulate::room::keypoints_of_camera(scene, static_cast<int>(c), errors));
      format::keypoints::write_coco_keypoints(sequences_.back(), camera.source);
    }
    return rig;
  }
  void write(const Rig& rig, std::size_t camera) {
    format::keypoints::write_coco_keypoints(sequences_[camera], rig.cameras[camera].source);
  }
  std::string error_of(const Rig& rig, const KeypointsInSpaceOptions& options = {}) {
    try {
      KeypointsSummary summary;
      keypoints_in_space(rig, options, summary);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  test::TemporaryFolder folder_;
  std::vector<KeypointSequence> sequences_;
};

TEST_F(KeypointsInSpace, AreTracksUnderTheirNames) {
  const RoomScene scene(recorded_room(1));
  KeypointsSummary summary;
  const Recording recording = keypoints_in_space(rig_of(scene), {}, summary);
  EXPECT_EQ(recording.tracks().size(), 25U);
  EXPECT_EQ(summary.set, "body_25b");
  EXPECT_EQ(summary.people.size(), 1U);
  EXPECT_TRUE(summary.warnings.empty()) << summary.warnings.front();
  double sum = 0, count = 0;
  const KeypointSet& set = marey::simulate::room::room_keypoint_set();
  for (const TrackColumns& track : recording.tracks()) {
    const auto point = std::find(set.points.begin(), set.points.end(), track.name.label) - set.points.begin();
    ASSERT_LT(point, 25);
    for (std::size_t row = 0; row < track.size(); ++row) {
      const auto truth =
          marey::simulate::room::true_keypoints(scene, recording.seconds_at(static_cast<std::size_t>(track.at()[row])))[0];
      sum += (track.position(row) - truth[static_cast<std::size_t>(point)]).norm();
      ++count;
      EXPECT_TRUE(track.column(TrackColumns::Optional::covariance).known(row));
    }
  }
  EXPECT_GT(count, 0.95 * 25 * 150);
  EXPECT_LT(sum / count, 0.022);
}

TEST_F(KeypointsInSpace, AreFoundInVideosByTheGivenSearch) {
  RoomOptions small = recorded_room(1);
  small.image = {108, 192};
  const RoomScene scene(small);
  const KeypointErrors errors{.noise_px = 0.8, .outlier_px = 6};
  Rig rig = scene.rig();
  for (RigCamera& camera : rig.cameras) {
    camera.source = folder_ / (camera.name + ".mp4");
    test::ffmpeg("-f lavfi -i color=size=108x192:rate=50:duration=2 -pix_fmt yuv420p " + camera.source);
  }
  std::vector<std::string> searched;
  KeypointsInSpaceOptions options;
  options.find = [&](const RigCamera& camera, const Hooks&) {
    searched.push_back(camera.name);
    corridor::Feed feed(camera, CameraId{});
    std::size_t frames = 0;
    while (feed.next()) ++frames;
    const auto number = static_cast<int>(
        std::find_if(rig.cameras.begin(), rig.cameras.end(), [&](const RigCamera& one) { return one.name == camera.name; }) -
        rig.cameras.begin());
    KeypointSequence sequence = marey::simulate::room::keypoints_of_camera(scene, number, errors);
    sequence.frames.resize(frames);
    sequence.from = camera.source;
    sequence.size = feed.info().size;
    sequence.rate_hz = feed.rate_hz();
    return sequence;
  };
  KeypointsSummary summary;
  const Recording recording = keypoints_in_space(rig, options, summary);
  EXPECT_EQ(searched, (std::vector<std::string>{"cam1", "cam2", "cam3", "cam4"}));
  EXPECT_EQ(summary.frames, 100);
  EXPECT_EQ(summary.rate_hz, 50);
  ASSERT_EQ(summary.people.size(), 1U);
  EXPECT_GT(summary.measured, 20 * 100);

  KeypointsInSpaceOptions none;
  none.find = [&](const RigCamera& camera, const Hooks&) {
    KeypointSequence no_person;
    no_person.set = marey::simulate::room::room_keypoint_set();
    no_person.frames.resize(10);
    no_person.from = camera.source;
    return no_person;
  };
  EXPECT_NE(error_of(rig, none).find("no person is placed"), std::string::npos) << "videos without people";
}

TEST_F(KeypointsInSpace, OfOneCameraStandOnTheFloorAndSaySo) {
  const RoomScene scene(recorded_room(1));
  Rig rig = rig_of(scene);
  rig.cameras.resize(1);
  KeypointsSummary summary;
  const Recording recording = keypoints_in_space(rig, {}, summary);
  EXPECT_TRUE(summary.one_camera);
  ASSERT_EQ(summary.warnings.size(), 1U);
  EXPECT_NE(summary.warnings[0].find("feet meet the floor"), std::string::npos);
  EXPECT_TRUE(recording.header.made_by.options.contains("positions"));
  double sum = 0, count = 0;
  for (const TrackColumns& track : recording.tracks()) {
    if (!track.name.label.ends_with("_hip")) continue;
    const auto& set = marey::simulate::room::room_keypoint_set();
    const auto point = std::find(set.points.begin(), set.points.end(), track.name.label) - set.points.begin();
    for (std::size_t row = 0; row < track.size(); ++row) {
      const auto truth =
          marey::simulate::room::true_keypoints(scene, recording.seconds_at(static_cast<std::size_t>(track.at()[row])))[0];
      sum += (track.position(row) - truth[static_cast<std::size_t>(point)]).norm();
      ++count;
    }
  }
  EXPECT_GT(count, 150);
  EXPECT_LT(sum / count, 0.3) << "m";
}

TEST_F(KeypointsInSpace, OfSeveralPeopleBearTheirNumber) {
  const RoomScene scene(recorded_room(3));
  KeypointsSummary summary;
  const Rig rig = rig_of(scene);
  const Recording recording = keypoints_in_space(rig, {}, summary);
  EXPECT_EQ(recording.tracks().size(), 75U);
  EXPECT_EQ(recording.tracks()[25].name.label.substr(0, 3), "P2:");
  KeypointsSummary again;
  KeypointsInSpaceOptions one;
  one.people = 1;
  EXPECT_EQ(keypoints_in_space(rig, one, again).tracks().size(), 25U);
}

TEST_F(KeypointsInSpace, FindOffsetsWhereTheRigHasNone) {
  RoomOptions options = recorded_room(1);
  options.offset_s = 0.15;
  options.frames = 300;
  const RoomScene scene(options);
  Rig rig = rig_of(scene);
  for (RigCamera& camera : rig.cameras) camera.offset_s.reset();
  KeypointsSummary summary;
  keypoints_in_space(rig, {}, summary);
  for (std::size_t c = 1; c < 4; ++c) {
    ASSERT_TRUE(summary.cameras[c].offset_s);
    EXPECT_NEAR(*summary.cameras[c].offset_s, *scene.rig().cameras[c].offset_s, 0.01);
  }
}

TEST_F(KeypointsInSpace, SayWhichCamerasAreExchanged) {
  const RoomScene scene(recorded_room(1));
  Rig rig = rig_of(scene);
  std::swap(rig.cameras[0].source, rig.cameras[1].source);
  KeypointsSummary summary;
  std::string stated;
  try {
    keypoints_in_space(rig, {}, summary);
    for (const std::string& warning : summary.warnings) stated += warning;
  } catch (const Error& error) {
    stated = error.what();
  }
  EXPECT_NE(stated.find("\"cam1\" and \"cam2\" exchanged"), std::string::npos) << stated;
}

TEST_F(KeypointsInSpace, SayWhichCameraIsMirrored) {
  const RoomScene scene(recorded_room(1));
  const Rig rig = rig_of(scene);
  for (auto& frame : sequences_[2].frames) {
    for (auto& person : frame) {
      Keypoints<2> other = person;
      for (std::size_t i = 0; i < 25; ++i) {
        other.points[i] = person.points[static_cast<std::size_t>(sequences_[2].set.mirrored[i])];
        if (other.points[i]) other.points[i]->position.x() = 1079 - other.points[i]->position.x();
      }
      person = other;
    }
  }
  write(rig, 2);
  KeypointsSummary summary;
  keypoints_in_space(rig, {}, summary);
  std::string stated;
  for (const std::string& warning : summary.warnings) stated += warning + "\n";
  EXPECT_NE(stated.find("images of \"cam3\" mirrored"), std::string::npos) << stated;
}

TEST_F(KeypointsInSpace, AreRefusedInOneSentence) {
  const RoomScene scene(recorded_room(1));
  Rig rig = rig_of(scene);
  Rig one = rig;
  for (std::size_t c = 1; c < 4; ++c) one.cameras[c].source.clear();
  EXPECT_NE(error_of(one).find("only one calibrated camera"), std::string::npos);
  Rig other = rig;
  other.cameras[1].source = folder_ / "coco.json";
  sequences_[1].set.points.resize(17);
  for (auto& frame : sequences_[1].frames) {
    for (auto& person : frame) person.points.resize(17);
  }
  format::keypoints::write_coco_keypoints(sequences_[1], other.cameras[1].source);
  EXPECT_NE(error_of(other).find("all cameras must have one set"), std::string::npos);
  Rig video = rig;
  video.cameras[0].source = folder_ / "cam1.mp4";
  EXPECT_NE(error_of(video).find("cam1.mp4: no such file, for camera"), std::string::npos);
  std::ofstream(folder_ / "cam1.mp4") << "a video\n";
  EXPECT_NE(error_of(video).find("needs a video, or keypoints"), std::string::npos);
}

TEST_F(KeypointsInSpace, GoOnWithoutACameraThatEnds) {
  const RoomScene scene(recorded_room(1));
  const Rig rig = rig_of(scene);
  sequences_[3].frames.resize(60);
  write(rig, 3);
  KeypointsSummary summary;
  keypoints_in_space(rig, {}, summary);
  EXPECT_EQ(summary.frames, 150);
  ASSERT_EQ(summary.warnings.size(), 1U);
  EXPECT_NE(summary.warnings[0].find("has 60 frames"), std::string::npos);
}

TEST(KeypointFrames, AreBlendedPersonByPerson) {
  const auto person_at = [](double x) {
    Keypoints<2> person;
    for (int i = 0; i < 4; ++i) person.points.push_back(Keypoint<2>{.position = {x + 10 * i, 20.0 * i}});
    return person;
  };
  const auto people = between_frames({person_at(0), person_at(500)}, {person_at(504), person_at(4)}, 0.25);
  ASSERT_EQ(people.size(), 2U);
  EXPECT_NEAR(people[0].points[0]->position.x(), 1, 1e-9);
  EXPECT_NEAR(people[1].points[0]->position.x(), 501, 1e-9);
  EXPECT_EQ(between_frames({person_at(0)}, {}, 0.25).size(), 1U) << "the nearer frame has it";
  EXPECT_TRUE(between_frames({person_at(0)}, {}, 0.75).empty());
}

TEST(KeypointsOfRealCameras, HaveSteadierBonesThanThePeers) {
  const std::string folder = test::data("markerless");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not here";
  Rig rig = format::rig::read_qualisys_rig(folder + "/calibration/Calib.qca.txt");
  for (RigCamera& camera : rig.cameras) camera.source = folder + "/peer_2d/" + camera.name + "_json";
  KeypointsSummary summary;
  KeypointsInSpaceOptions options;
  options.rate_hz = 60;
  options.people = 1;
  options.find_offsets = false;
  const Recording recording = keypoints_in_space(rig, options, summary);
  const auto track_of = [&](const char* label) {
    for (const TrackColumns& track : recording.tracks()) {
      if (track.name.label == label) return &track;
    }
    return static_cast<const TrackColumns*>(nullptr);
  };
  // Standard deviations of Pose2Sim's bones on the same 2-D points, mm: raw and low-passed.
  struct Bone {
    const char *from, *to;
    double raw, filtered;
  };
  int steadier = 0;
  for (const Bone& bone : {Bone{"left_hip", "left_knee", 20.5, 17.7}, Bone{"right_hip", "right_knee", 15.6, 12.0},
                           Bone{"left_knee", "left_ankle", 37.0, 35.8}, Bone{"right_knee", "right_ankle", 28.7, 22.1},
                           Bone{"left_shoulder", "left_elbow", 19.3, 17.7}, Bone{"right_shoulder", "right_elbow", 13.6, 10.8},
                           Bone{"left_elbow", "left_wrist", 17.8, 11.8}, Bone{"right_elbow", "right_wrist", 24.9, 18.9}}) {
    double sum = 0, squares = 0, count = 0;
    const TrackColumns *from = track_of(bone.from), *to = track_of(bone.to);
    ASSERT_NE(from, nullptr);
    ASSERT_NE(to, nullptr);
    for (std::int32_t t = 0; t < 100; ++t) {
      const auto a = from->row_at(t), b = to->row_at(t);
      if (!a || !b) continue;
      const double length = 1000 * (from->position(*a) - to->position(*b)).norm();
      sum += length;
      squares += length * length;
      ++count;
    }
    const double deviation = std::sqrt(squares / count - sum / count * (sum / count));
    EXPECT_GT(count, 90);
    EXPECT_LT(deviation, bone.raw) << bone.from;
    steadier += deviation < bone.filtered ? 1 : 0;
  }
  EXPECT_GE(steadier, 6);
}

}  // namespace
}  // namespace marey::pipeline::keypoints
