#include "marey/pipeline/people/nobody_found.h"

#include <string_view>

#include <fmt/format.h>

namespace marey::pipeline::people {
namespace {

constexpr double kSlow = 4;  // frames/s, below which people go farther from frame to frame than can be told

std::int64_t left_out(const corridor::Summary& summary, std::string_view reason,
                      std::int64_t corridor::Summary::Camera::* of_camera) {
  const auto found = summary.left_out.find(reason);
  std::int64_t count = found != summary.left_out.end() ? found->second : 0;
  for (const corridor::Summary::Camera& camera : summary.cameras) count += camera.*of_camera;
  return count;
}

std::string counted(std::int64_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace

std::optional<std::string> why_nobody(const corridor::Summary& summary) {
  if (summary.tracks > 0 || summary.stopped) return std::nullopt;
  std::string said = "nobody was found: ";
  const std::int64_t misfits = left_out(summary, "misfits", &corridor::Summary::Camera::misfits);
  const std::int64_t noise = left_out(summary, "noise", &corridor::Summary::Camera::noise);
  if (summary.frames < 3)
    return said + fmt::format("there is no more than {} to see anybody move in", counted(summary.frames, "frame"));
  if (summary.detections > 0) {
    said += fmt::format("people were seen {} in {}, but nowhere for long enough to be believed",
                        counted(summary.detections, "time"), counted(summary.frames, "frame"));
    if (summary.rate_hz > 0 && summary.rate_hz < kSlow)
      said += fmt::format("; at {:.3g} frames a second they go far from one frame to the next", summary.rate_hz);
    return said;
  }
  if (misfits > 0) return said + fmt::format("what moved has not the shape or size of people ({})", counted(misfits, "region"));
  if (noise > 0) return said + fmt::format("all that moved was too small for people ({})", counted(noise, "region"));
  return said + "nothing moved before the camera; who stands still all the time is taken for a part of the scene";
}

}  // namespace marey::pipeline::people
