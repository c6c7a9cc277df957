#include "marey/simulate/room/room.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "marey/simulate/room/body.h"
#include "marey/simulate/room/room_video.h"
#include "marey/simulate/room/to_and_fro.h"

namespace marey::simulate::room {
namespace {

TEST(Room, BlobsLieWhereTheRigSeesTheirMarkers) {
  RoomOptions options;
  options.noise_px = 0.1;
  options.offset_s = 0.02;
  const RoomScene scene(options);
  double sum = 0;
  int count = 0, offset = 0;
  for (const std::int64_t index : {0, 77, 1199}) {
    const RoomFrame frame = scene.frame(index);
    ASSERT_EQ(frame.detected.size(), 8u);
    for (std::size_t c = 0; c < 8; ++c) {
      const RigCamera& camera = scene.rig().cameras[c];
      offset += camera.offset_s != 0;
      const auto points = scene.points(frame.time_s + *camera.offset_s);
      for (const RoomBlob& blob : frame.detected[c]) {
        sum += (blob.pixel - *camera.camera()->project(points[static_cast<std::size_t>(blob.marker.value())])).squaredNorm();
        ++count;
      }
    }
  }
  EXPECT_EQ(offset, 3 * 7);
  EXPECT_GT(count, 3 * 8 * 12) << "of 50 markers a camera sees a good part";
  EXPECT_LT(count, 3 * 8 * 40) << "the body hides the rest";
  EXPECT_NEAR(std::sqrt(sum / (2 * count)), 0.1, 0.008);
}

TEST(Room, EveryMotionIsSmoothAndStaysInTheVolume) {
  for (const NamedRoomMotion& motion : room_motions()) {
    RoomOptions options;
    options.motion = motion.motion;
    options.seed = 7;
    const RoomScene scene(options);
    EXPECT_EQ(scene.labels().size(), scene.points(0).size()) << motion.name;
    double fastest = 0;
    for (int i = 0; i < 2400; ++i) {
      const auto now = scene.points(i / 120.0), before = scene.points((i - 1) / 120.0);
      for (std::size_t m = 0; m < now.size(); ++m) {
        fastest = std::max(fastest, (now[m] - before[m]).norm() * 120);
        EXPECT_LE(std::abs(now[m].x()), 2.2) << motion.name;
        EXPECT_LE(std::abs(now[m].y()), 2.2) << motion.name;
        EXPECT_GE(now[m].z(), -0.01) << motion.name << " " << scene.labels()[m];
        EXPECT_LE(now[m].z(), 2.6) << motion.name;
      }
    }
    EXPECT_LT(fastest, motion.motion == RoomMotion::run ? 10 : 6) << motion.name << ": m/s";
    const bool moves = motion.motion != RoomMotion::still && motion.motion != RoomMotion::ground;
    EXPECT_EQ(fastest > 0.5, moves) << motion.name;
  }
}

TEST(Room, TheBodyHidesWhatIsBehindIt) {
  const BodyPose pose = standing_pose({0, 0, 0});
  EXPECT_TRUE(hidden_by_body(pose, {-0.5, 0, 1.2}, {4, 0, 1.2}));
  EXPECT_FALSE(hidden_by_body(pose, {0.5, 0, 1.2}, {4, 0, 1.2}));
  EXPECT_FALSE(hidden_by_body(pose, {-0.5, 0, 2.2}, {4, 0, 2.2}));
  // Slow twin: points along the line against points along each limb.
  Random random(5);
  int hidden = 0;
  for (int i = 0; i < 300; ++i) {
    const Vector<3> from(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0, 2));
    const Vector<3> to(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(0, 2));
    double depth = 1;  // m from the nearest capsule's surface
    for (std::size_t limb = 0; limb < kLimbs; ++limb) {
      for (int s = 0; s <= 300; ++s) {
        const Vector<3> location = from + (to - from) * s / 300.0;
        for (int t = 0; t <= 60; ++t) {
          depth = std::min(
              depth, (location - pose[limb] * Vector<3>(limb_shapes()[limb].end * t / 60)).norm() - limb_shapes()[limb].radius);
        }
      }
    }
    if (std::abs(depth) < 0.004) continue;  // closer than the twin's steps resolve
    EXPECT_EQ(hidden_by_body(pose, from, to), depth < 0) << i;
    hidden += depth < 0;
  }
  EXPECT_GT(hidden, 30);
}

TEST(Room, MarkersKeepTheirPlaceOnTheirLimb) {
  Random random(3);
  const auto markers = position_markers(60, random);
  for (const BodyMarker& marker : markers) {
    const LimbShape& limb = limb_shapes()[static_cast<std::size_t>(marker.limb)];
    const double along = marker.in_limb.dot(limb.end) / limb.end.squaredNorm();
    EXPECT_NEAR((marker.in_limb - along * limb.end).norm(), limb.radius + 0.008, 1e-12) << marker.label;
  }
}

TEST(Room, PeopleAreApartAndTheFirstIsTheSameAlone) {
  for (const RoomMotion motion : {RoomMotion::walk, RoomMotion::run, RoomMotion::kneel, RoomMotion::wave}) {
    RoomOptions alone;
    alone.motion = motion;
    alone.markers = 30;
    RoomOptions three = alone;
    three.actors = 3;
    three.props = 2;
    const RoomScene one(alone), many(three);
    ASSERT_EQ(many.labels().size(), 3 * 30u + 2 * 5);
    EXPECT_EQ(many.labels()[30].substr(0, 7), "actor2:");
    EXPECT_EQ(many.skeleton(1)->markers.front().label, many.labels()[30]);
    EXPECT_FALSE(many.skeleton(3));
    for (double t = 0; t < 20; t += 0.5) {
      if (motion == RoomMotion::walk) {
        EXPECT_NEAR((many.points(t)[7] - one.points(t)[7]).norm(), 0, 1e-12);
      }
      for (const auto& [a, b] : {std::pair{0, 1}, {1, 2}, {0, 2}}) {
        const Vector<3> between = many.segments(t, a)[0].translation - many.segments(t, b)[0].translation;
        EXPECT_GT(between.head<2>().norm(), 0.7) << t;
      }
      const auto poses = many.prop_poses(t);
      for (std::size_t p = 0; p < 2; ++p) {
        for (std::size_t m = 0; m < 5; ++m)
          EXPECT_NEAR((many.points(t)[90 + 5 * p + m] - poses[p] * many.props()[p].markers[m].position).norm(), 0, 1e-12);
      }
    }
  }
}

TEST(Room, CoordinatesArePosesOfTheSkeleton) {
  for (const NamedRoomMotion& motion : room_motions()) {
    RoomOptions options;
    options.motion = motion.motion;
    options.markers = 20;
    const RoomScene scene(options);
    const auto skeleton = scene.skeleton();
    if (!skeleton) continue;
    for (double t = 0; t < 12; t += 0.37) {
      const std::vector<double> coordinates = scene.coordinates(t);
      ASSERT_EQ(coordinates.size(), skeleton->coordinates.size());
      const auto reported = pose_of(*skeleton, coordinates);
      const auto segments = scene.segments(t);
      for (std::size_t s = 0; s < segments.size(); ++s) {
        EXPECT_NEAR((reported[s].translation - segments[s].translation).norm(), 0, 1e-9)
            << motion.name << " " << skeleton->segments[s].name;
        EXPECT_NEAR((reported[s].rotation - segments[s].rotation).norm(), 0, 1e-9)
            << motion.name << " " << skeleton->segments[s].name;
      }
    }
  }
}

TEST(Room, SkinCarriesMarkersMostWhereJointsBendMost) {
  RoomOptions options;
  options.motion = RoomMotion::kneel;
  RoomOptions soft = options;
  soft.skin_m = 0.03;
  const RoomScene bone(options), skin(soft);
  double thigh = 0, head = 0, standing = 0;
  for (double t = 0; t < 6; t += 0.05) {
    const auto on_bone = bone.points(t), on_skin = skin.points(t);
    for (std::size_t m = 0; m < on_bone.size(); ++m) {
      const double slid = (on_bone[m] - on_skin[m]).norm();
      if (bone.labels()[m].find("thigh") != std::string::npos) thigh = std::max(thigh, slid);
      if (bone.labels()[m].find("head") != std::string::npos) head = std::max(head, slid);
      if (t == 0) standing = std::max(standing, slid);
    }
  }
  EXPECT_NEAR(thigh, 0.03, 0.002);
  EXPECT_LT(head, 0.002);
  EXPECT_LT(standing, 0.02);
}

TEST(Room, DropsGhostsMergesAndGapsAreAsMany) {
  RoomOptions clean;
  clean.motion = RoomMotion::cloud;
  clean.markers = 200;
  clean.cameras = 2;
  RoomOptions dirty = clean;
  dirty.dropped = 0.2;
  dirty.ghosts = 0.1;
  RoomOptions merged = clean;
  merged.merge_px = 6;
  RoomOptions gaps = clean;
  gaps.gap_fraction = 0.1;
  const RoomScene a(clean), b(dirty), c(merged), d(gaps);
  double all = 0, kept = 0, ghosts = 0, joint = 0, joint_blobs = 0, covered = 0;
  for (std::int64_t i = 0; i < 3000; i += 30) {
    const RoomFrame clean_frame = a.frame(i), dirty_frame = b.frame(i), merged_frame = c.frame(i), gap_frame = d.frame(i);
    for (std::size_t camera = 0; camera < 2; ++camera) {
      all += static_cast<double>(clean_frame.detected[camera].size());
      for (const RoomBlob& blob : dirty_frame.detected[camera]) (blob.marker ? kept : ghosts) += 1;
      joint += static_cast<double>(merged_frame.detected[camera].size());
      joint_blobs += static_cast<double>(std::count_if(merged_frame.detected[camera].begin(), merged_frame.detected[camera].end(),
                                                       [](const RoomBlob& blob) { return blob.merged; }));
      covered += static_cast<double>(gap_frame.detected[camera].size());
      EXPECT_TRUE(std::is_sorted(dirty_frame.detected[camera].begin(), dirty_frame.detected[camera].end(),
                                 [](const RoomBlob& x, const RoomBlob& y) { return x.pixel.y() < y.pixel.y(); }));
    }
  }
  EXPECT_NEAR(kept / all, 0.8, 0.01);
  EXPECT_NEAR(ghosts / all, 0.1, 0.01);
  EXPECT_NEAR(covered / all, 0.9, 0.02);
  EXPECT_GT(joint_blobs, 0);
  EXPECT_LE(joint + joint_blobs, all) << "a joint blob stands for two or more";
}

TEST(Room, AFrameIsTheSameInAnyOrder) {
  RoomOptions options;
  options.dropped = options.ghosts = 0.1;
  const RoomScene one(options), two(options);
  one.frame(3);
  const RoomFrame a = one.frame(500), b = two.frame(500);
  for (std::size_t camera = 0; camera < a.detected.size(); ++camera) {
    ASSERT_EQ(a.detected[camera].size(), b.detected[camera].size());
    for (std::size_t i = 0; i < a.detected[camera].size(); ++i) EXPECT_EQ(a.detected[camera][i].pixel, b.detected[camera][i].pixel);
  }
  options.seed = 2;
  EXPECT_NE(RoomScene(options).rig().cameras[0].camera_from_world->translation,
            one.rig().cameras[0].camera_from_world->translation);
}

TEST(RoomVideo, SpotsOverAFieldOfNoiseAreThePicture) {
  RoomOptions options;
  options.motion = RoomMotion::cloud;  // spots that touch, and at the border
  options.markers = 300;
  options.image = {321, 240};
  options.cameras = 2;
  const RoomScene scene(options);
  for (const double noise : {0.0, 0.7}) {
    const RoomVideoOptions video{.image_noise = noise};
    const RoomSpots spots(scene, 1, video);
    for (const std::uint64_t i : {0u, 7u}) {
      const double time = static_cast<double>(i) / options.rate_hz;
      const std::vector<RoomBlob> detected = scene.observed_by(1, time, i);
      ASSERT_GT(detected.size(), 100u);
      const cv::Mat whole = draw_room(scene, 1, time, detected, i, video), together = spots.image(spots.draw(time, detected, i));
      ASSERT_EQ(together.size(), whole.size());
      EXPECT_LE(cv::norm(whole, together, cv::NORM_INF), 10 * noise);
      const double rms = cv::norm(whole, together, cv::NORM_L2) / std::sqrt(static_cast<double>(whole.total()));
      EXPECT_NEAR(rms, noise * std::sqrt(2.0), 0.2 * noise) << "the noise of both, and it is not the same";
    }
  }
}

TEST(RoomVideo, SpotsTakeAFiftiethOfThePicture) {
  RoomOptions options;
  const RoomScene scene(options);
  const RoomSpots spots(scene, 0);
  const RoomSpots::Drawn drawn = spots.draw(0, scene.observed_by(0, 0, 0), 0);
  EXPECT_LT(drawn.pixels.size() + drawn.locations.size() * sizeof(cv::Rect), static_cast<std::size_t>(options.image.area()) / 50);
}

TEST(ToAndFro, TurnsWithoutAJerk) {
  for (const double length : {0.3, 1.0, 2.0, 7.0}) {
    const double ramp = std::min(0.5, length / 2), step = 1e-3;
    EXPECT_EQ(to_and_fro(0, length), 0);
    EXPECT_NEAR(to_and_fro(length, length), length - ramp, 1e-9);
    EXPECT_NEAR(to_and_fro(2 * length, length), 0, 1e-9);
    double before = 0;
    for (double t = -length; t < 5 * length; t += step) {
      const double velocity = (to_and_fro(t + step, length) - to_and_fro(t, length)) / step;
      EXPECT_LE(std::abs(velocity), 1 + 1e-9);
      if (t > -length) {
        ASSERT_LE(std::abs(velocity - before), 1.01 * step / ramp) << length << " s, at " << t;
      }
      before = velocity;
    }
    EXPECT_NEAR(to_and_fro(1.3 * length, length), to_and_fro(0.7 * length, length), 1e-9) << "back as it came";
  }
}

TEST(Room, ABumpMovesOneCameraFromThenOn) {
  RoomOptions options;
  options.bump = RoomOptions::Bump{.camera = 2, .time_s = 1, .angle = 0.02};
  const RoomScene scene(options);
  for (std::size_t camera = 0; camera < 8; ++camera) {
    const Matrix<3> turn = scene.rig_at(1.0).cameras[camera].camera_from_world->rotation *
                           scene.rig_at(0.99).cameras[camera].camera_from_world->rotation.transpose();
    EXPECT_NEAR(geometry::angle_axis_of(turn).norm(), camera == 2 ? 0.02 : 0, 1e-9);
  }
}

}  // namespace
}  // namespace marey::simulate::room
