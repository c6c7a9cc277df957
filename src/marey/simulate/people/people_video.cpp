#include "marey/simulate/people/people_video.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"
#include "marey/simulate/people/people_motion.h"

namespace marey::simulate::people {
namespace {

constexpr std::array<NamedPeopleSituation, 9> kSituations{{{"apart", PeopleSituation::apart},
                                                           {"crossing", PeopleSituation::crossing},
                                                           {"post", PeopleSituation::post},
                                                           {"abrupt", PeopleSituation::abrupt},
                                                           {"border", PeopleSituation::border},
                                                           {"overlap", PeopleSituation::overlap},
                                                           {"crowd", PeopleSituation::crowd},
                                                           {"standing", PeopleSituation::standing},
                                                           {"returns", PeopleSituation::returns}}};

constexpr double kStature = 1.78;  // m
constexpr double kLens = 3.0;      // focal length in widths of the image: as from a stand

void check(const PeopleVideoOptions& options) {
  if (options.size.width < 32 || options.size.height < 32) throw Error("a video of people needs images of at least 32 × 32 pixels");
  if (!(options.rate_hz > 0)) throw Error("a video's rate is {} frames a second; it must be positive", options.rate_hz);
  if (!(options.height_px >= 4) || options.height_px > options.size.height)
    throw Error("people {} px tall do not fit an image {} px high; 4 px is the least", options.height_px, options.size.height);
  if (options.samples < 1 || options.samples > 16)
    throw Error("{} points per pixel and axis; 1 to 16 are possible", options.samples);
  if (options.frames && *options.frames < 1) throw Error("a video of {} frames; it needs one at least", *options.frames);
  if (options.min_hidden_s && !(*options.min_hidden_s > 0 && *options.min_hidden_s <= options.hidden_s))
    throw Error("people hidden for {} to {} s; the shortest time must be positive and not above the longest", *options.min_hidden_s,
                options.hidden_s);
  if (options.people && *options.people < 0) throw Error("{} people; the number cannot be negative", *options.people);
}

LevelCamera camera_for(const PeopleVideoOptions& options) {
  LevelCamera camera;
  camera.size = options.size;
  camera.focal = kLens * options.size.width;
  camera.distance = camera.focal * kStature * std::cos(camera.pitch) / options.height_px;
  return camera;
}

/// The factor on every level: steady; slowly up and down by a third; or by a cloud, from one frame to the next.
std::vector<double> lights(LightChange change, int frames, Random& random) {
  std::vector<double> values(static_cast<std::size_t>(frames), 1.0);
  const double begin = random.uniform(0, 2 * std::numbers::pi);
  const int first = frames * 2 / 5 + random.integer(0, std::max(1, frames / 10));
  const int second = frames * 7 / 10 + random.integer(0, std::max(1, frames / 10));
  const double cloud = random.uniform(0.6, 0.75);
  for (int i = 0; i < frames; ++i) {
    double& value = values[static_cast<std::size_t>(i)];
    if (change == LightChange::gradual) value = 0.85 + 0.2 * std::sin(begin + 2 * std::numbers::pi * i / std::max(200, frames));
    if (change == LightChange::sudden && i >= first && i < second) value = cloud;
  }
  return values;
}

std::vector<PosedFigure> posed(const std::vector<PeopleMotion::Located>& located, const std::vector<Figure>& figures) {
  std::vector<PosedFigure> people;
  for (const auto& one : located) people.push_back({one.id, &figures[static_cast<std::size_t>(one.id - 1)], one.stance});
  return people;
}

Image scaled(const Image& image, cv::Size size) {
  if (image.size() == size) return image;
  cv::Mat bgr;
  cv::resize(image.bgr(), bgr, size, 0, 0, cv::INTER_AREA);
  return Image::from_bgr(bgr);
}

/// What a shaking camera may see beside its image, px: an even number.
int margin_for(double shake_px) {
  return 8 + 2 * static_cast<int>(std::ceil(3 * shake_px));
}

/// The image continues as in a mirror.
Image widened(const Image& image, int margin) {
  if (margin == 0) return image;
  cv::Mat bgr;
  cv::copyMakeBorder(image.bgr(), bgr, margin, margin, margin, margin, cv::BORDER_REFLECT_101);
  return Image::from_bgr(bgr);
}

/// The camera's aim while the shutter of frame `index` is open: as many instants as make a blur of it.
std::vector<PixelMap> time_steps_of(const CameraShake& shake, const LevelCamera& camera, const PeopleVideoOptions& options,
                                    int index) {
  const double time = index / options.rate_hz, half = PeopleVideo::kExposure / 2;
  const double smear = camera.focal * (shake.turn(time + half) - shake.turn(time - half)).head<2>().norm();
  const int count = std::clamp(static_cast<int>(std::ceil(smear)), 1, 6);
  const Vector<2> middle((camera.size.width - 1) / 2.0, (camera.size.height - 1) / 2.0);
  std::vector<PixelMap> time_steps;
  for (int i = 0; i < count; ++i) {
    const double at = time + half * ((2 * i + 1.0) / count - 1);
    time_steps.push_back(rotated_pixels(-shake.turn(at), camera.focal, middle));
  }
  return time_steps;
}

class RenderedSource final : public Source {
 public:
  explicit RenderedSource(std::shared_ptr<const PeopleVideo> video) : video_(std::move(video)) {
    info_.name = "simulated people";
    info_.size = video_->options().size;
    info_.rate_hz = video_->options().rate_hz;
    info_.frame_count = video_->frames();
  }

  const SourceInfo& info() const override { return info_; }

  std::optional<Frame> next() override {
    if (next_ >= video_->frames()) return std::nullopt;
    Frame frame;
    frame.index = next_;
    frame.time = timestamp_from_seconds(next_ / video_->options().rate_hz);
    frame.image = video_->render(next_++).image;
    return frame;
  }

 private:
  std::shared_ptr<const PeopleVideo> video_;
  SourceInfo info_;
  int next_ = 0;
};

}  // namespace

std::span<const NamedPeopleSituation> people_situations() {
  return kSituations;
}

PeopleVideo::PeopleVideo(PeopleSituation situation, std::uint64_t seed, const PeopleVideoOptions& options)
    : situation_(situation), options_(options) {
  check(options_);
  const bool few =
      situation == PeopleSituation::crossing || situation == PeopleSituation::post || situation == PeopleSituation::overlap;
  if (!options_.frames) options_.frames = situation == PeopleSituation::crossing ? 100 : 200;
  if (!options_.people) options_.people = few ? 2 : 6;
  camera_ = camera_for(options_);
  Random random(seed);
  PeopleMotion motion = move_people(situation, camera_, options_, random);
  figures_ = std::move(motion.figures);
  if (options_.own_clothes) dress_all(figures_, seed);
  for (const auto& frame : motion.frames) people_.push_back(posed(frame, figures_));
  const std::vector<double> light = lights(options_.light, *options_.frames, random);
  for (std::size_t i = 0; i < people_.size(); ++i) {
    FrameConditions& now = conditions_.emplace_back();
    now.light = light[i];
    now.seed = seed * 1'000'003 + i;
  }
  PeopleVideoOptions before = options_;
  before.people = 6;
  const int second = std::max(1, static_cast<int>(std::lround(options_.rate_hz)));
  before.frames = kEarlier * second;
  PeopleMotion earlier = move_people(PeopleSituation::apart, camera_, before, random);
  earlier_figures_ = std::move(earlier.figures);
  for (int i = 0; i < kEarlier; ++i) {
    earlier_.push_back(posed(earlier.frames[static_cast<std::size_t>(i) * static_cast<std::size_t>(second)], earlier_figures_));
  }
  RenderOptions render;
  render.samples = options_.samples;
  render.shadows = options_.shadows;
  render.noise = options_.noise;
  render.degradation = options_.degradation;
  LevelCamera detected = camera_;
  if (options_.shake_px > 0) {
    shake_.emplace(options_.shake_px, camera_.focal, std::hypot(camera_.size.width, camera_.size.height) / 2, seed);
    for (int i = 0; i < frames(); ++i)
      conditions_[static_cast<std::size_t>(i)].time_steps = time_steps_of(*shake_, camera_, options_, i);
    render.margin = margin_for(options_.shake_px);
    detected.size += cv::Size(2 * render.margin, 2 * render.margin);
  }
  const Image ground =
      options_.ground.empty() ? draw_lawn(detected, 1) : widened(scaled(options_.ground, options_.size), render.margin);
  renderer_ = std::make_unique<PeopleRenderer>(ground, detected, std::move(motion.posts), render);
}

int PeopleVideo::max_at_a_time() const {
  std::size_t maximum = 0;
  for (const auto& frame : people_) maximum = std::max(maximum, frame.size());
  return static_cast<int>(maximum);
}

Vector<3> PeopleVideo::turn(int index) const {
  return shake_ ? shake_->turn(index / options_.rate_hz) : Vector<3>::Zero().eval();
}

RenderedFrame PeopleVideo::render(int index) const {
  const auto i = static_cast<std::size_t>(index);
  return renderer_->render(people_[i], conditions_[i]);
}

Image PeopleVideo::render_earlier(int index) const {
  FrameConditions conditions = conditions_[static_cast<std::size_t>(index * frames() / kEarlier)];
  conditions.seed = ~conditions.seed;  // other noise than that of the frame itself
  return renderer_->render(earlier_[static_cast<std::size_t>(index)], conditions).image;
}

std::unique_ptr<Source> make_source(std::shared_ptr<const PeopleVideo> video) {
  return std::make_unique<RenderedSource>(std::move(video));
}

}  // namespace marey::simulate::people
