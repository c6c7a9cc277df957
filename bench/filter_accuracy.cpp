// How well each filter predicts: a target on paths that no filter's model is, measured with noise, followed with every filter's
// defaults. Prints, for each kind of path, the root mean square of the distance between the position predicted before a frame and
// the true one (px), the share of frames in which the measurement fell outside the search area (lost), and the median radius of the
// search area (px), so that a filter that is never lost because it searches everywhere is seen for what it is.
// Paths, speeds and noise are drawn from a seed. A measurement outside the search area is taken in all the same, so that
// errors are comparable.
//
//   filter_accuracy [--targets N] [--seed N] [--rate HZ] [--noise PX]
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "marey/filter/filters.h"
#include "marey/geometry/median.h"

#include "experiments/markdown_table.h"

namespace marey {
namespace {

using Location = std::function<Vector<2>(double)>;
constexpr double kDuration = 4;  // s

struct Draw {
  std::mt19937 random;
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  double angle() { return uniform(0, 2 * std::numbers::pi); }
};

Vector<2> heading(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

/// Straight legs, each at its own velocity, joined at their ends; the leg's acceleration is along it.
struct Leg {
  double start;
  Vector<2> from, velocity, acceleration;
};

Location along(std::vector<Leg> legs) {
  for (std::size_t k = 1; k < legs.size(); ++k) {
    const double t = legs[k].start - legs[k - 1].start;
    legs[k].from = legs[k - 1].from + t * legs[k - 1].velocity + 0.5 * t * t * legs[k - 1].acceleration;
  }
  return [legs](double time) {
    std::size_t k = legs.size() - 1;
    while (k > 0 && legs[k].start > time) --k;
    const double t = time - legs[k].start;
    return Vector<2>(legs[k].from + t * legs[k].velocity + 0.5 * t * t * legs[k].acceleration);
  };
}

Location zigzag(Draw& draw) {
  const double speed = draw.uniform(100, 900);
  double course = draw.angle();
  std::vector<Leg> legs;
  for (double t = 0; t < kDuration; t += draw.uniform(0.15, 0.6)) {
    legs.push_back({t, Vector<2>::Zero(), speed * heading(course), Vector<2>::Zero()});
    course += (legs.size() % 2 == 0 ? 1 : -1) * draw.uniform(0.7, 2.6);
  }
  return along(std::move(legs));
}

Location accelerating(Draw& draw) {
  std::vector<Leg> legs;
  double course = draw.angle();
  double length = 0;
  for (double t = 0; t < kDuration; t += length) {
    length = draw.uniform(0.5, 1.2);
    const double top = draw.uniform(300, 1000);
    legs.push_back({t, Vector<2>::Zero(), Vector<2>::Zero(), top / length * heading(course)});
    course += draw.uniform(-2.5, 2.5);
  }
  return along(std::move(legs));
}

/// Goes, stands still, continues, all at once.
Location stopping(Draw& draw) {
  std::vector<Leg> legs;
  for (double t = 0; t < kDuration; t += draw.uniform(0.3, 0.8)) {
    const double speed = legs.size() % 2 == 0 ? draw.uniform(100, 700) : 0;
    legs.push_back({t, Vector<2>::Zero(), speed * heading(draw.angle()), Vector<2>::Zero()});
  }
  return along(std::move(legs));
}

Location circling(Draw& draw) {
  const double speed = draw.uniform(100, 900);
  const double rate = draw.uniform(1, 8);
  const double phase = draw.angle();
  return [=](double t) { return Vector<2>(speed / rate * heading(phase + rate * t)); };
}

/// A limb: a few sine waves of 0.4 to 3 Hz in each axis.
Location swinging(Draw& draw) {
  struct Wave {
    double size, rate, phase;
  };
  std::vector<Wave> waves;
  for (int k = 0; k < 6; ++k) {
    const double hertz = draw.uniform(0.4, 3);
    waves.push_back({draw.uniform(10, 60) / hertz, 2 * std::numbers::pi * hertz, draw.angle()});
  }
  return [waves](double t) {
    Vector<2> location = Vector<2>::Zero();
    for (std::size_t k = 0; k < waves.size(); ++k)
      location[static_cast<int>(k % 2)] += waves[k].size * std::sin(waves[k].rate * t + waves[k].phase);
    return location;
  };
}

Location straight(Draw& draw) {
  return along({{0, Vector<2>::Zero(), draw.uniform(0, 900) * heading(draw.angle()), Vector<2>::Zero()}});
}

struct Result {
  std::vector<double> errors;
  std::vector<double> radii;
  std::size_t outside = 0;
};

struct TrackFunction {
  const Location& location;
  double rate;
  double noise;
  unsigned seed;
  Result& result;

  template <typename F>
  void operator()(const typename F::Options& options) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, noise);
    const Matrix<2> R = noise * noise * Matrix<2>::Identity();
    const auto detected = [&](double t) { return Vector<2>(location(t) + Vector<2>(normal(random), normal(random))); };
    F filter(options, detected(0), R);
    for (int k = 1; k < kDuration * rate; ++k) {
      const double t = k / rate;
      filter.predict(1 / rate);
      const Vector<2> z = detected(t);
      if (k > 3) {
        result.errors.push_back((filter.position() - location(t)).norm());
        result.outside += filter.gate_distance(z, R) > 1;
        // By bisection along one axis: the area may be of any shape.
        double low = 0;
        double high = 4096;
        for (int i = 0; i < 20; ++i) {
          const double middle = 0.5 * (low + high);
          (filter.gate_distance(filter.position() + Vector<2>(middle, 0), R) < 1 ? low : high) = middle;
        }
        result.radii.push_back(low);
      }
      filter.correct(z, R);
    }
  }
};

double root_mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace
}  // namespace marey

int main(int count, char** words) {
  using namespace marey;
  int targets = 40;
  unsigned seed = 1;
  double rate = 30, noise = 0.05;
  CLI::App app("How well each filter predicts");
  app.add_option("--targets", targets, "of each kind of path")->capture_default_str();
  app.add_option("--seed", seed)->capture_default_str();
  app.add_option("--rate", rate, "Hz")->capture_default_str();
  app.add_option("--noise", noise, "px, standard deviation along each axis")->capture_default_str();
  CLI11_PARSE(app, count, words);
  const std::vector<std::pair<std::string, Location (*)(Draw&)>> kinds = {{"straight", straight},         {"zigzag", zigzag},
                                                                          {"acceleration", accelerating}, {"stops", stopping},
                                                                          {"circle", circling},           {"limb", swinging}};
  std::vector<std::string> titles{"filter"};
  for (const auto& [name, make] : kinds) titles.push_back(name);
  fmt::print("{}", experiments::markdown_header(titles));
  for (const filter::NamedFilter& filter : filter::named_filters()) {
    std::vector<std::string> cells{std::string(filter.name)};
    for (const auto& [name, make] : kinds) {
      Result result;
      for (int i = 0; i < targets; ++i) {
        Draw draw{std::mt19937(seed * 1000 + static_cast<unsigned>(i))};
        const Location location = make(draw);
        filter::with_filter<2>(filter.options, TrackFunction{location, rate, noise, seed + static_cast<unsigned>(i), result});
      }
      cells.push_back(fmt::format("{:.2f} · {:.1f} % · {:.0f}", root_mean_square(result.errors),
                                  100.0 * static_cast<double>(result.outside) / static_cast<double>(result.errors.size()),
                                  geometry::median(result.radii)));
    }
    fmt::print("{}", experiments::markdown_row(cells));
  }
  return 0;
}
