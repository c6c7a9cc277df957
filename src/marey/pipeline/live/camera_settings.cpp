#include "marey/pipeline/live/camera_settings.h"

#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/source_name.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/rig/rig_ptz.h"

namespace marey::pipeline::live {

using source::live::CameraControls;
using source::live::Control;

namespace {

bool is_on_node(const RigCamera& camera) {
  return scheme_of(camera.source) == "node";
}

}  // namespace

std::shared_ptr<CameraControls> controls_of(const RigCamera& camera) {
  CameraControls::Values required;
  if (camera.exposure_ms) required[Control::exposure] = *camera.exposure_ms;
  if (camera.gain) required[Control::gain] = *camera.gain;
  if (camera.threshold && is_on_node(camera)) required[Control::threshold] = *camera.threshold;
  return std::make_shared<CameraControls>(std::move(required));
}

CameraSettings::CameraSettings(const Rig& rig, std::optional<double> threshold) {
  for (RigCamera camera : rig.cameras) {
    if (threshold) camera.threshold = threshold;
    corridor::MarkerTuning::Values values{.threshold = camera.threshold, .masks = camera.masks};
    cameras_.push_back({camera.name, camera.size, controls_of(camera), std::make_shared<corridor::MarkerTuning>(std::move(values)),
                        is_on_node(camera)});
    saved_.push_back(kept_of(cameras_.size() - 1));
  }
  begun_ = saved_;
}

void CameraSettings::fit(std::size_t index, const RigCamera& camera) {
  const std::lock_guard lock(mutex_);
  const std::optional<cv::Size> before = std::exchange(cameras_[index].size, camera.size);
  if (!before || before == camera.size) return;
  const double factor = static_cast<double>(camera.size->width) / before->width;
  for (std::vector<Kept>* kept : {&begun_, &saved_}) {
    for (Mask& mask : (*kept)[index].masks) mask = mask.scaled(factor);
  }
  std::vector<Mask> masks = cameras_[index].tuning->values().masks;  // some may have been drawn already
  for (Mask& mask : masks) mask = mask.scaled(factor);
  cameras_[index].tuning->set_masks(std::move(masks));
}

CameraSettings::Camera CameraSettings::camera(std::size_t index) const {
  const Entry& entry = cameras_[index];
  const std::string refused = entry.controls->refused();
  return {entry.controls->has(), refused.empty() ? refused : fmt::format("{}: {}", entry.name, refused), entry.tuning->values()};
}

void CameraSettings::set_threshold(std::size_t index, std::optional<double> level) {
  if (level && !(*level > 0 && *level < kBrightest))
    throw Error("{}: does not take that threshold; it must be a grey level above 0 and below {:g}", cameras_[index].name,
                kBrightest);
  const Entry& entry = cameras_[index];
  entry.tuning->set_threshold(level);
  if (entry.on_node) entry.controls->request(Control::threshold, level.value_or(0));
}

CameraSettings::Kept CameraSettings::kept_of(std::size_t camera) const {
  corridor::MarkerTuning::Values values = cameras_[camera].tuning->values();
  return {cameras_[camera].controls->taken(), values.threshold, std::move(values.masks)};
}

bool CameraSettings::has_changed() const {
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (kept_of(i) != saved_[i]) return true;
  }
  return false;
}

/// What is as it was stays as the file has it.
void CameraSettings::enter_camera(RigCamera& camera, const Entry& entry, const Kept& before, const Kept& now) {
  for (const auto& [control, value] : now.controls) {
    if (control == Control::exposure) camera.exposure_ms = value;
    if (control == Control::gain) camera.gain = value;
  }
  if (now.threshold != before.threshold) camera.threshold = now.threshold;
  if (now.masks == before.masks) return;
  camera.masks = now.masks;
  if (!entry.size || !camera.size || *entry.size == *camera.size) return;
  for (Mask& mask : camera.masks) mask = mask.scaled(static_cast<double>(camera.size->width) / entry.size->width);
}

void CameraSettings::enter(Rig& rig) const {
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < cameras_.size(); ++i)
    enter_camera(camera_named(rig, cameras_[i].name), cameras_[i], begun_[i], kept_of(i));
}

void CameraSettings::save(const std::string& rig_file) {
  Rig rig = format::rig::read_rig(rig_file);
  const std::lock_guard lock(mutex_);
  std::vector<Kept> now;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    now.push_back(kept_of(i));
    enter_camera(camera_named(rig, cameras_[i].name), cameras_[i], saved_[i], now.back());
  }
  format::rig::write_ptz_rig(rig, format::rig::read_ptz(rig_file), rig_file);
  saved_ = std::move(now);
}

}  // namespace marey::pipeline::live
