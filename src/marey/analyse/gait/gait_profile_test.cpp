// Against a twin that follows the paper's equations word by word, on random curves.
#include "marey/analyse/gait/gait_profile.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace marey::analyse::gait {
namespace {

constexpr std::array<unsigned, 3> kProfileSeeds = {1, 2, 3};

CyclePoints random_points(std::mt19937& random, double sigma) {
  std::normal_distribution<double> normal(0, sigma);
  CyclePoints points{};
  for (double& point : points) point = normal(random);
  return points;
}

/// Nine variables of both sides, `cycles` a side; cycles of the left have even indices.
std::vector<CycleCurve> random_curves(std::mt19937& random, std::size_t cycles, double sigma) {
  std::vector<CycleCurve> curves;
  for (const Side side : kSides) {
    for (const std::string_view name : kProfileVariables) {
      CycleCurve curve{.name = (side == Side::left ? "left_" : "right_") + std::string(name), .cycles = {}};
      for (std::size_t c = 0; c < cycles; ++c) {
        curve.cycles.push_back(random_points(random, sigma));
        curve.cycle_of.push_back(2 * c + static_cast<std::size_t>(side));
      }
      summarise(curve.cycles, curve.mean, curve.deviation);
      curves.push_back(curve);
    }
  }
  return curves;
}

/// GVS of one variable and side, by the definition.
double naive_variable(const std::vector<CycleCurve>& walk, const std::vector<ReferencePerson>& people, const std::string& side,
                      const std::string& name) {
  std::array<double, kCyclePoints> reference{};
  for (std::size_t p = 0; p < kCyclePoints; ++p) {
    for (const ReferencePerson& person : people) {
      double sum = 0, count = 0;
      for (const CycleCurve& curve : person.curves) {
        if (curve.name != "left_" + name && curve.name != "right_" + name) continue;
        for (const CyclePoints& cycle : curve.cycles) {
          sum += cycle[p];
          ++count;
        }
      }
      reference[p] += sum / count / static_cast<double>(people.size());
    }
  }
  double total = 0, count = 0;
  for (const CycleCurve& curve : walk) {
    if (curve.name != side + name) continue;
    for (const CyclePoints& cycle : curve.cycles) {
      double squares = 0;
      for (std::size_t p = 0; p < kCyclePoints; ++p) squares += std::pow(cycle[p] - reference[p], 2);
      total += std::sqrt(squares / kCyclePoints);
      ++count;
    }
  }
  return total / count;
}

TEST(GaitProfile, AgreesWithTheDefinition) {
  for (const unsigned seed : kProfileSeeds) {
    std::mt19937 random(seed);
    std::vector<ReferencePerson> people;
    for (std::size_t i = 0; i < 4; ++i) people.push_back({.name = "", .curves = random_curves(random, 1 + i, 0.1), .figures = {}});
    const std::vector<CycleCurve> walk = random_curves(random, 3, 0.3);
    const GaitProfile profile = gait_profile(walk, reference_bands(people));
    std::array<double, 2> squares{};
    double fifteen = 0;
    for (std::size_t v = 0; v < kProfileVariables.size(); ++v) {
      for (const std::size_t s : {0U, 1U}) {
        const double naive = naive_variable(walk, people, s == 0 ? "left_" : "right_", std::string(kProfileVariables[v]));
        EXPECT_NEAR(profile.variables[v].mean[s].value(), naive, 1e-12) << kProfileVariables[v] << ", seed " << seed;
        squares[s] += naive * naive;
        if (s == 0 || v >= 3) fifteen += naive * naive;
      }
    }
    EXPECT_NEAR(profile.score[0].value(), std::sqrt(squares[0] / 9), 1e-12);
    EXPECT_NEAR(profile.score[1].value(), std::sqrt(squares[1] / 9), 1e-12);
    EXPECT_NEAR(profile.overall.value(), std::sqrt(fifteen / 15), 1e-12);
    EXPECT_GT(profile.score_deviation[0].value(), 0);
  }
}

TEST(GaitProfile, IsZeroForTheReferenceItself) {
  std::mt19937 random(kProfileSeeds[0]);
  ReferencePerson person{.name = "", .curves = random_curves(random, 1, 0.1), .figures = {}};
  for (CycleCurve& curve : person.curves) curve.cycles.assign(1, person.curves[curve.name.starts_with("left_") ? 0 : 9].cycles[0]);
  for (std::size_t v = 0; v < 9; ++v) person.curves[9 + v].cycles = person.curves[v].cycles;
  const GaitProfile profile = gait_profile(person.curves, reference_bands(std::span(&person, 1)));
  EXPECT_NEAR(profile.overall.value(), 0, 1e-15);
  EXPECT_FALSE(profile.score_deviation[0]) << "one cycle has no deviation";
}

TEST(GaitProfile, IgnoresWholeTurns) {
  std::mt19937 random(kProfileSeeds[1]);
  const std::vector<ReferencePerson> people = {{.name = "", .curves = random_curves(random, 2, 0.1), .figures = {}}};
  std::vector<CycleCurve> walk = random_curves(random, 2, 0.1);
  const GaitProfile before = gait_profile(walk, reference_bands(people));
  for (CyclePoints& cycle : walk[2].cycles) {
    for (double& point : cycle) point += 2 * std::numbers::pi;
  }
  EXPECT_NEAR(gait_profile(walk, reference_bands(people)).overall.value(), before.overall.value(), 1e-9);
}

TEST(GaitProfile, HasNoScoreWithoutAVariable) {
  std::mt19937 random(kProfileSeeds[2]);
  const std::vector<ReferencePerson> people = {{.name = "", .curves = random_curves(random, 2, 0.1), .figures = {}}};
  std::vector<CycleCurve> walk = random_curves(random, 2, 0.1);
  walk[8].cycles.clear();  // the left foot's progression
  const GaitProfile profile = gait_profile(walk, reference_bands(people));
  EXPECT_FALSE(profile.score[0]);
  EXPECT_TRUE(profile.score[1]);
  EXPECT_FALSE(profile.overall);
  EXPECT_FALSE(profile.variables[8].mean[0]);
  EXPECT_TRUE(gait_profile({}, reference_bands(people)).variables.size() == 9);
  EXPECT_FALSE(gait_profile(walk, {}).score[1]) << "no reference";
}

TEST(GaitProfile, ScoresPeopleOfTheGroupAgainstTheOthers) {
  std::mt19937 random(kProfileSeeds[0]);
  std::vector<ReferencePerson> people;
  for (int i = 0; i < 5; ++i) people.push_back({.name = "", .curves = random_curves(random, 2, 0.1), .figures = {}});
  const std::vector<ReferenceScore> scores = reference_scores(people);
  ASSERT_EQ(scores.size(), 10U);
  EXPECT_EQ(scores.back().name, "GPS");
  // A point of a cycle has deviation 0.1, the mean of four others' four cycles 0.1/4.
  EXPECT_NEAR(scores.back().mean, 0.1 * std::sqrt(1 + 1.0 / 16), 0.003);
  EXPECT_TRUE(reference_scores(std::span(people).first(2)).empty());
}

TEST(GaitProfile, CountsEveryPersonOnceInFigures) {
  const auto person = [](double left, double right) {
    return ReferencePerson{
        .name = "", .curves = {}, .figures = {{.name = "speed", .unit = "m/s", .mean = {left, right}, .deviation = {}}}};
  };
  const std::vector<ReferencePerson> people = {person(1, 1.2), person(1.3, 1.3)};
  const std::vector<ReferenceFigure> figures = reference_figures(people);
  ASSERT_EQ(figures.size(), 1U);
  EXPECT_NEAR(figures[0].mean, 1.2, 1e-12);
  EXPECT_NEAR(figures[0].deviation.value(), 0.2 / std::sqrt(2), 1e-12);
}

SignalCurve constant(const std::string& label, Side side, const std::string& unit, std::initializer_list<double> cycles) {
  SignalCurve curve{.label = label, .side = side, .cycles = {}, .unit = unit};
  for (const double value : cycles) {
    CyclePoints points{};
    points.fill(value);
    curve.cycles.push_back(points);
  }
  return curve;
}

TEST(GaitProfile, SignalsOfTheGroupCountEachPersonOnce) {
  std::vector<ReferencePerson> people(2);
  people[0].signals = {constant("up", Side::left, "% of weight", {90, 110}), constant("up", Side::right, "% of weight", {100}),
                       constant("up", Side::left, "% of weight", {100}), constant("hip moment", Side::left, "N m/kg", {1})};
  people[1].signals = {constant("up", Side::right, "% of weight", {120}), constant("up", Side::left, "N", {700}),
                       constant("knee power", Side::left, "W", {50})};
  const std::vector<ReferenceSignal> signals = reference_signals(people);
  ASSERT_EQ(signals.size(), 2U) << "newtons and watts of people of any weight are not compared";
  EXPECT_EQ(signals[0].label, "hip moment");
  EXPECT_EQ(signals[0].people, 1U);
  EXPECT_DOUBLE_EQ(signals[0].mean[50], 1);
  EXPECT_EQ(signals[0].deviation[50], 0);
  EXPECT_EQ(signals[1].label, "up");
  EXPECT_EQ(signals[1].people, 2U);
  EXPECT_DOUBLE_EQ(signals[1].mean[50], 110);
  EXPECT_DOUBLE_EQ(signals[1].deviation[50], std::sqrt(200.0));
  EXPECT_TRUE(reference_signals({}).empty());
}

}  // namespace
}  // namespace marey::analyse::gait
