#include "marey/pipeline/corridor/summary.h"

namespace marey::pipeline::corridor {
namespace {

using reconstruct::NoPoint;

std::string_view key_of(NoPoint reason) {
  switch (reason) {
    case NoPoint::too_few_rays:
      return "too_few_rays";
    case NoPoint::parallel_rays:
      return "parallel_rays";
    case NoPoint::behind_camera:
      return "behind_camera";
    case NoPoint::rays_disagree:
      return "rays_disagree";
    case NoPoint::no_solution:
      return "no_solution";
  }
  return "";
}

}  // namespace

std::vector<Exclusion> exclusions(const Summary& summary) {
  std::vector<Exclusion> all;
  const auto add = [&](std::string_view key, std::string_view description, std::optional<std::int64_t> count) {
    if (count) all.push_back({key, description, *count});
  };
  const Dropped& dropped = summary.dropped;
  add("too_short", "seen too briefly to be trusted", dropped.too_short);
  add("noise", "moving regions too small to be a part of a person", dropped.noise);
  add("no_person", "boxes in which the network sees no person", dropped.no_person);
  add("unexplained_regions", "moving regions that no body explains", dropped.unexplained_regions);
  add("off_pitch", "who were never on the pitch", dropped.off_pitch);
  if (summary.points) {
    add("two_ray_points", "points of two rays alone", summary.points->two_ray_points);
    for (const auto& [reason, count] : summary.points->not_located) add(key_of(reason), reconstruct::meaning(reason), count);
  }
  if (summary.live) {
    add("superseded", "instants superseded by a newer one", summary.live->superseded);
    add("incomplete", "instants incomplete", summary.live->incomplete);
    add("empty", "instants without a camera", summary.live->empty);
    add("late_frames", "frames late", summary.live->late_frames);
    add("overrun", "frames overrun", summary.live->overrun);
  }
  return all;
}

std::vector<std::pair<std::string_view, double>> figures(const Summary& summary) {
  std::vector<std::pair<std::string_view, double>> all;
  const auto add = [&](std::string_view name, auto value) { all.emplace_back(name, static_cast<double>(value)); };
  if (const auto& noise = summary.noise) {
    add("measurement_px", noise->measurement_px);
    add("acceleration_px_s2", noise->acceleration_px_s2);
  }
  if (const auto& points = summary.points) {
    add("noise_px", points->noise_px);
    if (points->residual_px) add("residual_px", *points->residual_px);
    add("observations", points->observations);
    add("unexplained", points->unexplained);
  }
  if (const auto& set = summary.marker_set) {
    add("set_points", set->points);
    add("set_named", set->named);
    add("set_searched_s", set->searched_s);
    if (set->found_at_s) add("set_found_at_s", *set->found_at_s);
  }
  if (const auto& skeleton = summary.skeleton) {
    if (skeleton->rms_mm) add("skeleton_rms_mm", *skeleton->rms_mm);
    add("skeleton_initialisations", skeleton->initialisations);
  }
  if (const auto& ground = summary.ground) {
    add("linking_s", ground->linking_s);
    add("links", ground->links);
    add("uncertain_links", ground->uncertain_links);
    if (ground->ball_samples) add("ball_samples", *ground->ball_samples);
  }
  if (const auto& keypoints = summary.body_points) {
    add("people", keypoints->people);
    add("people_in_images", keypoints->people_in_images);
    add("people_located", keypoints->people_located);
    add("regions", keypoints->regions);
    add("person_searches", keypoints->person_searches);
    if (keypoints->residual_px) add("residual_px", *keypoints->residual_px);
    add("noise", keypoints->noise);
  }
  return all;
}

}  // namespace marey::pipeline::corridor
