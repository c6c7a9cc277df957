#include "marey/pipeline/camera_desk.h"

#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/rig/rig_turns.h"

namespace marey::pipeline {

using source::live::CameraControls;
using source::live::Control;

std::shared_ptr<CameraControls> controls_of(const RigCamera& camera) {
  CameraControls::Values wanted;
  if (camera.exposure_ms) wanted[Control::exposure] = *camera.exposure_ms;
  if (camera.gain) wanted[Control::gain] = *camera.gain;
  return std::make_shared<CameraControls>(std::move(wanted));
}

CameraDesk::CameraDesk(const Rig& rig, std::optional<double> threshold) {
  for (const RigCamera& camera : rig.cameras) {
    MarkerTuning::Values values{.threshold = threshold ? threshold : camera.threshold, .masks = camera.masks};
    cameras_.push_back({camera.name, camera.size, controls_of(camera), std::make_shared<MarkerTuning>(std::move(values))});
    saved_.push_back(kept_of(cameras_.size() - 1));
  }
}

void CameraDesk::fit(std::size_t index, const RigCamera& camera) {
  const std::lock_guard lock(mutex_);
  const std::optional<cv::Size> before = std::exchange(cameras_[index].size, camera.size);
  if (!before || before == camera.size) return;
  const double factor = static_cast<double>(camera.size->width) / before->width;
  for (cv::Rect& mask : saved_[index].masks) mask = scaled_part(mask, factor);
  std::vector<cv::Rect> masks = cameras_[index].tuning->values().masks;  // some may have been drawn already
  for (cv::Rect& mask : masks) mask = scaled_part(mask, factor);
  cameras_[index].tuning->set_masks(std::move(masks));
}

CameraDesk::Camera CameraDesk::camera(std::size_t index) const {
  const Entry& entry = cameras_[index];
  const std::string refused = entry.controls->refused();
  return {entry.controls->has(), refused.empty() ? refused : fmt::format("{}: {}", entry.name, refused), entry.tuning->values()};
}

void CameraDesk::set_threshold(std::size_t index, std::optional<double> level) {
  constexpr double kBrightest = 65535;
  if (level && !(*level > 0 && *level < kBrightest))
    throw Error("{}: does not take that threshold; it must be a grey level above 0 and below {:g}", cameras_[index].name,
                kBrightest);
  cameras_[index].tuning->set_threshold(level);
}

CameraDesk::Kept CameraDesk::kept_of(std::size_t camera) const {
  MarkerTuning::Values values = cameras_[camera].tuning->values();
  return {cameras_[camera].controls->taken(), values.threshold, std::move(values.masks)};
}

bool CameraDesk::has_changed() const {
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (kept_of(i) != saved_[i]) return true;
  }
  return false;
}

/// What is as it was stays as the file has it.
void CameraDesk::enter(RigCamera& camera, const Entry& entry, const Kept& before, const Kept& now) {
  for (const auto& [control, value] : now.controls) (control == Control::exposure ? camera.exposure_ms : camera.gain) = value;
  if (now.threshold != before.threshold) camera.threshold = now.threshold;
  if (now.masks == before.masks) return;
  camera.masks = now.masks;
  if (!entry.size || !camera.size || *entry.size == *camera.size) return;
  for (cv::Rect& mask : camera.masks) mask = scaled_part(mask, static_cast<double>(camera.size->width) / entry.size->width);
}

void CameraDesk::save(const std::string& rig_file) {
  Rig rig = format::rig::read_rig(rig_file);
  const std::lock_guard lock(mutex_);
  std::vector<Kept> now;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    now.push_back(kept_of(i));
    enter(camera_named(rig, cameras_[i].name), cameras_[i], saved_[i], now.back());
  }
  format::rig::write_turning_rig(rig, format::rig::read_turning(rig_file), rig_file);
  saved_ = std::move(now);
}

}  // namespace marey::pipeline
