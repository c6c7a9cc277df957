#include "marey/format/match/game_state.h"

#include <functional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/match/ground_match.h"

namespace marey::format::match {
namespace {

std::string person(const std::string& image, int track, const std::string& role, const std::string& team,
                   const std::string& jersey) {
  return fmt::format(
      R"({{"image_id":"{}","track_id":{},"supercategory":"object","category_id":1,"attributes":{{"role":"{}","team":{},)"
      R"("jersey":{}}},"bbox_pitch":{{"x_bottom_middle":1.5,"y_bottom_middle":-2}}}})",
      image, track, role, team, jersey);
}

std::string predictions(const std::vector<std::string>& people) {
  return fmt::format("{{\"predictions\":[{}]}}", fmt::join(people, ","));
}

std::string truth(const std::vector<std::string>& people) {
  return fmt::format(
      R"({{"images":[{{"image_id":"2021000001","has_labeled_person":true,"has_labeled_pitch":true,"has_labeled_camera":true}},)"
      R"({{"image_id":"2021000002","has_labeled_person":false,"has_labeled_pitch":true,"has_labeled_camera":true}},)"
      R"({{"image_id":"2021000003","has_labeled_person":true,"has_labeled_pitch":true,"has_labeled_camera":true}}],)"
      "\"annotations\":[{}]}}",
      fmt::join(people, ","));
}

std::string stated(const std::function<void()>& read) {
  try {
    read();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

const LabelledImages kImages{2021, {0, 2}};

TEST(GameState, TheTruthKnowsItsLabelledImages) {
  const TrueGameState found = parse_true_game_state(
      truth({person("2021000003", 4, "player", "\"left\"", "\"7\""), person("2021000001", 5, "goalkeeper", "\"right\"", "\"1\""),
             person("2021000002", 6, "referee", "null", "null"), person("2021000001", 7, "ball", "null", "null")}),
      "t.json");
  EXPECT_EQ(found.images.frames, (std::vector<std::int32_t>{0, 2}));
  ASSERT_EQ(found.state.people.size(), 2U);
  EXPECT_EQ(found.state.people[0].role, PitchRole::goalkeeper);
  EXPECT_EQ(found.state.people[0].jersey, "") << "numbers of goalkeepers are not compared";
  EXPECT_EQ(found.state.people[1].frame, 2);
  EXPECT_EQ(found.state.people[1].jersey, "7");
  EXPECT_EQ(found.state.people[1].location, Vector<2>(1.5, -2));
}

TEST(GameState, PredictionsAreOfTheTruthsImages) {
  const std::string text =
      predictions({person("2021000001", 1, "player", "null", "null"), person("1000000003", 2, "player", "null", "null"),
                   person("0002", 3, "other", "null", "null"), person("3021000001", 4, "player", "null", "null"),
                   person("2021000002", 5, "player", "null", "null")});
  const GameState found = parse_predicted_game_state(text, "p.json", kImages);
  ASSERT_EQ(found.people.size(), 3U) << "not those of another clip and of an image without labels";
  EXPECT_EQ(found.people[1].frame, 2) << "Marey's ids name no clip";
  EXPECT_EQ(found.people[2].frame, 2) << "short ids count from 0";
  const GameState none =
      parse_predicted_game_state(predictions({person("3021000001", 4, "player", "null", "null")}), "p.json", kImages);
  ASSERT_EQ(none.warnings.size(), 1U);
  EXPECT_NE(none.warnings[0].find("begin with 2021"), std::string::npos) << none.warnings[0];
}

TEST(GameState, NamesEntriesThatCannotBeEvaluated) {
  const auto message = [&](const std::string& one) {
    return stated([&] { parse_predicted_game_state(predictions({one}), "p.json", kImages); });
  };
  const std::string image = "2021000001";
  EXPECT_EQ(message(person(image, 1, "goalie", "null", "null")),
            "p.json: person 1 of the list has the role \"goalie\"; a game state has player, goalkeeper, referee, other and ball");
  EXPECT_NE(message(person(image, 1, "player", "\"red\"", "null")).find("the team \"red\"; a game state has left and right"),
            std::string::npos);
  EXPECT_NE(message(person(image, 1, "player", "null", "\"7a\"")).find("the shirt number \"7a\""), std::string::npos);
  EXPECT_NE(message(person("x", 1, "player", "null", "null")).find("image_id \"x\""), std::string::npos);
  EXPECT_NE(message(person(image, -1, "player", "null", "null")).find("track_id"), std::string::npos);
  EXPECT_NE(message("3").find("is not an object"), std::string::npos);
  const std::string one = person(image, 1, "player", "null", "null");
  EXPECT_EQ(stated([&] { parse_predicted_game_state(predictions({one, one}), "p.json", kImages); }),
            "p.json: track 1 is twice in image 1");
  EXPECT_NE(stated([&] { parse_predicted_game_state(truth({one}), "p.json", kImages); }).find("this is the truth"),
            std::string::npos);
  EXPECT_NE(stated([&] { parse_true_game_state(predictions({one}), "p.json"); }).find("these are predictions"), std::string::npos);
  const std::string whole = truth({one});
  for (std::size_t length = 0; length < whole.size(); length += 7)
    EXPECT_NE(stated([&] { parse_true_game_state(whole.substr(0, length), "t.json"); }), "no error") << length;
}

TEST(GameState, TwoWithOneNumberAreTold) {
  const std::vector<std::string> people{
      person("2021000001", 3, "player", "\"left\"", "\"7\""), person("2021000001", 9, "player", "\"left\"", "\"7\""),
      person("2021000003", 3, "player", "\"left\"", "\"7\""), person("2021000003", 8, "player", "\"right\"", "\"7\"")};
  const std::string sentence = "p.json: 2 people of the team left have the number 7 (tracks 3, 9), in 1 image";
  const GameState found = parse_predicted_game_state(predictions(people), "p.json", kImages);
  ASSERT_EQ(found.warnings.size(), 1U);
  EXPECT_EQ(found.warnings[0], sentence);
  const GroundMatch match = parse_soccernet(predictions(people), "p.json", {});
  ASSERT_EQ(match.warnings.size(), 1U);
  EXPECT_EQ(match.warnings[0], "p.json: 2 people of the team left have the number 7 at one time (tracks 3, 9)");
  std::vector<std::string> more = people;
  for (const char* image : {"2021000001", "2021000003"}) {
    more.push_back(person(image, 11, "player", "\"right\"", "\"10\""));
    more.push_back(person(image, 12, "player", "\"right\"", "\"10\""));
  }
  const GameState both = parse_predicted_game_state(predictions(more), "p.json", kImages);
  ASSERT_EQ(both.warnings.size(), 1U) << "one sentence a file, of what is shared most";
  EXPECT_EQ(both.warnings[0],
            "p.json: 2 people of the team right have the number 10 (tracks 11, 12), in 2 images; 1 more number is shared by people "
            "of one team");
  const GroundMatch odd = parse_soccernet(predictions({person("2021000001", 3, "goalie", "\"left\"", "\"7\"")}), "p.json", {});
  ASSERT_EQ(odd.warnings.size(), 1U);
  EXPECT_EQ(odd.warnings[0], "p.json: the role \"goalie\" of 1 entries is unknown; their people are read without one");
}

}  // namespace
}  // namespace marey::format::match
