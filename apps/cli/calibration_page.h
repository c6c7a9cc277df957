#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/calibrate/image_coverage.h"
#include "marey/core/sink.h"
#include "marey/pipeline/calibrate/calibrate_ground.h"
#include "marey/pipeline/calibrate/live_observed.h"
#include "marey/pipeline/live/camera_settings.h"

#include "json_value.h"
#include "live_screen.h"
#include "viewer/live_viewer.h"

namespace marey::cli {

/// What calibrates live cameras, in words.
struct CalibrationSubject {
  std::string job;         ///< "wand", "people": as the page calls it (apps/viewer/page/src/wand.ts)
  std::string invitation;  ///< "wave the wand through the whole volume"
  calibrate::ImageCoverage::Criteria criteria = {};
};

/// The report while a wand is waved, or people walk, before live cameras: how much each has seen, and a sentence for each that has
/// seen enough.
class CalibrationScreen {
 public:
  explicit CalibrationScreen(bool quiet) : out_(std::in_place, quiet) {}

  void begun(const CalibrationSubject& subject, bool keys);
  void show(const pipeline::calibrate::LiveObserved& detected);
  /// Nothing more is said.
  void end() { out_.reset(); }

 private:
  std::optional<StatusLine> out_;
  std::vector<bool> covered_;
};

/// The same on a page, with the cameras' images; then how good the calibration is.
class CalibrationPage {
 public:
  struct Options {
    viewer::ListenAddress location;
    bool allow_control = false;  ///< who opens the page from another computer may change the cameras
    std::function<pipeline::calibrate::GroundCalibration(const Rig&)> ground =
        {};                        ///< by an L-frame that lies on the floor now; empty: the page has no such button
    std::function<void()> enough;  ///< called, on another thread, where the page's user finds that it will do
  };
  /// Prints its address. What is changed of the cameras on it is in `camera_settings`.
  CalibrationPage(const CalibrationSubject& subject, const Options& options, const Rig& rig,
                  std::shared_ptr<pipeline::live::CameraSettings> camera_settings);

  void show(const pipeline::calibrate::LiveObserved& detected);
  void computing();
  void failed(const std::string& why);
  /// `report` as --json prints it. Stays until the last page is closed, or the program is asked to end; in the meantime the ground
  /// is set as often as a person asks for it, and the file written again.
  void done(Rig rig, Json report, const std::string& file);

 private:
  void notify(const char* phase);
  void show_rig(const Rig& rig);
  void report(const pipeline::calibrate::LiveObserved& detected);

  void set_ground(Rig& rig, const std::string& file);

  std::string job_;
  std::shared_ptr<pipeline::live::CameraSettings> camera_settings_;
  std::function<pipeline::calibrate::GroundCalibration(const Rig&)> ground_;
  std::atomic<bool> ground_required_ = false;
  viewer::LiveViewer viewer_;
  std::unique_ptr<Sink> sink_;
  Json reported_;
  int shown_ = 0;
};

}  // namespace marey::cli
