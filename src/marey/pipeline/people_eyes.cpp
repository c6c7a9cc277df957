#include "marey/pipeline/people_eyes.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "marey/pipeline/detections_input.h"
#include "marey/pipeline/read_ahead.h"
#include "marey/source/open_source.h"
#include "marey/source/region_source.h"

namespace marey::pipeline {
namespace {

// A detector learns the empty scene from this many pictures, spread over this long a beginning.
constexpr int kSamples = 30;
constexpr double kSampledSeconds = 30;
constexpr int kMostFramesRead = 300;
constexpr double kUsualRate = 25;

std::vector<Frame> sample(Source& source) {
  const double span = std::min<double>(kSampledSeconds * source.info().rate_hz.value_or(kUsualRate), kMostFramesRead);
  const auto step = std::max<std::int64_t>(1, static_cast<std::int64_t>(span / kSamples));
  std::vector<Frame> samples;
  while (samples.size() < kSamples) {
    auto frame = source.next();
    if (!frame) break;
    if (frame->index % step == 0) samples.push_back(std::move(*frame));
  }
  return samples;
}

}  // namespace

std::unique_ptr<Source> open_pictures(const PeopleInput& input) {
  auto source = source::open_source(input.pictures, input.rate_hz);
  return input.region ? source::crop(std::move(source), *input.region) : std::move(source);
}

DetectionStage open_detection_stage(const PeopleInput& input, const DetectionStageOptions& options) {
  if (!input.detections.empty()) {
    DetectionsInput known = open_detections(input.detections, input.rate_hz);
    return {std::move(known.source), std::move(known.detector)};
  }
  auto people =
      std::make_unique<detect::people::PeopleDetector>(detect::background::make_background(options.background), options.people);
  DetectionStage eyes{open_pictures(input), nullptr, people.get()};
  eyes.detector = std::move(people);
  if (options.read_ahead) eyes.detector->prime(sample(*open_pictures(input)));
  eyes.source = read_ahead(std::move(eyes.source));
  return eyes;
}

}  // namespace marey::pipeline
