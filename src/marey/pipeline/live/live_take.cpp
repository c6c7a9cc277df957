#include "marey/pipeline/live/live_take.h"

#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/take/take_file.h"
#include "marey/source/live/played.h"

namespace marey::pipeline::live {
namespace {

using source::live::Address;
using source::live::Came;
using source::live::Connect;
using source::live::Opening;
using source::live::Shot;

bool names_take(const Address& address) {
  return address.location.ends_with(".marey");
}

/// A take's name with its options.
struct TakeName {
  int camera = 0;  ///< from 1; 0: all of them
  bool loop = false;

  explicit TakeName(const Address& address) {
    source::live::AddressOptions options(address);
    options.whole("camera", camera, 1, 1000);
    options.flag("loop", loop);
    options.done();
  }
};

Rig rig_of_take(const std::string& path) {
  const format::take::TakeReader take(path);
  if (take.summary().detected == 0)
    throw Error(
        "{}: holds nothing that its cameras saw, so that it cannot stand for them; marey view and marey play show what it holds",
        path);
  return take.header().rig.value();  // whose cameras saw it
}

/// One camera of a take: its points of each instant, when the instant comes.
class TakeCamera final : public source::live::Connection {
 public:
  TakeCamera(std::string path, CameraId camera, bool loop, Timestamp begin, source::LiveTime& time, std::stop_token stop)
      : path_(std::move(path)), camera_(camera), loop_(loop), begin_(begin), time_(time), stop_(std::move(stop)), take_(path_) {
    const RigCamera& known = take_.header().rig.value().cameras[static_cast<std::size_t>(number(camera))];
    info_.name = path_;
    info_.rate_hz = take_.header().rate_hz;
    if (known.size) info_.size = *known.size;
    first_ = take_.summary().first_time.value_or(Timestamp{});
  }

  const SourceInfo& info() const override { return info_; }

  Came next(Shot& shot) override {
    while (!pending_) {
      pending_ = take_.next();
      if (pending_) break;
      if (!loop_ || sequence_ == 0) return Came::end;
      again();
    }
    const Timestamp due = begin_ + (pending_->time - first_);
    if (!source::live::wait_until_due(due, time_, stop_)) return Came::nothing;
    const Instant now = std::move(*std::exchange(pending_, std::nullopt));
    last_ = now.time;
    shot.sequence = sequence_++;
    shot.taken = due;
    shot.given.detections = points_of(now);
    return seconds(time_.now() - due) * *info_.rate_hz > source::live::kMaxBehind ? Came::nothing : Came::frame;
  }

 private:
  std::vector<Detection> points_of(const Instant& instant) const {
    std::vector<Detection> points;
    for (const ImageObservation& detected : instant.detected) {
      if (detected.camera != camera_) continue;
      Detection& point = points.emplace_back();
      point.centre = detected.pixel;
      if (detected.sigma) point.covariance = *detected.sigma * *detected.sigma * Matrix<2>::Identity();
      point.area = detected.area.value_or(0);
    }
    return points;
  }

  void again() {
    begin_ += last_ - first_ + duration_from_seconds(1 / *info_.rate_hz);
    take_ = format::take::TakeReader(path_);
  }

  std::string path_;
  CameraId camera_;
  bool loop_;
  Timestamp begin_, first_{}, last_{};
  source::LiveTime& time_;
  std::stop_token stop_;
  format::take::TakeReader take_;
  SourceInfo info_;
  std::optional<Instant> pending_;
  std::int64_t sequence_ = 0;
};

Connect open_take(const Address& address, const Opening& opening) {
  const TakeName name(address);
  const Rig rig = rig_of_take(address.location);
  const auto cameras = std::ssize(rig.cameras);
  if (name.camera == 0 && cameras > 1)
    throw Error("{}: stands for {} cameras; add ?camera=1 to ?camera={} for one of them", address.text, cameras, cameras);
  if (name.camera > cameras) throw Error("{}: has {} cameras", address.text, cameras);
  const CameraId camera{std::max(0, name.camera - 1)};
  return [path = address.location, camera, loop = name.loop, begin = opening.begin](
             source::LiveTime& time, const std::stop_token& stop) -> std::unique_ptr<source::live::Connection> {
    return std::make_unique<TakeCamera>(path, camera, loop, begin(), time, stop);
  };
}

Rig cameras_of_take(const Address& address) {
  const TakeName name(address);
  Rig rig = rig_of_take(address.location);
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    RigCamera& camera = rig.cameras[i];
    const char* sign = address.options.empty() ? "?" : "&";
    camera.source = name.camera > 0 ? address.text : fmt::format("{}{}camera={}", address.text, sign, i + 1);
    camera.offset_s.reset();  // a take's instants are by one clock
    camera.detections.clear();
    camera.region.reset();
  }
  if (name.camera > std::ssize(rig.cameras)) throw Error("{}: has {} cameras", address.text, rig.cameras.size());
  if (name.camera > 0) rig.cameras = {rig.cameras[static_cast<std::size_t>(name.camera - 1)]};
  return rig;
}

Rig one_camera(const Address& address) {
  Rig rig;
  rig.cameras.emplace_back().source = address.text;
  return rig;
}

}  // namespace

source::live::Kind with_takes(source::live::Kind videos) {
  source::live::Kind both = videos;
  both.form = "play:FILE?loop";
  both.meaning = "a video, a folder of images, or what a take's cameras saw, in real time";
  both.open = [open = videos.open](const Address& address, const Opening& opening) {
    return names_take(address) ? open_take(address, opening) : open(address, opening);
  };
  both.cameras = [](const Address& address) { return names_take(address) ? cameras_of_take(address) : one_camera(address); };
  return both;
}

}  // namespace marey::pipeline::live
