#include "status_text.h"

#include "camera_health.h"
#include "json_value.h"

namespace marey::viewer {
namespace {

cli::Json camera_json(const LiveReport::Camera& camera) {
  cli::Json told = cli::page_json_of(camera.health);
  told["dials"] = cli::Json::array();
  for (const auto& dial : camera.dials) {
    told["dials"].push_back(
        {{"name", dial.name}, {"unit", dial.unit}, {"least", dial.least}, {"most", dial.most}, {"now", dial.now}});
  }
  if (!camera.refused.empty()) told["refused"] = camera.refused;
  if (!camera.finds_markers) return told;
  told["threshold"] = camera.threshold;
  told["learning"] = camera.learning;
  told["masks"] = cli::Json::array();
  for (const Mask& mask : camera.masks) told["masks"].push_back(cli::Json(mask.numbers()));
  return told;
}

}  // namespace

std::string status_text(const LiveReport& report) {
  cli::Json status{{"cameras", cli::Json::array()},
                   {"steps", cli::Json::array()},
                   {"overtaken", report.overtaken},
                   {"unsaved", report.unsaved},
                   {"notes", cli::Json(report.notes)}};
  for (const LiveReport::Camera& camera : report.cameras) status["cameras"].push_back(camera_json(camera));
  for (const LiveReport::Step& step : report.steps)
    status["steps"].push_back({{"name", step.name}, {"median", step.median}, {"p99", step.p99}});
  return "status " + compact(status);
}

}  // namespace marey::viewer
