#include "marey/format/motion/force_plates.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/motion/c3d.h"
#include "marey/format/motion/c3d_section.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::format::motion {
namespace {

constexpr unsigned kSeed = 38;
constexpr std::size_t kPlateFrames = 20, kPlateSamples = 10;  // at 100 Hz
constexpr std::int64_t kPlateFirst = 49;

/// A plate as a file has it, and the loads that its channels must show.
struct PlateOfFile {
  int type = 2;
  double moment_unit_m = 0.001;  ///< of the channels: N mm
  Vector<3> origin{0.002, -0.001, -0.04};
  std::vector<std::vector<double>> rows;  ///< by sample, the channels' values
  Eigen::Matrix<double, 6, 6> calibration = Eigen::Matrix<double, 6, 6>::Identity();

  std::size_t channels() const { return type == 3 ? 8 : 6; }
};

/// Corners of a plate that lies turned in the world; z up, m.
std::array<Vector<3>, 4> rotated_corners() {
  const Matrix<3> turn = Eigen::AngleAxisd(0.5, Vector<3>::UnitZ()).toRotationMatrix();
  std::array<Vector<3>, 4> corners;
  const std::array<Vector<3>, 4> flat = {Vector<3>(0.3, -0.2, 0), Vector<3>(-0.3, -0.2, 0), Vector<3>(-0.3, 0.2, 0),
                                         Vector<3>(0.3, 0.2, 0)};
  for (std::size_t c = 0; c < 4; ++c) corners[c] = turn * flat[c] + Vector<3>(1, 2, 0.01);
  return corners;
}

/// The parameters of a file whose data begin in `block`; `path` is for errors.
std::string plate_parameters(const std::string& path, const PlateOfFile& plate, const std::array<Vector<3>, 4>& corners,
                             int channels_named, std::int64_t block) {
  const std::size_t n = plate.channels() + 1;
  C3dSection section;
  section.group("POINT");
  section.word("USED", 1);
  section.real("SCALE", -0.1);
  section.real("RATE", 100);
  section.word("DATA_START", block);
  section.text("UNITS", "mm");
  section.texts("LABELS", std::array<std::string, 1>{"A"});
  section.group("ANALOG");
  section.word("USED", static_cast<std::int64_t>(n));
  section.real("GEN_SCALE", 0.5);
  section.real("RATE", 100.0 * kPlateSamples);
  section.words("OFFSET", std::vector<std::int64_t>(n, 3));
  section.reals("SCALE", std::vector<double>(n, 2), {n});
  std::vector<std::string> labels = {"L Rect"}, units = {"V"};
  for (std::size_t c = 1; c < n; ++c) {
    labels.push_back("Channel" + std::to_string(c));
    units.push_back(plate.type == 4             ? "V"
                    : plate.type == 3 || c <= 3 ? "N"
                    : plate.moment_unit_m == 1  ? "Nm"
                    : plate.type == 1 && c < 6  ? "mm"
                                                : "Nmm");
  }
  section.texts("LABELS", labels);
  section.texts("UNITS", units);
  section.group("FORCE_PLATFORM");
  section.word("USED", 1);
  section.words("TYPE", std::array<std::int64_t, 1>{plate.type});
  std::vector<std::int64_t> numbers;
  for (std::size_t c = 1; c < n; ++c) numbers.push_back(channels_named != 0 ? channels_named : static_cast<std::int64_t>(c) + 1);
  section.words("CHANNEL", numbers);
  std::vector<double> flat;
  for (const Vector<3>& corner : corners) {
    for (const double value : corner) flat.push_back(1000 * value);
  }
  section.reals("CORNERS", flat, {3, 4, 1});
  section.reals("ORIGIN", std::array<double, 3>{1000 * plate.origin.x(), 1000 * plate.origin.y(), 1000 * plate.origin.z()}, {3, 1});
  if (plate.type == 4)
    section.reals("CAL_MATRIX", std::vector<double>(plate.calibration.data(), plate.calibration.data() + 36), {6, 6, 1});
  return section.blocks(path);
}

void write_plate(const std::string& path, const PlateOfFile& plate, const std::array<Vector<3>, 4>& corners,
                 int channels_named = 0) {
  const std::size_t n = plate.channels() + 1;
  const auto parameters = [&](std::int64_t block) { return plate_parameters(path, plate, corners, channels_named, block); };
  const auto block = static_cast<std::int64_t>(2 + parameters(2).size() / kC3dBlock);
  std::string bytes("\x02\x50", 2);
  for (const std::size_t word : {std::size_t{1}, n * kPlateSamples, static_cast<std::size_t>(kPlateFirst) + 1,
                                 static_cast<std::size_t>(kPlateFirst) + kPlateFrames, std::size_t{0}})
    put_word(bytes, static_cast<std::int64_t>(word));
  put_real(bytes, -0.1);
  put_word(bytes, block);
  put_word(bytes, kPlateSamples);
  put_real(bytes, 100);
  bytes.resize(kC3dBlock, '\0');
  bytes += parameters(block);
  for (std::size_t f = 0; f < kPlateFrames; ++f) {
    for (int i = 0; i < 4; ++i) put_real(bytes, 0);
    for (std::size_t s = 0; s < kPlateSamples; ++s) {
      put_real(bytes, 7 + 3);
      for (const double value : plate.rows[f * kPlateSamples + s]) put_real(bytes, value + 3);  // a step is 0.5 · 2
    }
  }
  std::ofstream(path, std::ios::binary) << bytes;
}

class ForcePlatesTest : public testing::Test {
 protected:
  ForcePlatesTest() : random_(kSeed) {
    for (std::size_t s = 0; s < kPlateFrames * kPlateSamples; ++s) {
      PlateLoad load;
      load.force = {number(50), number(60), -400 + number(300)};  // the plate's z points down
      load.moment = {number(40), number(30), number(5)};
      truth_.push_back(load);
    }
  }
  double number(double scale) { return scale * std::uniform_real_distribution<double>(-1, 1)(random_); }

  /// What a plate of a type shows of the loads, in N and `moment_unit_m`, per the C3D user guide.
  PlateOfFile plate_of(int type) {
    PlateOfFile plate;
    plate.type = type;
    if (type == 3) plate.origin = {0.2, 0.15, -0.04};
    for (int i = 0; i < 36 && type == 4; ++i) plate.calibration.data()[i] += 0.05 * number(1);
    for (const PlateLoad& load : truth_) plate.rows.push_back(row_of(plate, load));
    return plate;
  }

  std::vector<double> row_of(const PlateOfFile& plate, const PlateLoad& load) {
    const Vector<3>& f = load.force;
    const double unit = plate.moment_unit_m;
    if (plate.type == 1) {
      // Where the force meets the surface, and the rest about its normal.
      const Vector<3> at(-load.moment.y() / f.z(), load.moment.x() / f.z(), 0);
      return {f.x(), f.y(), f.z(), at.x() / unit, at.y() / unit, (load.moment - at.cross(f)).z() / unit};
    }
    const Vector<3> about_sensor =
        load.moment + Vector<3>(plate.type == 3 ? Vector<3>(0, 0, plate.origin.z()) : plate.origin).cross(f);
    if (plate.type == 3) return corners_of(plate, f, about_sensor);
    Eigen::Matrix<double, 6, 1> six;
    six << f, about_sensor / unit;
    six = plate.calibration.inverse() * six;
    return {six.data(), six.data() + 6};
  }

  /// Eight forces that have these sums; two are free, so random.
  std::vector<double> corners_of(const PlateOfFile& plate, const Vector<3>& f, const Vector<3>& m) {
    const double a = plate.origin.x(), b = plate.origin.y();
    const double x34 = number(20), x12 = f.x() - x34;
    const double twist = (m.z() - b * (x34 - x12)) / a;  // y14 − y23
    const double y14 = 0.5 * (f.y() + twist), y23 = 0.5 * (f.y() - twist);
    const double z12_34 = m.x() / b, z23_14 = m.y() / a, free = number(50);
    // Sum, (1 + 2) − (3 + 4), (2 + 3) − (1 + 4), and one combination that shows in none.
    const double z1 = 0.25 * (f.z() + z12_34 - z23_14) + free, z2 = 0.25 * (f.z() + z12_34 + z23_14) - free;
    const double z3 = 0.25 * (f.z() - z12_34 + z23_14) + free, z4 = 0.25 * (f.z() - z12_34 - z23_14) - free;
    return {x12, x34, y14, y23, z1, z2, z3, z4};
  }

  void expect_truth(const AnalogData& data) const {
    ASSERT_EQ(data.plates.size(), 1U);
    const ForcePlate& plate = data.plates[0];
    ASSERT_EQ(plate.loads.size(), truth_.size());
    const Matrix<3> axes = plate.axes();
    EXPECT_LT(axes.col(2).z(), -0.99) << "z points into the floor";
    for (std::size_t s = 0; s < truth_.size(); ++s) {
      EXPECT_LT((plate.loads[s].force - axes * truth_[s].force).norm(), 1e-3) << s << ", seed " << kSeed;
      EXPECT_LT((plate.loads[s].moment - axes * truth_[s].moment).norm(), 1e-3) << s << ", seed " << kSeed;
    }
  }

  test::TemporaryFolder folder_;
  std::mt19937 random_;
  std::vector<PlateLoad> truth_;
};

TEST_F(ForcePlatesTest, ReadsTypes1To4InTheWorld) {
  for (const int type : {1, 2, 3, 4}) {
    SCOPED_TRACE(type);
    write_plate(folder_ / "a.c3d", plate_of(type), rotated_corners());
    const AnalogData data = read_analog_data({.path = folder_ / "a.c3d"});
    expect_truth(data);
    EXPECT_TRUE(data.warnings.empty());
    EXPECT_EQ(data.plates.at(0).type, type);
    EXPECT_DOUBLE_EQ(data.rate_hz, 1000);
    EXPECT_DOUBLE_EQ(data.begin_s, 0.49);
    EXPECT_LT((data.plates[0].centre() - Vector<3>(1, 2, 0.01)).norm(), 1e-6);
    ASSERT_EQ(data.channels.size(), 1U);
    EXPECT_EQ(data.channels[0].label, "L Rect");
    EXPECT_DOUBLE_EQ(data.channels[0].values.at(5), 7);
  }
}

TEST_F(ForcePlatesTest, TurnsPlatesWithARecordingWhoseYIsUp) {
  std::array<Vector<3>, 4> y_up = rotated_corners();
  for (Vector<3>& corner : y_up) corner = Vector<3>(corner.x(), corner.z(), -corner.y());
  write_plate(folder_ / "a.c3d", plate_of(2), y_up);
  const AnalogData data = read_analog_data({.path = folder_ / "a.c3d", .rotated = true});
  expect_truth(data);
  EXPECT_LT((data.plates.at(0).corners[0] - rotated_corners()[0]).norm(), 1e-6);
}

TEST_F(ForcePlatesTest, ReadsOriginsFromTheSurfaceToTheSensor) {
  PlateOfFile plate = plate_of(2);
  plate.origin = -plate.origin;
  write_plate(folder_ / "a.c3d", plate, rotated_corners());
  expect_truth(read_analog_data({.path = folder_ / "a.c3d"}));
}

TEST_F(ForcePlatesTest, OmitsPlatesThatItCannotRead) {
  PlateOfFile plate = plate_of(2);
  plate.type = 12;
  write_plate(folder_ / "a.c3d", plate, rotated_corners());
  AnalogData data = read_analog_data({.path = folder_ / "a.c3d"});
  ASSERT_EQ(data.warnings.size(), 1U);
  EXPECT_NE(data.warnings[0].find("its type is 12"), std::string::npos);
  plate.type = 2;
  write_plate(folder_ / "a.c3d", plate, rotated_corners(), 99);
  data = read_analog_data({.path = folder_ / "a.c3d"});
  ASSERT_EQ(data.warnings.size(), 1U);
  EXPECT_NE(data.warnings[0].find("channels"), std::string::npos);
  const Vector<3> same(1, 1, 0);
  write_plate(folder_ / "a.c3d", plate, {same, same, same, same});
  data = read_analog_data({.path = folder_ / "a.c3d"});
  ASSERT_EQ(data.warnings.size(), 1U);
  EXPECT_NE(data.warnings[0].find("rectangle"), std::string::npos);
  EXPECT_TRUE(data.plates.empty());
}

TEST_F(ForcePlatesTest, MarksChannelsAtTheirLimit) {
  PlateOfFile plate = plate_of(2);
  for (std::size_t s = 0; s < plate.rows.size(); ++s) {
    for (double& value : plate.rows[s]) value = number(1);
    const double bump = -900 * std::sin(3.14159 * static_cast<double>(s) / 100);
    if (s < 100) plate.rows[s][2] = std::max(bump, -700.0);
  }
  write_plate(folder_ / "a.c3d", plate, rotated_corners());
  const AnalogData data = read_analog_data({.path = folder_ / "a.c3d"});
  ASSERT_EQ(data.plates.size(), 1U);
  ASSERT_EQ(data.plates[0].saturated.size(), plate.rows.size());
  for (std::size_t s = 0; s < plate.rows.size(); ++s) EXPECT_EQ(data.plates[0].saturated[s] != 0, plate.rows[s][2] == -700) << s;
  ASSERT_EQ(data.warnings.size(), 1U);
}

TEST_F(ForcePlatesTest, RealPlatesAreReadWithoutAWarning) {
  const std::string walk = test::data("gait_children/HC002D/straight_HC002D06.c3d");
  if (!std::filesystem::exists(walk)) GTEST_SKIP() << walk << " is not here";
  const AnalogData data = read_analog_data({.path = walk});
  EXPECT_TRUE(data.warnings.empty());
  ASSERT_EQ(data.plates.size(), 2U);
  EXPECT_EQ(data.channels.size(), 12U);
  double largest = 0;
  for (const PlateLoad& load : data.plates[0].loads) largest = std::max(largest, load.force.z());
  EXPECT_NEAR(largest, 374.46, 0.01) << "ezc3d's";
}

}  // namespace
}  // namespace marey::format::motion
