#include "marey/calibrate/board/board_rig.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "marey/calibrate/board/board_graph.h"
#include "marey/calibrate/board/board_motion.h"
#include "marey/calibrate/board/board_pose.h"
#include "marey/calibrate/bundle/bundle.h"
#include "marey/core/error.h"

namespace marey::calibrate::board {
namespace {

using Timing = BoardRigOptions::Timing;

/// Every view with the pose that its camera alone would give it; views without one are omitted of both lists.
std::vector<std::vector<PosedView>> pose_views(const Board& board, std::vector<BoardRigCamera>& cameras, bool stills) {
  std::vector<std::vector<PosedView>> all;
  for (BoardRigCamera& camera : cameras) {
    std::vector<PosedView> posed;
    std::erase_if(camera.views, [&](const TimedView& detected) {
      const auto pose = board_pose(board, detected.view, camera.lens);
      if (pose) posed.push_back({stills ? static_cast<double>(detected.instant) : detected.time_s, *pose});
      return !pose;
    });
    if (camera.views.empty())
      throw Error("camera \"{}\": the board {} is not seen; is it the board that was shown?", camera.name, to_string(board));
    all.push_back(std::move(posed));
  }
  return all;
}

/// All that the lens's calibration had found is free; coefficients that it left at 0 stay.
bundle::LensFreedom freedom_of(const geometry::Lens& lens) {
  bundle::LensFreedom freedom;
  freedom.focal = freedom.aspect = freedom.principal = bundle::LensFreedom::free;
  std::visit(
      [&](const auto& model) {
        for (std::size_t i = 0; i < model.distortion.size(); ++i)
          freedom.distortion[i] = model.distortion[i] != 0 ? bundle::LensFreedom::free : 0;
      },
      lens);
  return freedom;
}

/// Stills: one board pose an instant, and the bundle over all.
BoardRig fit_stills(const Board& board, std::span<const BoardRigCamera> cameras, const std::vector<std::vector<PosedView>>& poses,
                    const std::vector<BoardPlacement>& start, bool refine_lenses) {
  bundle::Bundle bundle;
  for (int id = 0; id < board.corner_count(); ++id) bundle.board.push_back(board.corner(id));
  std::map<std::int64_t, int> bodies;  // by instant
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    bundle::BundleCamera camera{cameras[c].lens, start[c].camera_from_world, 0, {}, c > 0, false};
    if (refine_lenses) camera.freedom = freedom_of(cameras[c].lens);
    bundle.cameras.push_back(camera);
    for (std::size_t i = 0; i < poses[c].size(); ++i) {
      const TimedView& detected = cameras[c].views[i];
      const auto [at, fresh] = bodies.try_emplace(detected.instant, static_cast<int>(bundle.bodies.size()));
      if (fresh) bundle.bodies.emplace_back(start[c].camera_from_world.inverse() * poses[c][i].camera_from_board);
      for (const BoardCorner& corner : detected.view.corners)
        bundle.observations.push_back({static_cast<int>(c), at->second, corner.id, corner.pixel, Vector<2>::Zero()});
    }
  }
  bundle::BundleOptions how;
  how.min_outlier_px = 0.5;
  how.outlier_sigmas = 6;
  const bundle::BundleResult found = bundle::adjust(bundle, how);
  BoardRig rig;
  rig.noise_px = found.noise_px;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    BoardRigPose camera{bundle.cameras[c].lens, bundle.cameras[c].camera_from_world};
    camera.centre_deviation = found.deviations[c].centre;
    rig.cameras.push_back(camera);
  }
  const auto errors = bundle::errors_of(bundle);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    BoardRigPose& camera = rig.cameras[static_cast<std::size_t>(bundle.observations[i].camera)];
    ++camera.observations;
    if (!found.inlier[i]) continue;
    ++camera.inliers;
    camera.mean_px += errors[i]->norm();
    camera.rms_px += errors[i]->squaredNorm();
  }
  for (BoardRigPose& camera : rig.cameras) {
    camera.mean_px /= std::max(1, camera.inliers);
    camera.rms_px = std::sqrt(camera.rms_px / std::max(1, camera.inliers));
    rig.observations += camera.observations;
  }
  rig.inliers = found.inliers;
  rig.mean_px = found.mean_px;
  rig.rms_px = found.rms_px;
  return rig;
}

double longest_period(const std::vector<std::vector<PosedView>>& poses) {
  double longest = 0;
  for (const auto& views : poses) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < views.size(); ++i) steps.push_back(views[i].time_s - views[i - 1].time_s);
    if (steps.empty()) continue;
    std::ranges::sort(steps);
    longest = std::max(longest, steps[steps.size() / 2]);
  }
  return longest;
}

void warn(BoardRig& rig, std::span<const BoardRigCamera> cameras, double frame_s) {
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const BoardRigPose& camera = rig.cameras[c];
    if (camera.inliers < 0.8 * camera.observations)
      rig.warnings.push_back(fmt::format(
          "camera \"{}\": {} of {} corners do not fit the others'; was the board flat, and the lens calibrated at this focus?",
          cameras[c].name, camera.observations - camera.inliers, camera.observations));
    if (camera.offset_deviation_s > 0.1 * frame_s)
      rig.warnings.push_back(
          fmt::format("camera \"{}\": its offset is known to no better than {:.1f} ms; move the board faster, to all sides",
                      cameras[c].name, 1e3 * camera.offset_deviation_s));
  }
  if (rig.jitter_s > 0.02 * frame_s)
    rig.warnings.push_back(
        fmt::format("images were taken unevenly, {:.1f} ms before or after their time: what moves fast will be placed badly",
                    1e3 * rig.jitter_s));
}

}  // namespace

BoardRig calibrate_board_rig(const Board& board, std::span<const BoardRigCamera> given, const BoardRigOptions& options) {
  if (given.size() < 2) throw Error("a rig is calibrated from two cameras at least, and there is {}", given.size());
  std::vector<BoardRigCamera> cameras(given.begin(), given.end());
  const bool stills = options.timing == Timing::stills;
  const auto poses = pose_views(board, cameras, stills);
  const std::vector<BoardPlacement> located = position_cameras(poses, cameras, options);
  if (stills) return fit_stills(board, cameras, poses, located, options.refine_lenses);
  std::vector<BoardRigPose> start;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    BoardRigPose camera;
    camera.lens = cameras[c].lens;
    camera.camera_from_world = located[c].camera_from_world;
    camera.offset_s = located[c].offset_s;
    start.push_back(camera);
  }
  BoardMotionOptions how;
  how.knot_s = longest_period(poses);
  how.refine_offsets = options.timing == Timing::videos;
  how.refine_lenses = options.refine_lenses;
  how.refine_readout = options.rolling_shutter;
  BoardRig rig = fit_board_motion(board, cameras, poses, start, how, true);
  warn(rig, cameras, how.knot_s);
  return rig;
}

}  // namespace marey::calibrate::board
