// The jobs of a rig whose cameras are live: the same stages as for files, with the policy that the newest whole instant wins.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "marey/core/rig.h"
#include "marey/pipeline/corridor/live_monitor.h"
#include "marey/pipeline/corridor/recorder.h"
#include "marey/pipeline/keypoints/keypoints_live.h"
#include "marey/pipeline/live/camera_settings.h"
#include "marey/pipeline/markers/image_stage.h"
#include "marey/pipeline/markers/markers_in_space.h"
#include "marey/pipeline/markers/track_naming.h"
#include "marey/pipeline/people/ground/people_on_ground.h"
#include "marey/pipeline/people/image_stage.h"

namespace marey::pipeline::live {

enum class LiveTargets { markers, people, keypoints };

/// What runs, by the request and the known parts of the rig.
enum class LiveJob { preview, markers_in_image, markers_in_space, people_in_image, people_on_ground, keypoints_in_space };

/// "a preview", "markers in space", …
std::string_view to_string(LiveJob job);

struct LiveOptions {
  LiveTargets targets = LiveTargets::markers;
  bool ground = false;  ///< people are placed on the ground that the cameras face
  markers::MarkersInSpaceOptions space;
  markers::ImageMarkerOptions markers;
  people::ImagePeopleOptions people;
  people::ground::PeopleOnGroundOptions on_ground;
  keypoints::KeypointsLiveOptions keypoints;  ///< of several cameras; of one: `people.keypoints`
  source::LivePolicy policy = {.time = nullptr, .late_s = 0.05, .stalled_s = 0.5, .lost_s = 5};  ///< without a time: the steady one
  std::shared_ptr<CameraSettings> camera_settings =
      {};  ///< what of the cameras is changed while they run; null: they are as the rig says
  std::shared_ptr<markers::TrackNaming> naming = {};  ///< names that tracks are given by hand; null: none
  double patience_s = 3;                              ///< that is waited at the beginning for cameras that are not there

  std::string take;                                   ///< the take recorded into, NAME.marey; empty: nothing
  std::string numbers = {};                           ///< a CSV file of people's shirt numbers; empty: they are not read
  std::string images;                                 ///< a folder for what each camera saw while it was recorded; empty: not kept
  std::shared_ptr<corridor::RecordSwitch> recording;  ///< null: all is recorded
  double preroll_s = 5;                               ///< of what came before recording was switched on

  std::vector<std::unique_ptr<Sink>> sinks;                      ///< wires, viewers and callbacks besides
  std::function<void(const corridor::LiveStatus&)> status = {};  ///< four times a second, from the run's thread
  std::function<void(LiveJob, const Rig&)> begun = {};           ///< the rig as its cameras are, once they are there
};

struct LiveSummary : corridor::Summary {
  LiveJob job = LiveJob::preview;
  corridor::LiveStatus last;  ///< when it ended
  bool recorded = false;
};

/// One camera: in its image. Several: markers or keypoints in space if two or more are calibrated, people if `ground` is set, else
/// a preview.
LiveJob live_job(const Rig& rig, LiveTargets targets, bool ground);

/// Runs until `hooks.stop` says so, or all that is played has ended; the recording is complete then. Throws Error if a source
/// cannot be meant, a camera's images do not fit the rig, no camera gave anything, or the take cannot be begun.
LiveSummary live(const Rig& rig, LiveOptions options, const Hooks& hooks = {});

}  // namespace marey::pipeline::live
