#include "marey/pipeline/keypoints/images_with_people.h"

#include <memory>
#include <optional>
#include <utility>

#include "marey/detect/keypoints/model_folder.h"
#include "marey/detect/network/halved_image.h"
#include "marey/detect/network/run_network.h"
#include "marey/pipeline/corridor/stopwatch.h"

namespace marey::pipeline::keypoints {

using detect::keypoints::Body;
using detect::keypoints::ImageRegion;
using detect::keypoints::PersonRegion;

FindPeople people_finder(const std::string& file) {
  const auto network = std::make_shared<detect::network::LoadedNetwork>(
      detect::network::read_network_model(file.empty() ? detect::keypoints::model_file("person.toml") : file));
  return [network](const Image& image) {
    // Not more pixels are converted than the network receives.
    const cv::Size input = network->model().input;
    Image small = image;
    double scale = 1;
    for (; small.size().width >= 2 * input.width && small.size().height >= 2 * input.height; scale *= 2)
      small = detect::network::halved(small);
    std::vector<Box> boxes;
    for (const detect::network::Candidate& one : network->find(small.bgr()))
      boxes.push_back({scale * one.left, scale * one.top, scale * (one.right - one.left), scale * (one.bottom - one.top)});
    return boxes;
  };
}

FindBodies body_finder(const std::string& model) {
  const auto network = std::make_shared<detect::keypoints::LandmarkNetwork>(detect::keypoints::landmark_model(model));
  return [network](std::span<const ImageRegion> searched) { return network->find(searched); };
}

ImagesWithPeople::ImagesWithPeople(const KeypointSet& set, std::size_t cameras, FindPeople find_people, FindBodies find_bodies,
                                   const CameraPeopleOptions& options)
    : find_people_(std::move(find_people)), find_bodies_(std::move(find_bodies)) {
  for (std::size_t c = 0; c < cameras; ++c) cameras_.emplace_back(set, options);
}

void ImagesWithPeople::step(std::span<const Image> images, Timestamp now, const std::function<bool(std::size_t camera)>& full) {
  const auto is_full = [&](std::size_t c) { return full && full(c); };
  // The person detector, in the image that has waited for it longest.
  std::optional<std::size_t> chosen;
  double longest = 0;
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    const auto due = images[c].empty() ? std::nullopt : cameras_[c].search_due(now, is_full(c));
    if (due && (!chosen || *due > longest)) chosen = c, longest = *due;
  }
  if (chosen) {
    const corridor::Stopwatch watch;
    ++searches_;
    cameras_[*chosen].searched(find_people_(images[*chosen]), now);
    searching_.add(watch.seconds());
  }
  std::vector<ImageRegion> searched;
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    if (images[c].empty()) continue;
    for (const PersonRegion& region : cameras_[c].regions()) searched.push_back({images[c], region});
  }
  std::vector<Body> bodies;
  if (!searched.empty()) {
    const corridor::Stopwatch watch;
    bodies = find_bodies_(searched);
    detecting_.add(watch.seconds());
  }
  regions_ += std::ssize(searched);
  std::size_t begin = 0;
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    if (images[c].empty()) continue;
    const std::size_t count = cameras_[c].size();
    cameras_[c].take(std::span(bodies).subspan(begin, count), now, is_full(c));
    begin += count;
  }
}

}  // namespace marey::pipeline::keypoints
