#include "marey/evaluate/game_state_evaluation.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace marey::evaluate {
namespace {

/// Two players who stand ten metres apart for ten images.
std::vector<PitchPerson> two_players() {
  std::vector<PitchPerson> people;
  for (int frame = 0; frame < 10; ++frame) {
    people.push_back({frame, 1, {0, 0}, PitchRole::player, PitchTeam::left, "7"});
    people.push_back({frame, 2, {10, 0}, PitchRole::player, PitchTeam::right, "9"});
  }
  return people;
}

TEST(GameStateEvaluation, TheTruthItselfIsPerfect) {
  const auto truth = two_players();
  const GameStateEvaluation result = evaluate_game_state(truth, truth);
  EXPECT_NEAR(result.gs_hota().hota, 1, 1e-12);
  EXPECT_NEAR(result.gs_hota().localisation, 1, 1e-12);
  EXPECT_EQ(result.true_people, 20);
}

TEST(GameStateEvaluation, EachDetailIsAskedFor) {
  const auto truth = two_players();
  auto tracks = truth;
  for (PitchPerson& person : tracks) {
    if (person.id == 1) person.jersey = "8";
    if (person.id == 2) person.team = PitchTeam::left;
  }
  const GameStateEvaluation result = evaluate_game_state(truth, tracks);
  EXPECT_NEAR(result.scores(GameStateDetail::positions).hota, 1, 1e-12);
  EXPECT_NEAR(result.scores(GameStateDetail::roles).hota, 1, 1e-12);
  // One of two is right: DetA = 10 / 30, AssA = 1.
  EXPECT_NEAR(result.scores(GameStateDetail::teams).hota, std::sqrt(1.0 / 3), 1e-12);
  EXPECT_EQ(result.gs_hota().hota, 0);
  for (PitchPerson& person : tracks) person.role = PitchRole::other;
  EXPECT_EQ(evaluate_game_state(truth, tracks).scores(GameStateDetail::roles).hota, 0);
}

TEST(GameStateEvaluation, FiveMetresAreAlikeByATwentieth) {
  const std::vector<PitchPerson> truth{{0, 1, {0, 0}, PitchRole::referee, PitchTeam::none, ""}};
  auto tracks = truth;
  for (const auto& [distance, levels] : {std::pair(4.999, 1), std::pair(5.001, 0), std::pair(0.5, 19)}) {
    tracks[0].location = {0.6 * distance, 0.8 * distance};
    const double hota = evaluate_game_state(truth, tracks).gs_hota().hota;
    EXPECT_NEAR(hota, levels / 19.0, 1e-12) << distance;
  }
}

TEST(GameStateEvaluation, ClipsAddUp) {
  const auto truth = two_players();
  GameStateEvaluation all = evaluate_game_state(truth, truth);
  all += evaluate_game_state(truth, {});
  // Half of the true places were found, all under one name: DetA = 20 / 40 and AssA = 1 at every level.
  EXPECT_NEAR(all.gs_hota().hota, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(all.gs_hota().association, 1, 1e-12);
  EXPECT_NEAR(all.gs_hota().detection_precision, 1, 1e-12);
}

}  // namespace
}  // namespace marey::evaluate
