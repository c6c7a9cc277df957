#include "marey/format/take/take_plates.h"

#include <array>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/take/sqlite.h"
#include "marey/format/take/take_file.h"

#include "support/files.h"

namespace marey::format::take {
namespace {

ForcePlate stored_plate() {
  ForcePlate plate;
  plate.name = "plate 1";
  plate.type = 3;
  plate.corners = {Vector<3>(0.25, 0.3, 0), Vector<3>(-0.25, 0.3, 0), Vector<3>(-0.25, -0.3, 0), Vector<3>(0.25, -0.3, 0.001)};
  plate.rate_hz = 1000;
  plate.begin_s = 1.25;
  for (int s = 0; s < 100; ++s) plate.loads.push_back({Vector<3>(s, -s, 700 + s), Vector<3>(1, 0.5 * s, -s)});
  return plate;
}

class TakePlatesTest : public testing::Test {
 protected:
  TakePlatesTest() : path_(folder_ / "a.marey") {
    TakeWriter writer(path_);
    RecordingHeader header;
    header.rate_hz = 100;
    header.frame.kind = FrameOfReference::Kind::space;
    writer.begin(header);
    writer.finish();
  }
  test::TemporaryFolder folder_;
  std::string path_;
};

TEST_F(TakePlatesTest, KeepsPlates) {
  EXPECT_TRUE(read_plates(path_).empty());
  ForcePlate marked = stored_plate();
  marked.saturated.assign(marked.loads.size(), 0);
  marked.saturated[7] = 1;
  write_plates(path_, std::array{stored_plate(), stored_plate()});
  write_plates(path_, std::array{stored_plate(), marked});
  const std::vector<ForcePlate> plates = read_plates(path_);
  ASSERT_EQ(plates.size(), 2U) << "the second time in place of the first";
  EXPECT_EQ(plates[0].name, "plate 1");
  EXPECT_EQ(plates[0].type, 3);
  EXPECT_EQ(plates[0].begin_s, 1.25);
  EXPECT_EQ(plates[0].corners, stored_plate().corners);
  EXPECT_TRUE(plates[0].saturated.empty());
  EXPECT_EQ(plates[1].saturated, marked.saturated);
  ASSERT_EQ(plates[0].loads.size(), 100U);
  EXPECT_EQ(plates[0].loads[9].force, Vector<3>(9, -9, 709));
  EXPECT_EQ(plates[0].loads[9].moment, Vector<3>(1, 4.5, -9));
}

TEST_F(TakePlatesTest, DamagedPlatesAreRefused) {
  write_plates(path_, std::array{stored_plate()});
  for (const char* damage : {"UPDATE plate SET corners = x'00'", "UPDATE plate SET loads = x'0000'", "UPDATE plate SET rate_hz = 0",
                             "UPDATE plate SET saturated = x'01'"}) {
    write_plates(path_, std::array{stored_plate()});
    Database(path_, Database::Mode::create).run(damage);
    EXPECT_THROW(read_plates(path_), Error) << damage;
  }
}

}  // namespace
}  // namespace marey::format::take
