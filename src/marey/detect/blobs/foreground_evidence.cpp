#include "marey/detect/blobs/foreground_evidence.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "marey/core/error.h"

namespace marey::detect::blobs {
namespace {

constexpr int kDefaultStep = 5;            // px, as the paper's grid is remembered
constexpr float kForeground = 4;           // standard deviations from all that was learned of a point
constexpr std::size_t kMinFrameCount = 3;  // by definition: frames of which a median omits one that is far off

}  // namespace

ForegroundEvidence::ForegroundEvidence(const ForegroundEvidenceOptions& options) : options_(options) {
  if (options.step && *options.step < 1) throw Error("the grid's points are {} px apart; 1 is the least", *options.step);
  if (options.foreground_kinds < 1) throw Error("{} kinds of foreground; 1 is the least", options.foreground_kinds);
  if (!(options.max_evidence > 0)) throw Error("a point tells {} nats at most; it must be positive", options.max_evidence);
}

void ForegroundEvidence::prime(std::span<const Frame> samples) {
  std::vector<cv::Mat> detected;
  for (const Frame& frame : samples) detected.push_back(filter_responses(frame.image, options_.step.value_or(kDefaultStep)));
  if (detected.size() >= kMinFrameCount) learn(detected);
}

std::shared_ptr<const BlobEvidence> ForegroundEvidence::of(const Frame& frame) {
  const int step = options_.step.value_or(kDefaultStep);
  const cv::Mat responses = filter_responses(frame.image, step);
  if (background_.empty()) {
    waiting_.push_back(responses);
    if (std::ssize(waiting_) >= options_.learning_frames) learn(std::exchange(waiting_, {}));
    return nullptr;
  }
  if (responses.size() != grid_) throw Error("{}", "the images of a camera change their size within the recording");
  auto evidence = std::make_shared<BlobEvidence>();
  evidence->step = step;
  evidence->origin = Vector<2>::Constant(0.5 * (step - 1));
  evidence->log_ratio.create(grid_, CV_32FC1);
  const auto maximum = static_cast<float>(options_.max_evidence);
  for (int row = 0; row < grid_.height; ++row) {
    const Response* response = responses.ptr<Response>(row);
    const PointBackground* background = &background_[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.width)];
    float* ratio = evidence->log_ratio.ptr<float>(row);
    for (int column = 0; column < grid_.width; ++column) {
      ratio[column] = std::clamp(log_density(foreground_, response[column]) - background[column].log_density(response[column]),
                                 -maximum, maximum);
    }
  }
  return evidence;
}

void ForegroundEvidence::learn(const std::vector<cv::Mat>& detected) {
  grid_ = detected.front().size();
  const Response noise = response_noise(detected);
  std::vector<Response> of_point;
  background_.clear();
  background_.reserve(static_cast<std::size_t>(grid_.area()));
  for (int at = 0; at < grid_.area(); ++at) {
    of_point.clear();
    for (const cv::Mat& grid : detected) of_point.push_back(grid.at<Response>(at / grid_.width, at % grid_.width));
    background_.emplace_back(of_point, noise);
  }
  foreground_ = learn_foreground(outliers(detected), options_.foreground_kinds, options_.seed);
}

std::vector<Response> ForegroundEvidence::outliers(const std::vector<cv::Mat>& detected) const {
  std::vector<Response> found;
  for (const cv::Mat& grid : detected) {
    for (int at = 0; at < grid_.area(); ++at) {
      const Response& response = grid.at<Response>(at / grid_.width, at % grid_.width);
      if (background_[static_cast<std::size_t>(at)].distance(response) > kForeground) found.push_back(response);
    }
  }
  return found;
}

}  // namespace marey::detect::blobs
