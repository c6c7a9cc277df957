#include <gtest/gtest.h>

#include "marey/pipeline/jobs/batch.h"
#include "marey/pipeline/jobs/register.h"
#include "marey/pipeline/jobs/solve.h"
#include "marey/pipeline/jobs/track_ground.h"
#include "marey/pipeline/jobs/track_image.h"

namespace marey::pipeline::jobs {
namespace {

using Association = track::ground::GroundAssociation;

std::string refusal(const std::function<void()>& run) {
  try {
    run();
  } catch (const WrongOption& error) {
    return error.what();
  }
  return "";
}

Rig detections_only() {
  Rig rig;
  rig.cameras.emplace_back().detections = "left.txt";
  return rig;
}

Rig with_images() {
  Rig rig;
  rig.cameras.emplace_back().source = "left.mp4";
  return rig;
}

TEST(Table, SetsTheBoundMemberAndStatesCanonicalText) {
  double margin = 2;
  std::optional<int> order;
  bool smooth = true;
  std::string path;
  Table table;
  table.number("margin", margin, "m", closed(0, 10), "margin");
  table.whole("spline-order", order, "N", 2, 8, "spline-order");
  table.flag("no-smooth", smooth, "no smoothing", false);
  table.input_file("labels", path, "labels");
  table.always("targets", "markers");
  EXPECT_EQ(table.find("margin")->fallback, "2");
  EXPECT_EQ(table.find("margin")->value, "m in [0, 10]");
  table.find("margin")->set("2.50");
  table.find("spline-order")->set("3");
  table.find("no-smooth")->set("true");
  table.find("labels")->set("names.txt");
  EXPECT_EQ(margin, 2.5);
  EXPECT_EQ(order, 3);
  EXPECT_FALSE(smooth);
  EXPECT_EQ(table.given(), (std::map<std::string, std::string>{
                               {"margin", "2.5"}, {"spline-order", "3"}, {"no-smooth", "true"}, {"targets", "markers"}}));
  EXPECT_EQ(table.files(false), std::vector<std::string>{"names.txt"});
  EXPECT_TRUE(table.files(true).empty());
  EXPECT_EQ(table.find("margins"), nullptr);
}

TEST(Table, RefusesTextsOutsideTheDomain) {
  double margin = 2;
  std::string model = "full";
  Table table;
  table.number("margin", margin, "m", closed(0, 10), "margin");
  table.choice("model", model, {"lite", "full"}, "model");
  table.text("plot", model, "plot").ending_in({".svg"});
  EXPECT_NE(refusal([&] { table.find("margin")->set("11"); }).find("give m in [0, 10]"), std::string::npos);
  EXPECT_NE(refusal([&] { table.find("margin")->set("nan"); }), "");
  EXPECT_NE(refusal([&] { table.find("model")->set("heavy"); }).find("lite, full"), std::string::npos);
  EXPECT_NE(refusal([&] { table.find("plot")->set("plot.png"); }).find(".svg"), std::string::npos);
  EXPECT_EQ(margin, 2);
  EXPECT_FALSE(table.find("margin")->given);
}

TEST(Table, RefusesAnOptionWithoutTheOneThatItNeeds) {
  bool outline = false;
  std::optional<int> lines;
  Table table;
  table.flag("contour", outline, "contour");
  table.whole("measurement-lines", lines, "N", 1, 8, "measurement-lines").needing("contour");
  table.find("measurement-lines")->set("4");
  EXPECT_EQ(refusal([&] { table.check_needs(); }), "--measurement-lines requires --contour");
  table.find("contour")->set("true");
  EXPECT_EQ(refusal([&] { table.check_needs(); }), "");
}

TEST(Table, TextsAreAdded) {
  std::vector<std::string> labels;
  Table table;
  table.texts("exclude", labels, "exclude");
  table.find("exclude")->set("LANK");
  table.find("exclude")->set("RANK");
  EXPECT_EQ(labels, (std::vector<std::string>{"LANK", "RANK"}));
  EXPECT_EQ(table.given().at("exclude"), "LANK,RANK");
}

TEST(Solve, ResolvesNamesAndRefusesTwoSkeletons) {
  Solve job{.up = "y", .bvh_up = "z"};
  job.options.bones.rig_names = "mixamo";
  const bodies::SolveOptions options = resolved(job);
  EXPECT_EQ(options.up, format::UpAxis::y);
  EXPECT_EQ(options.bones.bvh_up, format::UpAxis::z);
  EXPECT_EQ(options.bones.rig_names, "mixamo");
  EXPECT_FALSE(resolved(Solve{}).up.has_value());
  job.skeleton = "person.toml";
  job.options.static_trial = "standing.c3d";
  EXPECT_NE(refusal([&] { resolved(job); }).find("--static-trial"), std::string::npos);
  job.options.static_trial.clear();
  job.options.marker_set = "cmu-41";
  EXPECT_NE(refusal([&] { resolved(job); }).find("--marker-set"), std::string::npos);
}

TEST(Batch, WordsOfATaskAreCanonical) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(canonical_words("track", {"--rate=20.0", "--measured-only", "--json"}),
            (Words{"--rate", "20", "--measured-only", "--json"}));
  EXPECT_EQ(canonical_words("track", {"--rate", "2e1", "--measured-only", "--json"}),
            (Words{"--rate", "20", "--measured-only", "--json"}));
  EXPECT_EQ(canonical_words("track", {"--targets", "markers", "--threshold", "60.50"}),
            (Words{"--targets", "markers", "--threshold", "60.5"}));
  EXPECT_EQ(canonical_words("ground", {"--association", "jpda"}), (Words{"--association", "jpda"}));
  EXPECT_EQ(canonical_words("measure", {"--rate=x"}), (Words{"--rate=x"}));
  EXPECT_EQ(canonical_words("track", {"--targets=cars", "--rate=x"}), (Words{"--targets=cars", "--rate=x"}));
  EXPECT_NE(refusal([] { canonical_words("track", {"--rate", "fast"}); }).find("--rate: "), std::string::npos);
  EXPECT_NE(refusal([] { canonical_words("ground", {"--association=all"}); }).find("mht"), std::string::npos);
  EXPECT_NE(refusal([] { canonical_words("track", {"--rate"}); }).find("--rate: has no value"), std::string::npos);
}

TEST(Jobs, DescribeEachOptionOnceWithHelpAndExistingReferences) {
  for (const std::string& job : job_names()) {
    with_table(job, [&](Table& table) {
      std::map<std::string, int> count;
      for (const Option& option : table.options()) ++count[option.name];
      for (const Option& option : table.options()) {
        EXPECT_EQ(count[option.name], 1) << job << " " << option.name;
        EXPECT_GT(option.help.size(), 10u) << job << " " << option.name;
        EXPECT_TRUE(option.needs.empty() || option.needs == "ground" || table.find(option.needs) != nullptr)
            << job << " " << option.name;
        for (const std::string& other : option.depends)
          EXPECT_TRUE(job == "live" || table.find(other) != nullptr) << job << " " << option.name << " " << other;
      }
    });
  }
  EXPECT_THROW(with_table("track cars", [](Table&) {}), Error);
}

TEST(TrackGround, ResolvesDefaultsThatDependOnOthers) {
  EXPECT_EQ(resolved(TrackGround{}, with_images()).tracker.associate, Association::mht);
  EXPECT_FALSE(resolved(TrackGround{}, with_images()).learn.association);
  EXPECT_TRUE(resolved(TrackGround{}, detections_only()).learn.association);
  EXPECT_TRUE(resolved(TrackGround{}, with_images()).learn.walk);
  TrackGround live;
  live.options.live = true;
  EXPECT_EQ(resolved(live, with_images()).tracker.associate, Association::gnn);
  EXPECT_FALSE(resolved(TrackGround{.filter = "kalman"}, with_images()).learn.walk);
  const TrackGround jpda{.ground = {.size = "", .area = "", .teams = "", .association = "jpda", .margin = {}}};
  EXPECT_EQ(resolved(jpda, detections_only()).tracker.associate, Association::jpda);
  EXPECT_FALSE(resolved(jpda, detections_only()).learn.association);
  Rig over_pitch = with_images();
  over_pitch.calibration.emplace().method = "pitch";
  EXPECT_TRUE(resolved(TrackGround{}, over_pitch).pitch.has_value());
  EXPECT_FALSE(resolved(TrackGround{}, with_images()).pitch.has_value());
}

TEST(TrackGround, RefusesOptionsThatExcludeEachOther) {
  TrackGround live_ball{.ball = true};
  live_ball.options.live = true;
  EXPECT_NE(refusal([&] { resolved(live_ball, with_images()); }).find("--ball"), std::string::npos);
  TrackGround margin{.rig_name = "rig.toml"};
  margin.ground.margin = 1;
  EXPECT_NE(refusal([&] { resolved(margin, with_images()); }).find("rig.toml"), std::string::npos);
  margin.ground.size = "20x10";
  EXPECT_EQ(resolved(margin, with_images()).margin, 1);
  EXPECT_EQ(resolved(margin, with_images()).area.size(), 4u);
}

TEST(TrackPeople, RefusesOptionsThatExcludeEachOther) {
  EXPECT_NE(refusal([] { resolved(TrackPeople{.delay = 1}); }).find("--live"), std::string::npos);
  EXPECT_NE(refusal([] { resolved(TrackPeople{.detection = {.network = "", .every = 2}}); }).find("requires --detector"),
            std::string::npos);
  EXPECT_NE(refusal([] { resolved(TrackPeople{.outline = true, .control_points = 3}); }).find("--control-points 3"),
            std::string::npos);
  EXPECT_EQ(resolved(TrackPeople{.outline = true, .control_points = 12, .order = 3}).outlines->order, 3);
}

}  // namespace
}  // namespace marey::pipeline::jobs
