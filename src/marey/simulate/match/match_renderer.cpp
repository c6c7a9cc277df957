#include "marey/simulate/match/match_renderer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <variant>

#include <Eigen/Geometry>

#include "marey/simulate/match/goal_posts.h"
#include "marey/simulate/match/match_ground.h"

namespace marey::simulate::match {
namespace {

constexpr double kShakenExposure = 0.01;  // s

/// What a shaking camera may see beside its image, px: an even number.
int match_margin(double shake_px) {
  return shake_px > 0 ? 8 + 2 * static_cast<int>(std::ceil(3 * shake_px)) : 0;
}

/// The same camera with `margin` px more on each side.
GroundView wider(const GroundView& view, int margin) {
  if (margin == 0) return view;
  const Camera& camera = *view.camera();
  geometry::Lens lens = camera.lens();
  std::visit([&](auto& model) { model.principal += Vector<2>(margin, margin); }, lens);
  return GroundView(Camera(lens, camera.camera_from_world(), camera.size() + cv::Size(2 * margin, 2 * margin)), view.surface());
}

double focal_of(const Camera& camera) {
  return std::visit([](const auto& model) { return model.focal.x(); }, camera.lens());
}

/// Where a pixel of the camera, turned by `turn`, lies in its image at rest: through the lens as it is.
people::PixelMap at_rest(const Camera& camera, const Vector<3>& turn) {
  const Camera alone(camera.lens(), Rigid3{}, camera.size());
  const Matrix<3> back = Eigen::AngleAxisd(-turn.norm(), turn.stableNormalized()).toRotationMatrix();
  return [alone, back](const Vector<2>& pixel) -> Vector<2> {
    const auto ray = alone.bearing(pixel);
    const auto detected = ray ? alone.project(back * *ray) : std::nullopt;
    return detected.value_or(pixel);
  };
}

people::PeopleRenderer renderer_of(const GroundView& at_camera, const Matrix<3>& world_from_pitch, const geometry::PitchSize& pitch,
                                   const MatchVideoOptions& options, std::uint64_t seed) {
  people::RenderOptions render;
  render.margin = match_margin(options.shake_px);
  const GroundView view = wider(at_camera, render.margin);
  render.samples = 3;
  render.shadows = options.shadows;
  render.sun = {0.45, 0.3, 1.0};
  render.shadow_level = options.shadow_level;
  render.noise = options.noise;
  render.contact = options.contact;
  render.degradation = options.degradation;
  const Image ground = draw_match_ground(view, world_from_pitch.inverse(), pitch, seed);
  // Far outside the image nothing needs to be drawn, however large a lens would make it.
  const auto in_reach = [view](const Vector<3>& point) -> std::optional<people::Sighting> {
    const auto detected = sight(view, point);
    const double reach = view.size().width;
    if (!detected || std::abs(detected->at.x()) > 2 * reach || std::abs(detected->at.y()) > 2 * reach || detected->scale > reach)
      return std::nullopt;
    return detected;
  };
  return {ground, in_reach, goal_posts(world_from_pitch, pitch), render};
}

/// Corners, crossings of lines, marks: one half of the pitch, mirrored to the other.
std::vector<Vector<2>> known_positions(const geometry::PitchSize& pitch) {
  const double middle = pitch.width / 2, half = pitch.length / 2;
  std::vector<Vector<2>> locations{{half, 0}, {half, middle - 9.15}, {half, middle}, {half, middle + 9.15}, {half, pitch.width}};
  for (const bool other : {false, true}) {
    const auto add = [&](double x, double y) { locations.emplace_back(other ? pitch.length - x : x, y); };
    for (const double side : {-1.0, 1.0}) {
      add(0, middle + side * middle);
      add(0, middle + side * 20.16);
      add(16.5, middle + side * 20.16);
      add(0, middle + side * 9.16);
      add(5.5, middle + side * 9.16);
      add(16.5, middle + side * 7.312);  // where the arc leaves the penalty area
    }
  }
  return locations;
}

}  // namespace

MatchRenderer::MatchRenderer(const GroundView& view, const Matrix<3>& world_from_pitch, const geometry::PitchSize& pitch,
                             const MatchVideoOptions& options, std::uint64_t seed)
    : options_(options),
      seed_(seed),
      camera_(*view.camera()),
      renderer_(renderer_of(view, world_from_pitch, pitch, options, seed)) {
  const cv::Size size = view.size();
  if (options.shake_px > 0) shake_.emplace(options.shake_px, focal_of(camera_), std::hypot(size.width, size.height) / 2, seed);
}

Image MatchRenderer::render(std::span<const people::Figure, kMatchPeople> figures,
                            std::span<const people::Stance, kMatchPeople> stances, double time, std::int64_t index) const {
  return render_with(figures, stances, {}, time, index).image;
}

people::RenderedFrame MatchRenderer::render_with(std::span<const people::Figure, kMatchPeople> figures,
                                                 std::span<const people::Stance, kMatchPeople> stances,
                                                 std::span<const people::PosedBall> balls, double time, std::int64_t index) const {
  std::vector<people::PosedFigure> people;
  for (std::size_t i = 0; i < figures.size(); ++i) people.push_back({static_cast<int>(i) + 1, &figures[i], stances[i]});
  const double begin = static_cast<double>(seed_ % 97);
  const double swing =
      0.6 * std::sin(begin + 2 * std::numbers::pi * time / 71) + 0.4 * std::sin(2 * begin + 2 * std::numbers::pi * time / 29);
  people::FrameConditions conditions;
  conditions.light = 1 + options_.light_change * (swing - 1) / 2;
  conditions.seed = seed_ * 1'000'003 + static_cast<std::uint64_t>(index);
  if (shake_) {
    constexpr int kMoments = 3;
    for (int i = 0; i < kMoments; ++i)
      conditions.time_steps.push_back(at_rest(camera_, shake_->turn(time + kShakenExposure * ((i + 0.5) / kMoments - 0.5))));
  }
  return renderer_.render(people, conditions, balls);
}

std::vector<MatchClick> match_clicks(const GroundView& view, const Matrix<3>& world_from_pitch, const geometry::PitchSize& pitch,
                                     double noise, int wrong, std::uint64_t seed) {
  constexpr double kSlip = 40;  // px
  Random random(seed * 2654435761u + 51);
  std::vector<MatchClick> clicks;
  for (const Vector<2>& location : known_positions(pitch)) {
    const Vector<2> at = in_world(world_from_pitch, location);
    const auto pixel = view.pixel(at);
    const Vector<2> slip = random.gaussian_pair(noise);
    if (!pixel || !view.camera()->in_image(*pixel)) continue;
    if (view.camera()->in_image(*pixel + slip)) clicks.push_back({location, *pixel + slip});  // clicks are within the image
  }
  const int count = std::min(wrong, static_cast<int>(clicks.size()) / 2);
  for (int i = 0; i < count; ++i) {  // in turn put elsewhere and named as its neighbour
    MatchClick& click = clicks[static_cast<std::size_t>(2 * i)];
    if (i % 2 == 0)
      click.pixel += kSlip * random.gaussian_pair();
    else
      click.ground = clicks[static_cast<std::size_t>(2 * i + 1)].ground;
  }
  return clicks;
}

}  // namespace marey::simulate::match
