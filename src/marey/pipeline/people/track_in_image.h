// The two jobs of one camera's images, from its file to the user's files.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "marey/core/keypoint_sequence.h"
#include "marey/core/rig.h"
#include "marey/format/register.h"
#include "marey/pipeline/markers/image_stage.h"
#include "marey/pipeline/people/image_stage.h"

namespace marey::pipeline::people {

/// Where the results go; what is empty is not made.
struct TrackOutput {
  std::string tracks;
  std::string format = {};        ///< by name; empty: the ending of `tracks` says it
  std::string overlay = {};       ///< a video with the tracks drawn into the images
  std::string copy = {};          ///< the video, with nothing drawn and faces blurred
  bool blur_faces = false;        ///< in `overlay`
  std::string plot = {};          ///< an SVG image of the trajectories, in the coordinates of the image
  std::string target_masks = {};  ///< a folder for the visible pixels of each target's contour (target_mask_sink.h)
  std::string numbers = {};       ///< of people: a CSV file of their shirts' numbers (number_sink.h)
  std::string masks = {};         ///< of people: a folder for the foreground of each frame (draw/mask_folder.h)
};

/// Follows people through what one camera saw: its `source`, or its `detections` by another program. Its name may be empty. The
/// same input gives the same output, bit for bit. Throws Error if the input cannot be read at all, or an output not written;
/// nothing half-written stays behind.
corridor::Summary track_people(const RigCamera& camera, const TrackOutput& output, const ImagePeopleOptions& options = {},
                               const Hooks& hooks = {});

/// The body keypoints of one camera's images, as track_people finds them; `options.keypoints` is set. Throws Error if the images
/// cannot be read, or the network is not usable.
KeypointSequence find_keypoints(const RigCamera& camera, const ImagePeopleOptions& options, const Hooks& hooks = {});

/// Follows markers through a recording under the names they have in its first frame. Throws likewise, and where labels do not fit.
corridor::Summary track_markers(const RigCamera& camera, const TrackOutput& output, const markers::ImageMarkerOptions& options = {},
                                const Hooks& hooks = {});

/// Images of one camera that another program may hold.
struct ImageFeed {
  RigCamera camera;
  corridor::FeedOptions how = {};
  std::function<std::unique_ptr<detect::Detector>()> detector = {};  ///< another program's, of people; empty: none
};

/// The same, into `sinks` besides `output`, whose `tracks` may be empty. Outlines that wait for the second pass then are in a file
/// next to `options.beside`.
corridor::Summary track_people(const ImageFeed& feed, const TrackOutput& output, std::vector<std::unique_ptr<Sink>> sinks,
                               const ImagePeopleOptions& options, const Hooks& hooks);
corridor::Summary track_markers(const ImageFeed& feed, const TrackOutput& output, std::vector<std::unique_ptr<Sink>> sinks,
                                const markers::ImageMarkerOptions& options, const Hooks& hooks);

/// Names from a text file, one a line; blank lines do not count. Throws Error if it cannot be read, holds no name, or one twice.
std::vector<std::string> read_labels(const std::string& path);

/// A mask for MarkerOptions from an image file: what is brighter than black is omitted. Throws Error if it cannot be read.
cv::Mat read_mask(const std::string& path);

}  // namespace marey::pipeline::people
