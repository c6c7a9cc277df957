// The words in which one instant of a recording is reported, whatever was recorded: people in an image, people on a ground, markers
// in space. A stage makes instants, a sink takes them, a recording holds them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/body.h"
#include "marey/core/frame.h"
#include "marey/core/geometry.h"
#include "marey/core/ids.h"
#include "marey/core/keypoints.h"
#include "marey/core/outline.h"
#include "marey/core/provenance.h"
#include "marey/core/time.h"
#include "marey/core/track_kind.h"

namespace marey {

/// What one camera saw at one instant: a blob's centre.
struct ImageObservation {
  CameraId camera{};
  Vector<2> pixel = Vector<2>::Zero();  ///< px
  std::optional<double> sigma;          ///< standard deviation of each coordinate, px
  std::optional<double> area;           ///< px²
  std::optional<TrackId> track;         ///< whose it was found to be; nothing for a ghost, or before reconstruction

  bool operator==(const ImageObservation&) const = default;
};

/// One target at one instant. Units are those of the recording's frame of reference: px in an image, m elsewhere. Where that has
/// two dimensions the third coordinate is 0. What is not known is absent.
struct Sample {
  TrackId track{};
  Vector<3> position = Vector<3>::Zero();
  std::optional<Vector<3>> velocity;    ///< a second
  std::optional<Matrix<3>> covariance;  ///< of `position`
  Provenance provenance = Provenance::measured;
  CameraMask cameras = 0;                            ///< who saw it at this instant; none where that is not known
  std::optional<double> score;                       ///< confidence, in [0, 1]
  std::optional<Box> box;                            ///< px, in the image
  std::optional<double> residual_px;                 ///< RMS distance between the position's projections and the observations
  std::optional<double> residual_m;                  ///< the same in space, as other systems' files have it
  std::shared_ptr<const Outline> outline = nullptr;  ///< px, where outlines are followed and this one has one
  /// px, where body points are searched for and some were found; which they are says the recording's header.
  std::shared_ptr<const Keypoints<2>> keypoints = nullptr;

  bool measured() const { return provenance == Provenance::measured; }
};

/// Where a track of the ground or of space is seen in one camera's image, or would be if nothing hid it.
struct BoxInView {
  CameraId camera{};
  std::int64_t frame = 0;  ///< the camera's own count
  TrackId track{};
  Box box;                        ///< px
  std::optional<Vector<2>> foot;  ///< px; where the track's position is, if that is in the image's plane
  bool detected = true;           ///< the camera saw it at this instant
};

/// What a track is called, and what it is. Its label and its team are empty if none was given.
struct TrackName {
  TrackId id{};
  std::string label;
  std::string team;
  std::optional<std::array<std::uint8_t, 3>> colour = {};  ///< red, green, blue; to be drawn in, where it is not left to its number
  TrackKind kind = TrackKind::unspecified;                 ///< unspecified: the track keeps the kind that it has

  bool operator==(const TrackName&) const = default;
};

/// The state at one instant.
struct Instant {
  std::int64_t index = 0;                  ///< counts from 0 at the beginning of the recording; some may be omitted
  Timestamp time{};                        ///< by the recording's clock
  std::vector<Sample> samples;             ///< by track, each at most once
  std::vector<ImageObservation> detected;  ///< what the cameras saw, where the recording keeps it
  std::vector<BodyPose> bodies;            ///< by body, each at most once; what they are says the recording's header
  std::vector<TrackName> named;            ///< tracks whose label or team is new, or another than before
  std::vector<BoxInView> boxes;            ///< in cameras' images, where a sink asked for them; never stored
  std::vector<Frame> frames;               ///< the images of this instant, by camera, where a sink asked for them; never stored
};

}  // namespace marey
