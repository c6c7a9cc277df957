#include "reconstruct_keypoints.h"

#include <cmath>
#include <cstdio>
#include <string>

#include <fmt/core.h>

namespace marey::cli {

Json keypoints_json(const pipeline::keypoints::KeypointsSummary& summary, const std::string& out) {
  Json people = Json::array(), cameras = Json::object();
  for (const auto& person : summary.people)
    people.push_back({{"label", person.label}, {"instants", person.instants}, {"views", person.views}});
  for (const auto& camera : summary.cameras) {
    Json& stated = cameras[camera.name];
    stated = {{"frames", camera.frames},           {"people", camera.people}, {"placed", camera.located},
              {"residual_px", camera.residual_px}, {"noise", camera.noise},   {"swapped_limbs", camera.swapped}};
    stated["offset_s"] = camera.offset_s ? Json(*camera.offset_s) : Json();
    stated["offset_sigma_s"] = camera.offset_sigma_s ? Json(*camera.offset_sigma_s) : Json();
  }
  return {{"keypoint_set", summary.set},
          {"keypoints", summary.points},
          {"frames", summary.frames},
          {"seconds", summary.seconds},
          {"rate_hz", summary.rate_hz},
          {"people", people},
          {"cameras", cameras},
          {"points", {{"measured", summary.measured}, {"filled", summary.filled}}},
          {"people_in_images", summary.views},
          {"people_in_images_placed", summary.located},
          {"residual_px", summary.residual_px},
          {"noise", summary.noise},
          {"place_ms", summary.position_ms},
          {"one_camera", summary.one_camera},
          {"interrupted", summary.stopped},
          {"warnings", summary.warnings},
          {"take", out}};
}

void print_keypoints_summary(const pipeline::keypoints::KeypointsSummary& summary, const std::string& out) {
  fmt::print(stderr, "{} {} of {} keypoints ({}) in {} frames ({:.1f} s at {:g} Hz)\n", summary.people.size(),
             summary.people.size() == 1 ? "person" : "people", summary.points, summary.set, summary.frames, summary.seconds,
             summary.rate_hz);
  for (const auto& person : summary.people) {
    if (!person.label.empty())
      fmt::print(stderr, "  {}: in {} frames, by {:.1f} cameras\n", person.label, person.instants, person.views);
  }
  fmt::print(stderr, "points: {} measured, {} filled; {} of {} people in images are placed\n", summary.measured, summary.filled,
             summary.located, summary.views);
  if (summary.one_camera) {
    fmt::print(stderr, "take: {}\n", out);
    return;
  }
  fmt::print(stderr, "reprojection: {:.1f} px median; noise {:.2f} times what the files state\n", summary.residual_px,
             summary.noise);
  for (const auto& camera : summary.cameras) {
    if (camera.frames == 0) continue;
    std::string line = fmt::format("  {}: {:.1f} px", camera.name, camera.residual_px);
    if (camera.swapped > 0) line += fmt::format(", left and right exchanged in {} limbs", camera.swapped);
    if (camera.offset_s)
      line += fmt::format(", started {:.1f} ms {} ± {:.1f} ms", 1000 * std::abs(*camera.offset_s),
                          *camera.offset_s < 0 ? "earlier" : "later", 1000 * camera.offset_sigma_s.value_or(0));
    fmt::print(stderr, "{}\n", line);
  }
  fmt::print(stderr, "association and triangulation: {:.2f} ms a frame\n", summary.position_ms);
  fmt::print(stderr, "take: {}\n", out);
}

}  // namespace marey::cli
