// An instant as Foxglove's messages, for MCAP files and for the Foxglove WebSocket: points as a PointCloud (Rerun reads that),
// bodies as FrameTransforms, both drawn with their names as a SceneUpdate, and the times as JSON.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "marey/core/instant.h"
#include "marey/core/recording.h"

namespace marey::format::mcap {

/// What goes over one topic.
struct Topic {
  std::string_view name, encoding, schema_name, schema_encoding;
  std::string schema;
};

/// Markers, transforms, scene, times: always these, in this order.
const std::vector<Topic>& topics();
inline constexpr std::size_t kPointsTopic = 0, kTransformsTopic = 1, kSceneTopic = 2, kTimesTopic = 3;

/// ns, each by the clock that its user has.
struct MessageTimes {
  std::int64_t stamp = 0;  ///< in the messages
  std::optional<std::int64_t> capture = {}, solve = {}, send = {};
};

class FoxgloveMessages {
 public:
  void begin(const RecordingHeader& header);
  void add(const std::vector<TrackName>& names);

  /// Of that topic; empty if this instant has none.
  std::string message(std::size_t topic, const Instant& instant, const MessageTimes& times) const;

 private:
  std::string points(const Instant& instant, const MessageTimes& times) const;
  std::string transforms(const Instant& instant, const MessageTimes& times) const;
  std::string scene(const Instant& instant, const MessageTimes& times) const;

  RecordingHeader header_;
  std::unordered_map<int, TrackName> names_;  // by track
};

}  // namespace marey::format::mcap
