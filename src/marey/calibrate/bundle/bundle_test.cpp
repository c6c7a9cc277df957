#include "marey/calibrate/bundle/bundle.h"

#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "marey/calibrate/bundle/bundle_residual.h"
#include "marey/core/geometry.h"
#include "marey/geometry/camera.h"

namespace marey::calibrate::bundle {
namespace {

/// Uniform and Gaussian numbers from one seed.
struct Dice {
  explicit Dice(unsigned seed) : engine(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
  double gaussian(double sigma) { return sigma * std::normal_distribution<double>()(engine); }
  Vector<3> in_cube(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  std::mt19937 engine;
};

/// A camera at `centre` that faces the origin, its image upright.
Rigid3 facing_inward(const Vector<3>& centre) {
  const Vector<3> ahead = -centre.normalized(), right = ahead.cross(Vector<3>::UnitZ()).normalized();
  Matrix<3> R;
  R << right.transpose(), ahead.cross(right).transpose(), ahead.transpose();
  return {R, -R * centre};
}

const geometry::BrownLens kBrown{{1000, 1004}, {640, 512}, {-0.2, 0.05, 0.001, -0.0005, 0.01, 0.02, -0.01, 0.003}};
const geometry::FisheyeLens kFisheye{{500, 505}, {640, 512}, {0.02, -0.01, 0.003, -0.0004}};
const geometry::TsaiLens kTsai{{1000, 1010}, {640, 512}, {-0.12}};

Bundle ring_of_cameras(int cameras, const geometry::Lens& lens) {
  Bundle bundle;
  for (int c = 0; c < cameras; ++c) {
    const double angle = 2 * M_PI * c / cameras;
    bundle.cameras.push_back({lens, facing_inward({3 * std::cos(angle), 3 * std::sin(angle), 1.5 + 0.3 * (c % 2)})});
  }
  bundle.cameras.front().refine_pose = false;
  bundle.wand = {0, 0.12, 0.30};
  bundle.board = {{0, 0, 0}, {0.2, 0, 0}, {0.4, 0, 0}, {0, 0.2, 0}, {0.2, 0.2, 0}, {0.4, 0.25, 0}};
  return bundle;
}

/// Adds bodies of the kind and what the cameras see of them, with noise.
void fill(Bundle& bundle, std::size_t kind, int bodies, double noise, Dice& dice) {
  const std::array<std::size_t, 3> markers = {1, bundle.wand.size(), bundle.board.size()};
  for (int b = 0; b < bodies; ++b) {
    const Vector<3> at = dice.in_cube(0.8);
    if (kind == 0) bundle.bodies.emplace_back(at);
    if (kind == 1) bundle.bodies.emplace_back(WandPose{at, dice.in_cube(1).normalized()});
    if (kind == 2) bundle.bodies.emplace_back(Rigid3{geometry::rotation_from(dice.in_cube(1.5)), at});
    for (int c = 0; c < static_cast<int>(bundle.cameras.size()); ++c) {
      for (int m = 0; m < static_cast<int>(markers[kind]); ++m) {
        BundleObservation detected{c, b, m};
        detected.pixel = predicted_pixel(bundle, detected).value() + Vector<2>(dice.gaussian(noise), dice.gaussian(noise));
        bundle.observations.push_back(detected);
      }
    }
  }
}

void disturb(Bundle& bundle, Dice& dice, double size) {
  for (BundleCamera& camera : bundle.cameras) {
    if (!camera.refine_pose) continue;
    camera.camera_from_world = Rigid3{geometry::rotation_from(dice.in_cube(size)), dice.in_cube(size)} * camera.camera_from_world;
  }
  for (Body& body : bundle.bodies) {
    if (auto* point = std::get_if<Vector<3>>(&body)) *point += dice.in_cube(size);
    if (auto* wand = std::get_if<WandPose>(&body)) {
      *wand = {wand->origin + dice.in_cube(size), (wand->direction + dice.in_cube(size)).normalized()};
    }
    if (auto* board = std::get_if<Rigid3>(&body))
      *board = *board * Rigid3{geometry::rotation_from(dice.in_cube(size)), dice.in_cube(size)};
  }
}

double centre_error(const Bundle& found, const Bundle& truth) {
  double worst = 0;
  for (std::size_t c = 0; c < truth.cameras.size(); ++c) {
    const auto centre = [c](const Bundle& b) { return b.cameras[c].camera_from_world.inverse().translation; };
    worst = std::max(worst, (centre(found) - centre(truth)).norm());
  }
  return worst;
}

TEST(Bundle, JacobiansAgreeWithDifferences) {
  Dice dice(1);
  for (const geometry::Lens& lens : {geometry::Lens(kBrown), geometry::Lens(kFisheye), geometry::Lens(kTsai)}) {
    for (const Body& body : {Body(Vector<3>(0.1, -0.2, 0.3)), Body(WandPose{{0.1, 0.2, -0.1}, Vector<3>(1, 2, 3).normalized()}),
                             Body(Rigid3{geometry::rotation_from({0.4, -2.1, 0.3}), {0.1, 0, 0.2}})}) {
      const BundleObservation detected{0, 0, 0, {600, 500}, {130, -250}};
      const Vector<3> site = body.index() == 1 ? Vector<3>(0.3, 0, 0) : Vector<3>(0.2, 0.1, 0.05);
      const std::unique_ptr<ceres::CostFunction> cost(bundle::make_reprojection(lens, body, site, detected, true));
      std::vector<std::vector<double>> blocks = {
          bundle::numbers_of(facing_inward({2, 1, 1.5})), bundle::numbers_of(lens), bundle::numbers_of(body), {0.002}};
      const auto evaluate = [&](double** jacobians) {
        std::array<const double*, 4> at{};
        for (std::size_t i = 0; i < 4; ++i) at[i] = blocks[i].data();
        Vector<2> error;
        EXPECT_TRUE(cost->Evaluate(at.data(), error.data(), jacobians));
        return error;
      };
      std::vector<std::vector<double>> jacobians;
      std::array<double*, 4> locations{};
      for (const auto& block : blocks) jacobians.emplace_back(2 * block.size());
      for (std::size_t i = 0; i < 4; ++i) locations[i] = jacobians[i].data();
      const Vector<2> with = evaluate(locations.data());
      EXPECT_LT((with - evaluate(nullptr)).norm(), 1e-9) << "both paths through the lens are one projection";
      for (std::size_t block = 0; block < 4; ++block) {
        for (std::size_t i = 0; i < blocks[block].size(); ++i) {
          const double at = blocks[block][i], step = 1e-6 * std::max(1.0, std::abs(at));
          blocks[block][i] = at + step;
          const Vector<2> above = evaluate(nullptr);
          blocks[block][i] = at - step;
          const Vector<2> slope = (above - evaluate(nullptr)) / (2 * step);
          blocks[block][i] = at;
          const std::size_t width = blocks[block].size();
          const Vector<2> ours(jacobians[block][i], jacobians[block][width + i]);
          EXPECT_LT((ours - slope).norm(), 1e-5 * (1 + slope.norm()))
              << geometry::name_of(lens) << " body " << body.index() << " block " << block << " number " << i;
        }
      }
    }
  }
}

TEST(Bundle, ProjectsAsTheCameraDoes) {
  Dice dice(2);
  for (const geometry::Lens& lens : {geometry::Lens(kBrown), geometry::Lens(kFisheye), geometry::Lens(kTsai)}) {
    Bundle bundle = ring_of_cameras(3, lens);
    fill(bundle, 1, 20, 0, dice);
    for (const BundleObservation& detected : bundle.observations) {
      const Camera camera(lens, bundle.cameras[static_cast<std::size_t>(detected.camera)].camera_from_world, {1280, 1024});
      const auto pixel = camera.project(marker_position(bundle, detected));
      ASSERT_TRUE(pixel);
      EXPECT_LT((*pixel - detected.pixel).norm(), 1e-9);
    }
  }
}

TEST(Bundle, FindsARigByAWandWithinItsOwnDeviations) {
  Dice dice(3);
  Bundle truth = ring_of_cameras(5, kBrown);
  for (BundleCamera& camera : truth.cameras) camera.freedom = {LensFreedom::free, 0, LensFreedom::free, {LensFreedom::free}};
  fill(truth, 1, 150, 0.1, dice);
  Bundle bundle = truth;
  disturb(bundle, dice, 0.03);
  for (BundleCamera& camera : bundle.cameras) std::get<geometry::BrownLens>(camera.lens).focal *= 1.02;
  const BundleResult result = adjust(bundle);
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(result.noise_px, 0.1, 0.003);
  EXPECT_GT(result.inliers, 0.99 * static_cast<double>(truth.observations.size()));
  double squares = 0, largest = 0;
  int numbers = 0;
  for (std::size_t c = 0; c < truth.cameras.size(); ++c) {
    const CameraDeviation& sigma = result.deviations[c];
    ASSERT_GT(sigma.focal, 0);
    largest = std::max(largest, sigma.centre.norm());
    squares += std::pow(
        (geometry::focal_of(bundle.cameras[c].lens).x() / geometry::focal_of(truth.cameras[c].lens).x() - 1) / sigma.focal, 2);
    ++numbers;
    for (int axis = 0; c > 0 && axis < 3; ++axis, ++numbers) {
      const auto centre = [&](const Bundle& b) { return b.cameras[c].camera_from_world.inverse().translation; };
      squares += std::pow((centre(bundle) - centre(truth))[axis] / sigma.centre[axis], 2);
    }
  }
  EXPECT_NEAR(squares / numbers, 1, 0.7) << "errors are of the size that the deviations promise";
  EXPECT_LT(largest, 5e-3);
  EXPECT_LT(centre_error(bundle, truth), 3 * largest);
}

TEST(Bundle, PutsOutliersOut) {
  Dice dice(4);
  Bundle truth = ring_of_cameras(4, kTsai);
  fill(truth, 1, 100, 0.1, dice);
  std::vector<char> spoilt(truth.observations.size(), 0);
  for (std::size_t i = 0; i < spoilt.size(); i += 23) {
    spoilt[i] = 1;
    truth.observations[i].pixel += Vector<2>(dice.uniform(3, 60), dice.uniform(-60, 60));
  }
  Bundle bundle = truth;
  disturb(bundle, dice, 0.02);
  const BundleResult result = adjust(bundle);
  int missed = 0, lost = 0;
  for (std::size_t i = 0; i < spoilt.size(); ++i) {
    missed += spoilt[i] && result.inlier[i];
    lost += !spoilt[i] && !result.inlier[i];
  }
  EXPECT_EQ(missed, 0);
  EXPECT_LE(lost, 3);
  EXPECT_NEAR(result.noise_px, 0.1, 0.004);
  EXPECT_LT(centre_error(bundle, truth), 2e-3);
}

TEST(Bundle, FindsALensByABoardInOneView) {
  Dice dice(5);
  Bundle truth = ring_of_cameras(1, kFisheye);
  truth.cameras[0].freedom = {LensFreedom::free, LensFreedom::free, LensFreedom::free, {LensFreedom::free}};
  fill(truth, 2, 60, 0.05, dice);
  Bundle bundle = truth;
  auto& lens = std::get<geometry::FisheyeLens>(bundle.cameras[0].lens);
  lens.focal = {520, 520};
  lens.principal = {630, 520};
  lens.distortion[0] = 0;
  disturb(bundle, dice, 0.05);
  const BundleResult result = adjust(bundle);
  EXPECT_NEAR(result.noise_px, 0.05, 0.005);
  EXPECT_NEAR(lens.focal.x(), 500, 5 * result.deviations[0].focal * 500);
  EXPECT_NEAR(lens.principal.x(), 640, 5 * result.deviations[0].principal.x());
  EXPECT_NEAR(lens.distortion[0], 0.02, 5 * result.deviations[0].distortion[0]);
  EXPECT_EQ(lens.distortion[1], kFisheye.distortion[1]) << "what is held stays";
}

TEST(Bundle, WeightsPriorKnowledge) {
  // One point does not determine a focal length: it stays at its prior value, and so does its deviation.
  Dice dice(6);
  Bundle bundle = ring_of_cameras(3, kTsai);
  bundle.cameras[1].freedom.focal = 0.01;
  for (BundleCamera& camera : bundle.cameras) camera.refine_pose = false;
  fill(bundle, 0, 1, 0.0, dice);
  bundle.observations[1].pixel += Vector<2>(0.01, 0.01);
  const BundleResult result = adjust(bundle, {.noise_px = 0.1, .min_outlier_px = 1});
  EXPECT_NEAR(geometry::focal_of(bundle.cameras[1].lens).x(), 1000, 10);
  EXPECT_GT(result.deviations[1].focal, 0);
  EXPECT_LE(result.deviations[1].focal, 0.0101);
}

TEST(Bundle, FindsATimeOffset) {
  Dice dice(7);
  Bundle bundle = ring_of_cameras(4, kBrown);
  fill(bundle, 0, 200, 0.05, dice);
  for (BundleObservation& detected : bundle.observations) {
    detected.velocity = {dice.uniform(-800, 800), dice.uniform(-800, 800)};
    if (detected.camera == 2) detected.pixel += detected.velocity * 0.004;
  }
  bundle.cameras[2].refine_offset = true;
  Bundle truth = bundle;
  disturb(bundle, dice, 0.01);
  const BundleResult result = adjust(bundle, {.rounds = 0});
  EXPECT_NEAR(bundle.cameras[2].offset_s, 0.004, 5 * result.deviations[2].offset_s);
  EXPECT_LT(result.deviations[2].offset_s, 1e-4);
  EXPECT_NEAR(result.noise_px, 0.05, 0.005);
}

TEST(Bundle, BodiesThatTooFewSeeAreLeftOut) {
  Dice dice(8);
  Bundle bundle = ring_of_cameras(3, kTsai);
  fill(bundle, 0, 30, 0.1, dice);
  bundle.bodies.emplace_back(Vector<3>(0.1, 0.1, 0.1));
  bundle.observations.push_back({0, 30, 0, {100, 100}});
  const BundleResult result = adjust(bundle);
  EXPECT_EQ(result.inlier.back(), 0);
  EXPECT_EQ(result.inliers, 90);
  EXPECT_TRUE(adjust(bundle, {.deviations = false}).deviations.empty());
}

TEST(Bundle, NothingSeenIsNoError) {
  Bundle bundle = ring_of_cameras(2, kTsai);
  const BundleResult result = adjust(bundle);
  EXPECT_EQ(result.inliers, 0);
}

}  // namespace
}  // namespace marey::calibrate::bundle
