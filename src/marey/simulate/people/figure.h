#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/simulate/random.h"

namespace marey::simulate::people {

/// What of a figure has a colour of its own.
enum class FigurePart { skin, hair, shirt, shorts, socks, shoes };
inline constexpr std::size_t kFigureParts = 6;

/// Red, green, blue in 0 … 255.
using Rgb = std::array<double, 3>;

/// How a person is built and dressed.
struct Figure {
  double stature = 1.78;  ///< m, standing upright
  double girth = 1;       ///< thickness of body and limbs, 1 for an athlete
  int team = 0;           ///< 0 or 1
  std::array<Rgb, kFigureParts> colours{};
};

/// A person of everyday size in the kit of a team (0 or 1), skin and hair drawn from `random`.
Figure draw_figure(Random& random, int team);

/// Every person in clothes of their own, as they are bought: shirt, shorts, socks and shoes of any colours, most of them subdued.
void dress_all(std::span<Figure> figures, std::uint64_t seed);

/// How a person stands at one instant. The ground is z = 0, z points up.
struct Stance {
  Vector<2> location = Vector<2>::Zero();  ///< m on the ground, below the hips
  double heading = 0;                      ///< rad, anticlockwise from +x as seen from above
  double speed = 0;                        ///< m/s: decides how far the limbs swing, and whether the person walks or runs
  double phase = 0;                        ///< rad, of the gait: 2π is one stride, two steps
  double crouch = 0;                       ///< 0 upright … 1 squatting
  double reach = 0;                        ///< 0 arms swing … 1 both arms thrown up
};

/// Length of a stride (two steps) at a speed, m: gait phase grows by 2π · distance / stride.
double stride_length(double speed, double stature);

/// A limb: the convex hull of two balls, one colour.
struct Limb {
  Vector<3> from, to;  ///< m
  double from_radius = 0, to_radius = 0;
  FigurePart part{};
};

/// The figure's limbs in the world; the lowest touches the ground but in a runner's flight.
std::vector<Limb> pose(const Figure& figure, const Stance& stance);

}  // namespace marey::simulate::people
