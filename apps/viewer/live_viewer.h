#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/camera_health.h"
#include "marey/core/mask.h"
#include "marey/core/sink.h"
#include "marey/geometry/pitch.h"

#include "page_command.h"
#include "web_server.h"

namespace marey::viewer {

/// The state of the cameras and the losses, as the page shows it beside them.
struct LiveReport {
  struct Camera {
    CameraHealth health = {};
    /// What of it can be changed, and how it is now.
    struct CameraControl {
      std::string name, unit;
      double minimum = 0, maximum = 0, now = 0;
    };
    std::vector<CameraControl> controls = {};
    bool finds_markers = false;  ///< then these count:
    std::optional<double> threshold = {};
    std::vector<Mask> masks = {};
    bool learning = false;     ///< what is lit, to mask it
    std::string refused = {};  ///< why it did not fulfil the last request
  };
  /// One step of the path from the camera to the page, s.
  struct Step {
    std::string name;  ///< "decode", "track"
    double median = 0, p99 = 0;
  };

  std::vector<Camera> cameras;     ///< CameraId i is cameras[i]
  std::int64_t superseded = 0;     ///< instants that were dropped because newer ones were whole
  std::vector<Step> steps;         ///< none if they were not measured
  bool unsaved = false;            ///< something was changed that the rig file does not have
  std::vector<std::string> notes;  ///< sentences to the user; the page shows them until the next report
};

/// The part of the ground that the page shows of people on it, before any of them is seen; none: where they are.
struct LiveGround {
  std::optional<geometry::PitchSize> pitch = {};
  std::vector<Vector<3>> area = {};  ///< corners, m, in the coordinates of the run's positions
};

struct LiveViewOptions {
  ListenAddress location;
  /// The page's record button; without it, no button. Called on the server's thread, so it only notes the request. An Error
  /// of its is shown on the page.
  std::function<void(bool on)> record = {};
  /// What pages change of cameras and names; without it nothing. Called on the server's thread. An Error of its is shown on the
  /// page.
  std::function<void(const PageCommand&)> change = {};
  std::string rig_file = {};  ///< that changes are saved in; empty: no such file
  /// What is done, where it is not a run that tracks: "wand", "people". The page adapts to it.
  std::string job = {};
  /// The page's button by which a wand has been waved enough, or people have walked; without it, no button. As `record`.
  std::function<void()> enough = {};
  /// The page's button by which the ground is set, by an L-frame on it; without it, no button. As `record`.
  std::function<void()> ground = {};
  /// The time now by the run's clock, so that the page can say how old is what it shows.
  std::function<Timestamp()> now = {};
  LiveGround ground_area = {};
  double images_hz = 10;  ///< of each camera that a person watches
};

/// Shows a run while it continues. `sinks.add(viewer.make_sink())` is all that a run needs of it.
///
/// It holds nothing up: of everything the newest counts, images are made into JPEG on a thread of its own, only of cameras that
/// some page shows, at the size at which it shows them. A run without tracks (a preview of a rig that is not calibrated) writes
/// instants with frames and their detections, and nothing else.
class LiveViewer {
 public:
  /// Listens from now on. Throws Error if that cannot be.
  explicit LiveViewer(const LiveViewOptions& options);
  ~LiveViewer();
  LiveViewer(const LiveViewer&) = delete;
  LiveViewer& operator=(const LiveViewer&) = delete;

  std::string address() const;
  /// The sink of a run; of one run at a time. It may outlive the viewer, and then does nothing.
  std::unique_ptr<Sink> make_sink();

  // From any thread.
  void report(const LiveReport& report);
  /// What the record button shows: whether it is being recorded now, and into what.
  void recording(bool on, const std::string& into = {});
  /// How a wand or people are seen, as JSON that page/src/wand.ts declares.
  void wand(const std::string& json);
  WebServer::Count count() const;

 private:
  class Core;
  class ViewerSink;
  std::shared_ptr<Core> core_;
};

}  // namespace marey::viewer
