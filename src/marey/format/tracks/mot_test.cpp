#include "marey/format/tracks/mot.h"

#include <random>

#include <gtest/gtest.h>

#include "marey/core/error.h"

#include "support/files.h"

namespace marey::format::tracks {
namespace {

std::vector<LabelledBox> parsed(std::string_view text, MotKind kind = MotKind::tracks) {
  return parse_mot(text, "t.txt", kind).boxes;
}

std::string error_of(std::string_view text, MotKind kind = MotKind::tracks) {
  try {
    parsed(text, kind);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Mot, CountsFromZeroInside) {
  const std::vector<LabelledBox> expected{{0, 3, {62, 152, 82, 288}, 0.5}};
  EXPECT_EQ(parsed("1,3,63,153,82,288,0.5,-1,-1,-1\n"), expected);
}

TEST(Mot, EveryWayToWriteALine) {
  const std::vector<LabelledBox> expected{{0, 3, {1.5, 2, 4, 5}, 1}};
  for (const char* text :
       {"1,3,2.5,3,4,5", "1,3,2.5,3,4,5\n", "1, 3, 2.5, 3, 4, 5, 1\r\n", "1 3 2.5 3 4 5\n", " 1\t3\t2.5\t3\t4\t5\t1 \n",
        "\xEF\xBB\xBF"
        "1,3,2.5,3,4,5\n",
        "\n\r\n   \n1,3,2.5,3,4,5,1,-1,-1,-1,car\n\n", "1.000e+00,3.0,+2.5,3e0,4.,5,1,\n"}) {
    EXPECT_EQ(parsed(text), expected) << text;
  }
  EXPECT_TRUE(parsed("").empty());
}

TEST(Mot, SortsFramesAndKeepsOrderWithin) {
  const auto boxes = parsed("2,1,1,1,1,1\n1,9,1,1,1,1\n2,0,1,1,1,1\n1,3,1,1,1,1\n");
  ASSERT_EQ(boxes.size(), 4U);
  EXPECT_EQ(boxes[0].id, 9);
  EXPECT_EQ(boxes[1].id, 3);
  EXPECT_EQ(boxes[2].id, 1);
  EXPECT_EQ(boxes[3].id, 0);
}

TEST(Mot, TruthTellsWhatMotChallengeDoesNotJudge) {
  const auto boxes = parsed("1,1,1,1,5,5,1\n1,2,1,1,5,5,0\n1,3,1,1,5,5\n", MotKind::truth);
  ASSERT_EQ(boxes.size(), 3U);
  EXPECT_NE(boxes[0].score, 0);
  EXPECT_EQ(boxes[1].score, 0);
  EXPECT_NE(boxes[2].score, 0);
}

TEST(Mot, DetectionsHaveNoIdsAndLoseEmptyBoxes) {
  const MotTable table =
      parse_mot("1,-1,1,1,5,5,0.9\n1,-1,1,1,6,6,0.1\n2,-1,1,1,0,6,0.1\n2,-1,1,1,6,-3,1\n", "d.txt", MotKind::detections);
  ASSERT_EQ(table.boxes.size(), 2U);
  EXPECT_EQ(table.boxes[0].id, LabelledBox::no_person);
  ASSERT_EQ(table.warnings.size(), 1U);
  EXPECT_EQ(table.warnings[0], "d.txt:3: a box without width or height was omitted (2 in all)");
}

TEST(Mot, ErrorsNameTheLineAndWhatIsExpected) {
  const std::string ok = "1,1,1,1,5,5\n\n";
  EXPECT_EQ(error_of(ok + "1,2,3"), "t.txt:3: has 3 columns; expected are frame,id,left,top,width,height[,score,...]");
  EXPECT_EQ(error_of("frame,id,left"), "t.txt:1: frame is \"frame\"; it must be a number");
  EXPECT_EQ(error_of(ok + "2,1,1,1,5x,5"), "t.txt:3: width is \"5x\"; it must be a number");
  EXPECT_EQ(error_of(ok + "2,1,,1,5,5"), "t.txt:3: left is \"\"; it must be a number");
  EXPECT_EQ(error_of(ok + "2,1,nan,1,5,5"), "t.txt:3: left is \"nan\"; it must be a finite number below 1e9");
  EXPECT_EQ(error_of(ok + "2,1,1,-inf,5,5"), "t.txt:3: top is \"-inf\"; it must be a finite number below 1e9");
  EXPECT_EQ(error_of(ok + "2,1,1,1e999,5,5"), "t.txt:3: top is \"1e999\"; it must be a finite number below 1e9");
  EXPECT_EQ(error_of(ok + "2,1,1,1,0,5"), "t.txt:3: width is 0; it must be positive");
  EXPECT_EQ(error_of(ok + "2,1,1,1,5,-2"), "t.txt:3: height is -2; it must be positive");
  EXPECT_EQ(error_of(ok + "0,1,1,1,5,5"), "t.txt:3: frame is 0; frames are whole numbers from 1");
  EXPECT_EQ(error_of(ok + "1.5,1,1,1,5,5"), "t.txt:3: frame is 1.5; frames are whole numbers from 1");
  EXPECT_EQ(error_of(ok + "99999999999,1,1,1,5,5"), "t.txt:3: frame is \"99999999999\"; it must be a finite number below 1e9");
  EXPECT_EQ(error_of(ok + "2,-1,1,1,5,5"), "t.txt:3: id is -1; in tracks and truth ids are whole numbers from 0");
  EXPECT_EQ(error_of("2,7,1,1,5,5\n3,7,1,1,5,5\n2,7,2,1,5,5\n"),
            "t.txt:3: id 7 stands in frame 2 already, on line 1; an id may stand once a frame");
  EXPECT_EQ(error_of(std::string("\x7F"
                                 "ELF\0\1",
                                 6)),
            "t.txt:1: frame is \"?ELF??\"; it must be a number");
}

TEST(Mot, FilesThatCannotBeRead) {
  const auto message = [](const std::string& path) -> std::string {
    try {
      read_mot(path, MotKind::truth);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message("/no/such.txt"), "/no/such.txt: cannot be read (No such file or directory)");
  EXPECT_EQ(message("/tmp"), "/tmp: cannot be read (Is a directory)");
}

TEST(Mot, ReadsBackWhatItWrites) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> hundredths(-100'000, 300'000);
  std::string text;
  std::vector<LabelledBox> boxes;
  for (int i = 0; i < 2000; ++i) {
    // Coordinates as they come from a file: a decimal number, less one.
    const auto location = [&] { return hundredths(random) / 100.0 - 1; };
    const auto size = [&] { return (std::abs(hundredths(random)) + 1) / 100.0; };
    boxes.push_back({i / 10, i % 10, {location(), location(), size(), size()}, hundredths(random) / 100.0});
    append_mot(text, boxes.back());
  }
  EXPECT_EQ(parsed(text), boxes);
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.txt", text);
  EXPECT_EQ(read_mot(folder / "a.txt", MotKind::tracks).boxes, boxes);
}

std::vector<LabelledBox> read_piecewise(const std::string& path) {
  std::vector<LabelledBox> boxes;
  MotReader reader(path);
  while (const auto piece = reader.next()) boxes.insert(boxes.end(), piece->begin(), piece->end());
  return boxes;
}

TEST(Mot, PieceByPieceIsTheSameAsAtOnce) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> hundredths(1, 300'000);
  std::string text = "\xEF\xBB\xBF";
  for (int i = 0; i < 40'000; ++i) {
    const auto location = [&] { return hundredths(random) / 100.0; };
    append_mot(text, {i / 7, LabelledBox::no_person, {location(), location(), i % 1000 == 999 ? 0 : location(), location()}, 0.5});
    if (i % 100 == 0) text += "\r\n";
  }
  text.pop_back();  // a last line need not end
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.txt", text);
  ASSERT_GT(text.size(), 1'000'000U) << "several pieces";
  const MotTable at_once = read_mot(folder / "a.txt", MotKind::detections);
  EXPECT_EQ(read_piecewise(folder / "a.txt"), at_once.boxes);
  MotReader reader(folder / "a.txt");
  while (reader.next()) continue;
  EXPECT_EQ(reader.warnings(), at_once.warnings);
  EXPECT_EQ(at_once.warnings.size(), 1U);
}

TEST(Mot, PiecesNameTheLineThatIsWrong) {
  const test::TemporaryFolder folder;
  std::string text;
  for (int i = 0; i < 20'000; ++i) append_mot(text, {i, LabelledBox::no_person, {1, 2, 3, 4}, 1});
  test::write_file(folder / "a.txt", text + "20001,-1,5,6,7");
  const auto message = [](const std::string& path) -> std::string {
    try {
      read_piecewise(path);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_NE(message(folder / "a.txt").find("a.txt:20001: has 5 columns"), std::string::npos) << message(folder / "a.txt");
  EXPECT_EQ(message("/no/such.txt"), "/no/such.txt: cannot be read (No such file or directory)");
  test::write_file(folder / "empty.txt", "");
  EXPECT_TRUE(read_piecewise(folder / "empty.txt").empty());
}

TEST(Mot, ReportsOutlierFrame) {
  for (const MotKind kind : {MotKind::truth, MotKind::tracks, MotKind::detections}) {
    try {
      parse_mot("1,1,5,5,10,20,1\n2,1,5,5,10,20,1\n999999999,1,5,5,10,20,1\n", "a.txt", kind);
      FAIL();
    } catch (const Error& error) {
      EXPECT_STREQ(error.what(), "a.txt: frames 1 to 999999999 are named, of which 3 are there; a number must be wrong");
    }
  }
}

}  // namespace
}  // namespace marey::format::tracks
