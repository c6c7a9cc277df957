// Three in ten markers hidden for half a second, once a second, at random, on recordings of many kinds: how far the solved angles
// step and how far they are from the solution with all markers. A row for each recording, in turn (as while cameras see), offline
// and with --smooth: windows in which an angle that a marker determines steps by more than 10° beyond that solution, the largest
// such step, windows after which it is more than 2° off from 0.1 s after the markers' return on (angles that all markers
// determine), and the largest of these. Usage: hidden_markers [SEEDS] [WORD: only recordings whose name has it] [-v: every such
// window]
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ostream.h>

#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/pipeline/bodies/solve_skeleton.h"
#include "marey/pipeline/markers/skeleton_in_space.h"
#include "marey/solve/skeleton/sequence.h"

namespace {

using namespace marey;
using solve::skeleton::ObservedMarkers;
using solve::skeleton::SolvedSequence;

constexpr double kDegrees = 180 / std::numbers::pi;

struct Case {
  std::string name, recording, skeleton;
  pipeline::bodies::SolveOptions options;
};

std::vector<Case> cases(const std::string& data) {
  std::vector<Case> all;
  for (const char* subject : {"subject01", "subject02", "subject04"}) {
    Case c{std::string("arnold ") + subject,
           data + "/arnold_synthetic/" + subject + "/markers.trc",
           data + "/arnold_synthetic/" + subject + "/scaled.osim",
           {}};
    for (const char side : {'R', 'L'}) {
      for (const char* joint : {"HJC", "KJC", "AJC", "SJC", "EJC"}) c.options.exclude.push_back(side + std::string(joint));
    }
    all.push_back(std::move(c));
  }
  all.push_back({"opensim synthetic",
                 data + "/opensim_ik/synthetic/subject01_synthetic_marker_data.trc",
                 data + "/opensim_ik/synthetic/subject01_simbody.osim",
                 {}});
  all.push_back({"hamner run",
                 data + "/opensim_models/hamner/subject02_running.trc",
                 data + "/opensim_models/hamner/reference/subject02_registered.osim",
                 {}});
  all.push_back({"gait2354 walk",
                 data + "/opensim_models/gait2354/subject01_walk1.trc",
                 data + "/opensim_models/gait2354/reference/subject01_simbody.osim",
                 {}});
  const std::string children = data + "/gait_children";
  if (std::filesystem::exists(children)) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(children)) {
      if (entry.is_directory()) names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    for (const std::string& name : names) {
      std::string standing;
      std::vector<std::string> moving;
      for (const auto& entry : std::filesystem::directory_iterator(children + "/" + name)) {
        const std::string path = entry.path().string();
        if (entry.path().filename().string().starts_with("static"))
          standing = path;
        else
          moving.push_back(path);
      }
      std::sort(moving.begin(), moving.end());
      for (const std::string& path : moving) {
        Case c{"child " + std::filesystem::path(path).stem().string(), path, "", {}};
        c.options.static_trial = standing;
        all.push_back(std::move(c));
      }
    }
  }
  const std::string vicon = data + "/vicon_skeleton/";
  for (const auto& [take, skeleton] : {std::pair("nick_freeform_001", "Nick01"), std::pair("squat", "SehoonVSK3")}) {
    Case c{std::string("vicon ") + take, vicon + take + ".c3d", vicon + skeleton + ".vsk", {}};
    c.options.up = format::UpAxis::y;
    c.options.calibrate = std::string(take) == "squat";
    all.push_back(std::move(c));
  }
  std::erase_if(all, [](const Case& c) { return !std::filesystem::exists(c.recording); });
  return all;
}

std::vector<ObservedMarkers> read_frames(const Case& c, const Skeleton& skeleton, double& rate_hz) {
  const format::Format& format = format::format_to_read(c.recording, format::Content::space);
  format::ReadOptions how;
  how.up = c.options.up.value_or(format.name == "trc" && c.skeleton.ends_with(".osim") ? format::UpAxis::y : format::UpAxis::z);
  const auto reader = format::open_recording(c.recording, format, how);
  rate_hz = reader->header().rate_hz;
  pipeline::markers::SkeletonMarkers labels(skeleton, c.options.exclude);
  labels.name(reader->tracks());
  std::vector<ObservedMarkers> frames;
  while (const auto instant = reader->next()) {
    labels.name(instant->named);
    labels.take(*instant, frames.emplace_back());
  }
  return frames;
}

struct Hidden {
  std::size_t begin = 0, end = 0;  ///< frames
};

std::vector<Hidden> hide(std::vector<ObservedMarkers>& frames, double rate_hz, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<Hidden> windows;
  const auto at = [&](double seconds) { return static_cast<std::size_t>(std::lround(seconds * rate_hz)); };
  for (std::size_t begin = at(0.3); begin + at(0.5) < frames.size(); begin += at(1.0)) {
    const Hidden window{begin, begin + at(0.5)};
    std::vector<std::size_t> detected;
    for (std::size_t j = 0; j < frames[begin].size(); ++j) {
      if (frames[begin][j]) detected.push_back(j);
    }
    std::shuffle(detected.begin(), detected.end(), random);
    detected.resize(detected.size() * 3 / 10);
    for (std::size_t f = window.begin; f < window.end; ++f) {
      for (const std::size_t j : detected) frames[f][j].reset();
    }
    windows.push_back(window);
  }
  return windows;
}

struct Found {
  int windows = 0, jumps = 0, off = 0, unobserved = 0, angles = 0;
  double worst_jump = 0, worst_off = 0;
};

void compare(const Skeleton& skeleton, const std::vector<ObservedMarkers>& frames, const SolvedSequence& all,
             const SolvedSequence& hidden, const std::vector<Hidden>& windows, double rate_hz, bool verbose, Found& found) {
  const auto after = static_cast<std::size_t>(std::lround(0.1 * rate_hz));
  for (const Hidden& window : windows) {
    double jump = 0, off = 0;
    std::string jumped, was_off;
    std::size_t off_at = 0;
    const std::size_t until = std::min(all.rows.size(), window.end + 3 * after);
    for (std::size_t c = 0; c < skeleton.coordinates.size(); ++c) {
      if (!skeleton.coordinates[c].is_rotation || !skeleton.coordinates[c].free()) continue;
      for (std::size_t f = window.begin; f < until; ++f) {
        found.unobserved += all.observed[f][c] && !hidden.observed[f][c] ? 1 : 0;
        found.angles += all.observed[f][c] ? 1 : 0;
        if (all.observed[f][c] && hidden.observed[f][c] && hidden.observed[f - 1][c] && all.observed[f - 1][c]) {
          const double step =
              kDegrees * (std::abs(hidden.rows[f][c] - hidden.rows[f - 1][c]) - std::abs(all.rows[f][c] - all.rows[f - 1][c]));
          if (step > jump) {
            jump = step;
            jumped = fmt::format("{} frame {}", skeleton.coordinates[c].name, f);
          }
        }
        if (f >= window.end + after && all.observed[f][c]) {
          const double here = kDegrees * std::abs(std::remainder(hidden.rows[f][c] - all.rows[f][c], 2 * std::numbers::pi));
          if (here > off) {
            off = here;
            was_off = fmt::format("{} frame {}", skeleton.coordinates[c].name, f);
            off_at = f;
          }
        }
      }
    }
    ++found.windows;
    found.jumps += jump > 10 ? 1 : 0;
    found.off += off > 2 ? 1 : 0;
    found.worst_jump = std::max(found.worst_jump, jump);
    found.worst_off = std::max(found.worst_off, off);
    if (verbose && jump > 10) fmt::print(std::cout, "  frames {}-{}: {} steps {:.1f}\n", window.begin, window.end, jumped, jump);
    if (verbose && off > 2) {
      solve::skeleton::PoseSolver solver(skeleton);
      solver.learn_noise_of(all.rows, frames);
      const auto cost = [&](const SolvedSequence& solved) {
        return solver.cost_of(solver.articulation().state_of(solved.rows[off_at]), frames[off_at]);
      };
      fmt::print(std::cout, "  frames {}-{}: {} is {:.1f} off, cost {:.1f}, with all markers {:.1f}\n", window.begin, window.end,
                 was_off, off, cost(hidden), cost(all));
    }
  }
}

double rms_mm(const SolvedSequence& solved) {
  double sum = 0;
  int count = 0;
  for (std::size_t f = 0; f < solved.rms_m.size(); ++f) {
    sum += solved.rms_m[f] * solved.rms_m[f];
    ++count;
  }
  return 1000 * std::sqrt(sum / std::max(1, count));
}

}  // namespace

int main(int argc, char** argv) {
  const char* given = std::getenv("MAREY_DATA");
  const std::string data = given != nullptr ? given : "../shared/data";
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 4;
  const std::string only = argc > 2 ? argv[2] : "";
  const bool verbose = argc > 3;
  fmt::print(std::cout, "recording, way, RMS mm, windows, jumps, largest, off, largest, unseen %\n");
  for (const Case& c : cases(data)) {
    if (c.name.find(only) == std::string::npos) continue;
    pipeline::bodies::SolveOptions options = c.options;
    options.up = c.options.up;
    const Skeleton skeleton = pipeline::bodies::solve_with_skeleton(c.recording, c.skeleton, options).skeleton;
    double rate_hz = 0;
    const std::vector<ObservedMarkers> frames = read_frames(c, skeleton, rate_hz);
    for (const std::string method : {"in turn", "offline", "smooth"}) {
      const auto solve = [&](const std::vector<ObservedMarkers>& detected) {
        return solve::skeleton::solve_sequence(skeleton, detected, rate_hz,
                                               {.pose = {}, .whole = method != "in turn", .smooth = method == "smooth"});
      };
      const SolvedSequence all = solve(frames);
      Found found;
      for (int seed = 1; seed <= seeds; ++seed) {
        std::vector<ObservedMarkers> detected = frames;
        const std::vector<Hidden> windows = hide(detected, rate_hz, static_cast<std::uint32_t>(seed));
        compare(skeleton, frames, all, solve(detected), windows, rate_hz, verbose, found);
      }
      fmt::print(std::cout, "{}, {}, {:.2f}, {}, {}, {:.1f}, {}, {:.2f}, {:.1f}\n", c.name, method, rms_mm(all), found.windows,
                 found.jumps, found.worst_jump, found.off, found.worst_off, 100.0 * found.unobserved / std::max(1, found.angles));
      std::cout.flush();
    }
  }
}
