#include "marey/reconstruct/correspond.h"

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/reconstruct/room_test.h"

namespace marey::reconstruct {
namespace {

using room::Random;

/// What cameras see of markers at one instant, and which marker each blob is; −1 for a ghost.
struct Scene {
  std::vector<Camera> cameras;
  std::vector<Vector<3>> markers;
  std::vector<Observation<2>> detected;
  std::vector<int> owner;
  std::vector<int> views;  // by marker
};

struct SceneOptions {
  int cameras = 4, markers = 200;
  double dropped = 0.2, ghosts = 0.1, noise = 0.1;
};

void add_blob(Scene& scene, int camera, const Vector<2>& pixel, int owner) {
  Observation<2> blob;
  blob.value = pixel;
  blob.covariance.reset();
  blob.camera = CameraId{camera};
  scene.detected.push_back(blob);
  scene.owner.push_back(owner);
}

Scene make_scene(const SceneOptions& options, Random& random) {
  Scene scene;
  scene.cameras = room::cameras_round(options.cameras);
  for (int m = 0; m < options.markers; ++m) scene.markers.push_back(random.in_room());
  scene.views.assign(scene.markers.size(), 0);
  for (int c = 0; c < options.cameras; ++c) {
    for (int m = 0; m < options.markers; ++m) {
      const auto pixel = scene.cameras[c].project(scene.markers[m]);
      if (!pixel || !scene.cameras[c].in_image(*pixel) || random.chance(options.dropped)) continue;
      add_blob(scene, c, *pixel + random.gaussian_2d(options.noise), m);
      ++scene.views[m];
    }
    for (int g = 0; g < options.markers * options.ghosts; ++g) {
      add_blob(scene, c, {random.uniform(0, 1280), random.uniform(0, 1024)}, -1);
    }
  }
  return scene;
}

struct Score {
  int groups = 0, pure = 0, found = 0, to_find = 0;
};

void count(const Scene& scene, const Correspondences& result, Score& score) {
  std::set<int> found;
  for (const Located& located : result.points) {
    const int owner = scene.owner[located.detected.front()];
    const bool pure =
        owner >= 0 && std::all_of(located.detected.begin(), located.detected.end(), [&](int i) { return scene.owner[i] == owner; });
    ++score.groups;
    score.pure += pure;
    if (pure) found.insert(owner);
  }
  for (std::size_t m = 0; m < scene.markers.size(); ++m) score.to_find += scene.views[m] >= 3;
  for (const int m : found) score.found += scene.views[m] >= 3;
}

TEST(Correspond, FindsAndKeepsApartTwoHundredMarkers) {
  Random random(11);
  Score score;
  for (int i = 0; i < 20; ++i) {
    const Scene scene = make_scene({}, random);
    Corresponder corresponder(scene.cameras);
    count(scene, corresponder.match(scene.detected), score);
  }
  EXPECT_GE(score.pure, 0.998 * score.groups);
  EXPECT_GE(score.found, 0.995 * score.to_find);
}

TEST(Correspond, GivesEveryBlobAwayOnceAndCountsTheRest) {
  Random random(12);
  const Scene scene = make_scene({.cameras = 6, .markers = 80}, random);
  Corresponder corresponder(scene.cameras);
  const Correspondences& result = corresponder.match(scene.detected);
  std::set<int> used;
  const auto check = [&](const std::vector<Located>& points) {
    for (const Located& located : points) {
      std::set<int> cameras;
      for (const int i : located.detected) {
        EXPECT_TRUE(used.insert(i).second);
        EXPECT_TRUE(cameras.insert(number(scene.detected[i].camera)).second);
      }
      EXPECT_EQ(static_cast<int>(located.detected.size()), located.point.rays);
    }
  };
  check(result.points);
  check(result.by_two_rays);
  EXPECT_EQ(result.unexplained, static_cast<int>(scene.detected.size() - used.size()));
}

/// The slow and obvious twin: every choice of one blob or none of each camera, three at least, those of most rays first, then those
/// that fit best.
std::set<std::set<int>> exhaustively(const Scene& scene, const CorrespondOptions& options) {
  struct Group {
    std::set<int> blobs;
    double misfit;
  };
  std::vector<Group> groups;
  std::vector<std::vector<int>> of_camera(scene.cameras.size());
  for (int i = 0; i < std::ssize(scene.detected); ++i) of_camera[number(scene.detected[i].camera)].push_back(i);
  std::vector<int> chosen;
  const auto choose = [&](const auto& self, std::size_t camera) -> void {
    if (camera < scene.cameras.size()) {
      self(self, camera + 1);
      for (const int i : of_camera[camera]) {
        chosen.push_back(i);
        self(self, camera + 1);
        chosen.pop_back();
      }
      return;
    }
    if (chosen.size() < 3) return;
    std::vector<SightLine> lines;
    for (const int i : chosen) {
      const int c = number(scene.detected[i].camera);
      lines.push_back(sight_line(scene.cameras[c], c, scene.detected[i].value, options.noise_px).value());
    }
    TriangulateOptions all_or_nothing = options.triangulate;
    all_or_nothing.reject = false;
    const auto result = triangulate(lines, all_or_nothing);
    if (const auto* point = std::get_if<SpacePoint>(&result)) {
      groups.push_back({{chosen.begin(), chosen.end()}, point->chi_square / (2 * point->rays - 3)});
    }
  };
  choose(choose, 0);
  std::stable_sort(groups.begin(), groups.end(), [](const Group& p, const Group& q) {
    return p.blobs.size() != q.blobs.size() ? p.blobs.size() > q.blobs.size() : p.misfit < q.misfit;
  });
  std::set<int> taken;
  std::set<std::set<int>> result;
  for (const Group& group : groups) {
    if (std::any_of(group.blobs.begin(), group.blobs.end(), [&](int i) { return taken.contains(i); })) continue;
    taken.insert(group.blobs.begin(), group.blobs.end());
    result.insert(group.blobs);
  }
  return result;
}

TEST(Correspond, AgreesWithTryingEverything) {
  int same = 0, all = 0;
  for (std::uint64_t seed = 100; seed < 130; ++seed) {
    Random random(seed);
    const Scene scene = make_scene({.cameras = 4, .markers = 7, .ghosts = 0.3}, random);
    CorrespondOptions options;
    Corresponder corresponder(scene.cameras, options);
    std::set<std::set<int>> found;
    for (const Located& located : corresponder.match(scene.detected).points)
      found.insert({located.detected.begin(), located.detected.end()});
    const auto truth = exhaustively(scene, options);
    all += static_cast<int>(truth.size());
    for (const auto& group : truth) same += found.contains(group);
    EXPECT_LE(found.size(), truth.size() + 1) << "seed " << seed;
  }
  // The twin gates by chi-square alone, the matcher by the distance of two rays first.
  EXPECT_GE(same, 0.99 * all);
}

std::vector<Track<3>> predictions(const Scene& scene, double sigma, Random& random) {
  std::vector<Track<3>> expected;
  for (const Vector<3>& marker : scene.markers) {
    Track<3> track;
    track.position = marker + sigma * Vector<3>(random.gaussian(1), random.gaussian(1), random.gaussian(1));
    track.covariance = sigma * sigma * Matrix<3>::Identity();
    expected.push_back(track);
  }
  return expected;
}

TEST(Correspond, PredictionsClaimTheirBlobs) {
  Random random(13);
  const Scene scene = make_scene({.cameras = 8, .markers = 50, .dropped = 0.05, .ghosts = 0.05}, random);
  const auto expected = predictions(scene, 0.003, random);
  Corresponder corresponder(scene.cameras);
  const Correspondences& result = corresponder.match(scene.detected, expected);
  int right = 0;
  for (const Located& located : result.points) {
    if (!located.expected) continue;
    for (const int i : located.detected) EXPECT_EQ(scene.owner[i], *located.expected);
    right += (located.point.position - scene.markers[*located.expected]).norm() < 0.002;
  }
  EXPECT_EQ(right, 50);
}

TEST(Correspond, ClaimsWithTwoRaysAndSaysWhyNotWithOne) {
  Random random(14);
  Scene scene = make_scene({.cameras = 4, .markers = 3, .dropped = 0, .ghosts = 0}, random);
  const auto expected = predictions(scene, 0.002, random);
  std::vector<Observation<2>> detected;
  for (std::size_t i = 0; i < scene.detected.size(); ++i) {
    const int camera = number(scene.detected[i].camera);
    if (scene.owner[i] == 0 || (scene.owner[i] == 1 && camera < 2) || (scene.owner[i] == 2 && camera < 1))
      detected.push_back(scene.detected[i]);
  }
  Corresponder corresponder(scene.cameras);
  const Correspondences& result = corresponder.match(detected, expected);
  ASSERT_EQ(result.points.size(), 2);
  EXPECT_EQ(result.points[1].expected, 1);
  EXPECT_TRUE(result.points[1].by_two_rays());
  EXPECT_FALSE(result.missed[1]);
  EXPECT_EQ(result.missed[2], NoPoint::too_few_rays);
  EXPECT_EQ(result.unexplained, 1);
}

TEST(Correspond, ReportsPairsOfRaysApart) {
  Random random(15);
  const Scene scene = make_scene({.cameras = 2, .markers = 12, .dropped = 0, .ghosts = 0}, random);
  Corresponder apart(scene.cameras);
  const Correspondences& two = apart.match(scene.detected);
  EXPECT_TRUE(two.points.empty());
  EXPECT_GT(two.by_two_rays.size(), 6);
  Corresponder together(scene.cameras, {.min_rays = 2});
  EXPECT_GT(together.match(scene.detected).points.size(), 6);
}

TEST(Correspond, TakesOddInput) {
  Random random(16);
  Scene scene = make_scene({.cameras = 3, .markers = 5, .dropped = 0, .ghosts = 0}, random);
  Corresponder corresponder(scene.cameras);
  EXPECT_TRUE(corresponder.match({}).points.empty());
  Observation<2> odd;
  odd.value = {std::nan(""), 3};
  scene.detected.push_back(odd);
  odd.value = {3, 4};
  odd.camera = CameraId{77};
  scene.detected.push_back(odd);
  const Correspondences& result = corresponder.match(scene.detected);
  EXPECT_EQ(result.points.size(), 5);
  EXPECT_EQ(result.unexplained, 2);
  EXPECT_THROW(Corresponder(std::vector<Camera>{scene.cameras[0]}), Error);
}

TEST(Correspond, TooManyBlobsAtOneInstantAreRefused) {
  CorrespondOptions options;
  options.max_observations = 3;
  const Camera camera(geometry::BrownLens{}, Rigid3{}, {640, 480});
  Corresponder corresponder({camera, camera}, options);
  EXPECT_THROW(corresponder.match(std::vector<Observation<2>>(4)), Error);
}

}  // namespace
}  // namespace marey::reconstruct
