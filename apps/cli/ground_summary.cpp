#include "ground_summary.h"

#include <cstdio>
#include <string>

#include <fmt/core.h>

#include "json_value.h"
#include "summary_figures.h"

namespace marey::cli {
namespace {

std::int64_t camera_frames(const pipeline::people::ground::GroundSummary& summary) {
  std::int64_t sum = 0;
  for (const auto& camera : summary.cameras) sum += camera.frames;
  return sum;
}

}  // namespace

void print_json(const pipeline::people::ground::GroundSummary& summary, const pipeline::people::ground::GroundOutput& output,
                double elapsed) {
  Json cameras = Json::array();
  for (const pipeline::corridor::Summary::Camera& camera : summary.cameras) {
    cameras.push_back(
        {{"name", camera.name},
         {"frames", camera.frames},
         {"missed", camera.missed},
         {"detections", camera.detections},
         {"dropped", {{"outside", camera.outside}, {"noise", camera.noise}, {"unexplained_regions", camera.misfits}}}});
  }
  Json teams = Json::array();
  for (const analyse::Teams::Team& team : summary.teams) teams.push_back({{"name", team.name}, {"people", team.people}});
  const pipeline::corridor::GroundFigures ground = summary.ground.value_or(pipeline::corridor::GroundFigures{});
  const Json json = {{"frames", summary.frames},
                     {"seconds", summary.seconds},
                     {"people", summary.tracks},
                     {"rows", summary.samples},
                     {"predicted", summary.samples - summary.measured},
                     {"off_pitch", summary.dropped.off_pitch.value_or(0)},
                     {"cameras", cameras},
                     {"teams", teams},
                     {"elapsed", elapsed},
                     {"tracking_s", summary.first_pass_s},
                     {"linking_s", ground.linking_s},
                     {"links", ground.links},
                     {"uncertain_links", ground.uncertain_links},
                     {"interrupted", summary.stopped},
                     {"notes", summary.notes},
                     {"warnings", summary.warnings},
                     {"tracks", output.tracks},
                     {"overlays", path_or_null(output.overlays)},
                     {"copies", path_or_null(output.copies)},
                     {"numbers", path_or_null(output.numbers)},
                     {"pitch_view", path_or_null(output.pitch_view)}};
  print(json);
}

void print_summary(const pipeline::people::ground::GroundSummary& summary, const pipeline::people::ground::GroundOutput& output,
                   double elapsed) {
  for (const std::string& message_text : summary.notes) fmt::print(stderr, "{}\n", message_text);
  const std::size_t count = summary.cameras.size();
  fmt::print(stderr, "{} {} in {} instants ({:.1f} s), seen by {} {}; {:.0f} frames/s in all\n", summary.tracks,
             summary.tracks == 1 ? "person" : "people", summary.frames, summary.seconds, count, count == 1 ? "camera" : "cameras",
             static_cast<double>(camera_frames(summary)) / elapsed);
  for (const analyse::Teams::Team& team : summary.teams) fmt::print(stderr, "team {}: {} people\n", team.name, team.people);
  const std::int64_t predicted = summary.samples - summary.measured;
  if (predicted > 0)
    fmt::print(stderr, "{:.1f} % of their places were not seen but distinguished from before and after\n",
               percent_of(predicted, summary.samples));
  if (const std::int64_t off = summary.dropped.off_pitch.value_or(0); off > 0)
    fmt::print(stderr, "omitted: {} who were never on the pitch\n", off);
  for (const pipeline::corridor::Summary::Camera& camera : summary.cameras) {
    fmt::print(stderr, "{}: {} frames, {:.1f} people in each", camera.name, camera.frames,
               static_cast<double>(camera.detections) / static_cast<double>(std::max<std::int64_t>(1, camera.frames)));
    if (camera.missed > 0) fmt::print(stderr, "; no frame for {} instants", camera.missed);
    if (camera.outside > 0) fmt::print(stderr, "; omitted: {} seen beyond the pitch", camera.outside);
    if (camera.misfits > 0) fmt::print(stderr, "; {} moving regions that no body explains", camera.misfits);
    fmt::print(stderr, "\n");
  }
  fmt::print(stderr, "tracks: {}\n", output.tracks);
  if (!output.overlays.empty()) fmt::print(stderr, "overlays: {}\n", output.overlays);
  if (!output.copies.empty()) fmt::print(stderr, "copies: {}\n", output.copies);
  if (!output.numbers.empty()) fmt::print(stderr, "numbers: {}\n", output.numbers);
  if (!output.pitch_view.empty()) fmt::print(stderr, "pitch view: {}\n", output.pitch_view);
}

}  // namespace marey::cli
