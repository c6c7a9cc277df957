#include "marey/format/tracks/outline_json.h"

#include <iterator>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace marey::format::tracks {
namespace {

std::string_view name_of(Outline::State state) {
  switch (state) {
    case Outline::State::detected:
      return "seen";
    case Outline::State::partly:
      return "partly";
    case Outline::State::held:
      break;
  }
  return "held";
}

void append_pair(std::string& text, std::string_view name, const Vector<2>& value) {
  fmt::format_to(std::back_inserter(text), R"("{}":[{:.3f},{:.3f}],)", name, value.x(), value.y());
}

void append_pairs(std::string& text, std::string_view name, const std::vector<Vector<2>>& values) {
  auto out = std::back_inserter(text);
  fmt::format_to(out, R"("{}":[)", name);
  for (std::size_t i = 0; i < values.size(); ++i)
    fmt::format_to(out, "{}[{:.2f},{:.2f}]", i == 0 ? "" : ",", values[i].x(), values[i].y());
  text += "],";
}

}  // namespace

void append_json(std::string& text, const Outline& outline) {
  auto out = std::back_inserter(text);
  fmt::format_to(out, R"({{"state":"{}","order":{},)", name_of(outline.state), outline.order);
  append_pairs(text, "control_points", outline.control_points);
  append_pairs(text, "deviations", outline.deviations);
  if (!outline.behind.empty() || !outline.hidden.empty()) {
    fmt::format_to(out, R"("behind":[)");
    for (std::size_t i = 0; i < outline.behind.size(); ++i)
      fmt::format_to(out, "{}{}", i == 0 ? "" : ",", number(outline.behind[i]));
    fmt::format_to(out, R"(],"hidden":[{}],)", fmt::join(outline.hidden, ","));
  }
  append_pair(text, "centre", outline.centre);
  append_pair(text, "velocity", outline.velocity);
  fmt::format_to(out, R"("scale_rate":{:.5f},)", outline.scale_rate);
  if (outline.silhouette) append_pair(text, "silhouette", *outline.silhouette);
  append_pair(text, "centre_deviation", outline.centre_deviation);
  append_pair(text, "velocity_deviation", outline.velocity_deviation);
  fmt::format_to(out, R"("scale_rate_deviation":{:.5f}}})", outline.scale_rate_deviation);
}

}  // namespace marey::format::tracks
