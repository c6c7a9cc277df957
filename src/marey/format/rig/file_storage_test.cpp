#include "marey/format/rig/file_storage.h"

#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/core/persistence.hpp>

#include "marey/core/error.h"

namespace marey::format::rig {
namespace {

using Json = nlohmann::json;

Json parsed(const std::string& text) {
  return parse_file_storage(text, "file");
}

std::string message(const std::string& text) {
  try {
    parsed(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

TEST(FileStorage, ReadsWhatPeopleWrite) {
  const std::string text = R"(%YAML:1.0
# a comment
---
width: 640   # px
name: "a \"b\" # no comment"
other: 'it''s'
plain: some words: and more
nothing:
numbers: [ 1, -2.5e-3,
    .5, 600., +3 ]
matrix: !!opencv-matrix
   rows: 1
   cols: 2
   dt: d
   data: [ 1., 2. ]
cameras:
   -
      name: a
      size: { w:3, "h": 4 }
   - name: b
     K: [ [ 1, 2 ], [ 3, 4 ] ]
   - 7
list:
- 1
- - 2
  - 3
infinite: [ .Inf, -.Inf ]
)";
  const Json file = parsed(text);
  EXPECT_EQ(file["width"], 640);
  EXPECT_EQ(file["name"], "a \"b\" # no comment");
  EXPECT_EQ(file["other"], "it's");
  EXPECT_EQ(file["plain"], "some words: and more");
  EXPECT_TRUE(file["nothing"].is_null());
  EXPECT_EQ(file["numbers"], Json({1., -2.5e-3, .5, 600., 3.}));
  EXPECT_EQ(file["matrix"]["data"], Json({1., 2.}));
  EXPECT_EQ(file["cameras"][0]["size"]["w"], 3);
  EXPECT_EQ(file["cameras"][0]["size"]["h"], 4);
  EXPECT_EQ(file["cameras"][1]["name"], "b");
  EXPECT_EQ(file["cameras"][1]["K"], Json({{1, 2}, {3, 4}}));
  EXPECT_EQ(file["cameras"][2], 7);
  EXPECT_EQ(file["list"], Json({1, {2, 3}}));
  EXPECT_TRUE(std::isinf(file["infinite"][1].get<double>()));
  EXPECT_EQ(parsed("{\"a\": [1, 2.,\n 3], \"b\": {\"c\": \"\\u00e9\\n\"}}"), Json({{"a", {1, 2, 3}}, {"b", {{"c", "é\n"}}}}));
  EXPECT_EQ(parsed("<?xml version=\"1.0\"?>\n<opencv_storage><a>1 2.\n3</a><b>\"x "
                   "y\"</b><c><_>1</_><_><d>z</d></_></c><e/></opencv_storage>"),
            Json({{"a", {1, 2, 3}}, {"b", "x y"}, {"c", {1, {{"d", "z"}}}}, {"e", nullptr}}));
}

TEST(FileStorage, SaysWhatIsWrongWhere) {
  EXPECT_EQ(message(""), "file:1: holds nothing");
  EXPECT_EQ(message("%YAML:1.0\n---\na: 1\na: 2\n"), "file:4: \"a\" is there twice");
  EXPECT_EQ(message("a: 1\n  b: 2\n"), "file:2: stands further in than what it belongs to");
  EXPECT_EQ(message("a: [ 1, 2\n"), "file:2: \",\" or \"]\" must stand here");
  EXPECT_EQ(message("a: [ 1,\n"), "file:2: \"]\" is missing; the file is cut off");
  EXPECT_EQ(message("a: \"b\n"), "file:1: a quoted text does not end on its line");
  EXPECT_EQ(message("a: [ 1 ] 2\n"), "file:1: something follows where a value has ended");
  EXPECT_EQ(message("  a: 1\nb: 2\n"), "file:2: another value follows where the file's value has ended");
  EXPECT_EQ(message("a: \"\\ud800\"\n"), "file:1: an escape in a quoted text is not one that is known");
  EXPECT_EQ(message("a: 1\nb\n"), "file:2: a name with a colon and a value must stand here");
  EXPECT_EQ(message("a: &b 1\n"), "file:1: \"&\" begins nothing that a calibration holds");
}

// OpenCV 4.6 never comes back from this one.
TEST(FileStorage, RefusesWhatHoldsOpenCvForEver) {
  const std::string text =
      "%YAML:1.h: 640 \n      image_height: 40\n0,---\ncameras:\n   -<a>\n      name: a\n      imaga\n      image_width: 640\n "
      "e_width: "
      "640\n      image_height: 480\n      camera_matrix1e-320: [ 600., 0., 320., 0., 600., 240., 0., 0., 1. ]\n      rotation: [ "
      "0.1, "
      "0.2, 0.3 ]";
  EXPECT_EQ(message(text), "file:3: another value follows where the file's value has ended");
}

TEST(FileStorage, DepthIsBounded) {
  const auto times = [](std::string_view text, int count) {
    std::string result;
    for (int i = 0; i < count; ++i) result += text;
    return result;
  };
  std::string stairs;
  for (int i = 0; i < 200; ++i) stairs += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
  for (const std::string& text : {"a: " + times("[", 200'000), times("- ", 200'000), stairs, times("{a:", 200'000),
                                  "<opencv_storage>" + times("<a>", 200'000)})
    EXPECT_NE(message(text).find("nested more than"), std::string::npos) << text.substr(0, 20) << message(text);
  EXPECT_EQ(message("a: " + times("[", 90) + times("]", 90)), "none");
}

/// Both readers of one text, for numbers, lists and matrices.
bool same(const Json& ours, const cv::FileNode& theirs) {
  if (theirs.isSeq() != ours.is_array() || theirs.isMap() != ours.is_object()) return false;
  if (theirs.isString()) return ours == theirs.string();
  if (theirs.isInt() || theirs.isReal()) return ours.is_number() && ours.get<double>() == theirs.real();
  if (theirs.size() != ours.size()) return false;
  if (theirs.isMap()) {
    for (const auto& each : ours.items()) {
      if (!same(each.value(), theirs[each.key()])) return false;
    }
  }
  for (std::size_t i = 0; ours.is_array() && i < ours.size(); ++i) {
    if (!same(ours[i], theirs[static_cast<int>(i)])) return false;
  }
  return true;
}

void write_something(cv::FileStorage& file, std::mt19937& random) {
  const auto number = [&] { return std::normal_distribution(0.0, std::pow(10.0, static_cast<double>(random() % 9) - 4))(random); };
  for (unsigned i = 0, count = 1 + random() % 4; i < count; ++i) {
    file << "key" + std::to_string(i);
    switch (random() % 5) {
      case 0:
        file << number();
        break;
      case 1:
        file << static_cast<int>(random() % 1000) - 500;
        break;
      case 2: {
        cv::Mat_<double> matrix(1 + static_cast<int>(random() % 5), 2 + static_cast<int>(random() % 4));
        for (double& each : matrix) each = number();
        file << matrix;
        break;
      }
      case 3:
        file << std::string(random() % 2 == 0 ? "a word" : "x\"y: [z], #w'");
        break;
      default:
        file << "["
             << "{" << "a" << number() << "b" << std::vector<double>{number(), number()} << "}" << number() << "]";
    }
  }
}

TEST(FileStorage, ReadsWhatOpenCvWritesAsOpenCvDoes) {
  const unsigned seed = std::random_device()();
  std::mt19937 random(seed);
  for (int round = 0; round < 300; ++round) {
    const std::string ending = std::array{".yml", ".json", ".xml"}[static_cast<std::size_t>(round % 3)];
    cv::FileStorage file(ending, cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    write_something(file, random);
    const std::string text = file.releaseAndGetString();
    const cv::FileStorage theirs(text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
    Json ours = parsed(text);
    ASSERT_EQ(ours.size(), theirs.root().size());
    for (const auto& each : ours.items()) {
      ASSERT_TRUE(same(each.value(), theirs[each.key()])) << "seed " << seed << '\n'
                                                          << each.key() << ": " << each.value() << '\n'
                                                          << text;
    }
  }
}

TEST(FileStorage, AnyBytesEndInAValueOrOneError) {
  const unsigned seed = std::random_device()();
  std::mt19937 random(seed);
  const std::string letters = "ab: -\n[]{},\"'#!%.\\1e<>/_\t\r";
  for (int round = 0; round < 20000; ++round) {
    std::string text = round % 2 == 0 ? "%YAML:1.0\n---\n" : "";
    for (unsigned i = 0, size = random() % 60; i < size; ++i) text += letters[random() % letters.size()];
    const std::string stated = message(text);
    ASSERT_TRUE(stated == "none" || stated.starts_with("file")) << "seed " << seed << '\n' << text;
  }
}

}  // namespace
}  // namespace marey::format::rig
