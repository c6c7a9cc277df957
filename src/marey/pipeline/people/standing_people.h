// People who stand where the scene is learned are taken for a part of it, and nobody sees them. When one of them walks off, they
// are seen to move out of it, and their place shows that something has left: so the scene is corrected there, and a recording can
// be looked at again from its beginning with a scene in which they are not.
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
  /// `beginning`: the scene as it was learned ahead; empty where nothing was.
  explicit StandingPeople(Picture beginning) : beginning_(std::move(beginning)) {}

  /// What `see` will want to know of a frame, as far as it can be told before the detector has looked at it: both may be at work at
  /// once. Calls may be left out; what comes of `see` is the same.
  void look(const Frame& frame);

  /// What the tracker made of a frame in which `detector` looked for people. Who is found now to have come out of the scene is left
  /// out of it from now on. True where somebody was who had been in it since the beginning.
  bool see(const Frame& frame, std::span<const Track<2>> tracks, detect::Detector& detector);

  /// The picture without those who had been there since the beginning, in its own light.
  Picture without_them(const Picture& picture) const;

  /// How many had been there since the beginning.
  int since_beginning() const;
  /// What a live run says of those who came out of the scene, one sentence each: of all, or of those since the last call.
  std::vector<std::string> said(std::size_t from = 0) const;
  std::vector<std::string> news() { return said(std::exchange(told_, risers_.size())); }

 private:
  /// Somebody who began to move within the picture.
  struct Starter {
    TrackId id{};
    Timestamp at{};
    cv::Rect place;                    ///< px, round the body where it began; even-sided
    Box body;                          ///< px, within `place`
    Picture scene;                     ///< as it was then, at `place`
    std::optional<TrackId> left = {};  ///< who was then seen elsewhere, and may be the same
    Timestamp looked{};
    std::optional<std::int64_t> seen;  ///< the frame in which `look` has been there, and
    std::optional<cv::Mat> now;        ///< that is what had left
    cv::Mat gone;                      ///< what had left when it was last looked at, and
    Timestamp gone_at{};
  };
  /// Somebody who came out of the scene.
  struct Riser {
    TrackId id{};
    Timestamp at{};
    cv::Rect place;
    cv::Mat mask;     ///< of `place`: where they had stood
    Picture picture;  ///< what is there
    bool since_beginning = false;
  };

  void note_starters(const Frame& frame, std::span<const Track<2>> tracks, const detect::Detector& detector);
  void note_next(TrackId id, const Box& body, Timestamp now);
  static bool is_due(const Starter& starter, const Frame& frame);
  bool has_gone(Starter& starter, const Frame& frame) const;
  bool is_known(const Starter& starter) const;

  Picture beginning_;
  std::optional<Timestamp> first_;
  int last_id_ = 0;
  std::size_t told_ = 0;  // of the risers
  std::vector<Starter> starters_;
  std::vector<Riser> risers_;
};

}  // namespace marey::pipeline::people
