#include "status_text.h"

#include "camera_health.h"
#include "json_value.h"

namespace marey::viewer {
namespace {

cli::Json camera_json(const LiveReport::Camera& camera) {
  cli::Json reported = cli::page_json_of(camera.health);
  reported["controls"] = cli::Json::array();
  for (const auto& camera_control : camera.controls) {
    reported["controls"].push_back({{"name", camera_control.name},
                                    {"unit", camera_control.unit},
                                    {"min", camera_control.minimum},
                                    {"max", camera_control.maximum},
                                    {"now", camera_control.now}});
  }
  if (!camera.refused.empty()) reported["refused"] = camera.refused;
  if (!camera.finds_markers) return reported;
  reported["threshold"] = camera.threshold;
  reported["learning"] = camera.learning;
  reported["masks"] = cli::Json::array();
  for (const Mask& mask : camera.masks) reported["masks"].push_back(cli::Json(mask.numbers()));
  return reported;
}

}  // namespace

std::string status_text(const LiveReport& report) {
  cli::Json status{{"cameras", cli::Json::array()},
                   {"steps", cli::Json::array()},
                   {"superseded", report.superseded},
                   {"unsaved", report.unsaved},
                   {"notes", cli::Json(report.notes)}};
  for (const LiveReport::Camera& camera : report.cameras) status["cameras"].push_back(camera_json(camera));
  for (const LiveReport::Step& step : report.steps)
    status["steps"].push_back({{"name", step.name}, {"median", step.median}, {"p99", step.p99}});
  return "status " + compact(status);
}

}  // namespace marey::viewer
