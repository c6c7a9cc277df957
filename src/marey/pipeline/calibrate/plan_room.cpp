#include "marey/pipeline/calibrate/plan_room.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/draw/room_plan.h"
#include "marey/files/whole_file.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/rig/room_file.h"
#include "marey/geometry/median.h"

namespace marey::pipeline::calibrate {
namespace {

std::vector<Camera> cameras_of(const Rig& rig) {
  std::vector<Camera> cameras;
  for (const RigCamera& one : rig.cameras) {
    if (const auto camera = one.camera()) cameras.push_back(*camera);
  }
  return cameras;
}

double field_of_view_of(const Camera& camera) {
  const double middle = (camera.size().height - 1) / 2.0;
  const auto left = camera.bearing({0, middle}), right = camera.bearing({camera.size().width - 1.0, middle});
  return left && right ? std::acos(std::clamp(left->dot(*right), -1.0, 1.0)) : 1;
}

/// Cells of the grid from above, over its layers.
std::vector<draw::RoomPlan::Cell> cells_of(const PlannedRoom& room, const reconstruct::RoomCoverage& coverage) {
  std::vector<draw::RoomPlan::Cell> cells;
  const Vector<2> low = room.volume.from.head<2>(), extent = room.volume.to.head<2>() - low;
  const Vector<2> step(extent.x() / coverage.columns, extent.y() / coverage.rows);
  for (int j = 0; j < coverage.rows; ++j) {
    for (int i = 0; i < coverage.columns; ++i) {
      draw::RoomPlan::Cell& cell = cells.emplace_back();
      cell.from = low + step.cwiseProduct(Vector<2>(i, j));
      cell.to = cell.from + step;
      double squares = 0;
      for (int k = 0; k < coverage.layers; ++k) {
        const auto& point = coverage.points[static_cast<std::size_t>((k * coverage.rows + j) * coverage.columns + i)];
        cell.covered += point.covered / coverage.layers;
        squares += point.covered * point.error_m * point.error_m / coverage.layers;
      }
      if (cell.covered > 0) cell.error_m = std::sqrt(squares / cell.covered);
    }
  }
  return cells;
}

void draw_plan(const PlanOptions& options, const PlanSummary& summary, const Rig& rig, const reconstruct::RoomCoverage& coverage) {
  draw::RoomPlan plan{
      .title = fmt::format("{} {} cameras: {:.0f} % covered, {:.1f} mm in the median", rig.cameras.size(),
                           options.rig.empty() ? "planned" : "calibrated", 100 * coverage.covered, 1000 * coverage.median_m),
      .caption = fmt::format(
          "from above; share of points and sides that two cameras or more see, and the expected error at {} px of noise",
          summary.room.noise_px),
      .room = summary.room,
      .cameras = {},
      .cells = cells_of(summary.room, coverage)};
  for (const RigCamera& one : rig.cameras) {
    const auto camera = one.camera();
    if (!camera) continue;
    const Vector<3> ahead = camera->camera_from_world().rotation.row(2);
    plan.cameras.push_back(
        {one.name, camera->centre().head<2>(), ahead.head<2>(), camera->centre().z(), field_of_view_of(*camera)});
  }
  WholeFile file(options.plot);
  file.write(draw::to_svg(plan));
  file.finish();
}

/// The recording's measured points that bring a covariance.
std::optional<ReachedError> reached_of(const std::string& path, const Rig& rig, double noise_px) {
  std::vector<std::optional<Camera>> cameras;
  for (const RigCamera& one : rig.cameras) cameras.push_back(one.camera());
  std::vector<double> reached, expected, ratios;
  const auto reader = format::open_recording(path, format::format_to_read(path, format::Content::space));
  while (const auto instant = reader->next()) {
    stop_point();
    for (const Sample& sample : instant->samples) {
      if (!sample.covariance || !sample.measured() || sample.cameras == 0) continue;
      std::vector<Camera> seeing;
      for (std::size_t i = 0; i < cameras.size() && i < 64; ++i) {
        if (cameras[i] && (sample.cameras >> i & 1) != 0) seeing.push_back(*cameras[i]);
      }
      const auto bound = reconstruct::expected_error(sample.position, seeing, noise_px);
      if (!bound) continue;
      reached.push_back(std::sqrt(sample.covariance->trace()));
      expected.push_back(*bound);
      ratios.push_back(reached.back() / *bound);
    }
  }
  if (reached.empty()) return std::nullopt;
  const auto points = std::ssize(reached);
  return ReachedError{points, geometry::median(reached), geometry::median(expected), noise_px * geometry::median(ratios)};
}

}  // namespace

PlanSummary plan_room(const PlanOptions& options, const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  if (!options.recording.empty() && options.rig.empty())
    throw Error("{}: --recording is compared with the rig that made it; give --rig too", options.recording);
  PlanSummary summary;
  summary.room = format::rig::read_room(options.room);
  if (options.count) summary.room.cameras = *options.count;
  summary.planned = reconstruct::plan_cameras(summary.room);
  summary.coverage = reconstruct::coverage_of(summary.room, cameras_of(summary.planned));
  if (summary.room.mounts.size() < summary.planned.cameras.size())
    summary.warnings.push_back(fmt::format("{}: {} mounts for {} cameras: some hang at one place", options.room,
                                           summary.room.mounts.size(), summary.planned.cameras.size()));
  if (!options.output.empty()) format::rig::write_rig(summary.planned, options.output);
  if (options.rig.empty()) {
    if (!options.plot.empty()) draw_plan(options, summary, summary.planned, summary.coverage);
    return summary;
  }
  const Rig rig = format::rig::read_rig(options.rig);
  const std::vector<Camera> cameras = cameras_of(rig);
  summary.rig_cameras = static_cast<int>(cameras.size());
  if (cameras.empty()) throw Error("{}: no camera of it is calibrated; `marey calibrate` does that", options.rig);
  summary.rig = reconstruct::coverage_of(summary.room, cameras);
  if (!options.plot.empty()) draw_plan(options, summary, rig, *summary.rig);
  if (!options.recording.empty()) {
    summary.reached = reached_of(options.recording, rig, summary.room.noise_px);
    if (!summary.reached)
      summary.warnings.push_back(
          fmt::format("{}: has no point with a covariance and the cameras that saw it; a take (.marey) of `marey reconstruct` has",
                      options.recording));
  }
  return summary;
}

}  // namespace marey::pipeline::calibrate
