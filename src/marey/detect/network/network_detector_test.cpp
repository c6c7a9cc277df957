#include "marey/detect/network/network_detector.h"

#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "marey/core/error.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::detect::network {
namespace {

std::string person_network() {
  return test::data("models/person_ssd_mobilenetv2.onnx");
}

std::string refused_model(const std::string& text) {
  try {
    parse_network_model(text, "model.toml");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string refused_detector(const std::string& path) {
  try {
    NetworkDetectorOptions options;
    options.model = path;
    NetworkDetector detector(options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(NetworkModel, SaysWhatItsFileSays) {
  const NetworkModel model = parse_network_model(
      "network = \"n.onnx\"\ninput = [300, 200]\nlayout = \"yolox\"\ncolours = \"bgr\"\nmean = [1, 2, 3]\nperson = 4\nscore = "
      "0.3\n",
      "folder/model.toml");
  EXPECT_EQ(model.network, "folder/n.onnx");
  EXPECT_EQ(model.input, cv::Size(300, 200));
  EXPECT_EQ(model.layout, Layout::yolox);
  EXPECT_EQ(model.rgb, false);
  EXPECT_EQ((*model.mean)[2], 3);
  EXPECT_EQ(model.person, 4);
  EXPECT_FALSE(model.scale);
}

TEST(NetworkModel, ReportsAnErrorOfItsFileWithTheLine) {
  EXPECT_EQ(refused_model("input = [300, 300]\n"), "model.toml:1: network is missing: the ONNX file, beside this one");
  EXPECT_EQ(refused_model("network = \"n.onnx\"\n"),
            "model.toml:1: input is missing: [width, height] in px of the image that the network wants");
  EXPECT_EQ(refused_model("network = \"n.onnx\"\ninput = [300, 300]\nlayout = \"yolo\"\n"),
            "model.toml:3: layout must be one of ssd_raw, ssd, yolov5, yolox, yolov8, suppressed, nanodet, rt_detr, rf_detr");
  EXPECT_EQ(refused_model("network = \"n.onnx\"\ninput = [300]\n"), "model.toml:2: input must be a list of 2 numbers");
  EXPECT_NE(refused_model("netwrok = \"n.onnx\"\n").find("netwrok is not a setting of a model"), std::string::npos);
  EXPECT_NE(refused_model("network = ").find("model.toml:1:"), std::string::npos);
}

TEST(NetworkDetector, AnUnusableNetworkIsOneSentence) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(refused_detector(folder / "none.toml"),
            fmt::format("{}: cannot be read; give the TOML file that describes a detection network (docs/network.md)",
                        folder / "none.toml"));
  test::write_file(folder / "model.toml", "network = \"n.onnx\"\ninput = [300, 300]\n");
  EXPECT_EQ(refused_detector(folder / "model.toml"),
            fmt::format("{}: its network {} is not there", folder / "model.toml", folder / "n.onnx"));
  test::write_file(folder / "n.onnx", "no network");
  const std::string message_text = refused_detector(folder / "model.toml");
  EXPECT_NE(message_text.find("cannot be loaded as an ONNX network"), std::string::npos) << message_text;
  EXPECT_EQ(message_text.find('\n'), std::string::npos) << message_text;
}

TEST(NetworkDetector, TellsTheLayoutOfARealNetworkAndSeesNobodyOnGrey) {
  if (!std::filesystem::exists(person_network())) GTEST_SKIP() << person_network() << " is not here";
  NetworkModel model =
      parse_network_model(fmt::format("network = \"{}\"\ninput = [300, 300]\nperson = 4\n", person_network()), "model.toml");
  LoadedNetwork network(model);
  EXPECT_EQ(network.layout(), Layout::ssd_raw);
  EXPECT_TRUE(network.find(cv::Mat(400, 600, CV_8UC3, cv::Scalar(90, 120, 110))).empty());
  model.input = {200, 200};
  EXPECT_THROW(LoadedNetwork{model}, Error) << "it wants 300 x 300";
}

}  // namespace
}  // namespace marey::detect::network
