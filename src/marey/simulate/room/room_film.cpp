#include "marey/simulate/room/room_film.h"

#include <algorithm>

#include "marey/simulate/markers/discs.h"

namespace marey::simulate::room {
namespace {

constexpr float kGround = 22;            // grey level
constexpr double kGhostDistance = 4;     // m
constexpr double kSmallestRadius = 0.6;  // px

RoomOptions exact(RoomOptions options) {
  options.noise_px = 0;
  options.merge_px = 0;  // discs that touch are one by themselves
  return options;
}

class RoomFilm : public Source {
 public:
  RoomFilm(const RoomOptions& room, std::size_t index, const RoomFilmOptions& options)
      : scene_(exact(room)), index_(index), options_(options) {
    const RigCamera& camera = scene_.rig().cameras[index];
    info_ = {camera.name, *camera.size, scene_.options().rate_hz, scene_.options().frames};
  }

  const SourceInfo& info() const override { return info_; }

  std::optional<Frame> next() override {
    if (next_ >= scene_.options().frames) return std::nullopt;
    const RoomFrame frame = scene_.frame(next_++);
    return Frame{CameraId{static_cast<int>(index_)}, frame.index, timestamp_from_seconds(frame.time_s), Picture(render(frame))};
  }

 private:
  cv::Mat render(const RoomFrame& frame) const {
    const RigCamera& camera = scene_.rig_at(frame.time_s).cameras[index_];
    const Vector<3> centre = camera.camera()->centre();
    std::vector<markers::Disc> discs;
    for (const RoomBlob& blob : frame.seen[index_]) {
      const double distance = blob.marker ? (frame.points[static_cast<std::size_t>(*blob.marker)] - centre).norm() : kGhostDistance;
      const double radius = options_.marker_radius * geometry::focal_of(*camera.lens).x() / distance;
      discs.push_back({blob.pixel, std::max(kSmallestRadius, radius)});
    }
    cv::Mat image(*camera.size, CV_32FC1, cv::Scalar(kGround));
    markers::draw_discs(image, discs);
    const auto seed = scene_.options().seed * 1000003u + static_cast<std::uint64_t>(frame.index) * 64 + index_;
    return markers::expose(image, options_.picture_noise, seed);
  }

  RoomScene scene_;
  std::size_t index_;
  RoomFilmOptions options_;
  SourceInfo info_;
  std::int64_t next_ = 0;
};

}  // namespace

std::unique_ptr<Source> film_room(const RoomOptions& room, std::size_t index, const RoomFilmOptions& options) {
  return std::make_unique<RoomFilm>(room, index, options);
}

std::vector<int> cameras_that_see(const RoomScene& scene, const RoomFrame& frame) {
  std::vector<int> cameras(frame.points.size(), 0);
  for (int camera = 0; camera < scene.options().cameras; ++camera) {
    const std::vector<bool> visible = scene.visible(camera, frame.time_s, frame.points);
    for (std::size_t i = 0; i < visible.size(); ++i) cameras[i] += visible[i] ? 1 : 0;
  }
  return cameras;
}

}  // namespace marey::simulate::room
