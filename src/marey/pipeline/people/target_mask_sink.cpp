#include "marey/pipeline/people/target_mask_sink.h"

#include <cstdint>
#include <limits>

#include "marey/core/error.h"
#include "marey/format/tracks/mask_file.h"

namespace marey::pipeline::people {
namespace {

/// Writes a number into the pixels of a mask.
void paint_target(const RunMask& mask, std::uint16_t number, cv::Mat& image) {
  std::int64_t at = 0;
  for (std::size_t i = 0; i < mask.runs.size(); ++i) {
    const std::int64_t end = at + mask.runs[i];
    for (; i % 2 == 1 && at < end; ++at)
      image.at<std::uint16_t>(static_cast<int>(at % mask.height), static_cast<int>(at / mask.height)) = number;
    at = end;
  }
}

}  // namespace

Sink::SinkRequirements TargetMaskSink::begin(const RecordingHeader& header) {
  if (header.rig && !header.rig->cameras.empty() && header.rig->cameras.front().size) size_ = *header.rig->cameras.front().size;
  return {.images = size_.empty()};
}

void TargetMaskSink::write(const Instant& instant) {
  if (size_.empty() && !instant.frames.empty()) size_ = instant.frames.front().image.size();
  if (size_.empty()) throw Error("{}: the size of the image is not known, which masks need", name_);
  cv::Mat image(size_, CV_16UC1, cv::Scalar(0));
  for (const LabelledMask& one : format::tracks::visible_masks(instant, size_.width, size_.height)) {
    if (one.id < 1 || one.id > std::numeric_limits<std::uint16_t>::max())
      throw Error("{}: target {} has no number that a mask of 16 bits holds", name_, one.id);
    paint_target(one.mask, static_cast<std::uint16_t>(one.id), image);
  }
  folder_.add(instant.index, image, size_);
}

}  // namespace marey::pipeline::people
