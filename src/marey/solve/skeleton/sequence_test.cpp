// A simulated walker whose skin slides, with markers hidden.
#include "marey/solve/skeleton/sequence.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "marey/solve/skeleton/human.h"

namespace marey::solve::skeleton {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

Skeleton walker() {
  std::vector<StandingSegment> segments = {{"pelvis", {Matrix<3>::Identity(), {0, 0, 1}}, {}},
                                           {"trunk", {Matrix<3>::Identity(), {0, 0, 1.1}}, {}}};
  std::vector<StandingMarker> markers = {{"LASI", "pelvis", {0.1, 0.12, 1.02}}, {"RASI", "pelvis", {0.1, -0.12, 1.02}},
                                         {"SACR", "pelvis", {-0.1, 0, 1.03}},   {"C7", "trunk", {-0.08, 0, 1.5}},
                                         {"T10", "trunk", {-0.1, 0, 1.25}},     {"CLAV", "trunk", {0.06, 0, 1.45}},
                                         {"STRN", "trunk", {0.1, 0, 1.3}}};
  for (const double side : {1.0, -1.0}) {
    const std::string name = side > 0 ? "left_" : "right_", letter = side > 0 ? "L" : "R";
    const auto add = [&](const std::string& segment, const Vector<3>& location) {
      segments.push_back({name + segment, {Matrix<3>::Identity(), {location.x(), side * location.y(), location.z()}}, {}});
    };
    const auto mark = [&](const std::string& label, const std::string& segment, const Vector<3>& location) {
      markers.push_back({letter + label, name + segment, {location.x(), side * location.y(), location.z()}});
    };
    add("thigh", {0, 0.09, 0.94});
    add("shank", {0, 0.09, 0.5});
    add("foot", {0, 0.09, 0.08});
    add("upper_arm", {0, 0.2, 1.45});
    add("forearm", {0, 0.22, 1.15});
    add("hand", {0, 0.22, 0.9});
    mark("THI", "thigh", {0.02, 0.17, 0.7});
    mark("THF", "thigh", {0.09, 0.1, 0.65});
    mark("KNE", "thigh", {0, 0.15, 0.5});
    mark("TIB", "shank", {0.02, 0.15, 0.3});
    mark("TIF", "shank", {0.06, 0.1, 0.35});
    mark("ANK", "shank", {0, 0.14, 0.08});
    mark("HEE", "foot", {-0.06, 0.09, 0.05});
    mark("TOE", "foot", {0.16, 0.09, 0.04});
    mark("MT5", "foot", {0.1, 0.14, 0.03});
    mark("SHO", "trunk", {0, 0.18, 1.5});
    mark("UPA", "upper_arm", {0.03, 0.26, 1.3});
    mark("ELB", "upper_arm", {0, 0.26, 1.15});
    mark("FRM", "forearm", {0.02, 0.26, 1.05});
    mark("WRA", "forearm", {0.04, 0.22, 0.92});
    mark("WRB", "forearm", {-0.04, 0.22, 0.92});
    mark("FIN", "hand", {0, 0.22, 0.82});
  }
  return human_skeleton("walker", segments, markers);
}

double walk(const std::string& name, double time) {
  const double phase = 2 * std::numbers::pi * time * 0.9 + (name.starts_with("right") ? std::numbers::pi : 0);
  if (name == "pelvis_tx") return 1.3 * time;
  if (name.ends_with("hip_flexion")) return 0.15 + 0.4 * std::sin(phase);
  if (name.ends_with("knee_flexion")) return 0.55 + 0.5 * std::sin(phase + 0.9);
  if (name.ends_with("ankle_dorsiflexion")) return 0.15 * std::sin(phase + 2);
  if (name.ends_with("shoulder_flexion")) return -0.4 * std::sin(phase);
  if (name.ends_with("elbow_flexion")) return 0.6 - 0.2 * std::sin(phase);
  return 0.03 * std::sin(phase + static_cast<double>(name.size()));
}

/// 120 Hz; each marker slides by 6 mm beside a misfit of as much.
std::vector<ObservedMarkers> walking(const Skeleton& skeleton, int frames, std::mt19937& random) {
  const auto noise = [&](double size) { return size * (static_cast<double>(random()) / 2147483648.0 - 1); };
  std::vector<Vector<3>> slide, misfit;
  for (std::size_t j = 0; j < skeleton.markers.size(); ++j) {
    slide.emplace_back(noise(0.006), noise(0.006), noise(0.006));
    misfit.emplace_back(noise(0.006), noise(0.006), noise(0.006));
  }
  std::vector<ObservedMarkers> all;
  for (int f = 0; f < frames; ++f) {
    std::vector<double> coordinates = skeleton.rest();
    for (std::size_t c = 0; c < coordinates.size(); ++c) coordinates[c] += walk(skeleton.coordinates[c].name, f / 120.0);
    const auto pose = pose_of(skeleton, coordinates);
    ObservedMarkers& detected = all.emplace_back();
    for (std::size_t j = 0; j < skeleton.markers.size(); ++j) {
      const SkeletonMarker& marker = skeleton.markers[j];
      const Vector<3> on =
          marker.position + misfit[j] + std::sin(2 * std::numbers::pi * 0.9 * f / 120.0 + static_cast<double>(j)) * slide[j];
      detected.emplace_back(pose[static_cast<std::size_t>(marker.segment)] * on +
                            Vector<3>(noise(0.0005), noise(0.0005), noise(0.0005)));
    }
  }
  return all;
}

/// Three in ten markers hidden for half a second, once a second.
std::vector<std::size_t> hide(std::vector<ObservedMarkers>& frames, std::mt19937& random) {
  std::vector<std::size_t> begins;
  for (std::size_t begin = 36; begin + 100 < frames.size(); begin += 120) {
    begins.push_back(begin);
    std::vector<std::size_t> markers(frames[begin].size());
    for (std::size_t j = 0; j < markers.size(); ++j) markers[j] = j;
    std::shuffle(markers.begin(), markers.end(), random);
    markers.resize(3 * markers.size() / 10);
    for (std::size_t f = begin; f < begin + 60; ++f) {
      for (const std::size_t j : markers) frames[f][j].reset();
    }
  }
  return begins;
}

TEST(Sequence, BearsThreeInTenMarkersHidden) {
  const Skeleton skeleton = walker();
  for (unsigned seed = 1; seed <= 2; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const std::vector<ObservedMarkers> frames = walking(skeleton, 270, random);
    std::vector<ObservedMarkers> detected = frames;
    const std::vector<std::size_t> begins = hide(detected, random);
    for (const bool smooth : {false, true}) {
      SCOPED_TRACE(smooth ? "smooth" : "in turn");
      const SequenceOptions options{.pose = {}, .whole = smooth, .smooth = smooth};
      const SolvedSequence all = solve_sequence(skeleton, frames, 120, options),
                           hidden = solve_sequence(skeleton, detected, 120, options);
      for (std::size_t c = 0; c < skeleton.coordinates.size(); ++c) {
        if (!skeleton.coordinates[c].is_rotation) continue;
        double step = 0, off = 0;
        for (const std::size_t begin : begins) {
          for (std::size_t f = begin; f < begin + 100; ++f) {
            if (!all.observed[f][c]) continue;
            if (f >= begin + 72) off = std::max(off, std::abs(hidden.rows[f][c] - all.rows[f][c]));
            if (hidden.observed[f][c] && hidden.observed[f - 1][c])
              step = std::max(step,
                              std::abs(hidden.rows[f][c] - hidden.rows[f - 1][c]) - std::abs(all.rows[f][c] - all.rows[f - 1][c]));
          }
        }
        EXPECT_LT(off * kDegrees, 2) << skeleton.coordinates[c].name;
        if (smooth) {
          EXPECT_LT(step * kDegrees, 10) << skeleton.coordinates[c].name;
        }
      }
    }
  }
}

/// An observed segment stays where its markers have it, however fast it moves.
TEST(Sequence, SmoothingDoesNotBiasWhatIsSeen) {
  const Skeleton skeleton = walker();
  std::mt19937 random(5);
  const std::vector<ObservedMarkers> frames = walking(skeleton, 100, random);
  for (const double rate : {25.0, 120.0, 1000.0}) {  // the same frames: a walk 5 times slower to 8 times faster
    const SolvedSequence in_turn = solve_sequence(skeleton, frames, rate),
                         smooth = solve_sequence(skeleton, frames, rate, {.pose = {}, .whole = true, .smooth = true});
    double before = 0, after = 0;
    for (std::size_t f = 0; f < frames.size(); ++f) {
      before += std::pow(in_turn.rms_m[f], 2);
      after += std::pow(smooth.rms_m[f], 2);
    }
    EXPECT_LT(std::sqrt(after), 1.02 * std::sqrt(before)) << rate;
  }
}

}  // namespace
}  // namespace marey::solve::skeleton
