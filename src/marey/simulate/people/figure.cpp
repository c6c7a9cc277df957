// A person is some twenty balls and tapered rods on a tree of joints: hips, knees, ankles, shoulders, elbows. Lengths are shares of
// the stature (Winter, "Biomechanics and Motor Control of Human Movement", fig. 4.1, rounded). Joint angles are low harmonics of
// the gait phase: the hip swings as a sine, the knee bends while its leg swings forward, arms swing against their leg. Walking
// passes into running between 1.8 and 3.2 m/s: wider swings, bent elbows, a leaning trunk and an instant of flight. It looks like a
// person from some metres on, and is not a model of forces.
#include "marey/simulate/people/figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace marey::simulate::people {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Angles of one side, rad. Positive is forward for hip and shoulder, bent for knee and elbow.
struct SideAngles {
  double hip = 0, knee = 0, shoulder = 0, elbow = 0;
};

double mix(double a, double b, double fraction) {
  return a + fraction * (b - a);
}

double running_fraction(double speed) {
  return std::clamp((speed - 1.8) / 1.4, 0.0, 1.0);
}

SideAngles side_angles(const Stance& stance, double phase) {
  const double run = running_fraction(stance.speed);
  const double swing = std::min(1.0, stance.speed / 1.1);
  const double sine = std::sin(phase);
  const double bend = std::max(0.0, std::cos(phase + 0.45));  // largest soon after the foot has left the ground
  SideAngles angles;
  angles.hip = kDegree * (mix(4, 14, run) + swing * mix(25, 42, run) * sine);
  angles.knee = kDegree * (mix(5, 18, run) + swing * mix(52, 88, run) * bend * bend);
  angles.shoulder = kDegree * (-swing * mix(22, 42, run) * sine - mix(0, 6, run));
  angles.elbow = kDegree * (12 + swing * mix(8, 76, run) + swing * 10 * std::max(0.0, -sine));
  angles.hip = mix(angles.hip, 95 * kDegree, stance.crouch);
  angles.knee = mix(angles.knee, 125 * kDegree, stance.crouch);
  angles.shoulder = mix(angles.shoulder, 165 * kDegree, stance.reach);
  angles.elbow = mix(angles.elbow, 15 * kDegree, stance.reach);
  return angles;
}

/// Builds limbs in the body's frame (x forward, y left, z up, the hips' middle at 0), in statures.
class Builder {
 public:
  explicit Builder(double girth) : girth_(girth) {}

  void add(const Vector<3>& from, double from_radius, const Vector<3>& to, double to_radius, FigurePart part) {
    limbs_.push_back({from, to, girth_ * from_radius, girth_ * to_radius, part});
  }

  void leg(double side, const SideAngles& angles) {
    const Vector<3> hip(0, side * 0.055, 0);
    const Vector<3> thigh = down(angles.hip);
    const Vector<3> shank = down(angles.hip - angles.knee);
    const Vector<3> knee = hip + 0.245 * thigh;
    const Vector<3> ankle = knee + 0.235 * shank;
    add(hip, 0.058, knee, 0.036, FigurePart::skin);
    add(hip, 0.066, hip + 0.15 * thigh, 0.059, FigurePart::shorts);
    add(knee, 0.035, ankle, 0.024, FigurePart::skin);
    add(knee + 0.05 * shank, 0.037, ankle, 0.025, FigurePart::socks);
    const double sole = std::clamp(0.5 * (angles.hip - angles.knee), -60 * kDegree, 20 * kDegree);
    const Vector<3> toe(std::cos(sole), 0, std::sin(sole));
    add(ankle - 0.02 * toe + 0.02 * shank, 0.024, ankle + 0.1 * toe + 0.022 * shank, 0.018, FigurePart::shoes);
  }

  void arm(double side, const SideAngles& angles, const Vector<3>& shoulder, double lean) {
    const double spread = 0.12 * side;
    const auto direction = [&](double angle) { return (down(angle - lean) + Vector<3>(0, spread, 0)).normalized(); };
    const Vector<3> upper = direction(angles.shoulder);
    const Vector<3> lower = direction(angles.shoulder + angles.elbow);
    const Vector<3> elbow = shoulder + 0.175 * upper;
    const Vector<3> wrist = elbow + 0.145 * lower;
    add(shoulder, 0.028, elbow, 0.023, FigurePart::skin);
    add(shoulder, 0.036, shoulder + 0.11 * upper, 0.032, FigurePart::shirt);
    add(elbow, 0.023, wrist, 0.017, FigurePart::skin);
    add(wrist, 0.02, wrist + 0.04 * lower, 0.02, FigurePart::skin);
  }

  /// Trunk, neck and head; returns the middle between the shoulders.
  Vector<3> trunk(double lean, double twist) {
    const Vector<3> up(std::sin(lean), 0, std::cos(lean));
    const Vector<3> chest = 0.235 * up;
    const auto across = [&](double side) { return Vector<3>(side * twist * 0.035, side * 0.068, 0); };
    add(Vector<3>(0, 0, 0.02), 0.072, chest, 0.074, FigurePart::shirt);
    for (const double side : {-1.0, 1.0})
      add(Vector<3>(0, side * 0.038, 0.015), 0.064, chest + across(side), 0.06, FigurePart::shirt);
    add(0.262 * up + 1.1 * across(-1), 0.04, 0.262 * up + 1.1 * across(1), 0.04, FigurePart::shirt);
    add(Vector<3>(0, -0.05, -0.005), 0.07, Vector<3>(0, 0.05, -0.005), 0.07, FigurePart::shorts);
    add(0.28 * up, 0.034, 0.35 * up, 0.03, FigurePart::skin);
    const Vector<3> face = 0.405 * up + Vector<3>(0.012, 0, 0);
    add(face - 0.02 * up, 0.042, face + 0.018 * up, 0.05, FigurePart::skin);
    add(face + Vector<3>(-0.018, 0, 0.018), 0.052, face + Vector<3>(-0.002, 0, 0.032), 0.049, FigurePart::hair);
    return 0.268 * up;
  }

  std::vector<Limb> take() { return std::move(limbs_); }

 private:
  /// Hanging down, turned forward by an angle.
  static Vector<3> down(double angle) { return {std::sin(angle), 0, -std::cos(angle)}; }

  double girth_;
  std::vector<Limb> limbs_;
};

double lowest(const std::vector<Limb>& limbs) {
  double low = 0;
  for (const Limb& limb : limbs) {
    low = std::min({low, limb.from.z() - limb.from_radius, limb.to.z() - limb.to_radius});
  }
  return low;
}

}  // namespace

Figure draw_figure(Random& random, int team) {
  Figure figure;
  figure.stature = std::clamp(random.gaussian(1.79, 0.06), 1.62, 1.96);
  figure.girth = std::clamp(random.gaussian(1.0, 0.06), 0.85, 1.2);
  figure.team = team;
  const double skin = random.uniform(0.35, 1.0);
  const double hair = random.uniform(0.1, 0.7);
  const Rgb light{228, 180, 150};
  const Rgb brown{110, 80, 52};
  for (std::size_t c = 0; c < 3; ++c) {
    figure.colours[static_cast<std::size_t>(FigurePart::skin)][c] = skin * light[c];
    figure.colours[static_cast<std::size_t>(FigurePart::hair)][c] = hair * brown[c];
  }
  const auto clothe = [&](FigurePart part, const Rgb& colour) { figure.colours[static_cast<std::size_t>(part)] = colour; };
  clothe(FigurePart::shirt, team == 0 ? Rgb{205, 30, 38} : Rgb{235, 235, 238});
  clothe(FigurePart::shorts, team == 0 ? Rgb{240, 240, 240} : Rgb{28, 40, 105});
  clothe(FigurePart::socks, team == 0 ? Rgb{190, 28, 34} : Rgb{225, 225, 232});
  clothe(FigurePart::shoes, random.chance(0.5) ? Rgb{25, 25, 28} : Rgb{225, 190, 40});
  return figure;
}

void dress_all(std::span<Figure> figures, std::uint64_t seed) {
  Random random(seed ^ 0xc107e5);
  constexpr std::array<FigurePart, 4> kWorn{FigurePart::shirt, FigurePart::shorts, FigurePart::socks, FigurePart::shoes};
  for (Figure& figure : figures) {
    for (const FigurePart part : kWorn) {
      const double light = random.uniform(20, 235), hue = random.uniform(0, 2 * std::numbers::pi);
      const double colour = random.chance(0.4) ? random.uniform(0, 15) : random.uniform(15, 100);
      for (std::size_t c = 0; c < 3; ++c) {
        const double of_hue = std::cos(hue - 2 * std::numbers::pi * static_cast<double>(c) / 3);
        figure.colours[static_cast<std::size_t>(part)][c] = std::clamp(light + colour * of_hue, 12.0, 245.0);
      }
    }
  }
}

double stride_length(double speed, double stature) {
  // 1.5 m at a walk of 1.4 m/s, 2.9 m at 5 m/s, for a person of 1.78 m.
  return stature * (0.54 + 0.22 * std::max(0.0, speed));
}

std::vector<Limb> pose(const Figure& figure, const Stance& stance) {
  const double run = running_fraction(stance.speed);
  const double swing = std::min(1.0, stance.speed / 1.1);
  const double lean = mix(kDegree * (1 + swing * mix(2, 11, run)), 42 * kDegree, stance.crouch);
  const SideAngles left = side_angles(stance, stance.phase);
  const SideAngles right = side_angles(stance, stance.phase + std::numbers::pi);
  Builder builder(figure.girth);
  builder.leg(1, left);
  builder.leg(-1, right);
  const double twist = -swing * std::sin(stance.phase);  // the shoulder goes back where the leg goes forward
  const Vector<3> shoulders = builder.trunk(lean, twist);
  builder.arm(1, left, shoulders + Vector<3>(0.035 * twist, 0.108, 0), lean);
  builder.arm(-1, right, shoulders + Vector<3>(-0.035 * twist, -0.108, 0), lean);
  std::vector<Limb> limbs = builder.take();

  const double flight = 0.035 * run * (1 - stance.crouch) * std::pow(std::sin(stance.phase), 2);
  const double lift = flight - lowest(limbs);
  const double c = std::cos(stance.heading);
  const double s = std::sin(stance.heading);
  const auto located = [&](const Vector<3>& p) -> Vector<3> {
    const double x = figure.stature * p.x();
    const double y = figure.stature * p.y();
    return {stance.location.x() + c * x - s * y, stance.location.y() + s * x + c * y, figure.stature * (p.z() + lift)};
  };
  for (Limb& limb : limbs) {
    limb.from = located(limb.from);
    limb.to = located(limb.to);
    limb.from_radius *= figure.stature;
    limb.to_radius *= figure.stature;
  }
  return limbs;
}

}  // namespace marey::simulate::people
