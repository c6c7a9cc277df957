// Every thing that stands is drawn once, alone, onto a lattice of points finer than the pixels: its silhouette, exact to a lattice
// step, whose points also say which part and shade they show. From the farthest to the nearest, each is laid over the ground with
// the share of a pixel's points that it covers; what is visible of it is its silhouette less those of whatever stands nearer.
// Balls, those of limbs and those that are played with, are seen as discs, which holds to the square of their angular size. Shadows
// lie on the ground only, and two do not darken more than one. Everything is done in the planes that video is made of. Cost: a copy
// of the ground, the noise, and the lattice points of the figures.
#include "marey/simulate/people/people_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "marey/simulate/people/contact_shadow.h"
#include "marey/simulate/people/sprites.h"

namespace marey::simulate::people {
namespace {

constexpr int kShades = 16;
constexpr int kShadowSamples = 2;
constexpr int kRimPoints = 10;  // of the polygon that stands for a ball's shadow

/// How bright a rounded shape is across its width, light from the left or the right.
double shading(int shade, double side) {
  const double t = 2 * (shade + 0.5) / kShades - 1;
  return 0.78 + 0.2 * std::sqrt(1 - t * t) + 0.13 * side * t;
}

/// How far what has this colour lies before the limb that it is on, m: rods that share an axis have one depth. By FigurePart.
constexpr std::array<double, kFigureParts> kCover{0, 0, 0.1, 0.08, 0.05, 0.02};

/// Each level becomes zero + factor (level − zero).
void scale_levels(cv::Mat& plane, double factor, double zero) {
  cv::Mat table(1, 256, CV_8UC1);
  for (int i = 0; i < 256; ++i) table.at<std::uint8_t>(i) = clamp_level(static_cast<float>(zero + factor * (i - zero)));
  cv::LUT(plane, table, plane);
}

/// Points on the rim of a ball's shadow on the ground, as seen.
void add_shadow_rim(std::vector<cv::Point2f>& rim, const Projection& projection, const Vector<3>& centre, double radius,
                    const Vector<3>& sun, const Vector<2>& shift) {
  const Vector<2> away = -sun.head<2>() / sun.z();
  const double segment = std::sqrt(1 + away.squaredNorm());
  const Vector<2> along = away.norm() > 0 ? Vector<2>(away.normalized()) : Vector<2>(1, 0);
  const Vector<2> across(-along.y(), along.x());
  const Vector<2> middle = centre.head<2>() + centre.z() * away;
  for (int i = 0; i < kRimPoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / kRimPoints;
    const Vector<2> at = middle + radius * (std::cos(angle) * segment * along + std::sin(angle) * across);
    if (const auto detected = projection({at.x(), at.y(), 0})) {
      rim.emplace_back(static_cast<float>(detected->at.x() + shift.x()), static_cast<float>(detected->at.y() + shift.y()));
    }
  }
}

std::vector<Vector<2>> hull_of(const std::vector<cv::Point2f>& points) {
  std::vector<cv::Point2f> corners;
  if (points.size() > 2) cv::convexHull(points, corners);
  std::vector<Vector<2>> polygon;
  for (const cv::Point2f& corner : corners) polygon.emplace_back(corner.x, corner.y);
  return polygon;
}

bool meets(const Silhouette& silhouette, cv::Size image) {
  return !silhouette.empty() && !(silhouette.pixels() & cv::Rect({0, 0}, image)).empty();
}

/// How many points of each pixel lie in a shadow: the most of all shadows counted.
void count_points(const Silhouette& shadow, const cv::Rect& where, cv::Mat& fraction) {
  for (int y = where.y; y < where.br().y; ++y) {
    for (int x = where.x; x < where.br().x; ++x) {
      int points = 0;
      for (int row = 0; row < shadow.samples; ++row) {
        const auto* point =
            shadow.mask.ptr<std::uint8_t>(y * shadow.samples + row - shadow.lattice.y) + x * shadow.samples - shadow.lattice.x;
        for (int column = 0; column < shadow.samples; ++column) points += point[column] != 0 ? 1 : 0;
      }
      auto& cell = fraction.at<std::uint8_t>(y, x);
      cell = std::max(cell, static_cast<std::uint8_t>(points));
    }
  }
}

/// The same of the blocks of 2 × 2 pixels that `where` touches.
void add_up_blocks(const cv::Mat& fraction, const cv::Rect& where, cv::Mat& chroma_share) {
  const cv::Rect blocks = half_of(where);
  for (int y = blocks.y; y < blocks.br().y; ++y) {
    for (int x = blocks.x; x < blocks.br().x; ++x) {
      const cv::Rect block = cv::Rect(2 * x, 2 * y, 2, 2) & cv::Rect({0, 0}, fraction.size());
      int points = 0;
      for (int row = block.y; row < block.br().y; ++row) {
        for (int column = block.x; column < block.br().x; ++column) points += fraction.at<std::uint8_t>(row, column);
      }
      chroma_share.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(points * 4 / block.area());
    }
  }
}

/// Brings levels nearer to `zero` by `dark` for each point, which are used up: what lies in two shadows is darkened once.
void scale_levels(cv::Mat& plane, double zero, double dark, const cv::Rect& where, cv::Mat& fraction) {
  for (int y = where.y; y < where.br().y; ++y) {
    for (int x = where.x; x < where.br().x; ++x) {
      auto& points = fraction.at<std::uint8_t>(y, x);
      if (points == 0) continue;
      auto& level = plane.at<std::uint8_t>(y, x);
      level = clamp_level(static_cast<float>(zero + (1 - dark * points) * (level - zero)));
      points = 0;
    }
  }
}

/// Convex outlines as one silhouette within the image.
std::optional<Silhouette> union_of(const std::vector<std::vector<Vector<2>>>& outlines, cv::Size image) {
  Box box;
  for (const auto& outline : outlines) box = box.empty() ? bounds(outline) : geometry::hull(box, bounds(outline));
  box = geometry::intersection(box, {0, 0, static_cast<double>(image.width), static_cast<double>(image.height)});
  Silhouette result = blank_silhouette(box, kShadowSamples);
  if (result.empty()) return std::nullopt;
  for (const auto& outline : outlines) fill_convex(result, outline, 255);
  return result;
}

/// Figures, posts and balls from the farthest to the nearest.
void lay_all(std::vector<Sprite> sprites, std::vector<BallSprite> balls, Planes& planes) {
  const auto farther = [](const auto& a, const auto& b) { return a.depth > b.depth; };
  std::stable_sort(sprites.begin(), sprites.end(), farther);
  std::stable_sort(balls.begin(), balls.end(), farther);
  auto ball = balls.begin();
  for (const Sprite& sprite : sprites) {
    for (; ball != balls.end() && ball->depth > sprite.depth; ++ball) ball->lay(planes);
    sprite.lay(planes);
  }
  for (; ball != balls.end(); ++ball) ball->lay(planes);
}

void dim(Planes& planes, double light) {
  scale_levels(planes.luma, light, 16);
  scale_levels(planes.cb, light, 128);
  scale_levels(planes.cr, light, 128);
}

}  // namespace

std::optional<BallSprite> PeopleRenderer::sprite_of(const PosedBall& ball, const Vector<2>& shift) const {
  const auto from = projection_(ball.from), to = projection_(ball.to);
  if (!from || !to) return std::nullopt;
  BallSprite sprite;
  sprite.depth = (from->depth + to->depth) / 2;
  sprite.from = from->at + shift, sprite.to = to->at + shift;
  sprite.radius = ball.radius * (from->scale + to->scale) / 2;
  sprite.colour = to_ycc(ball.colour, 1);
  return sprite;
}

/// Of points all over a ball's disc, the share within the image that nothing nearer covers.
double PeopleRenderer::fraction_observed(const BallSprite& ball, std::span<const Sprite> sprites) const {
  constexpr int kSide = 7;
  int all = 0, detected = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const int column = i % kSide, row = i / kSide;
    const Vector<2> off(2.0 * (column + 0.5) / kSide - 1, 2.0 * (row + 0.5) / kSide - 1);
    if (off.squaredNorm() > 1) continue;
    ++all;
    const Vector<2> at = ball.middle() + ball.radius * off;
    if (at.x() < -0.5 || at.y() < -0.5 || at.x() >= luma_.cols - 0.5 || at.y() >= luma_.rows - 0.5) continue;
    const auto covers = [&](const Sprite& sprite) { return sprite.depth < ball.depth && sprite.covers(at); };
    if (std::none_of(sprites.begin(), sprites.end(), covers)) ++detected;
  }
  return static_cast<double>(detected) / all;
}

PeopleRenderer::PeopleRenderer(const Image& ground, Projection projection, std::vector<Post> posts, const RenderOptions& options)
    : projection_(std::move(projection)), posts_(std::move(posts)), options_(options) {
  const Image scene = ground.is_colour() && ground.range() == Image::Range::limited ? ground : Image::from_bgr(ground.bgr());
  luma_ = scene.luma().clone();
  cb_ = scene.cb().clone();
  cr_ = scene.cr().clone();
  Random random(20040229);
  const std::size_t values = std::max<std::size_t>(1U << 18U, static_cast<std::size_t>(luma_.cols) * 8);
  for (std::size_t i = 0; i < values && options_.noise > 0; ++i) noise_.push_back(static_cast<float>(random.gaussian()));
}

std::optional<Sprite> PeopleRenderer::sprite_of(const PosedFigure& person, const Vector<2>& shift) const {
  struct Detected {
    RoundCone2 cone;
    double depth;
    FigurePart part;
  };
  std::vector<Detected> limbs;
  Box box;
  for (const Limb& limb : pose(*person.figure, person.stance)) {
    const auto from = projection_(limb.from), to = projection_(limb.to);
    if (!from || !to) return std::nullopt;
    limbs.push_back({{from->at + shift, to->at + shift, limb.from_radius * from->scale, limb.to_radius * to->scale},
                     (from->depth + to->depth) / 2 - kCover[static_cast<std::size_t>(limb.part)],
                     limb.part});
    box = box.empty() ? bounds(limbs.back().cone) : geometry::hull(box, bounds(limbs.back().cone));
  }
  const Vector<2>& location = person.stance.location;
  const auto foot = projection_({location.x(), location.y(), 0});
  if (!foot) return std::nullopt;
  Sprite sprite;
  sprite.depth = foot->depth;
  sprite.shape = blank_silhouette(box, options_.samples);
  if (!meets(sprite.shape, size())) return std::nullopt;
  std::stable_sort(limbs.begin(), limbs.end(), [](const Detected& a, const Detected& b) { return a.depth > b.depth; });
  for (const Detected& limb : limbs) {
    fill(sprite.shape, limb.cone, static_cast<std::uint8_t>(1 + kShades * static_cast<int>(limb.part)), kShades);
  }
  // The sun's side of the image: the direction of a step towards it.
  const Vector<2> lit = location + 0.1 * options_.sun.head<2>();
  const auto towards_sun = projection_({lit.x(), lit.y(), 0});
  const double side = towards_sun && towards_sun->at.x() < foot->at.x() ? -1 : 1;
  for (std::size_t part = 0; part < kFigureParts; ++part) {
    for (int shade = 0; shade < kShades; ++shade) {
      sprite.palette[1 + kShades * part + static_cast<std::size_t>(shade)] =
          to_ycc(person.figure->colours[part], shading(shade, side));
    }
  }
  return sprite;
}

std::optional<Sprite> PeopleRenderer::sprite_of(const Post& post, const Vector<2>& shift) const {
  std::vector<cv::Point2f> corners;
  Sprite sprite;
  for (const Vector<2>& end : {post.from, post.to}) {
    for (const double z : {0.0, post.height}) {
      const auto detected = projection_({end.x(), end.y(), z});
      if (!detected) return std::nullopt;
      corners.emplace_back(static_cast<float>(detected->at.x() + shift.x()), static_cast<float>(detected->at.y() + shift.y()));
      if (z == 0) sprite.depth += detected->depth / 2;
    }
  }
  const std::vector<Vector<2>> outline = hull_of(corners);
  const Box image{0, 0, static_cast<double>(luma_.cols), static_cast<double>(luma_.rows)};
  sprite.shape = blank_silhouette(geometry::intersection(bounds(outline), image), options_.samples);
  if (sprite.shape.empty()) return std::nullopt;
  fill_convex(sprite.shape, outline, 1, kShades);
  for (int shade = 0; shade < kShades; ++shade) {
    sprite.palette[1 + static_cast<std::size_t>(shade)] = to_ycc(post.colour, shading(shade, 1));
  }
  return sprite;
}

std::optional<Silhouette> PeopleRenderer::shadow_of(std::span<const Limb> limbs, const Vector<2>& shift) const {
  std::vector<std::vector<Vector<2>>> outlines;
  for (const Limb& limb : limbs) {
    std::vector<cv::Point2f> rim;
    add_shadow_rim(rim, projection_, limb.from, limb.from_radius, options_.sun, shift);
    add_shadow_rim(rim, projection_, limb.to, limb.to_radius, options_.sun, shift);
    outlines.push_back(hull_of(rim));
  }
  return union_of(outlines, size());
}

std::optional<Silhouette> PeopleRenderer::shadow_of(const Post& post, const Vector<2>& shift) const {
  std::vector<cv::Point2f> rim;
  for (const Vector<2>& end : {post.from, post.to}) {
    add_shadow_rim(rim, projection_, {end.x(), end.y(), 0}, 0.01, options_.sun, shift);
    add_shadow_rim(rim, projection_, {end.x(), end.y(), post.height}, 0.01, options_.sun, shift);
  }
  return union_of({hull_of(rim)}, size());
}

Planes PeopleRenderer::ground(const FrameConditions& conditions) const {
  Planes planes;
  const auto moved = [](const cv::Mat& plane, const Vector<2>& shift) {
    const cv::Matx23d by(1, 0, shift.x(), 0, 1, shift.y());
    cv::Mat out;
    cv::warpAffine(plane, out, by, plane.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    return out;
  };
  const bool still = conditions.shift.isZero();
  planes.luma = still ? luma_.clone() : moved(luma_, conditions.shift);
  planes.cb = still ? cb_.clone() : moved(cb_, conditions.shift / 2);
  planes.cr = still ? cr_.clone() : moved(cr_, conditions.shift / 2);
  return planes;
}

void PeopleRenderer::darken(Planes& planes, std::span<const Silhouette> shadows) const {
  // Points in shadow: of kShadowSamples² a pixel, and of four times as many for each pixel of chroma.
  cv::Mat fraction = cv::Mat::zeros(planes.luma.size(), CV_8UC1), cb_share = cv::Mat::zeros(planes.cb.size(), CV_8UC1);
  const cv::Rect image({0, 0}, fraction.size());
  for (const Silhouette& shadow : shadows) count_points(shadow, shadow.pixels() & image, fraction);
  for (const Silhouette& shadow : shadows) add_up_blocks(fraction, shadow.pixels() & image, cb_share);
  cv::Mat cr_share = cb_share.clone();
  constexpr double kPoints = kShadowSamples * kShadowSamples;
  const double dark = 1 - options_.shadow_level;
  for (const Silhouette& shadow : shadows) {
    const cv::Rect where = shadow.pixels() & image;
    scale_levels(planes.luma, 16, dark / kPoints, where, fraction);
    scale_levels(planes.cb, 128, dark / (4 * kPoints), half_of(where), cb_share);
    scale_levels(planes.cr, 128, dark / (4 * kPoints), half_of(where), cr_share);
  }
}

void PeopleRenderer::add_noise(Planes& planes, std::uint64_t seed) const {
  if (noise_.empty()) return;
  Random random(seed);
  const auto add = [&](cv::Mat& plane, double sigma) {
    const auto factor = static_cast<float>(sigma);
    for (int y = 0; y < plane.rows; ++y) {
      const float* noise = noise_.data() + random.integer(0, static_cast<int>(noise_.size()) - plane.cols);
      auto* row = plane.ptr<std::uint8_t>(y);
      for (int x = 0; x < plane.cols; ++x) row[x] = clamp_level(static_cast<float>(row[x]) + factor * noise[x]);
    }
  };
  add(planes.luma, options_.noise);
  add(planes.cb, options_.noise / 2);
  add(planes.cr, options_.noise / 2);
}

/// What others, who stand nearer, and the image's border leave of `truth`, whose sprite is `own`.
void PeopleRenderer::observe_past(std::span<const Sprite> sprites, const Sprite& own, TrueFigure& truth) const {
  for (const Sprite& other : sprites) {
    if (&other != &own && other.depth < own.depth) take_away(truth.visible, other.shape);
  }
  crop(truth.visible, size());
  truth.visible_fraction = truth.visible.area() / truth.whole.area();
}

/// The truth in the pixels of the image without its margin, and without those who are in the margin alone.
void PeopleRenderer::come_from_margin(RenderedFrame& frame) const {
  const int margin = options_.margin;
  if (margin == 0) return;
  const cv::Size image = size() - cv::Size(2 * margin, 2 * margin);
  for (TrueFigure& person : frame.people) {
    for (Silhouette* shape : {&person.whole, &person.visible}) shape->lattice -= cv::Point(margin, margin) * shape->samples;
    crop(person.visible, image);
    person.visible_fraction = person.visible.empty() ? 0 : person.visible.area() / person.whole.area();
    person.foot -= Vector<2>(margin, margin);
  }
  std::erase_if(frame.people, [&](const TrueFigure& person) { return !meets(person.whole, image); });
  for (TrueBall& ball : frame.balls) ball.at -= Vector<2>(margin, margin);
}

RenderedFrame PeopleRenderer::render(std::span<const PosedFigure> people, const FrameConditions& conditions,
                                     std::span<const PosedBall> balls) const {
  Planes planes = ground(conditions);
  std::vector<Silhouette> shadows;
  std::vector<Sprite> sprites;
  RenderedFrame frame;
  std::vector<std::size_t> sprite_of_person;
  const auto keep_shadow = [&](std::optional<Silhouette> shadow) {
    if (shadow) shadows.push_back(std::move(*shadow));
  };
  for (const PosedFigure& person : people) {
    if (options_.shadows) keep_shadow(shadow_of(pose(*person.figure, person.stance), conditions.shift));
    auto sprite = sprite_of(person, conditions.shift);
    if (!sprite) continue;
    TrueFigure truth{person.id, person.figure->team, person.stance.location, Vector<2>::Zero(), sprite->shape, sprite->shape, 0};
    truth.whole.mask = sprite->shape.mask.clone();
    truth.visible.mask = sprite->shape.mask.clone();
    truth.foot = projection_({truth.ground.x(), truth.ground.y(), 0})->at + conditions.shift;
    frame.people.push_back(std::move(truth));
    sprite_of_person.push_back(sprites.size());
    sprites.push_back(std::move(*sprite));
  }
  for (const Post& post : posts_) {
    if (options_.shadows) keep_shadow(shadow_of(post, conditions.shift));
    if (auto sprite = sprite_of(post, conditions.shift)) sprites.push_back(std::move(*sprite));
  }
  for (std::size_t i = 0; i < frame.people.size(); ++i) observe_past(sprites, sprites[sprite_of_person[i]], frame.people[i]);
  std::vector<BallSprite> ball_sprites;
  for (const PosedBall& ball : balls) {
    auto sprite = sprite_of(ball, conditions.shift);
    if (!sprite) continue;
    const Vector<3> middle = (ball.from + ball.to) / 2;
    const std::array<Limb, 1> round{{{middle, middle, ball.radius, ball.radius, FigurePart::skin}}};
    if (options_.shadows) keep_shadow(shadow_of(round, conditions.shift));
    frame.balls.push_back({sprite->middle(), sprite->radius, fraction_observed(*sprite, sprites)});
    ball_sprites.push_back(*sprite);
  }
  darken(planes, shadows);
  for (const PosedFigure& person : people) {
    if (options_.contact > 0)
      darken_contact(pose(*person.figure, person.stance), projection_, options_.contact, conditions.shift, planes.luma, planes.cb,
                     planes.cr);
  }
  lay_all(std::move(sprites), std::move(ball_sprites), planes);
  if (conditions.light != 1) dim(planes, conditions.light);
  if (!conditions.time_steps.empty() || options_.margin > 0)
    planes = observed_through(planes, conditions.time_steps, options_.margin);
  come_from_margin(frame);
  add_noise(planes, conditions.seed);
  apply(options_.degradation, planes.luma, planes.cb, planes.cr);
  frame.image = Image(planes.luma, planes.cb, planes.cr, Image::Range::limited);
  return frame;
}

}  // namespace marey::simulate::people
