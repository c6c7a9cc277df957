#include "marey/evaluate/mask_evaluation.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace marey::evaluate {
namespace {

using Pixels = std::vector<bool>;  // column by column

RunMask mask_of(const Pixels& pixels, int width, int height) {
  RunMaskBuilder mask(width, height);
  for (const bool inside : pixels) mask.add(inside, 1);
  return mask.take();
}

double obvious_iou(const Pixels& a, const Pixels& b) {
  int both = 0, any = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    both += a[i] && b[i] ? 1 : 0;
    any += a[i] || b[i] ? 1 : 0;
  }
  return any > 0 ? static_cast<double>(both) / any : 0;
}

Pixels random_pixels(std::mt19937_64& random, std::size_t count) {
  std::bernoulli_distribution inside(std::uniform_real_distribution<>(0, 1)(random));
  Pixels pixels(count);
  for (std::size_t i = 0; i < count; ++i) pixels[i] = inside(random);
  return pixels;
}

TEST(RunMask, AgreesWithPixels) {
  const std::uint64_t seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  for (int trial = 0; trial < 300; ++trial) {
    const int width = std::uniform_int_distribution<>(1, 9)(random), height = std::uniform_int_distribution<>(1, 9)(random);
    const auto count = static_cast<std::size_t>(width * height);
    const Pixels a = random_pixels(random, count), b = random_pixels(random, count);
    const RunMask mask_a = mask_of(a, width, height), mask_b = mask_of(b, width, height);
    EXPECT_EQ(mask_a.area(), std::count(a.begin(), a.end(), true));
    EXPECT_DOUBLE_EQ(iou(mask_a, mask_b), obvious_iou(a, b));
    Pixels rest(count);
    for (std::size_t i = 0; i < count; ++i) rest[i] = a[i] && !b[i];
    EXPECT_EQ(without(mask_a, mask_b), mask_of(rest, width, height));
    int left = width, right = -1, top = height, bottom = -1;
    for (int i = 0; i < width * height; ++i) {
      if (!a[static_cast<std::size_t>(i)]) continue;
      left = std::min(left, i / height), right = std::max(right, i / height);
      top = std::min(top, i % height), bottom = std::max(bottom, i % height);
    }
    const Box box = mask_a.box();
    if (right < 0) {
      EXPECT_TRUE(box.empty());
    } else {
      EXPECT_EQ(box, (Box{double(left), double(top), double(right - left + 1), double(bottom - top + 1)}));
    }
  }
}

TEST(RunMask, OfAPolygonHasThePixelsWhoseCentreIsInside) {
  const std::uint64_t seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<> location(-5, 25);
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<Vector<2>> polygon(3 + trial % 5);
    for (Vector<2>& corner : polygon) corner = {location(random), location(random)};
    Pixels inside;
    for (int x = 0; x < 20; ++x) {
      for (int y = 0; y < 17; ++y) {
        bool odd = false;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
          const Vector<2>&a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
          if ((a.y() <= y) != (b.y() <= y) && x < a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) odd = !odd;
        }
        inside.push_back(odd);
      }
    }
    EXPECT_EQ(RunMask::of_polygon(polygon, 20, 17), mask_of(inside, 20, 17));
  }
}

/// Discs that move, do not overlap within a file, and are reported with errors; some missed, some false, identities that change.
struct Scene {
  std::vector<LabelledMask> truth, tracks;
};

Scene made_scene(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<> unit(0, 1);
  Scene scene;
  constexpr int kSize = 60;
  const auto disc = [&](double x, double y, double radius, RunMask& taken) {
    Pixels pixels;
    for (int column = 0; column < kSize; ++column) {
      for (int row = 0; row < kSize; ++row) pixels.push_back(std::hypot(column - x, row - y) < radius);
    }
    const RunMask own = without(mask_of(pixels, kSize, kSize), taken);
    RunMaskBuilder both(kSize, kSize);
    for_common_runs(own, taken, [&](bool a, bool b, std::uint32_t length) { both.add(a || b, length); });
    taken = both.take();
    return own;
  };
  for (int frame = 0; frame < 20; ++frame) {
    RunMask taken{kSize, kSize, {kSize * kSize}}, tracked = taken;
    for (int object = 0; object < 4; ++object) {
      const double x = 8 + 2 * frame + 3 * object, y = 10 + 12 * object - 0.4 * frame * object, radius = 5 + object;
      scene.truth.push_back({frame, object, disc(x, y, radius, taken)});
      if (unit(random) < 0.15) continue;
      const int id = object + (frame > 11 && object > 1 ? 10 : 0);
      scene.tracks.push_back({frame, id, disc(x + 6 * unit(random) - 3, y + 4 * unit(random) - 2, radius + unit(random), tracked)});
    }
    if (unit(random) < 0.2) scene.tracks.push_back({frame, 77, disc(50, 5, 4, tracked)});
  }
  return scene;
}

/// MOTS in its definition: masks of a file do not overlap, therefore an IoU of 0.5 or more is the only possible match.
TEST(MaskEvaluation, AgreesWithTheDefinitionOfSmotsa) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scene scene = made_scene(seed);
    double overlaps = 0;
    int matches = 0, switches = 0;
    std::map<int, int> last;
    for (const LabelledMask& object : scene.truth) {
      for (const LabelledMask& track : scene.tracks) {
        if (track.frame != object.frame || iou(object.mask, track.mask) < 0.5 - 1e-12) continue;
        overlaps += iou(object.mask, track.mask);
        ++matches;
        if (last.contains(object.id) && last[object.id] != track.id) ++switches;
        last[object.id] = track.id;
      }
    }
    const auto all = static_cast<double>(scene.truth.size()), reported = static_cast<double>(scene.tracks.size());
    const MaskEvaluation result = evaluate_masks(scene.truth, scene.tracks);
    ASSERT_GT(matches, 10);
    EXPECT_EQ(result.scores.clear.matches, matches);
    EXPECT_EQ(result.scores.clear.switches, switches);
    EXPECT_NEAR(result.motsp.value(), overlaps / matches, 1e-9);
    EXPECT_NEAR(result.smotsa.value(), (overlaps - (reported - matches) - switches) / all, 1e-9);
    EXPECT_NEAR(result.scores.clear.mota.value(), (matches - (reported - matches) - switches) / all, 1e-9);
  }
}

TEST(MaskEvaluation, OfTheTruthItselfIsPerfect) {
  const Scene scene = made_scene(3);
  const MaskEvaluation result = evaluate_masks(scene.truth, scene.truth);
  EXPECT_DOUBLE_EQ(result.smotsa.value(), 1);
  EXPECT_DOUBLE_EQ(result.motsp.value(), 1);
  EXPECT_DOUBLE_EQ(result.scores.hota.hota, 1);
  EXPECT_DOUBLE_EQ(result.scores.identity.f1.value(), 1);
}

TEST(MaskEvaluation, LeavesOutMasksInIgnoredRegions) {
  Scene scene = made_scene(4);
  const std::size_t before = scene.tracks.size();
  RunMaskBuilder corner(60, 60);
  for (int column = 0; column < 60; ++column) {
    corner.add(column >= 44, 12);
    corner.add(false, 48);
  }
  const RunMask region = corner.take();
  std::vector<LabelledMask> regions;
  for (int frame = 0; frame < 20; ++frame) regions.push_back({frame, 0, region});
  const auto far = std::count_if(scene.tracks.begin(), scene.tracks.end(), [](const auto& one) { return one.id == 77; });
  ASSERT_GT(far, 0);
  remove_ignored(scene.truth, regions, 0.5, scene.tracks);
  EXPECT_TRUE(std::none_of(scene.tracks.begin(), scene.tracks.end(), [](const auto& one) { return one.id == 77; }));
  EXPECT_GE(scene.tracks.size() + static_cast<std::size_t>(far) + 3, before);
}

}  // namespace
}  // namespace marey::evaluate
