#include "track_summary.h"

#include <cstdio>
#include <string>

#include <fmt/core.h>

#include "json_value.h"

namespace marey::cli {
namespace {

Json path_or_null(const std::string& path) {
  return path.empty() ? Json() : Json(path);
}

void print_pictures(const pipeline::TrackOutput& output) {
  if (!output.overlay.empty()) fmt::print(stderr, "overlay: {}\n", output.overlay);
  if (!output.plot.empty()) fmt::print(stderr, "plot: {}\n", output.plot);
}

}  // namespace

void print_json(const pipeline::TrackSummary& summary, const pipeline::TrackOutput& output, double elapsed) {
  Json json = {{"frames", summary.frames},
               {"seconds", summary.seconds},
               {"people", summary.people},
               {"rows", summary.rows},
               {"detections", summary.detections},
               {"dropped", {{"noise", summary.noise}, {"misfits", summary.misfits}, {"too_brief", summary.too_brief}}},
               {"elapsed", elapsed},
               {"stopped", summary.stopped},
               {"warnings", summary.warnings},
               {"tracks", output.tracks},
               {"overlay", path_or_null(output.overlay)},
               {"plot", path_or_null(output.plot)}};
  if (summary.outlines > 0) json["outlines"] = {{"rows", summary.outlines}, {"held", summary.held}};
  print(json);
}

void print_summary(const pipeline::TrackSummary& summary, const pipeline::TrackOutput& output, double elapsed) {
  fmt::print(stderr, "{} {} in {} frames ({:.1f} s), {:.0f} frames/s\n", summary.people, summary.people == 1 ? "person" : "people",
             summary.frames, summary.seconds, static_cast<double>(summary.frames) / elapsed);
  if (summary.too_brief > 0) fmt::print(stderr, "left out: {} seen too briefly to be believed\n", summary.too_brief);
  if (summary.noise > 0) fmt::print(stderr, "left out: {} moving regions too small to be a part of a person\n", summary.noise);
  if (summary.misfits > 0) fmt::print(stderr, "left out: {} moving regions that no body explains\n", summary.misfits);
  if (summary.outlines > 0) {
    fmt::print(stderr, "outlines: {}, {:.0f} % of them held while too little was seen\n", summary.outlines,
               100.0 * static_cast<double>(summary.held) / static_cast<double>(summary.outlines));
  }
  fmt::print(stderr, "tracks: {}\n", output.tracks);
  print_pictures(output);
}

void print_json(const pipeline::MarkerSummary& summary, const pipeline::TrackOutput& output, double elapsed) {
  Json json = {{"frames", summary.frames},         {"seconds", summary.seconds},
               {"markers", summary.markers},       {"rows", summary.rows},
               {"detections", summary.detections}, {"elapsed", elapsed},
               {"stopped", summary.stopped},       {"warnings", summary.warnings},
               {"tracks", output.tracks},          {"overlay", path_or_null(output.overlay)},
               {"plot", path_or_null(output.plot)}};
  if (summary.noise) {
    json["noise"] = {{"measurement_px", summary.noise->measurement_sigma}, {"acceleration_px_s2", summary.noise->acceleration}};
  }
  print(json);
}

void print_summary(const pipeline::MarkerSummary& summary, const pipeline::TrackOutput& output, double elapsed) {
  fmt::print(stderr, "{} {} in {} frames ({:.1f} s), {:.0f} frames/s\n", summary.markers,
             summary.markers == 1 ? "marker" : "markers", summary.frames, summary.seconds,
             static_cast<double>(summary.frames) / elapsed);
  if (summary.noise) {
    fmt::print(stderr, "noise: {:.3f} px in a measured place, {:.0f} px/s\u00b2 of acceleration\n",
               summary.noise->measurement_sigma, summary.noise->acceleration);
  }
  fmt::print(stderr, "tracks: {}\n", output.tracks);
  print_pictures(output);
}

}  // namespace marey::cli
