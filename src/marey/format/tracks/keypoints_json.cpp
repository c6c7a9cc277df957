#include "marey/format/tracks/keypoints_json.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace marey::format::tracks {

void append_json(std::string& text, const Keypoints<2>& body, const KeypointSet& set) {
  auto out = std::back_inserter(text);
  fmt::format_to(out, R"({{"presence":{:.4f},"points":{{)", body.presence);
  const char* between = "";
  for (std::size_t i = 0; i < std::min(body.points.size(), set.points.size()); ++i) {
    if (!body.points[i]) continue;
    const Keypoint<2>& point = *body.points[i];
    using nlohmann::json;
    fmt::format_to(out, "{}{}:[{:.3f},{:.3f},{:.3f},{:.4f},{:.4f}]", between,
                   json(set.points[i]).dump(-1, ' ', false, json::error_handler_t::replace), point.position.x(), point.position.y(),
                   std::sqrt(point.covariance.trace() / 2), point.visibility, point.presence);
    between = ",";
  }
  text += "}}";
}

}  // namespace marey::format::tracks
