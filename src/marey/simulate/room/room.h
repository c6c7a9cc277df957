#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/core/body.h"
#include "marey/core/geometry.h"
#include "marey/core/rig.h"
#include "marey/core/skeleton.h"

namespace marey::simulate::room {

/// What moves in the room.
enum class RoomMotion {
  walk,    ///< a person with markers on the body walks round; limbs hide markers
  run,     ///< runs round
  wave,    ///< the person stands and waves both arms
  kneel,   ///< goes down on both knees and up again
  roll,    ///< lies on the floor and rolls to and fro
  still,   ///< the person stands with arms aside and does not move
  wand,    ///< a wand, or a single light, is waved through the whole volume
  ground,  ///< an L-frame lies on the floor: it defines the world
  cloud,   ///< free markers drift through the volume, and nothing hides them
};

/// All motions with the names that the command line uses.
struct NamedRoomMotion {
  std::string_view name;
  RoomMotion motion;
};
std::span<const NamedRoomMotion> room_motions();

struct RoomOptions {
  RoomMotion motion = RoomMotion::walk;
  int cameras = 8;
  int markers = 50;   ///< on each body or in the cloud; a wand and an L-frame have their own
  int actors = 1;     ///< people who do the same, apart from each other
  int props = 0;      ///< rigid bodies of five markers that fly through the volume
  double skin_m = 0;  ///< how far a thigh's skin carries its markers at a bend of 90°; other limbs' less
  double rate_hz = 120;
  std::int64_t frames = 1200;

  Vector<3> volume{4, 4, 2.5};  ///< m: that the cameras stand round, its floor's middle the world's origin
  cv::Size image{1280, 1024};   ///< px
  bool distorted = true;        ///< lenses bend as real ones do; else all coefficients are 0
  double zoom = 1;              ///< times the focal length of a lens that sees 66° across

  double noise_px = 0.1;    ///< standard deviation of a blob's place, per axis
  double dropped = 0;       ///< share of blobs that a camera misses, each by itself
  double ghosts = 0;        ///< false blobs in an image, as a share of the markers there
  double merge_px = 0;      ///< blobs nearer than this are seen as one, in their middle
  bool occlusion = true;    ///< limbs hide markers
  double gap_fraction = 0;  ///< share of the time during which a marker is covered for all cameras at once
  double gap_s = 0.5;       ///< the longest such time; the shortest is a tenth of it

  double offset_s = 0;  ///< cameras were started up to this much before or after the first one
  struct Bump {
    int camera = 0;
    double time_s = 0;    ///< from then on, by the rig's clock
    double angle = 0.01;  ///< rad: it is turned about a direction that the seed chooses, and pushed by as many m
  };
  std::optional<Bump> bump;

  std::vector<double> wand{0, 0.12, 0.30};  ///< m along the wand; one number is a single light
  std::vector<Vector<3>> ground_frame{{0, 0, 0}, {0.2, 0, 0}, {0.6, 0, 0}, {0, 0.4, 0}};  ///< m
  std::uint64_t seed = 1;
};

/// A bright spot that a camera reports.
struct RoomBlob {
  Vector<2> pixel = Vector<2>::Zero();
  std::optional<int> marker;  ///< whose it is: an index into `labels`; nothing for a ghost
  bool merged = false;        ///< of two markers or more; `marker` is the nearest to the camera
};

/// One frame of all cameras. Frame i of a camera is exposed i / rate after its own start: at that time plus its offset by the rig's
/// clock.
struct RoomFrame {
  std::int64_t index = 0;
  double time_s = 0;                            ///< index / rate
  std::vector<Vector<3>> points;                ///< m: where each marker truly is at `time_s` by the rig's clock
  std::vector<std::vector<RoomBlob>> detected;  ///< by camera, from top to bottom as a detector finds them
};

/// A room full of cameras with exact truth. Every frame is a function of the options and its index: frames can be asked for in any
/// order and from several threads, and half an hour takes no more memory than one frame.
class RoomScene {
 public:
  /// At least 1 camera and 1 marker; rates, sizes and times positive; shares in [0, 1).
  explicit RoomScene(const RoomOptions& options);
  ~RoomScene();
  RoomScene(RoomScene&&) noexcept;
  RoomScene& operator=(RoomScene&&) noexcept;

  const RoomOptions& options() const;
  /// The true rig with its offsets, as it stands before a bump: "cam1", "cam2", …, without sources.
  const Rig& rig() const;
  /// The true rig at a time by its own clock.
  const Rig& rig_at(double time_s) const;
  /// A name for each marker.
  const std::vector<std::string>& labels() const;

  /// People with markers on them.
  int actors() const;
  /// The body of one of them; nothing if there is no body.
  std::optional<Skeleton> skeleton(int actor = 0) const;
  /// Where its segments truly are at a time by the rig's clock: world_from_segment, m. Only where there is a body.
  std::vector<Rigid3> segments(double time_s, int actor = 0) const;
  /// What its coordinates truly are, m and rad.
  std::vector<double> coordinates(double time_s, int actor = 0) const;
  /// The rigid bodies, and where they truly are.
  const std::vector<Body>& props() const;
  std::vector<Rigid3> prop_poses(double time_s) const;

  /// Where the markers are at a time by the rig's clock, m.
  std::vector<Vector<3>> points(double time_s) const;
  /// Which of `points` (of the same time) that camera could see: in its image, not hidden, not covered.
  std::vector<bool> visible(int camera, double time_s, std::span<const Vector<3>> points) const;
  RoomFrame frame(std::int64_t index) const;
  /// What one camera sees at a time by the rig's clock, whenever its frames are; noise, what is missed and ghosts are drawn by
  /// `draw`. With a frame's own time and its index that is the frame's `seen`.
  std::vector<RoomBlob> observed_by(int camera, double time_s, std::uint64_t draw) const;

  struct Parts;

 private:
  std::unique_ptr<Parts> parts_;
};

}  // namespace marey::simulate::room
