#include "track_summary.h"

#include <cstdio>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include "json_value.h"
#include "summary_figures.h"

namespace marey::cli {
namespace {

std::string_view counted(bool markers, std::int64_t count) {
  if (markers) return count == 1 ? "marker" : "markers";
  return count == 1 ? "person" : "people";
}

void print_excluded(const pipeline::corridor::Summary& summary) {
  for (const pipeline::corridor::Exclusion& one : exclusions(summary)) {
    if (one.count > 0) fmt::print(stderr, "omitted: {} {}\n", one.count, one.description);
  }
}

}  // namespace

void print_json(const pipeline::corridor::Summary& summary, const pipeline::people::TrackOutput& output, bool markers,
                double elapsed) {
  Json json = {{"frames", summary.frames},
               {"seconds", summary.seconds},
               {markers ? "markers" : "people", summary.tracks},
               {"rows", summary.samples},
               {"detections", summary.detections},
               {"elapsed", elapsed},
               {"interrupted", summary.stopped},
               {"notes", summary.notes},
               {"warnings", summary.warnings},
               {"tracks", output.tracks},
               {"overlay", path_or_null(output.overlay)},
               {"copy", path_or_null(output.copy)},
               {"plot", path_or_null(output.plot)}};
  if (!output.numbers.empty()) json["numbers"] = output.numbers;
  if (!markers) {
    const pipeline::corridor::Dropped& dropped = summary.dropped;
    json["dropped"] = {{"noise", dropped.noise.value_or(0)},
                       {"unexplained_regions", dropped.unexplained_regions.value_or(0)},
                       {"too_short", dropped.too_short.value_or(0)}};
  }
  if (summary.noise)
    json["noise"] = {{"measurement_px", summary.noise->measurement_px}, {"acceleration_px_s2", summary.noise->acceleration_px_s2}};
  if (summary.outlines > 0) json["outlines"] = {{"rows", summary.outlines}, {"coasted", summary.held_outlines}};
  if (summary.keypoints > 0)
    json["keypoints"] = {{"rows", summary.keypoints}, {"no_person", summary.dropped.no_person.value_or(0)}};
  print(json);
}

void print_summary(const pipeline::corridor::Summary& summary, const pipeline::people::TrackOutput& output, bool markers,
                   double elapsed) {
  for (const std::string& message_text : summary.notes) fmt::print(stderr, "{}\n", message_text);
  fmt::print(stderr, "{} {} in {} {} ({:.1f} s), {:.0f} frames/s\n", summary.tracks, counted(markers, summary.tracks),
             summary.frames, summary.frames == 1 ? "frame" : "frames", summary.seconds,
             static_cast<double>(summary.frames) / elapsed);
  print_excluded(summary);
  if (summary.noise) {
    fmt::print(stderr, "noise: {:.3f} px in a measured place, {:.0f} px/s\u00b2 of acceleration\n", summary.noise->measurement_px,
               summary.noise->acceleration_px_s2);
  }
  if (summary.outlines > 0) {
    fmt::print(stderr, "outlines: {}, {:.0f} % of them held while too little was seen\n", summary.outlines,
               100.0 * static_cast<double>(summary.held_outlines) / static_cast<double>(summary.outlines));
  }
  if (summary.keypoints > 0) {
    fmt::print(stderr, "keypoints: in {} of {} rows\n", summary.keypoints, summary.samples);
  }
  fmt::print(stderr, "tracks: {}\n", output.tracks);
  if (!output.overlay.empty()) fmt::print(stderr, "overlay: {}\n", output.overlay);
  if (!output.copy.empty()) fmt::print(stderr, "copy: {}\n", output.copy);
  if (!output.numbers.empty()) fmt::print(stderr, "numbers: {}\n", output.numbers);
  if (!output.plot.empty()) fmt::print(stderr, "plot: {}\n", output.plot);
}

}  // namespace marey::cli
