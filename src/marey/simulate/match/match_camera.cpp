#include "marey/simulate/match/match_camera.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace marey::simulate::match {

MatchScene::MatchScene(const MatchCamerasOptions& how, std::uint64_t its_seed)
    : options(how), seed(its_seed), rig(match_cameras(how, its_seed)), figures(match_figures(its_seed)) {
  if (rig.ground_from_world) world_from_pitch = rig.ground_from_world->inverse();
}

double MatchScene::match_time(double rig_time) const {
  return std::max(0.0, rig_time + options.offset_s);
}

MatchScene::Stances MatchScene::stances(std::span<const MatchPerson, kMatchPeople> people) const {
  Stances all;
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = match_stance(people[i], world_from_pitch);
  return all;
}

MatchCamera::MatchCamera(const MatchScene& scene, std::size_t index, const MatchDetectorOptions& detector,
                         const std::optional<MatchVideoOptions>& video)
    : scene_(scene),
      index_(index),
      rig_camera_(scene.rig.cameras[index]),
      view_(rig_camera_.ground_view(scene.rig.ground).value()),
      motion_(scene.seed, scene.options.pitch),
      detector_(detector),
      random_((scene.seed * 64 + index) * 2654435761u + 41) {
  if (detector.foot_error > 0) feet_.emplace(detector.foot_error, (scene.seed * 64 + index) * 2654435761u + 43);
  if (!video) return;
  video_.emplace(view_, scene.world_from_pitch, scene.options.pitch, *video, video_seed());
  has_ball_ = video->ball;
  exposure_s_ = video->exposure_s;
}

double MatchCamera::time() const {
  return static_cast<double>(frame_) / *rig_camera_.rate_hz;
}

void MatchCamera::advance() {
  if (feet_ && frame_ >= 0) feet_->advance(1 / *rig_camera_.rate_hz);
  ++frame_;
  match_time_ = scene_.match_time(time() + rig_camera_.offset_s.value_or(0));
  motion_.advance(match_time_);
  stances_ = scene_.stances(motion_.people());
  detected_ = people_in_view(view_, scene_.figures, stances_);
}

std::vector<LabelledBox> MatchCamera::detect() {
  std::vector<ObservedPerson> moved = detected_;
  for (ObservedPerson& person : moved) {
    if (!feet_) break;
    const Vector<2>& location = stances_[static_cast<std::size_t>(person.person)].location;
    const Vector<2> along = (location - view_.camera()->centre().head<2>()).normalized(), across(-along.y(), along.x());
    const Vector<2> error = feet_->of(person.person);
    const double fraction = detector_.foot_along;
    person = with_foot_moved(person, view_, location,
                             std::sqrt(2 * fraction) * error.x() * along + std::sqrt(2 * (1 - fraction)) * error.y() * across);
  }
  return detect_match(moved, view_, scene_.world_from_pitch, scene_.options.pitch, static_cast<std::int32_t>(frame_), detector_,
                      random_);
}

Image MatchCamera::image() const {
  return video_ ? video_->render(scene_.figures, stances_, match_time_, frame_) : Image();
}

MatchCamera::Shot MatchCamera::shoot() const {
  if (!video_) return {};
  std::vector<people::PosedBall> balls;
  const BallPosition ball = motion_.ball_position();
  if (has_ball_ && ball.there) {
    const auto in_world = [&](const Vector<3>& at) -> Vector<3> {
      const Vector<3> ground = scene_.world_from_pitch * Vector<3>(at.x(), at.y(), 1);
      return {ground.x(), ground.y(), at.z()};
    };
    const Vector<3> half = 0.5 * exposure_s_ * ball.velocity;
    balls.push_back({in_world(ball.location - half), in_world(ball.location + half), kBallRadius});
  }
  people::RenderedFrame frame = video_->render_with(scene_.figures, stances_, balls, match_time_, frame_);
  Shot shot{std::move(frame.image), {}};
  if (!frame.balls.empty()) shot.ball = frame.balls.front();
  return shot;
}

std::vector<MatchClick> MatchCamera::clicks(double noise, int wrong) const {
  return match_clicks(view_, scene_.world_from_pitch, scene_.options.pitch, noise, wrong, video_seed());
}

MatchTruth::MatchTruth(const MatchScene& scene) : scene_(scene), motion_(scene.seed, scene.options.pitch) {
  for (const RigCamera& camera : scene.rig.cameras) views_.push_back(*camera.ground_view(scene.rig.ground));
  for (int i = 0; i < kMatchPeople; ++i) people_.push_back({TrackId{i + 1}, match_label(i), std::string(match_team(i))});
}

Instant MatchTruth::next(std::span<const MatchCamera> cameras) {
  const double time = static_cast<double>(frame_) / scene_.options.rate_hz;
  motion_.advance(scene_.match_time(time));
  const auto stances = scene_.stances(motion_.people());
  std::array<CameraMask, kMatchPeople> observed_by{};
  for (std::size_t i = 0; i < views_.size(); ++i) {
    std::vector<ObservedPerson> own;
    const bool in_step = scene_.rig.cameras[i].offset_s.value_or(0) == 0;
    if (!in_step) own = people_in_view(views_[i], scene_.figures, stances);
    for (const ObservedPerson& person : in_step ? cameras[i].detected() : std::span<const ObservedPerson>(own)) {
      if (person.visible_fraction >= kHiddenFraction) observed_by[static_cast<std::size_t>(person.person)] |= CameraMask{1} << i;
    }
  }
  Instant instant;
  instant.index = frame_;
  instant.time = timestamp_from_seconds(time);
  if (frame_ == 0) instant.named = people_;
  for (std::size_t i = 0; i < people_.size(); ++i) {
    const MatchPerson& person = motion_.people()[i];
    Sample& sample = instant.samples.emplace_back();
    sample.track = people_[i].id;
    sample.position.head<2>() = person.location;
    sample.velocity.emplace(Vector<3>::Zero()).head<2>() = person.velocity;
    sample.cameras = observed_by[i];
  }
  ++frame_;
  return instant;
}

BallPosition BallTruth::next() {
  motion_.advance(scene_.match_time(static_cast<double>(frame_++) / scene_.options.rate_hz));
  return motion_.ball_position();
}

}  // namespace marey::simulate::match
