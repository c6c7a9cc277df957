#pragma once

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/ids.h"
#include "marey/core/rig.h"
#include "marey/core/time.h"
#include "marey/files/whole_file.h"

namespace marey::format {

/// A blob that another program found, or that a take kept.
struct ImageObservation {
  CameraId camera{};
  Vector<2> pixel = Vector<2>::Zero();  ///< px, from the centre of the first pixel
  std::string marker = {};              ///< which marker it is, where the file says; else empty
  std::optional<double> sigma = {};     ///< standard deviation of each coordinate, px
  std::optional<double> area = {};      ///< px²
};

/// All that was seen in one frame: camera by camera in the rig's order, then in the file's. A frame number is one instant only
/// where the cameras ran synchronised; else each camera's `rate_hz` and `offset_s` say when it was.
struct ObservedFrame {
  std::int64_t frame = 0;  ///< counts from 0
  std::vector<ImageObservation> points = {};
  std::optional<Timestamp> time = {};  ///< by the rig's clock, where the file says: then it is one instant of all cameras

  /// The part of one camera.
  std::span<const ImageObservation> of(CameraId camera) const;
};

/// Observations of all cameras, frame by frame, in the place of videos. Opens what `--observations` names:
///   a CSV file with header `camera,frame,x,y[,marker]`: 0-based frame, camera as named in the rig, px; sorted by frame, or not
///     (then the whole of it is held in memory);
///   a MultiCamSelfCal folder: `points.dat` with `IdMat.dat`, else `camN.points4cal.dat`; camera i is the rig's i-th;
///   a take, of which every instant is a frame.
class ObservationReader {
 public:
  /// Throws Error if the path cannot be read, is not one of these, or does not fit the rig's cameras. `rig` is needed here only.
  ObservationReader(const std::string& path, const Rig& rig);
  ~ObservationReader();
  ObservationReader(ObservationReader&&) noexcept;
  ObservationReader& operator=(ObservationReader&&) noexcept;

  /// The next frame in which something was seen, in order; nothing at the end. Throws Error for a line that cannot be used.
  std::optional<ObservedFrame> next();

  /// Frames a second, where the file says.
  std::optional<double> rate_hz() const;

  struct Parts;

 private:
  std::unique_ptr<Parts> parts_;
};

/// Everything at once, where a recording is short (a wand's, 2,000 frames).
std::vector<ObservedFrame> read_observations(const std::string& path, const Rig& rig);

/// A rig to begin with, for observations that come without one: cameras by name (a CSV's, sorted; "cam1", "cam2", … or as
/// `camera_order.txt` says for a MultiCamSelfCal folder), with the sizes of `Res.dat` and the lenses of the `.rad` files where
/// there are such. No poses. A take brings its own, whole. Throws Error as the reader does.
Rig rig_of_observations(const std::string& path);

/// Writes `camera,frame,x,y[,marker]`, sorted as it is called.
class ObservationWriter {
 public:
  ObservationWriter(const std::string& path, const Rig& rig, bool with_markers);
  /// Frames grow from call to call.
  void write(const ObservedFrame& frame);
  void finish() { file_.finish(); }

 private:
  WholeFile file_;
  std::vector<std::string> cameras_;
  bool with_markers_;
  std::string lines_;
};

}  // namespace marey::format
