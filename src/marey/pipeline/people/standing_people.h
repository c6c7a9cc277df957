// People who stand where the scene is learned are taken for a part of it, and no person sees them. When one of them walks off, they
// are seen to move out of it, and their place shows that something has left: so the scene is corrected there, and a recording can
// be inspected again from its beginning with a scene in which they are not.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "marey/core/frame.h"
#include "marey/core/track.h"
#include "marey/detect/detector.h"

namespace marey::pipeline::people {

class StandingPeople {
 public:
  /// `beginning`: the scene as it was learned ahead; empty if nothing was.
  explicit StandingPeople(Image beginning) : beginning_(std::move(beginning)) {}

  /// What `see` will want to know of a frame, as far as it can be reported before the detector has inspected it: both may be at
  /// work at once. Calls may be omitted; what results from `see` is the same.
  void inspect(const Frame& frame);

  /// The tracker's result of a frame that `detector` searched for people. A person found now to have come out of the scene is
  /// removed from it from now on. True where a person was who had been in it since the beginning.
  bool observe_frame(const Frame& frame, std::span<const Track<2>> tracks, detect::Detector& detector);

  /// The image without those who had been there since the beginning, in its own light.
  Image without_them(const Image& image) const;

  /// How many had been there since the beginning.
  int since_beginning() const;
  /// What a live run says of those who came out of the scene, one sentence each: of all, or of those since the last call.
  std::vector<std::string> stated(std::size_t from = 0) const;
  std::vector<std::string> news() { return stated(std::exchange(reported_, risers_.size())); }

 private:
  /// A person who began to move within the image.
  struct Starter {
    TrackId id{};
    Timestamp at{};
    cv::Rect location;                 ///< px, round the body where it began; even-sided
    Box body;                          ///< px, within `place`
    Image scene;                       ///< as it was then, at `place`
    std::optional<TrackId> left = {};  ///< who was then seen elsewhere, and may be the same
    Timestamp inspected{};
    std::optional<std::int64_t> detected;  ///< the frame in which `look` has been there, and
    std::optional<cv::Mat> now;            ///< that is what had left
    cv::Mat gone;                          ///< what had left when it was last inspected, and
    Timestamp gone_at{};
  };
  /// A person who came out of the scene.
  struct Riser {
    TrackId id{};
    Timestamp at{};
    cv::Rect location;
    cv::Mat mask;  ///< of `place`: where they had stood
    Image image;   ///< the image there
    bool since_beginning = false;
  };

  void note_starters(const Frame& frame, std::span<const Track<2>> tracks, const detect::Detector& detector);
  void note_next(TrackId id, const Box& body, Timestamp now);
  static bool is_due(const Starter& starter, const Frame& frame);
  bool has_gone(Starter& starter, const Frame& frame) const;
  bool is_known(const Starter& starter) const;

  Image beginning_;
  std::optional<Timestamp> first_;
  int last_id_ = 0;
  std::size_t reported_ = 0;  // of the risers
  std::vector<Starter> starters_;
  std::vector<Riser> risers_;
};

}  // namespace marey::pipeline::people
