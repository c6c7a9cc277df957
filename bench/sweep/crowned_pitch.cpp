// Cameras over pitches that are not flat: how far off a place on the pitch is, and the focal length, with what crown.
//
//   crowned_pitch [seeds=N] [from=N] [case=NAME] [noise=PX] [wrong=N] [width=PX] [level=1]
//
// Two cameras of 3072 x 1728 px (`width`) on one stand, or apart, 7.4 m up and 14 m behind the touchline; every corner, crossing
// and mark that they see is clicked, `noise` px off, `wrong` of each camera's grossly; the paint is rendered with grass and noise,
// blurred and put through JPEG, as a codec would. Printed: the error of places over all of the pitch that a camera sees (every 2
// m), 95 % of them, along the touchline and across; the same along within 4 m of the near touchline; the worst focal length; the
// share of places within their own 95 % ellipse and of focal lengths within their own interval. Beside it a plane under the same
// clicks by OpenCV's calibrateCamera, the gross clicks omitted for it. `level=1`: the ground is held level here too.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "marey/calibrate/pitch/pitch.h"
#include "marey/calibrate/pitch/pitch_deviation.h"
#include "marey/calibrate/pitch/pitch_sightings.h"
#include "marey/core/error.h"
#include "marey/geometry/ground_view.h"
#include "marey/simulate/match/match_cameras.h"
#include "marey/simulate/match/match_ground.h"
#include "marey/simulate/match/match_renderer.h"

namespace {

using namespace marey;
using calibrate::pitch::PitchView;
using geometry::GroundSurface;
using simulate::match::MatchStand;

struct Case {
  std::string name;
  MatchStand stand;
  GroundSurface ground;
};

GroundSurface raised(double across, double along, double dome, double ridge) {
  GroundSurface ground;
  ground.set_terms({across, along, dome, ridge});
  return ground;
}

const std::vector<Case> kCases = {{"flat", MatchStand::football, {}},
                                  {"gentle", MatchStand::football, raised(0.15, 0.2, 0, 0)},
                                  {"across", MatchStand::football, raised(0.4, 0, 0, 0)},
                                  {"along", MatchStand::football, raised(0, 0.4, 0, 0)},
                                  {"both", MatchStand::football, raised(0.4, 0.3, 0, 0)},
                                  {"envelope", MatchStand::football, raised(0, 0, 0.4, 0.5)},
                                  {"roof", MatchStand::football, raised(0.3, 0, 0, 1)},
                                  {"flat_apart", MatchStand::apart, {}},
                                  {"gentle_apart", MatchStand::apart, raised(0.15, 0.2, 0, 0)},
                                  {"both_apart", MatchStand::apart, raised(0.4, 0.3, 0, 0)}};

struct Settings {
  double seeds = 3, from = 1, noise = 2, wrong = 1, level = 0, width = 3072;
};

/// Luma of the empty ground as a codec leaves it.
cv::Mat recorded(const GroundView& view, const Matrix<3>& pitch_from_world, const geometry::PitchSize& size, std::uint64_t seed) {
  cv::Mat luma = simulate::match::draw_match_ground(view, pitch_from_world, size, seed).luma().clone();
  cv::GaussianBlur(luma, luma, {}, 0.9);
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", luma, bytes, {cv::IMWRITE_JPEG_QUALITY, 60});
  return cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
}

/// As it was done before grounds had heights: a plane, and a lens with all eight coefficients, camera by camera.
Camera over_a_plane(const PitchView& view, const Matrix<3>& world_from_pitch, const geometry::PitchSize& size) {
  std::vector<calibrate::pitch::PitchPoint> points = view.points;
  for (auto& point : points) point.ground = (world_from_pitch * point.ground.homogeneous()).head<2>();
  auto lines = geometry::pitch_lines(size, 0.25);
  for (auto& line : lines) {
    for (Vector<2>& location : line.points) location = (world_from_pitch * location.homogeneous()).head<2>();
    for (Vector<2>& tangent : line.tangents) tangent = world_from_pitch.topLeftCorner<2, 2>() * tangent;
  }
  const auto start = calibrate::pitch::camera_from_points(view.name, points, view.size);
  Camera camera = start.camera;
  for (const double reach : {14, 12, 10, 10, 8}) {
    const auto painted = calibrate::pitch::find_lines(view.empty_ground, GroundView(camera), lines, reach * view.size.width / 3072);
    if (!painted.empty()) camera = calibrate::pitch::refine(camera, points, start.inlier, painted, true);
  }
  return camera;
}

/// What was wrong where.
struct Errors {
  std::vector<double> along, across, near_along, focal;
  int covered = 0, locations = 0, focal_covered = 0, cameras = 0;
};

double fraction_of(std::vector<double> values, double fraction) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1))];
}

/// Calls `each(place on the pitch, place in the world, pixel)` for every two metres of the pitch in view.
template <typename Each>
void over_the_pitch(const GroundView& truth, const Matrix<3>& world_from_pitch, const geometry::PitchSize& size, const Each& each) {
  for (double x = 0.5; x <= size.length; x += 2) {
    for (double y = 0; y <= size.width; y += 2) {
      const Vector<2> world = (world_from_pitch * Vector<3>(x, y, 1)).head<2>();
      const auto pixel = truth.pixel(world);
      if (pixel && truth.camera()->in_image(*pixel)) each(Vector<2>(x, y), world, *pixel);
    }
  }
}

void note(Errors& errors, const Vector<2>& off, double y, const geometry::PitchSize& size) {
  errors.along.push_back(std::abs(off.x())), errors.across.push_back(std::abs(off.y()));
  if (y > size.width - 4) errors.near_along.push_back(std::abs(off.x()));
}

/// OpenCV's own over a plane, on the clicks that are right.
Camera by_opencv(const PitchView& view, const GroundView& truth, const Matrix<3>& world_from_pitch) {
  std::vector<cv::Point3f> locations;
  std::vector<cv::Point2f> pixels;
  for (const auto& click : view.points) {
    const Vector<2> world = (world_from_pitch * click.ground.homogeneous()).head<2>();
    const auto pixel = truth.pixel(world);
    if (!pixel || (*pixel - click.pixel).norm() > 20) continue;
    locations.emplace_back(static_cast<float>(world.x()), static_cast<float>(world.y()), 0.0F);
    pixels.emplace_back(static_cast<float>(click.pixel.x()), static_cast<float>(click.pixel.y()));
  }
  const double focal = 0.7 * view.size.width;
  cv::Mat K = (cv::Mat_<double>(3, 3) << focal, 0, view.size.width / 2.0, 0, focal, view.size.height / 2.0, 0, 0, 1);
  cv::Mat bent;
  std::vector<cv::Mat> turn, move;
  cv::calibrateCamera(std::vector<std::vector<cv::Point3f>>(1, locations), std::vector<std::vector<cv::Point2f>>(1, pixels),
                      view.size, K, bent, turn, move, cv::CALIB_USE_INTRINSIC_GUESS | cv::CALIB_FIX_ASPECT_RATIO);
  cv::Mat R;
  cv::Rodrigues(turn[0], R);
  geometry::BrownLens lens{{K.at<double>(0, 0), K.at<double>(1, 1)}, {K.at<double>(0, 2), K.at<double>(1, 2)}, {}};
  std::copy_n(bent.ptr<double>(), 5, lens.distortion.begin());
  Rigid3 pose;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) pose.rotation(i, j) = R.at<double>(i, j);
    pose.translation(i) = move[0].at<double>(i);
  }
  return {lens, pose, view.size};
}

/// One camera of ours against the truth, and against what it says of its own errors.
void assess(const calibrate::pitch::PitchCalibration& result, std::size_t index, const GroundView& truth,
            const Matrix<3>& world_from_pitch, const geometry::PitchSize& size, Errors& errors) {
  constexpr double kOfPlane = 5.991, kOfLine = 1.96;  // 95 % of χ² with two degrees of freedom; of a normal deviate
  const Camera& camera = result.views[index].camera;
  const GroundView found(camera, result.fit.ground);
  int number = 0;
  over_the_pitch(truth, world_from_pitch, size, [&](const Vector<2>& pitch, const Vector<2>& world, const Vector<2>& pixel) {
    const auto location = found.location(pixel);
    const Vector<2> off = location ? Vector<2>(location->ground - world) : Vector<2>(1e3, 1e3);
    note(errors, off, pitch.y(), size);
    if (number++ % 10 != 0 || !location) return;
    const auto covariance = calibrate::pitch::position_covariance(result.fit, index, location->ground);
    ++errors.locations;
    errors.covered += covariance && off.dot(covariance->inverse() * off) < kOfPlane ? 1 : 0;
  });
  const double focal = geometry::focal_of(camera.lens()).x(), real = geometry::focal_of(truth.camera()->lens()).x();
  errors.focal.push_back(std::abs(focal / real - 1));
  const auto own = static_cast<Eigen::Index>(index) * calibrate::pitch::CameraNumbers::count;
  ++errors.cameras;
  errors.focal_covered += std::abs(focal - real) < kOfLine * std::sqrt(result.fit.covariance(own, own)) ? 1 : 0;
}

/// Another person's camera over a plane.
void evaluate_plane(const Camera& camera, const GroundView& truth, const Matrix<3>& world_from_pitch,
                    const geometry::PitchSize& size, Errors& errors) {
  const GroundView found(camera);
  over_the_pitch(truth, world_from_pitch, size, [&](const Vector<2>& pitch, const Vector<2>& world, const Vector<2>& pixel) {
    const auto location = found.location(pixel);
    note(errors, location ? Vector<2>(location->ground - world) : Vector<2>(99, 99), pitch.y(), size);
  });
  errors.focal.push_back(std::abs(geometry::focal_of(camera.lens()).x() / geometry::focal_of(truth.camera()->lens()).x() - 1));
}

void one_scene(const Case& scene, std::uint64_t seed, const Settings& how, Errors& ours, Errors& before, Errors& theirs) {
  const simulate::match::MatchCamerasOptions cameras{
      .stand = scene.stand,
      .size = cv::Size(static_cast<int>(how.width), static_cast<int>(how.width * 9 / 16)),
      .pitch = {},
      .ground = scene.ground};
  const Rig rig = simulate::match::match_cameras(cameras, seed);
  const geometry::PitchSize size = cameras.pitch;
  const Matrix<3> world_from_pitch = rig.ground_from_world->inverse();
  std::vector<PitchView> views;
  std::vector<GroundView> truths;
  for (const RigCamera& camera : rig.cameras) {
    truths.push_back(camera.ground_view(rig.ground).value());
    PitchView& view = views.emplace_back();
    view.name = camera.name, view.size = *camera.size;
    for (const auto& click : simulate::match::match_clicks(truths.back(), world_from_pitch, size, how.noise,
                                                           static_cast<int>(how.wrong), seed * 2 + views.size()))
      view.points.push_back({click.ground, click.pixel, {}});
    view.empty_ground = recorded(truths.back(), *rig.ground_from_world, size, seed);
    evaluate_plane(by_opencv(view, truths.back(), world_from_pitch), truths.back(), world_from_pitch, size, theirs);
    evaluate_plane(over_a_plane(view, world_from_pitch, size), truths.back(), world_from_pitch, size, before);
  }
  calibrate::pitch::PitchCalibrationOptions options;
  options.size = size;
  if (how.level > 0) options.known = calibrate::pitch::GroundKnown::level;
  const auto result = calibrate::pitch::calibrate_pitch(views, options);
  for (std::size_t i = 0; i < views.size(); ++i) assess(result, i, truths[i], world_from_pitch, size, ours);
  std::printf("  seed %llu: %d terms of the lens; across %.3f along %.3f dome %.3f ridge %.2f;",
              static_cast<unsigned long long>(seed), result.fit.lens_terms, result.fit.ground.across, result.fit.ground.along,
              result.fit.ground.dome, result.fit.ground.ridge);
  for (const auto& view : result.views)
    std::printf(" %d of %d clicks,", static_cast<int>(std::count(view.inlier.begin(), view.inlier.end(), 1)),
                static_cast<int>(view.inlier.size()));
  std::printf("\n");
}

void print(const char* identity, const Errors& errors) {
  std::printf("  %-7s 95 %%: along %.3f across %.3f m, median %.3f %.3f; near touchline along %.3f; focal worst %.2f %%", identity,
              fraction_of(errors.along, 0.95), fraction_of(errors.across, 0.95), fraction_of(errors.along, 0.5),
              fraction_of(errors.across, 0.5), fraction_of(errors.near_along, 0.95), 100 * fraction_of(errors.focal, 1));
  if (errors.locations > 0)
    std::printf("; in their 95 %%: places %.1f %%, focal %d of %d", 100.0 * errors.covered / errors.locations, errors.focal_covered,
                errors.cameras);
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  Settings how;
  std::string only;
  std::map<std::string, double*> known{{"seeds", &how.seeds}, {"from", &how.from},   {"noise", &how.noise},
                                       {"wrong", &how.wrong}, {"level", &how.level}, {"width", &how.width}};
  for (int i = 1; i < argc; ++i) {
    const std::string text = argv[i];
    const auto equals = text.find('=');
    if (text.starts_with("case=")) {
      only = text.substr(5);
      continue;
    }
    const auto found = known.find(text.substr(0, equals));
    if (equals == std::string::npos || found == known.end()) return std::fprintf(stderr, "%s: no such setting\n", argv[i]), 2;
    *found->second = std::atof(text.c_str() + equals + 1);
  }
  try {
    for (const Case& scene : kCases) {
      if (!only.empty() && scene.name != only) continue;
      const auto [across, along, dome, ridge] = scene.ground.terms();
      std::printf("%s: across %.2f along %.2f dome %.2f m, ridge %.1f; clicks %.1f px off, %.0f gross\n", scene.name.c_str(),
                  across, along, dome, ridge, how.noise, how.wrong);
      Errors ours, before, theirs;
      for (int k = 0; k < static_cast<int>(how.seeds); ++k)
        one_scene(scene, static_cast<std::uint64_t>(how.from) + static_cast<std::uint64_t>(k), how, ours, before, theirs);
      print("marey", ours), print("before", before), print("OpenCV", theirs);
      std::fflush(stdout);
    }
  } catch (const Error& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
  return 0;
}
