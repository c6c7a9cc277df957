// A head is an eighth of a standing person, 13 % with its hair, and half as wide as its height again; a walker's sways by a head
// to either side of the box's middle. The face's points reach from ear to ear, 15 cm of a head of 23.
#include "marey/draw/heads.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace marey::draw {
namespace {

constexpr std::array<std::string_view, 4> kFaceParts{"nose", "eye", "ear", "mouth"};
// Shares of a box's height and width, and of the face's extent; generous by a half over the proportions above. unswept: the price
// of too much is pixels beside heads, of too little a face.
constexpr float kUpper = 0.22F, kWide = 0.28F, kFaceReach = 1.6F, kMinOfBody = 0.075F;
constexpr double kFacePresence = 0.3;  // presence of a point

bool is_of_face(std::string_view name) {
  return std::ranges::any_of(kFaceParts, [&](std::string_view part) { return name.find(part) != std::string_view::npos; });
}

std::optional<cv::Rect2f> upper_part(const Sample& sample) {
  if (!sample.box) return std::nullopt;
  const auto left = static_cast<float>(sample.box->left), top = static_cast<float>(sample.box->top);
  const auto width = static_cast<float>(sample.box->width), height = static_cast<float>(sample.box->height);
  // A person who bends or lies has the head anywhere in the upper half.
  if (width > 0.8F * height) return cv::Rect2f(left, top - 0.05F * height, width, 0.6F * height);
  const float upper = kUpper * height, wide = std::max(kWide * height, 0.7F * width);
  return cv::Rect2f(left + (width - wide) / 2, top - 0.03F * height, wide, upper + 0.03F * height);
}

std::optional<cv::Rect2f> round_face(const Sample& sample, const KeypointSet& set) {
  std::vector<cv::Point2f> points;
  const std::size_t count = std::min(set.points.size(), sample.keypoints->points.size());
  for (std::size_t i = 0; i < count; ++i) {
    const auto& point = sample.keypoints->points[i];
    if (point && point->presence >= kFacePresence && is_of_face(set.points[i]))
      points.emplace_back(static_cast<float>(point->position.x()), static_cast<float>(point->position.y()));
  }
  if (points.size() < 2) return std::nullopt;
  cv::Point2f centre(0, 0);
  for (const cv::Point2f& point : points) centre += point * (1.0F / static_cast<float>(points.size()));
  float reach = sample.box ? kMinOfBody * static_cast<float>(sample.box->height) : 0;
  for (const cv::Point2f& point : points) reach = std::max(reach, kFaceReach * static_cast<float>(cv::norm(point - centre)));
  return cv::Rect2f(centre.x - reach, centre.y - 1.2F * reach, 2 * reach, 2.4F * reach);
}

}  // namespace

std::optional<cv::Rect2f> head_of(const Sample& sample, const std::optional<KeypointSet>& keypoints) {
  if (sample.keypoints && keypoints) {
    if (const auto face = round_face(sample, *keypoints)) return face;
  }
  return upper_part(sample);
}

void HeadsOverTime::add(Timestamp now, std::span<const Sample> samples, const std::optional<KeypointSet>& keypoints) {
  FrameHeads& frame = frames_.emplace_back();
  frame.time = now;
  for (const Sample& sample : samples) {
    if (const auto head = head_of(sample, keypoints)) frame.heads.emplace_back(sample.track, *head);
  }
}

std::optional<std::vector<cv::Rect2f>> HeadsOverTime::next(bool at_end) {
  if (frames_.empty() || (!at_end && frames_.back().time - frames_.front().time <= hold_)) return std::nullopt;
  const FrameHeads& now = frames_.front();
  std::map<TrackId, cv::Rect2f> heads(now.heads.begin(), now.heads.end());
  for (const auto& [track, head] : now.heads) last_[track] = {now.time, head};
  for (const auto& [track, seen] : last_) {
    if (now.time - seen.first <= hold_) heads.try_emplace(track, seen.second);
  }
  for (std::size_t i = 1; i < frames_.size() && frames_[i].time - now.time <= hold_; ++i) {
    for (const auto& [track, head] : frames_[i].heads) heads.try_emplace(track, head);
  }
  std::erase_if(last_, [&](const auto& one) { return now.time - one.second.first > hold_; });
  std::vector<cv::Rect2f> rectangles;
  for (const auto& [track, head] : heads) rectangles.push_back(head);
  frames_.pop_front();
  return rectangles;
}

}  // namespace marey::draw
