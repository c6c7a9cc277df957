#include "marey/track/bramble/bramble_tracker.h"

#include <cmath>
#include <functional>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/filter/random_stream.h"
#include "marey/track/bramble/person_cylinder.h"

namespace marey::track::bramble {
namespace {

constexpr double kRate = 25;  // Hz

/// Faces along y (or, turned, along x) at the origin from 16 m, 6 m up.
GroundView view_from(bool rotated) {
  geometry::BrownLens lens;
  lens.focal = {620, 620};
  lens.principal = {319.5, 239.5};
  const double pitch = std::atan2(6, 16), c = std::cos(pitch), s = std::sin(pitch);
  Rigid3 pose;
  if (rotated) {
    pose.rotation << 0, 1, 0, s, 0, -c, -c, 0, -s;
  } else {
    pose.rotation << 1, 0, 0, 0, -s, -c, 0, c, -s;
  }
  pose.translation = {0, 0, std::hypot(16, 6)};
  return GroundView(Camera(lens, pose, {640, 480}));
}

/// What images of these people would say: nearly right everywhere, and noisy.
std::shared_ptr<const BlobEvidence> evidence_of(const GroundView& view, const std::vector<Vector<2>>& people,
                                                filter::RandomStream& random) {
  auto evidence = std::make_shared<BlobEvidence>();
  evidence->step = 5;
  evidence->origin = {2, 2};
  evidence->log_ratio.create(96, 128, CV_32FC1);
  for (float& value : cv::Mat_<float>(evidence->log_ratio)) value = static_cast<float>(-3 + 1.5 * random.normal_pair().first);
  for (const Vector<2>& location : people) {
    GridShape shape;
    cover(cylinder_outline(*view.camera(), {.foot = {location.x(), location.y(), 0}}), *evidence, shape);
    for (std::size_t i = 0; i < shape.rows.size(); ++i) {
      for (int x = shape.rows[i].begin; x < shape.rows[i].end; ++x)
        evidence->log_ratio.at<float>(shape.top + static_cast<int>(i), x) =
            static_cast<float>(2.5 + 1.5 * random.normal_pair().first);
    }
  }
  return evidence;
}

using People = std::map<int, Vector<2>>;
using Detected = std::map<int, Vector<2>>;

/// Runs `frames` instants of what `people` says; `look` is passed those reported, confirmed, by id.
void run(int frames, int cameras, const BrambleOptions& options, const std::function<std::vector<Vector<2>>(double)>& people,
         const std::function<void(int, const std::vector<Vector<2>>&, const Detected&)>& inspect) {
  std::vector<GroundView> views{view_from(false)};
  if (cameras == 2) views.push_back(view_from(true));
  BrambleTracker tracker(options, ground_views(views));
  filter::RandomStream random(5);
  for (int frame = 0; frame < frames; ++frame) {
    const std::vector<Vector<2>> truth = people(frame / kRate);
    const Timestamp now = timestamp_from_seconds(frame / kRate);
    std::vector<CameraEvidence> detected;
    for (int i = 0; i < cameras; ++i)
      detected.push_back({CameraId{i}, now, evidence_of(views[static_cast<std::size_t>(i)], truth, random)});
    Detected reported;
    for (const Track<2>& track : tracker.step(now, detected)) {
      if (track.confirmed) reported[number(track.id)] = track.position;
    }
    inspect(frame, truth, reported);
  }
}

/// The id of who is reported of within `reach` m of a place; 0: of no person.
int at(const Detected& reported, const Vector<2>& location, double reach = 0.8) {
  for (const auto& [id, where] : reported) {
    if ((where - location).norm() < reach) return id;
  }
  return 0;
}

TEST(BrambleTracker, FindsWhoIsThereAndKeepsThemApart) {
  const auto people = [](double t) { return std::vector<Vector<2>>{{-3 + 1.2 * t, 0}, {3 - 1.2 * t, 1.5}, {0.5 * t - 1, -3}}; };
  std::vector<std::set<int>> ids(3);
  int missed = 0, false_ones = 0;
  run(100, 1, {}, people, [&](int frame, const auto& truth, const Detected& reported) {
    if (frame < 15) return;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const int id = at(reported, truth[i]);
      missed += id == 0;
      if (id != 0) ids[i].insert(id);
    }
    false_ones += std::max<int>(0, static_cast<int>(reported.size()) - 3);
  });
  EXPECT_LE(missed, 5) << "of 255";
  EXPECT_LE(false_ones, 2);
  for (const std::set<int>& of_one : ids) EXPECT_EQ(of_one.size(), 1U);
}

TEST(BrambleTracker, PeopleArriveAndLeave) {
  const auto people = [](double t) {
    std::vector<Vector<2>> there{{-2, 0}};
    if (t > 1 && t < 3) there.push_back({2, 1});
    return there;
  };
  std::vector<std::size_t> told_at(100);
  run(100, 1, {}, people,
      [&](int frame, const auto&, const Detected& reported) { told_at[static_cast<std::size_t>(frame)] = reported.size(); });
  EXPECT_EQ(told_at[24], 1U);
  EXPECT_EQ(told_at[60], 2U);
  EXPECT_EQ(told_at[90], 1U);
}

TEST(BrambleTracker, AnEmptySceneHasNobody) {
  run(
      40, 1, {}, [](double) { return std::vector<Vector<2>>(); },
      [](int frame, const auto&, const Detected& reported) { EXPECT_TRUE(reported.empty()) << frame; });
}

TEST(BrambleTracker, AnotherCameraSeesWhoIsHidden) {
  // One stands right behind the other, seen along y.
  const auto people = [](double) { return std::vector<Vector<2>>{{0, -1}, {0, 0.6}}; };
  run(40, 2, {}, people, [](int frame, const auto& truth, const Detected& reported) {
    if (frame < 20) return;
    for (const Vector<2>& one : truth) EXPECT_NE(at(reported, one), 0) << frame;
  });
}

TEST(BrambleTracker, TheSameSeedGivesTheSame) {
  const auto people = [](double t) { return std::vector<Vector<2>>{{-1 + t, 0}, {1, 2 - t}}; };
  std::vector<Detected> first, second;
  BrambleOptions options;
  options.particles = 200;
  run(20, 1, options, people, [&](int, const auto&, const Detected& reported) { first.push_back(reported); });
  run(20, 1, options, people, [&](int, const auto&, const Detected& reported) { second.push_back(reported); });
  EXPECT_EQ(first, second);
}

TEST(BrambleTracker, RefusesWhatItCannotLookThrough) {
  Matrix<3> ground_from_image;
  ground_from_image << 0.1, 0, 0, 0, -0.1, 10, 0, 0, 1;
  EXPECT_THROW(BrambleTracker({}, ground_views({GroundView(ground_from_image, {100, 100})})), Error);
  BrambleOptions none;
  none.particles = 0;
  EXPECT_THROW(BrambleTracker(none, ground_views({view_from(false)})), Error);
}

}  // namespace
}  // namespace marey::track::bramble
