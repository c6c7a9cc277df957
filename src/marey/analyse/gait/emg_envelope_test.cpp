#include "marey/analyse/gait/emg_envelope.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace marey::analyse::gait {
namespace {

constexpr unsigned kEmgSeed = 38;

TEST(EmgEnvelope, FollowsTheActivityAndIgnoresOffsetAndCables) {
  constexpr double kEmgRate = 1000;
  std::mt19937 random(kEmgSeed);
  std::normal_distribution<double> noise;
  std::vector<double> signal;
  for (int i = 0; i < 4000; ++i) {
    const double time = i / kEmgRate, activity = 0.5 + 0.5 * std::sin(2 * std::numbers::pi * time);
    signal.push_back(0.7 + 0.4 * std::sin(2 * std::numbers::pi * 1.3 * time) + 1e-3 * activity * noise(random));
  }
  const std::vector<double> envelope = emg_envelope(signal, kEmgRate);
  double squares = 0, count = 0;
  for (std::size_t i = 300; i + 300 < envelope.size(); ++i) {
    const double activity = 0.5 + 0.5 * std::sin(2 * std::numbers::pi * static_cast<double>(i) / kEmgRate);
    squares += std::pow(envelope[i] / 1e-3 - activity * std::sqrt(2 / std::numbers::pi), 2);
    ++count;
  }
  EXPECT_LT(std::sqrt(squares / count), 0.1) << "of an activity of 1, seed " << kEmgSeed;
  EXPECT_TRUE(emg_envelope(signal, 50).empty());
}

TEST(EmgEnvelope, FindsTheSideOfALabel) {
  for (const char* label : {"Voltage.L Rect", "LGast", "left_tibialis", "TA_L"})
    EXPECT_EQ(side_of_label(label), Side::left) << label;
  for (const char* label : {"Voltage.R Tib Ant", "RVastusLat", "RIGHT HAM", "Gast R"})
    EXPECT_EQ(side_of_label(label), Side::right) << label;
  for (const char* label : {"", "Rectus", "Lateral", "EMG1", "Trigger"}) EXPECT_FALSE(side_of_label(label)) << label;
}

TEST(EmgEnvelope, IsTakenOverTheCyclesOfItsSide) {
  std::vector<double> envelope(3000);
  for (std::size_t i = 0; i < envelope.size(); ++i) envelope[i] = static_cast<double>(i);
  const std::vector<GaitCycles::Cycle> cycles = {
      {Side::left, 0.5, 1.5, {}}, {Side::right, 1, 2, {}}, {Side::left, 1.5, 2.5, {}}, {Side::left, 2.5, 3.5, {}}};
  const SignalCurve curve = signal_over_cycles("L", Side::left, envelope, 1000, 0.25, cycles);
  ASSERT_EQ(curve.cycles.size(), 2U) << "the last ends after the signal";
  EXPECT_NEAR(curve.cycles[0][0], 250, 1e-9);
  EXPECT_NEAR(curve.cycles[1][100], 2250, 1e-9);
  EXPECT_NEAR(curve.mean[50], 1250, 1e-9);
}

}  // namespace
}  // namespace marey::analyse::gait
