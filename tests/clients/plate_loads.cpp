// Prints the force plates of a C3D file, for plates_test.py to compare with another program: a line for each plate and sample,
//   plate | force (N) | centre of pressure (mm) | free moment (N mm)
// in the file's world. Where nothing pushes, the last two are missing.
#include <exception>

#include <Eigen/Geometry>
#include <fmt/core.h>

#include "marey/format/motion/force_plates.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: plate_loads FILE\n");
    return 2;
  }
  try {
    const auto data = marey::format::motion::read_analog_data({.path = argv[1]});
    for (std::size_t p = 0; p < data.plates.size(); ++p) {
      const marey::ForcePlate& plate = data.plates[p];
      const marey::Vector<3> normal = plate.axes().col(2);
      for (const marey::PlateLoad& load : plate.loads) {
        fmt::print("{} {:.9g} {:.9g} {:.9g}", p, load.force.x(), load.force.y(), load.force.z());
        const double push = load.force.dot(normal);
        if (push != 0) {
          const marey::Vector<3> arm = normal.cross(load.moment) / push, at = 1000 * (plate.centre() + arm);
          fmt::print(" {:.9g} {:.9g} {:.9g} {:.9g}", at.x(), at.y(), at.z(),
                     1000 * (load.moment - arm.cross(load.force)).dot(normal));
        }
        fmt::print("\n");
      }
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
