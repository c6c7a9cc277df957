// Who may be on a wire: the labels that recordings give tracks, in an order that stays, and the bodies. Wires that say names once
// and then places by their order (QTM, NatNet, LSL) and those that say names in every frame ask it alike.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "marey/core/instant.h"
#include "marey/core/recording.h"

namespace marey::stream {

/// A skeleton's segments, parents before children.
struct Skeleton {
  std::string name;
  std::vector<Body> segments;
};

class ChannelLayout {
 public:
  void begin(const RecordingHeader& header);
  /// Takes the names in. True where a label is new: the list of labels has grown.
  bool add(std::span<const TrackName> names);

  /// In the order in which they came; a track that is lost and comes back under another number has its old place.
  const std::vector<std::string>& labels() const { return labels_; }
  /// A track's; empty if it has none.
  std::string_view label_of(TrackId track) const;
  const std::vector<Body>& bodies() const { return bodies_; }  ///< by themselves
  const std::vector<Skeleton>& skeletons() const { return skeletons_; }

  /// What an instant shows, by label: null where that is not there. Valid as long as the instant.
  struct Scene {
    std::vector<const Sample*> labelled;  ///< one a label
    std::vector<const Sample*> others;    ///< without a label, and a label's second one
  };
  /// `scene` keeps its memory from call to call.
  void location(const Instant& instant, Scene& scene) const;

 private:
  std::vector<std::string> labels_;
  std::map<std::string, std::size_t, std::less<>> position_of_;  // of a label
  std::unordered_map<int, std::size_t> position_of_track_;       // of a track's label
  std::vector<Body> bodies_;
  std::vector<Skeleton> skeletons_;
};

/// Where a body is at that instant; null where the instant does not specify.
const BodyPose* pose_of(const Instant& instant, BodyId body);

/// A body's pose in its parent's frame.
Rigid3 in_parent(const BodyPose& parent, const BodyPose& child);

}  // namespace marey::stream
