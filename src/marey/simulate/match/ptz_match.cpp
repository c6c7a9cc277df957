#include "marey/simulate/match/ptz_match.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"
#include "marey/simulate/match/goal_posts.h"
#include "marey/simulate/value_noise.h"

namespace marey::simulate::match {
namespace {

/// Where main cameras stand, as in the images of televised matches: a little different for each seed.
geometry::Tripod drawn_tripod(const geometry::PitchSize& pitch, Random& random) {
  geometry::Tripod tripod;
  tripod.location = {pitch.length / 2 + random.uniform(-4, 4), random.uniform(-32, -18), random.uniform(9, 18)};
  tripod.lean = {random.gaussian(0, 0.006), random.gaussian(0, 0.006)};
  tripod.roll = random.gaussian(0, 0.005);
  tripod.ahead = random.uniform(0.05, 0.35);
  tripod.bend = random.uniform(-0.02, 0.045);
  return tripod;
}

/// The other camera: behind the goal, close to the ground, zoomed in.
const geometry::Tripod kOtherTripod{{70, -4, 2.2}, {}, 0, 0, 0};
const geometry::Heading kOtherHeading{0.9, 0.02, 1.9};

}  // namespace

PtzMatch::PtzMatch(const PtzMatchOptions& options, std::uint64_t seed)
    : options_(options),
      seed_(seed),
      random_(seed * 2654435761u + 91),
      detections_(seed * 2654435761u + 92),
      tripod_(drawn_tripod(options.pitch, random_)),
      ground_(options.pitch, seed, options.paint),
      motion_(seed, options.pitch),
      operator_(tripod_, options.pitch, options.operates, seed),
      figures_(match_figures(seed)) {
  if (options.size.width < 64 || options.size.height < 64)
    throw Error("images of {} x {} pixels; 64 x 64 is the least", options.size.width, options.size.height);
  if (!(options.rate_hz > 0)) throw Error("a rate of {} frames a second; it must be positive", options.rate_hz);
}

Camera PtzMatch::camera_now(const geometry::Heading& heading) const {
  geometry::Tripod breathing = tripod_;
  breathing.bend += options_.lens_breathes * (heading.log_focal - 1.2);
  return geometry::camera_of(breathing, heading, options_.size);
}

std::optional<geometry::Heading> PtzMatch::heading() const {
  if (std::any_of(options_.cuts.begin(), options_.cuts.end(), [&](const VideoSpan& cut) { return cut.holds(time()); }))
    return std::nullopt;
  return options_.screen > 0 ? on_screen(now_) : now_;
}

void PtzMatch::advance() {
  ++frame_;
  motion_.advance(time());
  before_ = now_;
  now_ = operator_.track_ball(motion_.ball(), 1 / options_.rate_hz);
  if (frame_ == 0) before_ = now_;
  const Camera other = geometry::camera_of(kOtherTripod, kOtherHeading, options_.size);
  camera_.emplace(heading() ? camera_now(*heading()) : other);
  drawn_.emplace(heading() ? camera_now(now_) : other);
  for (std::size_t i = 0; i < stances_.size(); ++i) stances_[i] = match_stance(motion_.people()[i], Matrix<3>::Identity());
  detected_ = people_in_view(GroundView(*camera_), figures_, stances_);
}

namespace {

/// What a hand does to the image of a screen: moved by px at 1280, rolled, enlarged.
struct Hand {
  double x = 0, y = 0, roll = 0, scale = 1;
};

Hand hand_at(double time, double shake, std::uint64_t seed) {
  const auto slow = [&](double rate, int which) { return value_noise({rate * time, 7.3 * which}, seed + 400); };
  return {1.7 * shake * (slow(1.1, 0) + 0.3 * slow(4, 1)), 1.7 * shake * (slow(1.1, 2) + 0.3 * slow(4, 3)), 0.002 * slow(0.7, 4),
          1.03 + 0.004 * slow(0.4, 5)};
}

}  // namespace

geometry::Heading PtzMatch::on_screen(const geometry::Heading& heading) const {
  const Hand hand = hand_at(time(), options_.screen, seed_);
  const double px = 640 * std::exp(heading.log_focal);
  return {heading.pan - hand.x / px / std::cos(heading.tilt), heading.tilt - hand.y / px, heading.log_focal + std::log(hand.scale)};
}

/// Off a screen: shaken, a little askew, its rows of pixels against the camera's.
cv::Mat PtzMatch::off_screen(const cv::Mat& shown) const {
  const Hand hand = hand_at(time(), options_.screen, seed_);
  const double unit = shown.cols / 1280.0, cosine = hand.scale * std::cos(hand.roll), sine = hand.scale * std::sin(hand.roll);
  const Vector<2> middle((shown.cols - 1) / 2.0, (shown.rows - 1) / 2.0);
  constexpr double kAskew = 3e-6;                                                                      // per px of the image
  cv::Matx33d to(cosine, -sine, middle.x() - cosine * middle.x() + sine * middle.y() + unit * hand.x,  //
                 sine, cosine, middle.y() - sine * middle.x() - cosine * middle.y() + unit * hand.y,   //
                 kAskew, 0, 1 - kAskew * middle.x());
  cv::Mat result;
  cv::warpPerspective(shown, result, to, shown.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  for (int y = 0; y < result.rows; ++y) {
    auto* row = result.ptr<cv::Vec3b>(y);
    for (int x = 0; x < result.cols; ++x) {
      const double moire = 1 + 0.03 * std::sin(0.061 * x + 0.013 * y + 2 * time()) * std::sin(0.047 * y - 0.009 * x);
      for (int i = 0; i < 3; ++i) row[x][i] = cv::saturate_cast<std::uint8_t>(moire * row[x][i] + 6);
    }
  }
  return result;
}

/// Every frame is smeared by the motion of its middle while it is exposed.
cv::Mat PtzMatch::blurred(const cv::Mat& sharp) const {
  if (!heading() || options_.exposure <= 0) return sharp;
  const double px = std::exp(now_.log_focal) * options_.size.width / 2 * options_.exposure * options_.rate_hz;
  const Vector<2> shift(px * (now_.pan - before_.pan) * std::cos(now_.tilt), px * (now_.tilt - before_.tilt));
  const double length = shift.norm();
  if (length < 0.3) return sharp;
  constexpr int kOften = 33;
  const int half = static_cast<int>(std::ceil(length / 2)) + 1;
  cv::Mat kernel(2 * half + 1, 2 * half + 1, CV_32F, cv::Scalar(0)), result;
  for (int i = 0; i < kOften; ++i) {
    const Vector<2> at = Vector<2>(half, half) + ((i + 0.5) / kOften - 0.5) * shift;
    const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y()));
    const auto a = static_cast<float>(at.x() - x), b = static_cast<float>(at.y() - y);
    kernel.at<float>(y, x) += (1 - a) * (1 - b) / kOften;
    kernel.at<float>(y, x + 1) += a * (1 - b) / kOften;
    kernel.at<float>(y + 1, x) += (1 - a) * b / kOften;
    kernel.at<float>(y + 1, x + 1) += a * b / kOften;
  }
  cv::filter2D(sharp, result, -1, kernel, {-1, -1}, 0, cv::BORDER_REPLICATE);
  return result;
}

void PtzMatch::add_graphics(cv::Mat& image) const {
  const double unit = image.cols / 1280.0;
  const auto rect = [&](double x, double y, double width, double height) {
    return cv::Rect(cvRound(x * unit), cvRound(y * unit), cvRound(width * unit), cvRound(height * unit));
  };
  if (options_.scoreboard && heading()) {
    image(rect(60, 40, 250, 44)) = cv::Scalar(60, 30, 20);
    cv::putText(image, "WHI 1 - 0 BLU", {cvRound(72 * unit), cvRound(70 * unit)}, cv::FONT_HERSHEY_SIMPLEX, 0.8 * unit,
                {240, 240, 240}, 2, cv::LINE_AA);
  }
  for (const VideoSpan& span : options_.graphics) {
    if (!span.holds(time())) continue;
    image(rect(0, 360, 1280, 360)) = cv::Scalar(90, 40, 30);
    for (int row = 0; row < 6; ++row) {
      image(rect(80, 400 + 50 * row, 1120, 4)) = cv::Scalar(230, 230, 230);
      cv::putText(image, "HOME SIDE   7   AWAY SIDE", {cvRound(300 * unit), cvRound((436 + 50 * row) * unit)},
                  cv::FONT_HERSHEY_SIMPLEX, unit, {235, 235, 235}, 2, cv::LINE_AA);
    }
  }
}

Image PtzMatch::image() const {
  people::RenderOptions render;
  render.samples = 2;
  render.sun = {0.45, 0.3, 1.0};
  render.shadow_level = 0.7;
  render.noise = 0;
  cv::Mat scene = ground_.draw(*drawn_);
  if (options_.people) {
    const GroundView view(*drawn_);
    const auto in_reach = [&](const Vector<3>& point) -> std::optional<people::Sighting> {
      const auto detected = sight(view, point);
      const double reach = drawn_->size().width;
      if (!detected || std::abs(detected->at.x()) > 2 * reach || std::abs(detected->at.y()) > 2 * reach || detected->scale > reach)
        return std::nullopt;
      return detected;
    };
    const people::PeopleRenderer renderer(Image::from_bgr(scene), in_reach, goal_posts(Matrix<3>::Identity(), options_.pitch),
                                          render);
    std::vector<people::PosedFigure> posed;
    for (std::size_t i = 0; i < figures_.size(); ++i) posed.push_back({static_cast<int>(i) + 1, &figures_[i], stances_[i]});
    scene = renderer.render(posed, {}).image.bgr();
  }
  scene = blurred(scene);
  add_graphics(scene);
  if (options_.screen > 0 && heading()) scene = off_screen(scene);
  const Image clean = Image::from_bgr(scene);
  cv::Mat luma = clean.luma().clone(), cb = clean.cb().clone(), cr = clean.cr().clone();
  people::apply(options_.degradation, luma, cb, cr);
  cv::RNG noise(seed_ * 1'000'003 + static_cast<std::uint64_t>(frame_));
  cv::Mat grain(luma.size(), CV_16S);
  noise.fill(grain, cv::RNG::NORMAL, 0, options_.noise);
  cv::add(luma, grain, luma, cv::noArray(), CV_8U);
  return Image(luma, cb, cr, clean.range());
}

std::vector<LabelledBox> PtzMatch::detect(const MatchDetectorOptions& detector) {
  return detect_match(detected_, GroundView(*camera_), Matrix<3>::Identity(), options_.pitch, static_cast<std::int32_t>(frame_),
                      detector, detections_);
}

std::vector<MatchClick> PtzMatch::clicks(double noise) const {
  return match_clicks(GroundView(*camera_), Matrix<3>::Identity(), options_.pitch, noise, 0,
                      seed_ * 1009 + static_cast<std::uint64_t>(frame_));
}

}  // namespace marey::simulate::match
