#include "marey/pipeline/people/no_people_found.h"

#include <string_view>

#include <fmt/format.h>

namespace marey::pipeline::people {
namespace {

constexpr double kSlow = 4;  // frames/s, below which people go farther from frame to frame than can be reported

std::int64_t dropped(const corridor::Summary& summary, std::optional<std::int64_t> corridor::Dropped::* in_image,
                     std::int64_t corridor::Summary::Camera::* of_camera) {
  std::int64_t count = (summary.dropped.*in_image).value_or(0);
  for (const corridor::Summary::Camera& camera : summary.cameras) count += camera.*of_camera;
  return count;
}

std::string counted(std::int64_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace

std::optional<std::string> why_none(const corridor::Summary& summary) {
  if (summary.tracks > 0 || summary.stopped) return std::nullopt;
  std::string stated = "no person was found: ";
  const std::int64_t misfits = dropped(summary, &corridor::Dropped::unexplained_regions, &corridor::Summary::Camera::misfits);
  const std::int64_t noise = dropped(summary, &corridor::Dropped::noise, &corridor::Summary::Camera::noise);
  if (summary.frames < 3)
    return stated + fmt::format("there is no more than {} to see any person move in", counted(summary.frames, "frame"));
  if (summary.detections > 0) {
    stated += fmt::format("people were seen {} in {}, but nowhere for long enough to be trusted",
                          counted(summary.detections, "time"), counted(summary.frames, "frame"));
    if (summary.rate_hz > 0 && summary.rate_hz < kSlow)
      stated += fmt::format("; at {:.3g} frames a second they go far from one frame to the next", summary.rate_hz);
    return stated;
  }
  if (misfits > 0) return stated + fmt::format("what moved has not the shape or size of people ({})", counted(misfits, "region"));
  if (noise > 0) return stated + fmt::format("all that moved was too small for people ({})", counted(noise, "region"));
  return stated + "nothing moved before the camera; who stands still all the time is taken for a part of the scene";
}

}  // namespace marey::pipeline::people
