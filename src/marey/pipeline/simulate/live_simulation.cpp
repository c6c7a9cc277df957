#include "marey/pipeline/simulate/live_simulation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include "marey/core/error.h"
#include "marey/simulate/people/people_video.h"
#include "marey/simulate/random.h"
#include "marey/simulate/room/room_video.h"
#include "marey/simulate/room/to_and_fro.h"
#include "marey/source/live/played.h"

namespace marey::pipeline::simulate {
namespace {

using marey::simulate::room::RoomScene;
using source::live::Address;
using source::live::AddressOptions;
using source::live::Came;
using source::live::Connection;
using source::live::Control;
using source::live::ControlRange;
using source::live::Kind;
using source::live::Opening;
using source::live::Shot;

constexpr double kDefaultExposure = 2;  // ms, for which images are drawn
constexpr double kMinExposure = 0.02, kMaxGain = 16;

/// How a room's cameras behave beside what they see.
struct RoomBehaviour {
  double drawn_s = 0;        ///< this much is drawn before it begins, and shown to and fro: it costs no time later
  double drift_ppm = 0;      ///< each camera's own clock is wrong by up to this much
  double jitter_ms = 0;      ///< mean delay of delivery, beside the exposure
  bool blobs = false;        ///< points come, not images
  bool frame = false;        ///< an L-frame lies on the floor, whatever else moves
  int lamps = 0;             ///< bright spots in each camera's image that do not move
  double exposure_ms = 0;    ///< of drawn images; 0: `kDefaultExposure`
  double gain = 1;           ///< likewise, times
  std::vector<double> away;  ///< camera from 1, from when to when it is not there, s
};

/// A name's options without the one that says which camera.
struct RoomName {
  marey::simulate::room::RoomOptions room;
  RoomBehaviour behaviour;
  int camera = 0;  ///< from 1; 0: all of them

  explicit RoomName(const Address& address);
};

RoomName::RoomName(const Address& address) {
  AddressOptions options(address);
  room.image = {640, 480};
  std::string motion = "walk";
  int seed = 1;
  options.whole("cameras", room.cameras, 1, 64);
  options.whole("markers", room.markers, 1, 2000);
  options.number("rate", room.rate_hz, 1, 1000);
  options.size("size", room.image.width, room.image.height);
  options.text("motion", motion);
  options.whole("seed", seed, 0, 1'000'000'000);
  options.number("noise", room.noise_px, 0, 100);
  options.number("offset", room.offset_s, 0, 1);
  options.number("drawn", behaviour.drawn_s, 0, 60);
  options.number("drift", behaviour.drift_ppm, 0, 500);
  options.number("jitter", behaviour.jitter_ms, 0, 1000);
  options.flag("blobs", behaviour.blobs);
  options.flag("frame", behaviour.frame);
  options.whole("lamps", behaviour.lamps, 0, 50);
  options.number("exposure", behaviour.exposure_ms, 0.01, 1000);
  options.number("gain", behaviour.gain, 1, kMaxGain);
  options.numbers("away", behaviour.away, 3);
  options.whole("camera", camera, 1, room.cameras);
  options.done();
  room.seed = static_cast<std::uint64_t>(seed);
  std::vector<std::string_view> known;
  for (const auto& each : marey::simulate::room::room_motions()) {
    known.push_back(each.name);
    if (each.name == motion) room.motion = each.motion;
  }
  if (std::find(known.begin(), known.end(), motion) == known.end())
    throw Error("{}: motion={} is not possible; it must be one of {}", address.text, motion, fmt::join(known, ", "));
  if (!behaviour.blobs) room.noise_px = room.merge_px = 0;  // the pixels bring the noise
}

/// A room that all its cameras share.
struct SharedRoom {
  explicit SharedRoom(const RoomName& name) : scene(name.room), behaviour(name.behaviour) {}

  RoomScene scene;
  RoomBehaviour behaviour;
  double rate_hz() const { return scene.options().rate_hz; }
  double longest_exposure_ms() const { return 1000 / rate_hz(); }
  double default_exposure_ms() const { return std::min(kDefaultExposure, longest_exposure_ms()); }

  /// What a camera sees: markers, an L-frame, and lamps.
  std::vector<marey::simulate::room::RoomBlob> observed_by(int camera, double time_s, std::uint64_t draw) const {
    auto detected = scene.observed_by(camera, time_s, draw);
    marey::simulate::Random random(scene.options().seed * 1009 + static_cast<std::uint64_t>(camera));
    const cv::Size size = scene.options().image;
    const auto camera_there = scene.rig().cameras[static_cast<std::size_t>(camera)].camera();
    for (const Vector<3>& corner : behaviour.frame ? scene.options().ground_frame : std::vector<Vector<3>>()) {
      const auto pixel = camera_there->project(corner);
      if (pixel && cv::Rect2d({}, cv::Size2d(size)).contains({pixel->x(), pixel->y()}))
        detected.push_back({.pixel = *pixel, .marker = {}});
    }
    for (int i = 0; i < behaviour.lamps; ++i) {
      const double x = random.uniform(0.05, 0.95) * size.width, y = random.uniform(0.05, 0.95) * size.height;
      detected.push_back({.pixel = {x, y}, .marker = {}});
    }
    return detected;
  }
  cv::Mat drawn(int camera, double time_s, std::uint64_t draw) const {
    return draw_room(scene, static_cast<std::size_t>(camera), time_s, observed_by(camera, time_s, draw), draw);
  }
};

/// What a camera sees, drawn beforehand.
struct DrawnRoom {
  marey::simulate::room::RoomSpots spots;
  std::vector<marey::simulate::room::RoomSpots::Drawn> drawn;
  std::int64_t period = 0;  ///< frames there and back

  DrawnRoom(const SharedRoom& room, int camera);
  const marey::simulate::room::RoomSpots::Drawn& frame(std::int64_t number) const;
};

/// The frames of one direction, or of both where the camera's offset from the turns makes them differ.
DrawnRoom::DrawnRoom(const SharedRoom& room, int camera) : spots(room.scene, static_cast<std::size_t>(camera)) {
  const auto one_way = std::max<std::int64_t>(2, std::llround(room.behaviour.drawn_s * room.rate_hz()));
  const double offset = room.scene.rig().cameras[static_cast<std::size_t>(camera)].offset_s.value_or(0);
  period = 2 * one_way - 2;
  drawn.resize(static_cast<std::size_t>(offset == 0 ? one_way : period));
  const double length = static_cast<double>(one_way - 1) / room.rate_hz();
  tbb::parallel_for(std::size_t{0}, drawn.size(), [&](std::size_t i) {
    const double t = marey::simulate::room::to_and_fro(offset + static_cast<double>(i) / room.rate_hz(), length);
    drawn[i] = spots.draw(t, room.observed_by(camera, t, i), i);
  });
}

const marey::simulate::room::RoomSpots::Drawn& DrawnRoom::frame(std::int64_t number) const {
  const std::int64_t at = (number % period + period) % period;
  return drawn[static_cast<std::size_t>(at < std::ssize(drawn) ? at : period - at)];
}

/// One of its cameras. Frame n is exposed at offset + n / rate by the camera's own clock.
class RoomCamera final : public Connection {
 public:
  RoomCamera(std::shared_ptr<const SharedRoom> room, std::shared_ptr<const DrawnRoom> drawn, int camera, const std::string& name,
             Timestamp begin, source::LiveTime& time, std::stop_token stop)
      : room_(std::move(room)), drawn_(std::move(drawn)), camera_(camera), begin_(begin), time_(time), stop_(std::move(stop)) {
    info_.name = name;
    info_.size = room_->scene.options().image;
    info_.rate_hz = room_->rate_hz();
    marey::simulate::Random random(room_->scene.options().seed * 977 + static_cast<std::uint64_t>(camera));
    if (room_->behaviour.drift_ppm > 0) drift_ = 1e-6 * random.uniform(-room_->behaviour.drift_ppm, room_->behaviour.drift_ppm);
    exposure_ms_ = room_->behaviour.exposure_ms > 0 ? room_->behaviour.exposure_ms : room_->default_exposure_ms();
    gain_ = room_->behaviour.gain;
    offset_ = room_->scene.rig().cameras[static_cast<std::size_t>(camera)].offset_s.value_or(0);
    check_presence();
    const double since = seconds(time_.now() - begin_) - offset_;
    if (since > 0) next_ = static_cast<std::int64_t>(std::ceil(since * room_->rate_hz()));
  }

  const SourceInfo& info() const override { return info_; }

  std::vector<ControlRange> controls() override {
    if (room_->behaviour.blobs) return {};
    return {{Control::exposure, kMinExposure, room_->longest_exposure_ms(), exposure_ms_}, {Control::gain, 1, kMaxGain, gain_}};
  }
  void set(Control control, double value) override {
    for (const ControlRange& range : controls()) {
      if (range.control != control) continue;
      const char* unit = control == Control::exposure ? " ms" : "";
      if (!(value >= range.minimum && value <= range.maximum))
        throw Error("{}: does not take that {}; it must be {:g} to {:g}{}", info_.name, to_string(control), range.minimum,
                    range.maximum, unit);
      (control == Control::exposure ? exposure_ms_ : gain_) = value;
      return;
    }
    Connection::set(control, value);
  }

  Came next(Shot& shot) override {
    check_presence();
    if (!prepared_) prepared_ = drawn(next_);
    const double delay = room_->behaviour.jitter_ms > 0 ? 1e-3 * room_->behaviour.jitter_ms * delay_of(next_) : 0;
    const Timestamp due = begin_ + duration_from_seconds(exposed(next_) + delay);
    if (!source::live::wait_until_due(due, time_, stop_)) return Came::nothing;
    const double late = seconds(time_.now() - due) * room_->rate_hz();
    shot.given = std::move(*std::exchange(prepared_, std::nullopt));
    shot.sequence = next_;
    if (has_own_clock()) {
      shot.device_time = duration_from_seconds(1000.0 * camera_ + static_cast<double>(next_) / room_->rate_hz());
    } else {
      shot.taken = begin_ + duration_from_seconds(exposed(next_));
    }
    ++next_;
    if (late > source::live::kMaxBehind) next_ += static_cast<std::int64_t>(late);
    return Came::frame;
  }

 private:
  bool has_own_clock() const { return drift_ != 0 || room_->behaviour.jitter_ms > 0; }
  /// s since the room began, by the run's clock.
  double exposed(std::int64_t frame) const { return offset_ + static_cast<double>(frame) / room_->rate_hz() * (1 + drift_); }

  /// In units of the mean: exponential, as queues are.
  double delay_of(std::int64_t frame) const {
    marey::simulate::Random random(static_cast<std::uint64_t>(frame) * 64 + static_cast<std::uint64_t>(camera_) + 1);
    return -std::log(random.uniform(1e-6, 1));
  }

  void check_presence() const {
    const auto& away = room_->behaviour.away;
    if (away.empty() || camera_ + 1 != static_cast<int>(away[0])) return;
    const double now = seconds(time_.now() - begin_);
    if (now >= away[1] && now < away[2]) throw Error("{}: the simulated camera is away until {} s", info_.name, away[2]);
  }

  /// As bright as exposure and gain make it.
  Image exposed_image(const cv::Mat& drawn) const {
    const double times = exposure_ms_ / room_->default_exposure_ms() * gain_;
    if (times == 1) return Image(drawn);
    cv::Mat bright;
    drawn.convertTo(bright, -1, times);
    return Image(bright);
  }

  CameraFrame drawn(std::int64_t frame) const {
    CameraFrame given;
    if (drawn_ != nullptr) {
      given.frame.image = exposed_image(drawn_->spots.image(drawn_->frame(frame)));
      return given;
    }
    const double t = exposed(frame);
    const auto draw = static_cast<std::uint64_t>(frame);
    if (!room_->behaviour.blobs) {
      given.frame.image = exposed_image(room_->drawn(camera_, t, draw));
      return given;
    }
    const auto detected = room_->observed_by(camera_, t, draw);
    std::vector<Detection>& detections = given.detections.emplace();
    for (const marey::simulate::room::RoomBlob& blob : detected) {
      Detection& detection = detections.emplace_back();
      detection.centre = blob.pixel;
    }
    return given;
  }

  std::shared_ptr<const SharedRoom> room_;
  std::shared_ptr<const DrawnRoom> drawn_;
  int camera_;
  Timestamp begin_;
  source::LiveTime& time_;
  std::stop_token stop_;
  SourceInfo info_;
  double drift_ = 0, offset_ = 0;
  double exposure_ms_, gain_;
  std::int64_t next_ = 0;
  std::optional<CameraFrame> prepared_;
};

/// The rooms that are open, by their name without the camera's number.
class Rooms {
 public:
  std::shared_ptr<const SharedRoom> room(const Address& address, const RoomName& name) {
    auto options = address.options;
    options.erase("camera");
    std::string key;
    for (const auto& [option, value] : options) key += option + "=" + value + "&";
    const std::lock_guard lock(mutex_);
    std::weak_ptr<const SharedRoom>& known = rooms_[key];
    auto shared = known.lock();
    if (shared == nullptr) known = shared = std::make_shared<const SharedRoom>(name);
    return shared;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::weak_ptr<const SharedRoom>> rooms_;
};

/// Null where everything is drawn as it comes.
std::shared_ptr<const DrawnRoom> draw_beforehand(const SharedRoom& room, int camera) {
  if (room.behaviour.blobs || room.behaviour.drawn_s * room.rate_hz() < 0.5) return nullptr;
  return std::make_shared<DrawnRoom>(room, camera);
}

source::live::Connect open_room(Rooms& rooms, const Address& address, const Opening& opening) {
  const RoomName name(address);
  if (name.camera == 0 && name.room.cameras > 1)
    throw Error("{}: stands for {} cameras; add camera=1 to {} for one of them", address.text, name.room.cameras,
                name.room.cameras);
  const int camera = std::max(0, name.camera - 1);
  const auto room = rooms.room(address, name);
  return [=, text = address.text, begin = opening.begin, drawn = draw_beforehand(*room, camera)](
             source::LiveTime& time, const std::stop_token& stop) -> std::unique_ptr<Connection> {
    return std::make_unique<RoomCamera>(room, drawn, camera, text, begin(), time, stop);
  };
}

source::live::Connect open_people(const Address& address, const Opening& opening) {
  marey::simulate::people::PeopleVideoOptions video;
  std::string situation = "crowd";
  int seed = 1, people = 6, frames = 1500;
  AddressOptions options(address);
  options.size("size", video.size.width, video.size.height);
  options.number("rate", video.rate_hz, 1, 200);
  options.text("situation", situation);
  options.whole("people", people, 0, 100);
  options.whole("frames", frames, 2, 100'000);
  options.whole("seed", seed, 0, 1'000'000'000);
  options.done();
  video.people = people;
  video.frames = frames;
  std::optional<marey::simulate::people::PeopleSituation> chosen;
  std::vector<std::string_view> known;
  for (const auto& each : marey::simulate::people::people_situations()) {
    known.push_back(each.name);
    if (each.name == situation) chosen = each.situation;
  }
  if (!chosen)
    throw Error("{}: situation={} is not possible; it must be one of {}", address.text, situation, fmt::join(known, ", "));
  const auto made = std::make_shared<const marey::simulate::people::PeopleVideo>(*chosen, static_cast<std::uint64_t>(seed), video);
  return source::live::play([made] { return marey::simulate::people::make_source(made); }, {.begin = opening.begin, .loop = true});
}

/// A room's cameras are calibrated: the simulator knows where they are.
Rig cameras_in(const Address& address) {
  Rig rig;
  if (address.location != "room") {
    rig.cameras.emplace_back().name = "cam1";
    rig.cameras.back().source = address.text;
    return rig;
  }
  const RoomName name(address);
  rig = RoomScene(name.room).rig();
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const char* sign = address.options.empty() ? "?" : "&";
    rig.cameras[i].source = name.camera > 0 ? address.text : fmt::format("{}{}camera={}", address.text, sign, i + 1);
    rig.cameras[i].offset_s.reset();  // live, every frame says when it was taken
  }
  if (name.camera > 0) rig.cameras = {rig.cameras[static_cast<std::size_t>(name.camera - 1)]};
  return rig;
}

}  // namespace

Kind simulation_kind() {
  return {.schemes = {"sim"},
          .form = "sim://room?cameras=8&motion=walk&rate=120, sim://people",
          .meaning = "the simulator: a room full of calibrated cameras, or one camera before people",
          .open =
              [rooms = std::make_shared<Rooms>()](const Address& address, const Opening& opening) {
                if (address.location == "room") return open_room(*rooms, address, opening);
                if (address.location == "people") return open_people(address, opening);
                throw Error("{}: there is no simulation {}; there are: room, people", address.text, address.location);
              },
          .cameras = cameras_in};
}

}  // namespace marey::pipeline::simulate
