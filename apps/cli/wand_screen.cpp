#include "wand_screen.h"

#include <chrono>
#include <cstdio>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "marey/calibrate/wand/wand_coverage.h"
#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/format/rig/rig_file.h"

#include "camera_health.h"
#include "page_changes.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

using calibrate::wand::WandCoverage;
constexpr int kToldEvery = 3;                               // of the looks, which are ten a second
constexpr auto kToBeSent = std::chrono::milliseconds(300);  // the last words of a program that ends

Json seen_by(const pipeline::calibrate::WandSeen::Camera& camera) {
  return {{"name", camera.health.name},  {"state", to_string(camera.health.state)},
          {"coverage", camera.coverage}, {"views", camera.views},
          {"covered", camera.covered},   {"parts", Json(camera.parts)}};
}

std::function<void(const viewer::PageCommand&)> changing_wands(const WandPage::Options& options,
                                                               const std::shared_ptr<pipeline::live::CameraDesk>& desk) {
  if (!is_for_this_computer(options.place.listen) && !options.allow_control) return {};
  return page_changes(desk, nullptr, "");
}

}  // namespace

void WandScreen::begun(bool keys) {
  out_->say(fmt::format("wave the wand through the whole volume{}", keys ? "; q: that will do" : ""));
}

void WandScreen::show(const pipeline::calibrate::WandSeen& seen) {
  covered_.resize(seen.cameras.size());
  for (std::size_t c = 0; c < seen.cameras.size(); ++c) {
    if (!seen.cameras[c].covered || covered_[c]) continue;
    covered_[c] = true;
    out_->say(fmt::format("camera \"{}\" has seen enough: {:.0f} % of its picture", seen.cameras[c].health.name,
                          100 * seen.cameras[c].coverage));
  }
  if (seen.enough) out_->say(fmt::format("all of them have, after {:.0f} s", seen.seconds));
  std::string line = fmt::format("{:.0f} s ", seen.seconds);
  for (const pipeline::calibrate::WandSeen::Camera& camera : seen.cameras) {
    line += " " + short_line_of(camera.health, fmt::format("{:.0f} %", 100 * camera.coverage));
  }
  out_->show(line);
}

WandPage::WandPage(const Options& options, const Rig& rig, std::shared_ptr<pipeline::live::CameraDesk> desk)
    : desk_(std::move(desk)),
      ground_(options.ground),
      viewer_({.place = options.place,
               .change = changing_wands(options, desk_),
               .job = "wand",
               .enough = options.enough,
               .ground = [this] { ground_wanted_ = true; }}),
      sink_(viewer_.make_sink()) {
  told_ = {{"wanted", WandCoverage::wanted(pipeline::calibrate::knows_lenses(rig))},
           {"across", WandCoverage::kPartsAcross},
           {"down", WandCoverage::kPartsDown},
           {"needed", WandCoverage::kEnoughShared}};
  show_rig(rig);
  fmt::print(stderr, "marey: open {} in a browser\n", viewer_.address());
}

void WandPage::show_rig(const Rig& rig) {
  RecordingHeader header;
  header.name = "wand";
  header.frame.kind = FrameOfReference::Kind::space;
  header.made_by.program = "marey calibrate wand";
  header.rate_hz = 10;
  header.rig = rig;
  sink_->begin(header);
}

void WandPage::tell(const char* phase) {
  told_["phase"] = phase;
  viewer_.wand(compact(told_));
}

/// How the cameras are set.
void WandPage::report(const pipeline::calibrate::WandSeen& seen) {
  viewer::LiveReport told;
  for (const pipeline::calibrate::WandSeen::Camera& camera : seen.cameras) {
    auto& entry = told.cameras.emplace_back(viewer::LiveReport::Camera{.health = camera.health, .finds_markers = true});
    tell_changeable(entry, desk_->camera(told.cameras.size() - 1));
  }
  viewer_.report(told);
}

void WandPage::show(const pipeline::calibrate::WandSeen& seen) {
  sink_->write(seen.now);
  if (shown_++ % kToldEvery != 0 && !seen.enough) return;
  report(seen);
  told_["seconds"] = seen.seconds;
  told_["cameras"] = Json::array();
  told_["shared"] = Json::array();
  for (const pipeline::calibrate::WandSeen::Camera& camera : seen.cameras) told_["cameras"].push_back(seen_by(camera));
  for (const pipeline::calibrate::WandSeen::Shared& pair : seen.shared)
    told_["shared"].push_back({{"a", pair.a}, {"b", pair.b}, {"views", pair.views}, {"enough", pair.enough}});
  tell("waving");
}

void WandPage::computing() {
  tell("computing");
}

void WandPage::failed(const std::string& why) {
  told_["why"] = why;
  tell("failed");
  std::this_thread::sleep_for(kToBeSent);
}

void WandPage::done(Rig rig, Json report, const std::string& file) {
  show_rig(rig);
  told_["report"] = std::move(report);
  told_["rig"] = file;
  ground_wanted_ = false;  // before there was a rig nobody could ask
  tell("done");
  const std::stop_token stop = stop_by_signals();
  if (viewer_.count().pages > 0) fmt::print(stderr, "marey: the page shows how good it is; this ends when it is closed\n");
  while (viewer_.count().pages > 0 && !stop.stop_requested()) {
    if (ground_wanted_) set_ground(rig, file);
    std::this_thread::sleep_for(kToBeSent);
  }
}

void WandPage::set_ground(Rig& rig, const std::string& file) {
  told_["ground"] = Json();
  told_["ground"]["phase"] = "looking";
  tell("done");
  try {
    const pipeline::calibrate::GroundCalibration found = ground_(rig);
    rig = found.rig;
    format::rig::write_rig(rig, file);
    told_["ground"] = {{"phase", "set"}, {"rms_mm", found.found.rms_mm}, {"warnings", Json(found.warnings)}};
    show_rig(rig);
  } catch (const Stopped&) {
    told_["ground"] = Json();
  } catch (const Error& error) {
    told_["ground"] = {{"phase", "failed"}, {"why", error.what()}};
  }
  ground_wanted_ = false;
  tell("done");
}

}  // namespace marey::cli
