// What of a rig's cameras can be changed while they are live (exposure, gain, threshold, masks), and how it is kept in the rig.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/rig.h"
#include "marey/pipeline/corridor/marker_tuning.h"
#include "marey/source/live/camera_controls.h"

namespace marey::pipeline::live {

/// What the rig says of a camera's exposure and gain; of a node's, of its threshold too.
std::shared_ptr<source::live::CameraControls> controls_of(const RigCamera& camera);

/// From any thread.
class CameraSettings {
 public:
  static constexpr double kBrightest = 65535;  ///< grey level: thresholds are below

  struct Camera {
    std::vector<source::live::ControlRange> controls;  ///< that it has
    std::string refused;                               ///< why it did not take the last request, its name first; empty if it did
    corridor::MarkerTuning::Values markers;
  };

  /// `threshold` counts for all cameras, before the rig's.
  explicit CameraSettings(const Rig& rig, std::optional<double> threshold = {});

  std::size_t size() const { return cameras_.size(); }
  const std::shared_ptr<source::live::CameraControls>& controls(std::size_t camera) const { return cameras_[camera].controls; }
  const std::shared_ptr<corridor::MarkerTuning>& tuning(std::size_t camera) const { return cameras_[camera].tuning; }
  Camera camera(std::size_t index) const;
  /// Grey level; nothing: automatic. It goes to the node that finds the camera's markers too. Throws Error if no marker could be
  /// found by it.
  void set_threshold(std::size_t index, std::optional<double> level);
  /// The camera's images are known now, and its masks are in their px.
  void fit(std::size_t index, const RigCamera& camera);

  /// Enters what was changed into the rig file that the cameras come from, beside all that it holds. Throws Error if it cannot
  /// be read or written, or has no such camera any more.
  void save(const std::string& rig_file);
  /// Enters what was changed since the beginning, saved or not, into a rig of the same cameras.
  void enter(Rig& rig) const;
  /// Whether anything was changed that the rig file does not have.
  bool has_changed() const;

 private:
  /// All that a rig file keeps of a camera.
  struct Kept {
    source::live::CameraControls::Values controls;
    std::optional<double> threshold;
    std::vector<Mask> masks;
    bool operator==(const Kept&) const = default;
  };
  struct Entry {
    std::string name;
    std::optional<cv::Size> size;  ///< px, that the masks are in
    std::shared_ptr<source::live::CameraControls> controls;
    std::shared_ptr<corridor::MarkerTuning> tuning;
    bool on_node = false;  ///< of another computer, which may find its markers
  };
  Kept kept_of(std::size_t camera) const;
  static void enter_camera(RigCamera& camera, const Entry& entry, const Kept& before, const Kept& now);

  std::vector<Entry> cameras_;
  mutable std::mutex mutex_;  // for what follows
  std::vector<Kept> begun_, saved_;
};

}  // namespace marey::pipeline::live
