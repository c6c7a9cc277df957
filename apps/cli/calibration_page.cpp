#include "calibration_page.h"

#include <chrono>
#include <cstdio>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/format/rig/rig_file.h"

#include "camera_health.h"
#include "page_commands.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

using calibrate::ImageCoverage;
constexpr int kReportedEvery = 3;                           // of the checks, which are ten per second
constexpr auto kToBeSent = std::chrono::milliseconds(300);  // the last words of a program that ends

Json observed_by(const pipeline::calibrate::LiveObserved::Camera& camera) {
  return {{"name", camera.health.name},  {"state", to_string(camera.health.state)},
          {"coverage", camera.coverage}, {"views", camera.views},
          {"covered", camera.covered},   {"parts", Json(camera.parts)}};
}

std::function<void(const viewer::PageCommand&)> changing_cameras(
    const CalibrationPage::Options& options, const std::shared_ptr<pipeline::live::CameraSettings>& camera_settings) {
  if (!is_for_this_computer(options.location.listen) && !options.allow_control) return {};
  return page_changes(camera_settings, nullptr, "");
}

}  // namespace

void CalibrationScreen::begun(const CalibrationSubject& subject, bool keys) {
  out_->announce(fmt::format("{}{}", subject.invitation, keys ? "; q: that will do" : ""));
}

void CalibrationScreen::show(const pipeline::calibrate::LiveObserved& detected) {
  covered_.resize(detected.cameras.size());
  for (std::size_t c = 0; c < detected.cameras.size(); ++c) {
    if (!detected.cameras[c].covered || covered_[c]) continue;
    covered_[c] = true;
    out_->announce(fmt::format("camera \"{}\" has seen enough: {:.0f} % of its image", detected.cameras[c].health.name,
                               100 * detected.cameras[c].coverage));
  }
  if (detected.enough) out_->announce(fmt::format("all of them have, after {:.0f} s", detected.seconds));
  std::string line = fmt::format("{:.0f} s ", detected.seconds);
  for (const pipeline::calibrate::LiveObserved::Camera& camera : detected.cameras) {
    line += " " + short_line_of(camera.health, fmt::format("{:.0f} %", 100 * camera.coverage));
  }
  out_->show(line);
}

CalibrationPage::CalibrationPage(const CalibrationSubject& subject, const Options& options, const Rig& rig,
                                 std::shared_ptr<pipeline::live::CameraSettings> camera_settings)
    : job_(subject.job),
      camera_settings_(std::move(camera_settings)),
      ground_(options.ground),
      viewer_({.location = options.location,
               .change = changing_cameras(options, camera_settings_),
               .job = subject.job,
               .enough = options.enough,
               .ground = [this] { ground_required_ = ground_ != nullptr; }}),
      sink_(viewer_.make_sink()) {
  reported_ = {{"required", subject.criteria.fraction},
               {"across", ImageCoverage::kPartsAcross},
               {"down", ImageCoverage::kPartsDown},
               {"needed", subject.criteria.shared}};
  show_rig(rig);
  fmt::print(stderr, "marey: open {} in a browser\n", viewer_.address());
}

void CalibrationPage::show_rig(const Rig& rig) {
  RecordingHeader header;
  header.name = job_;
  header.frame.kind = FrameOfReference::Kind::space;
  header.made_by.program = "marey calibrate " + job_;
  header.rate_hz = 10;
  header.rig = rig;
  sink_->begin(header);
}

void CalibrationPage::notify(const char* phase) {
  reported_["phase"] = phase;
  viewer_.wand(compact(reported_));
}

/// How the cameras are set.
void CalibrationPage::report(const pipeline::calibrate::LiveObserved& detected) {
  viewer::LiveReport reported;
  for (const pipeline::calibrate::LiveObserved::Camera& camera : detected.cameras) {
    auto& entry =
        reported.cameras.emplace_back(viewer::LiveReport::Camera{.health = camera.health, .finds_markers = job_ == "wand"});
    report_changeable(entry, camera_settings_->camera(reported.cameras.size() - 1));
  }
  viewer_.report(reported);
}

void CalibrationPage::show(const pipeline::calibrate::LiveObserved& detected) {
  sink_->write(detected.now);
  if (shown_++ % kReportedEvery != 0 && !detected.enough) return;
  report(detected);
  reported_["seconds"] = detected.seconds;
  reported_["cameras"] = Json::array();
  reported_["shared"] = Json::array();
  for (const pipeline::calibrate::LiveObserved::Camera& camera : detected.cameras)
    reported_["cameras"].push_back(observed_by(camera));
  for (const pipeline::calibrate::LiveObserved::Shared& pair : detected.shared)
    reported_["shared"].push_back({{"a", pair.a}, {"b", pair.b}, {"views", pair.views}, {"sufficient", pair.enough}});
  reported_["missing"] = Json(detected.missing);
  notify("waving");
}

void CalibrationPage::computing() {
  notify("computing");
}

void CalibrationPage::failed(const std::string& why) {
  reported_["why"] = why;
  notify("failed");
  std::this_thread::sleep_for(kToBeSent);
}

void CalibrationPage::done(Rig rig, Json report, const std::string& file) {
  show_rig(rig);
  reported_["report"] = std::move(report);
  reported_["rig"] = file;
  ground_required_ = false;  // before there was a rig it could not be requested
  notify("done");
  const std::stop_token stop = stop_by_signals();
  if (viewer_.count().pages > 0) fmt::print(stderr, "marey: the page shows how good it is; this ends when it is closed\n");
  while (viewer_.count().pages > 0 && !stop.stop_requested()) {
    if (ground_required_) set_ground(rig, file);
    std::this_thread::sleep_for(kToBeSent);
  }
}

void CalibrationPage::set_ground(Rig& rig, const std::string& file) {
  reported_["ground"] = Json();
  reported_["ground"]["phase"] = "looking";
  notify("done");
  try {
    const pipeline::calibrate::GroundCalibration found = ground_(rig);
    rig = found.rig;
    format::rig::write_rig(rig, file);
    reported_["ground"] = {{"phase", "set"}, {"rms_mm", found.found.rms_mm}, {"warnings", Json(found.warnings)}};
    show_rig(rig);
  } catch (const Stopped&) {
    reported_["ground"] = Json();
  } catch (const Error& error) {
    reported_["ground"] = {{"phase", "failed"}, {"why", error.what()}};
  }
  ground_required_ = false;
  notify("done");
}

}  // namespace marey::cli
