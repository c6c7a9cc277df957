#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "marey/core/rig.h"

namespace marey::format::rig {

/// A folder as MultiCamSelfCal (Svoboda, Martinec, Pajdla 2005) reads and leaves it. Files that are missing are reported as
/// missing. All throw Error, `file:LINE: …` where there is a line, for a file that is not what its name says.
class SelfCalFolder {
 public:
  explicit SelfCalFolder(std::string path);

  /// Whether the folder holds anything of its kind.
  static bool is_one(const std::string& path);

  int cameras() const { return cameras_; }
  /// "cam1", "cam2", …, or as `camera_order.txt` says.
  const std::vector<std::string>& names() const { return names_; }

  struct Point {
    int camera = 0;
    std::int64_t frame = 0;  ///< a column of points.dat; where there are only camN.points4cal.dat, the rank of the point in space
    Vector<2> pixel = Vector<2>::Zero();
  };
  /// The observations, by frame and camera: `points.dat` with `IdMat.dat`, else `camN.points4cal.dat`, whose rows belong together
  /// where they name the same point in space.
  std::vector<Point> points() const;
  bool has_points() const;

  std::optional<cv::Size> size(int camera) const;             ///< `Res.dat`
  std::optional<geometry::BrownLens> lens(int camera) const;  ///< `*N.rad`

  /// px from the world's homogeneous coordinates, of undistorted pixels: `cameraN.Pmat.cal`, else `Pmatrices.dat`.
  std::optional<Eigen::Matrix<double, 3, 4>> projection(int camera) const;
  /// Points in the frame of `projection`, one a column, where they are known: their side of the cameras shows a mirrored world.
  std::optional<Eigen::Matrix<double, 3, Eigen::Dynamic>> world_points(int camera) const;
  /// The world's unit in m: 0.001 where `calibration_units.txt` says millimeters, else 1.
  double unit() const;

 private:
  std::vector<Point> points_of_table() const;
  std::vector<Point> points_of_lists() const;
  std::string file(const std::string& name) const;
  std::optional<std::string> first_of(const std::string& before, int number, const std::string& after) const;

  std::string path_;
  int cameras_ = 0;
  std::vector<std::string> names_;
};

/// A table of numbers as Octave and Matlab write them: rows of numbers between blanks, commas or semicolons; lines that begin with
/// # or % are remarks. Throws Error if it cannot be read, rows differ in length, or something is no number (NaN is one).
Eigen::MatrixXd read_number_table(const std::string& path);

}  // namespace marey::format::rig
