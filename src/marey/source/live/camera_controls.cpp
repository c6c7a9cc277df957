#include "marey/source/live/camera_controls.h"

#include <utility>

#include "marey/core/error.h"
#include "marey/source/live/connection.h"

namespace marey::source::live {

std::string_view to_string(Control control) {
  switch (control) {
    case Control::exposure:
      return "exposure";
    case Control::gain:
      return "gain";
    case Control::threshold:
      break;
  }
  return "threshold";
}

void Connection::set(Control control, double /*value*/) {
  throw Error("{}: its {} cannot be set from here", info().name, to_string(control));
}

void CameraControls::request(Control control, double value) {
  const std::lock_guard lock(mutex_);
  fresh_[control] = value;
  refused_.clear();
}

bool CameraControls::waits() const {
  const std::lock_guard lock(mutex_);
  return setting_ || !fresh_.empty();
}

std::vector<ControlRange> CameraControls::has() const {
  const std::lock_guard lock(mutex_);
  return has_;
}

CameraControls::Values CameraControls::taken() const {
  const std::lock_guard lock(mutex_);
  return taken_;
}

std::string CameraControls::refused() const {
  const std::lock_guard lock(mutex_);
  return refused_;
}

/// Returns those that it took.
CameraControls::Values CameraControls::set(Connection& camera, const Values& values) {
  Values taken;
  std::string refused;
  for (const auto& [control, value] : values) {
    try {
      camera.set(control, value);
      taken[control] = value;
    } catch (const Error& error) {
      refused = error.what();
      const std::string begin = camera.info().name + ": ";
      if (refused.starts_with(begin)) refused.erase(0, begin.size());
    }
  }
  std::vector<ControlRange> has = camera.controls();
  const std::lock_guard lock(mutex_);
  has_ = std::move(has);
  if (!refused.empty()) refused_ = std::move(refused);
  return taken;
}

void CameraControls::begin(Connection& camera) {
  Values required;
  {
    const std::lock_guard lock(mutex_);
    required = required_;
  }
  set(camera, required);
}

void CameraControls::apply(Connection& camera) {
  Values fresh;
  {
    const std::lock_guard lock(mutex_);
    if (fresh_.empty()) return;
    fresh = std::exchange(fresh_, {});
    setting_ = true;
  }
  const Values taken = set(camera, fresh);
  const std::lock_guard lock(mutex_);
  setting_ = false;
  for (const auto& [control, value] : taken) required_[control] = taken_[control] = value;
}

}  // namespace marey::source::live
