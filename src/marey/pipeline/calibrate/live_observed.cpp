#include "marey/pipeline/calibrate/live_observed.h"

#include <utility>

#include <fmt/format.h>

namespace marey::pipeline::calibrate {

LiveObserved observed_so_far(const marey::calibrate::ImageCoverage& images, std::span<const corridor::Feed> feeds,
                             const source::LivePolicy& policy) {
  LiveObserved observed;
  observed.enough = images.is_enough();
  for (std::size_t c = 0; c < feeds.size(); ++c) {
    const auto& parts = images.parts(c);
    CameraHealth health = feeds[c].health({}, policy);
    health.rate_hz = feeds[c].info().rate_hz;
    observed.cameras.push_back(
        {std::move(health), images.coverage(c), images.views(c), images.is_covered(c), {parts.begin(), parts.end()}});
    for (std::size_t other = c + 1; other < feeds.size(); ++other)
      observed.shared.push_back({c, other, images.shared(c, other), images.are_related(c, other)});
  }
  return observed;
}

std::string why_nothing_came(std::span<const corridor::Feed> feeds) {
  std::string why = "no camera gave a frame";
  for (const corridor::Feed& feed : feeds) {
    if (const std::string trouble = feed.health().trouble; !trouble.empty())
      why += fmt::format("\n  camera \"{}\": {}", feed.camera().name, trouble);
  }
  return why;
}

void enter_cameras(Rig& rig, std::span<const corridor::Feed> feeds) {
  for (std::size_t c = 0; c < feeds.size(); ++c) {
    rig.cameras[c] = feeds[c].camera();
    if (const cv::Size size = feeds[c].health().frames > 0 ? feeds[c].info().size : cv::Size(); !size.empty())
      rig.cameras[c].size = size;
    if (!rig.cameras[c].rate_hz) rig.cameras[c].rate_hz = feeds[c].info().rate_hz;
  }
}

}  // namespace marey::pipeline::calibrate
