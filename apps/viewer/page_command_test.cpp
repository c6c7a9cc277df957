#include "page_command.h"

#include <gtest/gtest.h>

namespace marey::viewer {
namespace {

template <typename Command>
Command read_as(std::string_view line) {
  const auto command = page_command(line);
  if (!command || !std::holds_alternative<Command>(*command)) {
    ADD_FAILURE() << line << " is not understood";
    return {};
  }
  return std::get<Command>(*command);
}

TEST(PageCommand, EachIsReadAsItIsWritten) {
  const auto camera_control = read_as<SetCameraControl>("dial 3 exposure 2.5");
  EXPECT_EQ(camera_control.camera, CameraId{3});
  EXPECT_EQ(camera_control.name, "exposure");
  EXPECT_EQ(camera_control.value, 2.5);
  EXPECT_EQ(read_as<SetThreshold>("threshold 0 80").level, 80.0);
  EXPECT_FALSE(read_as<SetThreshold>("threshold 0 auto").level);
  const auto mask = read_as<ChangeMasks>("mask 1 10 20 30 40");
  EXPECT_EQ(mask.what, ChangeMasks::What::add);
  EXPECT_EQ(mask.part, Mask(10, 20, 30, 40));
  EXPECT_EQ(read_as<ChangeMasks>("mask 1 10 20 30 40 5 60").part, Mask::polygon({{10, 20}, {30, 40}, {5, 60}}));
  EXPECT_EQ(read_as<ChangeMasks>("unmask 1 10 20 30 40 5 60").what, ChangeMasks::What::remove);
  EXPECT_EQ(read_as<ChangeMasks>("unmask 1 10 20 30 40").what, ChangeMasks::What::remove);
  EXPECT_EQ(read_as<ChangeMasks>("unmask 1 all").what, ChangeMasks::What::remove_all);
  EXPECT_EQ(read_as<ChangeMasks>("lit 63").camera, CameraId{63});
  EXPECT_EQ(read_as<NameTrack>("name 17 left knee ").label, "left knee");
  EXPECT_EQ(read_as<NameTrack>("name 17").label, "");
  EXPECT_EQ(read_as<NameTrack>("name 17 kn\x01\n\"ee").label.find('\n'), std::string::npos);
  read_as<SaveRig>("save");
}

TEST(PageCommand, RejectsUnknownCommand) {
  const std::string long_name = "name 1 " + std::string(kMaxName + 1, 'x');
  for (const std::string_view line : {"",
                                      " ",
                                      "dial",
                                      "dial 0 exposure",
                                      "dial 0 exposure nan",
                                      "dial 0 exposure inf",
                                      "dial 0 exposure -1",
                                      "dial 0 exposure 1e9",
                                      "dial 0 exposure 1x",
                                      "dial 0 focus 1",
                                      "dial 64 gain 1",
                                      "dial -1 gain 1",
                                      "dial 0 gain 1 2",
                                      "threshold 0",
                                      "threshold 0 nan",
                                      "threshold 0 1e12",
                                      "threshold 0 auto 1",
                                      "mask 0",
                                      "mask 0 1 2 3",
                                      "mask 0 1 2 3 0",
                                      "mask 0 -1 2 3 4",
                                      "mask 0 1 2 3 4 5",
                                      "mask 0 1 2 3 4 5 6 7",
                                      "mask 0 1 2 3 4 5 -6",
                                      "mask 0 1 2 3 4 5 all",
                                      "mask 0 1.5 2 3 4",
                                      "mask 0 1 2 3 99999999999999999999",
                                      "mask 0 all",
                                      "unmask 0 all all",
                                      "lit",
                                      "lit 0 1",
                                      "lit x",
                                      "name",
                                      "name x y",
                                      "name -1 y",
                                      "name 99999999999 y",
                                      "save it",
                                      "SAVE",
                                      "record on"})
    EXPECT_FALSE(page_command(line)) << line;
  EXPECT_FALSE(page_command(long_name));
}

}  // namespace
}  // namespace marey::viewer
