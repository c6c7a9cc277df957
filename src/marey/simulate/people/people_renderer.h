#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/image.h"
#include "marey/simulate/people/exposure.h"
#include "marey/simulate/people/figure.h"
#include "marey/simulate/people/image_degradation.h"
#include "marey/simulate/people/silhouette_raster.h"

namespace marey::simulate::people {

/// How a point of the world (m, z up, the ground at z = 0) is seen.
struct Sighting {
  Vector<2> at = Vector<2>::Zero();  ///< px
  double scale = 0;                  ///< px that a metre across the line of sight takes there
  double depth = 0;                  ///< m from the camera, for occlusion
};

/// The camera: nothing for a point that it cannot see. Any camera model fits; it is asked some fifty times a figure.
using Projection = std::function<std::optional<Sighting>(const Vector<3>&)>;

/// A person in one frame.
struct PosedFigure {
  int id = 0;  ///< from 1
  const Figure* figure = nullptr;
  Stance stance;
};

/// A ball in one frame, which moves while the shutter is open.
struct PosedBall {
  Vector<3> from = Vector<3>::Zero(), to = Vector<3>::Zero();  ///< m: its centre as the shutter opens and closes
  double radius = 0.11;                                        ///< m
  Rgb colour{236, 236, 232};
};

/// Something upright and flat that hides what is behind it: a post, a board, a wall.
struct Post {
  Vector<2> from = Vector<2>::Zero(), to = Vector<2>::Zero();  ///< m on the ground
  double height = 3;                                           ///< m
  Rgb colour{90, 92, 96};
};

struct RenderOptions {
  int samples = 4;                            ///< points per pixel in each direction, for edges and silhouettes
  bool shadows = true;                        ///
  Vector<3> sun = Vector<3>(0.5, 0.35, 1.0);  ///< towards the sun; z above 0
  double shadow_level = 0.55;                 ///< what a shadow leaves of the ground's brightness
  double contact = 0;                         ///< share of the light that shoes keep from the ground right under them
  double noise = 2;                           ///< standard deviation of luma, grey levels; chroma has half of it
  ImageDegradation degradation;               ///< lens, sharpening and codec
  int margin = 0;                             ///< px, even: so far the ground given reaches beyond the images, on each side
};

/// What changes from frame to frame besides the people.
struct FrameConditions {
  double light = 1;                       ///< factor on every level
  Vector<2> shift = Vector<2>::Zero();    ///< px that the image moves, and its truth with it
  std::vector<PixelMap> time_steps = {};  ///< of a camera that moves while the shutter is open; its truth is that of the rest
  std::uint64_t seed = 0;                 ///< of the noise
};

/// Where one person truly is in one frame.
struct TrueFigure {
  int id = 0;
  int team = 0;
  Vector<2> ground = Vector<2>::Zero();  ///< m, below the hips
  Vector<2> foot = Vector<2>::Zero();    ///< px; `ground` as the camera sees it
  Silhouette whole;                      ///< hidden parts included; reaches outside the image where the person does
  Silhouette visible;                    ///< the part in front of posts and nearer people, within the image
  double visible_fraction = 0;           ///< of the area of `whole`
};

/// Where a ball truly is in one frame.
struct TrueBall {
  Vector<2> at = Vector<2>::Zero();  ///< px: its centre halfway through the exposure
  double radius = 0;                 ///< px
  double visible_fraction = 0;       ///< of its disc: within the image and not occluded
};

struct RenderedFrame {
  Image image;                     ///< colour, limited range
  std::vector<TrueFigure> people;  ///< in the order given, those with a part of `whole` within the image
  std::vector<TrueBall> balls;     ///< those given that lie before the camera
};

struct BallSprite;
struct Planes;
struct Sprite;

/// Draws people, their shadows and posts over an image of the ground.
class PeopleRenderer {
 public:
  /// `ground` is the empty scene as the camera sees it, colour or grey, of the size that frames will have and `margin` more on each
  /// side; `projection` goes to its pixels. Posts stand in it permanently.
  PeopleRenderer(const Image& ground, Projection projection, std::vector<Post> posts = {}, const RenderOptions& options = {});

  /// The same for the same arguments. Safe to call from several threads.
  RenderedFrame render(std::span<const PosedFigure> people, const FrameConditions& conditions = {},
                       std::span<const PosedBall> balls = {}) const;

  cv::Size size() const { return luma_.size(); }

 private:
  std::optional<BallSprite> sprite_of(const PosedBall& ball, const Vector<2>& shift) const;
  std::optional<Sprite> sprite_of(const PosedFigure& person, const Vector<2>& shift) const;
  std::optional<Sprite> sprite_of(const Post& post, const Vector<2>& shift) const;
  std::optional<Silhouette> shadow_of(std::span<const Limb> limbs, const Vector<2>& shift) const;
  std::optional<Silhouette> shadow_of(const Post& post, const Vector<2>& shift) const;
  Planes ground(const FrameConditions& conditions) const;
  double fraction_observed(const BallSprite& ball, std::span<const Sprite> sprites) const;
  void observe_past(std::span<const Sprite> sprites, const Sprite& own, TrueFigure& truth) const;
  void darken(Planes& planes, std::span<const Silhouette> shadows) const;
  void add_noise(Planes& planes, std::uint64_t seed) const;
  void come_from_margin(RenderedFrame& frame) const;

  cv::Mat luma_, cb_, cr_;
  Projection projection_;
  std::vector<Post> posts_;
  RenderOptions options_;
  std::vector<float> noise_;  ///< Gaussian values of deviation 1, read from random places
};

}  // namespace marey::simulate::people
