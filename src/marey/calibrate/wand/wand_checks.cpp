#include "marey/calibrate/wand/wand_checks.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/LU>
#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/geometry/decompositions.h"
#include "marey/geometry/median.h"

namespace marey::calibrate::wand {
namespace {

constexpr std::size_t kMinFrames = 20;   // in which a camera has to see the wand
constexpr std::size_t kMinWands = 30;    // places of the wand, over all
constexpr double kApart = 0.01;          // of their distance from the wand: nearer, two cameras are one
constexpr double kFlat = 0.03;           // extent across a plane, as a share of the extent in it
constexpr double kLengthChange = 0.015;  // between parts of a recording

Vector<3> centre_of(const bundle::Bundle& bundle, std::size_t c) {
  return bundle.cameras[c].camera_from_world.inverse().translation;
}

void check_distance(const WandInput& input, const KnownDistance& distance) {
  const auto known = [&](const std::string& name) {
    return std::any_of(input.rig.cameras.begin(), input.rig.cameras.end(),
                       [&](const RigCamera& camera) { return camera.name == name; });
  };
  for (const std::string& name : {distance.first, distance.second}) {
    if (!known(name)) throw Error("--distance names camera \"{}\", which the rig does not have", name);
  }
  if (distance.first == distance.second) throw Error("--distance is between two cameras; it names \"{}\" twice", distance.first);
  if (!(distance.metres > 0)) throw Error("--distance has to be a positive number of metres; it is {}", distance.metres);
}

}  // namespace

void check_wand_input(const WandInput& input, const WandOptions& options) {
  if (input.rig.cameras.size() < 2) throw Error("a wand calibrates two cameras or more; the rig has {}", input.rig.cameras.size());
  const auto& at = input.wand.distances;
  if (at.empty() || at.size() > MarkerLine::maximum || at.front() != 0 ||
      !std::is_sorted(at.begin(), at.end(), std::less_equal<>())) {
    throw Error("{}", "a wand is two or three distances in metres that grow from 0, as 0,0.12,0.30; or \"led\" for a single light");
  }
  for (const RigCamera& camera : input.rig.cameras) {
    if (!camera.size || camera.size->width <= 0 || camera.size->height <= 0) {
      throw Error("camera \"{}\": its image's size is not known; write size = [width, height] into the rig", camera.name);
    }
    if (options.lens == LensUse::fixed && !camera.lens) {
      throw Error("camera \"{}\" has no lens to be held: calibrate it with `marey calibrate lens`, or let it be estimated",
                  camera.name);
    }
  }
  if (options.distance) check_distance(input, *options.distance);
}

void check_tracks(const WandInput& input, const std::vector<MarkTrack>& tracks) {
  for (std::size_t c = 0; c < tracks.size(); ++c) {
    if (tracks[c].frames.size() >= kMinFrames) continue;
    const bool light = input.wand.markers() == 1;
    throw Error("camera \"{}\": the {} is seen in {} of {} frames that hold anything; {} are needed: {}", input.rig.cameras[c].name,
                light ? "light" : "wand", tracks[c].frames.size(), input.detected[c].size(), kMinFrames,
                light ? "wave it longer before this camera, in the dark" : "wave it longer before this camera, and check --wand");
  }
}

void check_lengths(const std::vector<double>& lengths, const MarkerLine& wand) {
  constexpr std::size_t parts = 8, minimum = 5;
  if (wand.markers() < 2 || lengths.size() < parts * minimum) return;
  const double all = geometry::median(std::vector(lengths));
  std::vector<std::vector<double>> by_part(parts);
  std::vector<double> spreads;  // within the parts: a wand that changes has two lengths, each sharp
  for (std::size_t i = 0; i < lengths.size(); ++i) by_part[i * parts / lengths.size()].push_back(lengths[i]);
  for (const auto& part : by_part) {
    const double middle = geometry::median(std::vector(part));
    std::vector<double> off;
    for (const double length : part) off.push_back(std::abs(length - middle));
    spreads.push_back(1.4826 * geometry::median(off));
  }
  const double spread = geometry::median(spreads);
  for (std::size_t part = 0; part < parts; ++part) {
    const double here = geometry::median(by_part[part]);
    const double noise = 5 * spread / std::sqrt(static_cast<double>(by_part[part].size()));
    if (std::abs(here - all) <= std::max(kLengthChange * all, noise)) continue;
    throw Error(
        "the wand measures {:.1f} mm in part {} of {} of the recording and {:.1f} mm over all: it was another wand, or a marker "
        "or a camera moved; use the part of the recording that belongs to --wand",
        1000 * here, part + 1, parts, 1000 * all);
  }
}

void check_fitted_rig(const WandInput& input, const bundle::Bundle& bundle, const bundle::BundleResult& fit) {
  std::set<int> bodies;
  std::vector<int> detected(bundle.cameras.size(), 0);
  std::vector<Vector<3>> points;
  for (std::size_t i = 0; i < fit.inlier.size(); ++i) {
    if (!fit.inlier[i]) continue;
    bodies.insert(bundle.observations[i].body);
    ++detected[static_cast<std::size_t>(bundle.observations[i].camera)];
    points.push_back(bundle::marker_position(bundle, bundle.observations[i]));
  }
  if (bodies.size() < kMinWands) {
    throw Error("only {} places of the wand fit together, and {} are needed: wave it longer where two cameras or more see it",
                bodies.size(), kMinWands);
  }
  for (std::size_t c = 0; c < detected.size(); ++c) {
    if (detected[c] >= static_cast<int>(kMinFrames)) continue;
    throw Error(
        "camera \"{}\": only {} of its views of the wand fit to the other cameras: check its lens, and that it was started with "
        "them",
        input.rig.cameras[c].name, detected[c]);
  }
  Vector<3> mean = Vector<3>::Zero();
  for (const auto& point : points) mean += point / static_cast<double>(points.size());
  Matrix<3> time_steps = Matrix<3>::Zero();
  for (const auto& point : points) time_steps += (point - mean) * (point - mean).transpose();
  const Vector<3> extent = geometry::eigenpairs<3>(time_steps).values.cwiseMax(0).cwiseSqrt();
  if (extent[0] < kFlat * extent[2]) {
    throw Error("the wand was moved {}: move it through the whole volume, up and down, near and far, and turn it",
                extent[1] < kFlat * extent[2] ? "along a line" : "in a plane");
  }
  for (std::size_t a = 0; a < bundle.cameras.size(); ++a) {
    for (std::size_t b = a + 1; b < bundle.cameras.size(); ++b) {
      const double apart = (centre_of(bundle, a) - centre_of(bundle, b)).norm();
      if (apart > kApart * (centre_of(bundle, a) - mean).norm()) continue;
      throw Error(
          "cameras \"{}\" and \"{}\" stand in one place (or are the same recording given twice): leave one out, or move them apart",
          input.rig.cameras[a].name, input.rig.cameras[b].name);
    }
  }
}

}  // namespace marey::calibrate::wand
