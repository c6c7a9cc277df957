#include "marey/format/register.h"

#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "marey/format/recording_file.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::format {
namespace {

TEST(Register, EveryRowIsWhole) {
  std::set<std::pair<std::string_view, std::string_view>> known;
  for (const Format& format : formats()) {
    EXPECT_FALSE(format.name.empty() || format.title.empty() || format.detail.empty()) << format.name;
    EXPECT_TRUE(format.is_read() || format.create != nullptr) << format.name;
    EXPECT_EQ(format.is != nullptr, format.is_read()) << format.name;
    EXPECT_TRUE(format.create == nullptr || format.write == nullptr) << format.name;
    EXPECT_TRUE(format.open == nullptr || format.read == nullptr) << format.name;
    EXPECT_TRUE(known.emplace(format.name, format.title).second) << format.name;
    EXPECT_EQ(format_named(format.name, format.holds), &format) << format.name;
  }
}

TEST(Register, TheTableInTheDocumentsIsTheRegisters) {
  std::ifstream file(test::of_project("docs/formats.md"));
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_NE(text.str().find(format_table()), std::string::npos) << "docs/formats.md should hold this table:\n" << format_table();
}

TEST(Register, AnEndingIsOfTheFormatThatHoldsTheContent) {
  EXPECT_EQ(format_to_write("a/b.csv", "", Content::space).title, "a CSV file of points, one row each");
  EXPECT_EQ(format_to_write("b.csv", "", Content::ground).name, "ground");
  EXPECT_EQ(format_to_write("b.csv", "", Content::image).title, "tracks in an image, one row each");
  EXPECT_EQ(format_to_write("b_home.csv", "", Content::ground).name, "metrica");
  EXPECT_EQ(format_to_write("B.MAREY", "", Content::image).name, "take");
  EXPECT_EQ(format_to_write("b.txt", "csv", Content::ground).name, "ground");
  EXPECT_EQ(format_to_write("b.qca.txt", "", Content::rig).name, "qualisys");
  EXPECT_EQ(companion_file("b_home.csv"), "b_away.csv");
  EXPECT_EQ(companion_file("b.csv"), "");
}

std::string refusal(const std::string& path, const std::string& name, Content content) {
  try {
    format_to_write(path, name, content);
  } catch (const WrongFormat& error) {
    return error.what();
  }
  return "taken";
}

TEST(Register, RejectsUnknownFormatWithList) {
  EXPECT_EQ(refusal("b.xyz", "", Content::image),
            "b.xyz: unknown ending; these can be written: .marey (take), .csv (csv), .jsonl (jsonl), .json (coco), "
            "_json (openpose), --format mots, --format coco-instances, .txt (mot); or name a format "
            "with --format");
  EXPECT_EQ(refusal("b.c3d", "", Content::ground),
            "b.c3d: a C3D file holds points in space, and not people on the ground; these can be written: .marey (take), .mcap "
            "(mcap), .csv (ground), .json (soccernet), .dat (tracab), .xml (epts), _home.csv (metrica), .txt (mot)");
  EXPECT_NE(refusal("b.csv", "nexus", Content::space).find("is read only"), std::string::npos);
  EXPECT_NE(refusal("b.csv", "word", Content::space).find("\"word\" is not a format"), std::string::npos);
}

TEST(Register, AFileIsKnownByItsContent) {
  const test::TemporaryFolder folder;
  const auto known = [&](const std::string& text) {
    std::ofstream(folder / "file") << text;
    const Format* format = format_of_content(folder / "file");
    return format == nullptr ? std::string() : std::string(format->title);
  };
  EXPECT_EQ(known("camera,frame,x,y\na,0,1,2\n"), "observations of markers, one row each");
  EXPECT_EQ(known("frame,id,x,y,z\n"), "a CSV file of points, one row each");
  EXPECT_EQ(known("frame,id,x,y\n"), "people on the ground, one row each");
  EXPECT_EQ(known("frame,time,id,label,x,y,vx,vy,left,top,width,height,state\n"), "tracks in an image, one row each");
  EXPECT_EQ(known("1,-1,10,20,30,40,0.5\n2,-1,10,20,30,40,0.5\n"), "another program's detections, MOTChallenge text");
  EXPECT_EQ(known("1,1,10,20,30,40,1,-1,-1,-1\n"), "MOTChallenge text with boxes");
  EXPECT_EQ(known("1 1 10 20 30 40\n"), "MOTChallenge text with boxes");
  EXPECT_EQ(known("1,1,10,20,30,40,1,1,0.86\n"), "MOTChallenge text with boxes");
  EXPECT_EQ(known("1,1,10,20,30,40,1,3.5,4.5\n"), "MOTChallenge text with world coordinates");
  EXPECT_EQ(known("1,1,-1,-1,-1,-1,1,3.5,4.5,0\n"), "MOTChallenge text with world coordinates");
  EXPECT_EQ(known("LASI\nRASI\n"), "names of markers");
  EXPECT_EQ(known("label,x,y,z\nLASI,0,0,1\n"), "names of markers");
  EXPECT_EQ(known("[[camera]]\nname = \"a\"\n"), "a rig");
  EXPECT_EQ(known(""), "");
  EXPECT_EQ(known(std::string(100, '?') + "\n"), "");
}

TEST(Register, TracksInAPictureGoFromFormatToFormat) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "a.txt") << "1,3,10,20,30,40,0.5,-1,-1,-1\n2,3,11,20,30,40,0.5,-1,-1,-1\n2,4,5.5,6,7,8,1,-1,-1,-1\n";
  std::string from = folder / "a.txt";
  for (const char* name : {"b.csv", "c.jsonl", "d.marey", "e.txt"}) {
    const Format* read = format_of_content(from);
    ASSERT_NE(read, nullptr) << from;
    write_whole(folder / name, format_to_write(name, "", Content::image), read_whole(from, *read));
    from = folder / name;
  }
  const Recording recording = read_whole(from, *format_of_content(from)).recording;
  ASSERT_EQ(recording.tracks().size(), 2u);
  const Sample sample = recording.tracks()[1].sample(0);
  EXPECT_EQ(sample.track, TrackId(4));
  ASSERT_TRUE(sample.box);
  EXPECT_DOUBLE_EQ(sample.box->left, 4.5);
  EXPECT_DOUBLE_EQ(sample.box->height, 8);
}

}  // namespace
}  // namespace marey::format
