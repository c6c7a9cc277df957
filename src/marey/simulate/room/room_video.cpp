#include "marey/simulate/room/room_video.h"

#include <algorithm>

#include "marey/simulate/markers/discs.h"
#include "marey/simulate/random.h"

namespace marey::simulate::room {
namespace {

constexpr float kGround = 22;         // grey level
constexpr double kGhostDistance = 4;  // m
constexpr double kMinRadius = 0.6;    // px
constexpr int kField = 64;            // px by which a field of noise is wider and higher than an image: 4096 of them

RoomOptions exact(RoomOptions options) {
  options.noise_px = 0;
  options.merge_px = 0;  // discs that touch are one by themselves
  return options;
}

std::vector<markers::Disc> discs_of(const RoomScene& scene, std::size_t index, double time_s, const std::vector<RoomBlob>& detected,
                                    const RoomVideoOptions& options) {
  const RigCamera& camera = scene.rig_at(time_s).cameras[index];
  const Vector<3> centre = camera.camera()->centre();
  const std::vector<Vector<3>> points = scene.points(time_s);
  std::vector<markers::Disc> discs;
  for (const RoomBlob& blob : detected) {
    const double distance = blob.marker ? (points[static_cast<std::size_t>(*blob.marker)] - centre).norm() : kGhostDistance;
    const double radius = options.marker_radius * geometry::focal_of(*camera.lens).x() / distance;
    discs.push_back({blob.pixel, std::max(kMinRadius, radius)});
  }
  return discs;
}

std::uint64_t noise_seed(const RoomScene& scene, std::size_t index, std::uint64_t draw) {
  return scene.options().seed * 1000003u + draw * 64 + index;
}

class RoomVideo : public Source {
 public:
  RoomVideo(const RoomOptions& room, std::size_t index, const RoomVideoOptions& options)
      : scene_(exact(room)), index_(index), options_(options) {
    const RigCamera& camera = scene_.rig().cameras[index];
    info_ = {camera.name, *camera.size, scene_.options().rate_hz, scene_.options().frames};
  }

  const SourceInfo& info() const override { return info_; }

  std::optional<Frame> next() override {
    if (next_ >= scene_.options().frames) return std::nullopt;
    const std::int64_t index = next_++;
    const double time_s = static_cast<double>(index) / scene_.options().rate_hz;
    const double offset = scene_.rig().cameras[index_].offset_s.value_or(0);
    const auto draw = static_cast<std::uint64_t>(index);
    const std::vector<RoomBlob> detected = scene_.observed_by(static_cast<int>(index_), time_s + offset, draw);
    const Image image(draw_room(scene_, index_, time_s, detected, draw, options_));
    return Frame{CameraId{static_cast<int>(index_)}, index, timestamp_from_seconds(time_s), image};
  }

 private:
  RoomScene scene_;
  std::size_t index_;
  RoomVideoOptions options_;
  SourceInfo info_;
  std::int64_t next_ = 0;
};

}  // namespace

std::unique_ptr<Source> video_room(const RoomOptions& room, std::size_t index, const RoomVideoOptions& options) {
  return std::make_unique<RoomVideo>(room, index, options);
}

cv::Mat draw_room(const RoomScene& scene, std::size_t index, double time_s, const std::vector<RoomBlob>& detected,
                  std::uint64_t draw, const RoomVideoOptions& options) {
  cv::Mat image(*scene.rig().cameras[index].size, CV_32FC1, cv::Scalar(kGround));
  markers::draw_discs(image, discs_of(scene, index, time_s, detected, options));
  return markers::expose(image, options.image_noise, noise_seed(scene, index, draw));
}

RoomSpots::RoomSpots(const RoomScene& scene, std::size_t index, const RoomVideoOptions& options)
    : scene_(scene), index_(index), options_(options), size_(*scene.rig().cameras[index].size) {
  const cv::Mat ground(size_.height + kField, size_.width + kField, CV_32FC1, cv::Scalar(kGround));
  field_ = markers::expose(ground, options_.image_noise, noise_seed(scene, index, 0));
}

RoomSpots::Drawn RoomSpots::draw(double time_s, const std::vector<RoomBlob>& detected, std::uint64_t draw) const {
  const std::uint64_t seed = noise_seed(scene_, index_, draw);
  Random random(seed);
  Drawn drawn;
  drawn.noise = {static_cast<int>(random.uniform(0, kField)), static_cast<int>(random.uniform(0, kField))};
  const std::vector<markers::Disc> discs = discs_of(scene_, index_, time_s, detected, options_);
  std::vector<cv::Rect> reaches;
  for (const markers::Disc& disc : discs) reaches.push_back(markers::reach_of(disc) & cv::Rect({}, size_));
  for (std::size_t i = 0; i < discs.size(); ++i) {
    const cv::Rect& location = reaches[i];
    if (location.empty()) continue;
    std::vector<markers::Disc> inside;
    for (std::size_t j = 0; j < discs.size(); ++j) {
      if ((reaches[j] & location).empty()) continue;
      inside.push_back(discs[j]);
      inside.back().centre -= Vector<2>(location.x, location.y);
    }
    cv::Mat image(location.size(), CV_32FC1, cv::Scalar(kGround));
    markers::draw_discs(image, inside);
    const cv::Mat seen_there = markers::expose(image, options_.image_noise, seed * 31 + i);
    drawn.locations.push_back(location);
    drawn.pixels.insert(drawn.pixels.end(), seen_there.datastart, seen_there.dataend);
  }
  return drawn;
}

cv::Mat RoomSpots::image(const Drawn& drawn) const {
  cv::Mat image = field_(cv::Rect(drawn.noise, size_)).clone();
  const std::uint8_t* pixels = drawn.pixels.data();
  for (const cv::Rect& location : drawn.locations) {
    for (int y = 0; y < location.height; ++y, pixels += location.width)
      std::copy_n(pixels, location.width, image.ptr(location.y + y) + location.x);
  }
  return image;
}

std::vector<int> cameras_that_observe(const RoomScene& scene, const RoomFrame& frame) {
  std::vector<int> cameras(frame.points.size(), 0);
  for (int camera = 0; camera < scene.options().cameras; ++camera) {
    const std::vector<bool> visible = scene.visible(camera, frame.time_s, frame.points);
    for (std::size_t i = 0; i < visible.size(); ++i) cameras[i] += visible[i] ? 1 : 0;
  }
  return cameras;
}

}  // namespace marey::simulate::room
