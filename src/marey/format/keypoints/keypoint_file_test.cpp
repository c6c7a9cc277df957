#include "marey/format/keypoints/keypoint_file.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/core/keypoint_sets.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::format::keypoints {
namespace {

class KeypointFile : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
    return path.string();
  }
  std::string error_of(const std::string& path, std::string_view set = {}) {
    try {
      read_keypoints(path, set);
    } catch (const Error& error) {
      EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
      EXPECT_NE(std::string_view(error.what()).find(path.substr(0, path.find_last_of('.'))), std::string_view::npos)
          << error.what();
      return error.what();
    }
    return "";
  }
  /// `count` points as x, y, confidence; point i at (10 i, 5 i).
  static std::string triples(int count, double confidence = 0.9) {
    std::string text = "[";
    for (int i = 0; i < count; ++i)
      text += (i > 0 ? "," : "") + std::to_string(10 * i) + "," + std::to_string(5 * i) + "," + std::to_string(confidence);
    return text + "]";
  }

  test::TemporaryFolder folder_;
};

TEST_F(KeypointFile, ReadsAFolderOfOpenPoseByFrameNumber) {
  write("cam/video_000000000003_keypoints.json", R"({"people":[{"pose_keypoints_2d":)" + triples(18) + "}]}");
  write("cam/video_000000000001_keypoints.json", R"({"people":[]})");
  const KeypointSequence read = read_keypoints(folder_ / "cam");
  EXPECT_EQ(read.set.name, "coco_18");
  ASSERT_EQ(read.frames.size(), 4U);
  EXPECT_TRUE(read.frames[1].empty());
  ASSERT_EQ(read.frames[3].size(), 1U);
  const auto& point = read.frames[3][0].points[2];
  ASSERT_TRUE(point);
  EXPECT_EQ(point->position, Vector<2>(20, 10));
  EXPECT_NEAR(point->visibility, 0.9, 1e-6);
}

TEST_F(KeypointFile, TakesPointsWithoutConfidenceForAbsent) {
  const KeypointSequence read = read_keypoints(write(
      "one.json", R"([{"image_id":2,"score":2.5,"keypoints":)" + triples(16).substr(0, triples(16).size() - 1) + ",7,8,0]}]"));
  EXPECT_EQ(read.set.name, "coco");
  ASSERT_EQ(read.frames.size(), 3U);
  EXPECT_FALSE(read.frames[2][0].points[16]);
  EXPECT_TRUE(read.frames[2][0].points[15]);
  EXPECT_EQ(read.frames[2][0].presence, 1) << "AlphaPose's scores exceed 1";
}

TEST_F(KeypointFile, WritesCocoAndReadsItAgain) {
  KeypointSequence written;
  written.set = keypoint_set_named("halpe_26");
  written.size = cv::Size(1080, 1920);
  written.rate_hz = 50;
  written.frames.resize(4);
  Keypoints<2> person;
  person.points.resize(26);
  person.presence = 0.75;
  for (int i = 0; i < 25; ++i)
    person.points[static_cast<std::size_t>(i)] = Keypoint<2>{.position = {3.25 * i, 7.5 * i}, .visibility = 0.5};
  written.frames[1] = {person, person};
  const std::string path = folder_ / "cam.json";
  write_coco_keypoints(written, path);
  const KeypointSequence read = read_keypoints(path);
  EXPECT_EQ(read.set, written.set);
  EXPECT_EQ(read.size, written.size);
  EXPECT_EQ(read.rate_hz, written.rate_hz);
  ASSERT_EQ(read.frames.size(), 4U) << "frames without people count";
  ASSERT_EQ(read.frames[1].size(), 2U);
  EXPECT_EQ(read.frames[1][0].presence, 0.75);
  EXPECT_EQ(read.frames[1][0].points[24]->position, person.points[24]->position);
  EXPECT_FALSE(read.frames[1][0].points[25]);
}

TEST_F(KeypointFile, ReadsMmpose) {
  const KeypointSequence read =
      read_keypoints(write("mm.json", R"({"meta_info":{"keypoint_id2name":{"0":"nose","1":"left_eye","10":"r_knee"}},
      "instance_info":[{"frame_id":1,"instances":[{"keypoints":[[1,2],[3,4],[5,6]],"keypoint_scores":[0.5,0,0.9]}]}]})"));
  EXPECT_EQ(read.set.points, (std::vector<std::string>{"nose", "left_eye", "right_knee"}));
  ASSERT_EQ(read.frames.size(), 2U);
  EXPECT_FALSE(read.frames[1][0].points[1]);
  EXPECT_EQ(read.frames[1][0].points[2]->position, Vector<2>(5, 6));
}

TEST_F(KeypointFile, ReadsTablesOfDeepLabCutAndSleap) {
  const KeypointSequence dlc = read_keypoints(write("d.csv",
                                                    "scorer,s,s,s,s,s,s\nbodyparts,nose,nose,nose,LKnee,LKnee,LKnee\n"
                                                    "coords,x,y,likelihood,x,y,likelihood\n0,1,2,0.9,3,4,0.8\n1,,,,5,6,0.7\n"));
  EXPECT_EQ(dlc.set.points, (std::vector<std::string>{"nose", "left_knee"}));
  ASSERT_EQ(dlc.frames.size(), 2U);
  EXPECT_FALSE(dlc.frames[1][0].points[0]);
  EXPECT_EQ(dlc.frames[1][0].points[1]->position, Vector<2>(5, 6));
  const KeypointSequence sleap =
      read_keypoints(write("s.csv",
                           "track,frame_idx,instance.score,nose.x,nose.y,nose.score,l_knee.x,l_knee.y,l_knee.score\n"
                           ",4,0.5,1,2,0.9,nan,nan,\n"));
  EXPECT_EQ(sleap.set.points, (std::vector<std::string>{"nose", "left_knee"}));
  ASSERT_EQ(sleap.frames.size(), 5U);
  EXPECT_EQ(sleap.frames[4][0].presence, 0.5);
  EXPECT_FALSE(sleap.frames[4][0].points[1]);
}

TEST_F(KeypointFile, ReadsWhatMareyTracks) {
  const std::string line =
      R"({"frame":2,"time":0.04,"id":1,"keypoints":{"presence":0.9,"points":{"nose":[10,20,3,0.5,0.8],"left_foot_index":[11,90,4,1,1]}}})";
  const std::string csv =
      "frame,time,id,point,x,y,sd,visibility,presence\n2,0.04,1,nose,10,20,3,0.5,0.8\n2,0.04,1,left_foot_index,11,90,4,1,1\n";
  for (const std::string& path : {write("t.jsonl", R"({"frame":0,"time":0,"id":1})"
                                                   "\n" +
                                                       line + "\n"),
                                  write("t.csv", csv)}) {
    const KeypointSequence read = read_keypoints(path);
    EXPECT_EQ(read.set.name, "body_25") << "the smallest set with a nose and a big toe";
    ASSERT_EQ(read.frames.size(), 3U);
    ASSERT_EQ(read.frames[2].size(), 1U);
    const auto& nose = read.frames[2][0].points[0];
    ASSERT_TRUE(nose);
    EXPECT_NEAR(nose->visibility, 0.4, 1e-9);
    EXPECT_GT(nose->covariance(0, 0), 9) << "the network's own spread, and what networks are off besides";
    EXPECT_TRUE(read.frames[2][0].points[static_cast<std::size_t>(*point_named(read.set, "left_big_toe"))]);
  }
  EXPECT_NEAR(*read_keypoints(folder_ / "t.jsonl").rate_hz, 50, 1e-9);
  EXPECT_NE(error_of(write("cut.jsonl", line.substr(0, 70))).find("breaks off"), std::string::npos);
}

TEST_F(KeypointFile, RefusesWhatIsMalformedInOneSentence) {
  const std::string good = R"([{"image_id":0,"keypoints":)" + triples(17) + "}]";
  EXPECT_NE(error_of(write("truncated.json", good.substr(0, 60))).find("breaks off"), std::string::npos);
  EXPECT_NE(error_of(write("nan.json", R"([{"image_id":0,"keypoints":[NaN,1,1]}])")).find("NaN"), std::string::npos);
  EXPECT_NE(error_of(write("count.json", R"([{"image_id":0,"keypoints":)" + triples(19) + "}]")).find("19 points"),
            std::string::npos);
  EXPECT_NE(error_of(write("set.json", good), "body_25").find("body_25 has 25"), std::string::npos);
  EXPECT_NE(error_of(write("far.json", R"([{"image_id":0,"keypoints":[1e300,1,1]}])")).find("not a place"), std::string::npos);
  EXPECT_NE(error_of(write("other.json", R"({"cats":1})")).find("holds no keypoints"), std::string::npos);
  EXPECT_NE(error_of(write("kind.json", R"([{"image_id":0,"keypoints":"17"}])")).find("list of x, y"), std::string::npos);
  EXPECT_NE(error_of(write("number.json", R"([{"image_id":900000000000,"keypoints":)" + triples(17) +
                                              R"(},{"image_id":0,"keypoints":)" + triples(17) + "}]"))
                .find("must be wrong"),
            std::string::npos);
}

TEST_F(KeypointFile, KnowsTheSetOfRealOpenPose) {
  const std::string path = test::data("markerless/peer_2d/cam01_json");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  const KeypointSequence read = read_keypoints(path);
  EXPECT_EQ(read.set.name, "body_25b") << "BODY_25 has 25 points too";
  EXPECT_EQ(read.frames.size(), 100U);
  EXPECT_EQ(read.frames[0].size(), 2U);
}

}  // namespace
}  // namespace marey::format::keypoints
