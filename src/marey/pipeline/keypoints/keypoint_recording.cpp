#include "marey/pipeline/keypoints/keypoint_recording.h"

#include "marey/core/error.h"
#include "marey/core/frame_numbers.h"
#include "marey/core/keypoint_sets.h"
#include "marey/format/recording_file.h"

namespace marey::pipeline::keypoints {

Sink::SinkRequirements KeypointCollector::begin(const RecordingHeader& header) {
  if (!header.keypoints || header.frame.kind != FrameOfReference::Kind::image)
    throw Error("{}: contains no body keypoints in an image; make it with marey track --targets keypoints", into_.from);
  into_.set = *header.keypoints;
  // Programs differ in what they call a toe; in space a point has the same name whichever network found it.
  for (std::string& point : into_.set.points) point = common_keypoint_name(point);
  into_.rate_hz = header.rate_hz;
  if (header.rig && !header.rig->cameras.empty()) into_.size = header.rig->cameras.front().size;
  return {};
}

void KeypointCollector::write(const Instant& instant) {
  if (instant.index < 0 || instant.index > FrameNumbers::kMaxMissing)
    throw Error("{}: frame {} is not supported; a video has at most {}", into_.from, instant.index, FrameNumbers::kMaxMissing);
  into_.frames.resize(static_cast<std::size_t>(instant.index) + 1);
  for (const Sample& sample : instant.samples) {
    if (sample.keypoints) into_.frames.back().push_back(*sample.keypoints);
  }
}

KeypointSequence keypoints_of_take(const std::string& path) {
  const auto reader = format::open_recording(path);
  KeypointSequence sequence{.set = {}, .size = {}, .rate_hz = {}, .frames = {}, .from = path};
  KeypointCollector collector(sequence);
  collector.begin(reader->header());
  while (const auto instant = reader->next()) collector.write(*instant);
  return sequence;
}

}  // namespace marey::pipeline::keypoints
