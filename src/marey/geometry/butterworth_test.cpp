#include "marey/geometry/butterworth.h"

#include <complex>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "marey/geometry/vector.h"

namespace marey::geometry {
namespace {

/// |H| at `frequency`, a share of the rate.
double response(const Butterworth& f, double frequency) {
  const std::complex<double> z = std::polar(1.0, -2 * std::numbers::pi * frequency);
  return std::abs((f.b0 + f.b1 * z + f.b2 * z * z) / (1.0 + f.a1 * z + f.a2 * z * z));
}

TEST(Butterworth, LetsHalfOfThePowerThroughAtItsCutoff) {
  for (const double cutoff : {0.01, 0.1, 0.4}) {
    const Butterworth f(cutoff);
    EXPECT_NEAR(response(f, 0), 1, 1e-9);
    EXPECT_NEAR(response(f, cutoff), std::numbers::sqrt2 / 2, 1e-9);
    EXPECT_NEAR(response(f, 0.5), 0, 1e-6);
  }
  EXPECT_NEAR(std::pow(response(Butterworth(cutoff_of_one_pass(0.01)), 0.01), 2), std::numbers::sqrt2 / 2, 1e-3) << "two passes";
}

TEST(Butterworth, NothingLagsAndEachAxisIsOnItsOwn) {
  const unsigned seed = std::random_device()();
  SCOPED_TRACE(fmt::format("seed {}", seed));
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 1);
  std::vector<Vector<2>> both;
  std::vector<double> x, backwards;
  for (int i = 0; i < 200; ++i) both.emplace_back(noise(random), noise(random));
  for (const Vector<2>& each : both) x.push_back(each.x());
  backwards.assign(x.rbegin(), x.rend());
  low_pass(std::span(both), 0.05, 60);
  low_pass(std::span(x), 0.05, 60);
  low_pass(std::span(backwards), 0.05, 60);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(both[i].x(), x[i]);
  for (std::size_t i = 20; i < 180; ++i)
    EXPECT_NEAR(backwards[199 - i], x[i], 1e-3) << "what is turned round comes out turned round";
}

TEST(Butterworth, KeepsUniformMotion) {
  std::vector<double> line;
  for (int i = 0; i < 100; ++i) line.push_back(3 - 0.25 * i);
  std::vector<double> smooth = line, one{7};
  low_pass(std::span(smooth), 0.1, 40);
  for (std::size_t i = 0; i < line.size(); ++i) EXPECT_NEAR(smooth[i], line[i], 1e-3) << i;
  low_pass(std::span(one), 0.1, 40);
  EXPECT_EQ(one.front(), 7);
}

}  // namespace
}  // namespace marey::geometry
