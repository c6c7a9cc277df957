// MultiCamSelfCal writes a projection matrix of undistorted pixels, and keeps the lens apart: a pixel is undistorted with the lens
// (K, kc) of its .rad file, drawn with that same K, and then meets P = K' [R | t], whose K' differs from K and has a skew. One lens
// that does all of this is fitted to both together.
#include <filesystem>

#include <Eigen/LU>
#include <Eigen/QR>
#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/whole_file.h"
#include "marey/format/rig/imported_rig.h"
#include "marey/format/rig/self_cal_folder.h"
#include "marey/geometry/lens_fit.h"

namespace marey::format::rig {
namespace {

using Projection = Eigen::Matrix<double, 3, 4>;

struct Decomposed {
  Matrix<3> K = Matrix<3>::Identity();  // upper triangular, K(2, 2) = 1, positive diagonal
  Rigid3 camera_from_world;
};

/// P up to scale as K [R | t], R a rotation. Nothing if its left part is singular.
std::optional<Decomposed> decomposed(const Projection& given) {
  Projection P = given / given.leftCols<3>().row(2).norm();
  if (P.leftCols<3>().determinant() < 0) P = -P;
  const Matrix<3> M = P.leftCols<3>();
  if (!P.allFinite() || !(std::abs(M.determinant()) > 1e-12 * M.row(0).norm() * M.row(1).norm())) return std::nullopt;
  const Eigen::HouseholderQR<Matrix<3>> qr(M.inverse());
  const Matrix<3> Q = qr.householderQ();
  const Matrix<3> upper = qr.matrixQR().triangularView<Eigen::Upper>();
  Matrix<3> K = upper.inverse();
  const Vector<3> signs = K.diagonal().array().sign();
  K = K * signs.asDiagonal();
  Decomposed result;
  result.camera_from_world.rotation = signs.asDiagonal() * Q.transpose();
  result.camera_from_world.translation = K.inverse() * P.col(3);
  result.K = K / K(2, 2);
  return result;
}

/// Whether what the camera saw lies behind it: then the world is a mirror image of the true one.
bool is_mirrored(const Decomposed& camera, const Eigen::Matrix<double, 3, Eigen::Dynamic>& points) {
  Eigen::Index behind = 0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) behind += (camera.camera_from_world * Vector<3>(points.col(i))).z() < 0 ? 1 : 0;
  return 10 * behind > 9 * points.cols();
}

/// Sets lens and pose; how far the one lens is from the two, px RMS over the image (the matrix may have a skew).
double set_lens(RigCamera& camera, const Decomposed& found, const std::optional<geometry::BrownLens>& rad) {
  geometry::BrownLens pinhole;
  pinhole.focal = {found.K(0, 0), found.K(1, 1)};
  pinhole.principal = {found.K(0, 2), found.K(1, 2)};
  camera.lens = pinhole;
  camera.camera_from_world = found.camera_from_world;
  if (!camera.size) return 0;
  const Matrix<3> back = found.K.inverse();
  const auto direction = [&](const Vector<2>& pixel) -> std::optional<Vector<3>> {
    if (!rad) return Vector<3>(back * pixel.homogeneous());
    const auto ahead = Camera(*rad, Rigid3{}, *camera.size).bearing(pixel);
    if (!ahead || ahead->z() <= 0) return std::nullopt;
    const Vector<2> straight = rad->principal + rad->focal.cwiseProduct(ahead->hnormalized());
    return Vector<3>(back * straight.homogeneous());
  };
  geometry::BrownLens start = pinhole;
  if (rad) start.distortion = rad->distortion;
  const auto fit = geometry::fit_brown(direction, *camera.size, start, {.coefficients = 4, .turn = true});
  if (!fit) return 0;
  camera.lens = fit->lens;
  camera.camera_from_world = Rigid3{fit->turn, Vector<3>::Zero()} * found.camera_from_world;
  return fit->rms_px;
}

void mirror(Projection& P) {
  P.col(0) = -P.col(0);
}

std::string rad_text(const geometry::BrownLens& lens) {
  std::string text;
  const Matrix<3> K{{lens.focal.x(), 0, lens.principal.x()}, {0, lens.focal.y(), lens.principal.y()}, {0, 0, 1}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) text += fmt::format("K{}{} = {:.16f}\n", i + 1, j + 1, K(i, j));
  }
  text += "\n";
  for (std::size_t i = 0; i < 4; ++i) text += fmt::format("kc{} = {:.16f}\n", i + 1, lens.distortion[i]);
  return text;
}

std::string matrix_text(const Projection& P) {
  std::string text;
  for (int i = 0; i < 3; ++i) text += fmt::format("{:.17e} {:.17e} {:.17e} {:.17e}\n", P(i, 0), P(i, 1), P(i, 2), P(i, 3));
  return text;
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  WholeFile file(path.string());
  file.write(text);
  file.finish();
}

}  // namespace

Rig read_self_cal_rig(const std::string& path) {
  const SelfCalFolder folder(path);
  std::vector<Projection> projections;
  for (int i = 0; i < folder.cameras(); ++i) {
    const auto P = folder.projection(i);
    if (!P)
      throw Error("{}: there is no cameraN.Pmat.cal nor Pmatrices.dat: this folder holds observations and no calibration", path);
    if (!decomposed(*P)) throw Error("{}: the projection matrix of camera {} is singular", path, i + 1);
    projections.push_back(*P);
  }
  int mirrored = 0;
  for (int i = 0; i < folder.cameras(); ++i) {
    const auto points = folder.world_points(i);
    if (points) mirrored += is_mirrored(*decomposed(projections[static_cast<std::size_t>(i)]), *points) ? 1 : -1;
  }
  Rig rig;
  double farthest = 0;
  for (int i = 0; i < folder.cameras(); ++i) {
    Projection& P = projections[static_cast<std::size_t>(i)];
    if (mirrored > 0) mirror(P);
    RigCamera& camera = rig.cameras.emplace_back();
    camera.name = folder.names()[static_cast<std::size_t>(i)];
    camera.size = folder.size(i);
    farthest = std::max(farthest, set_lens(camera, *decomposed(P), folder.lens(i)));
    camera.camera_from_world->translation *= folder.unit();
  }
  std::string& method = rig.calibration.emplace().method = "MultiCamSelfCal";
  constexpr double kWorthTelling = 0.005;  // px
  if (farthest > kWorthTelling)
    method += fmt::format("; its matrices and lenses made one lens each, off by up to {:.2f} px RMS", farthest);
  check_imported(rig, path);
  return rig;
}

void write_self_cal_rig(const Rig& rig, const std::string& path) {
  const std::filesystem::path folder(path);
  std::vector<geometry::BrownLens> lenses;
  for (const RigCamera& camera : rig.cameras) {
    lenses.push_back(as_brown(camera, 4, "MultiCamSelfCal"));
    if (!camera.camera_from_world)
      throw Error("camera \"{}\": its pose is missing, which MultiCamSelfCal's matrices need; calibrate it first", camera.name);
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error("{}: the folder cannot be made ({})", path, error.message());
  std::string all, sizes, names;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const RigCamera& camera = rig.cameras[i];
    const geometry::BrownLens& lens = lenses[i];
    Projection pose;
    pose << camera.camera_from_world->rotation, camera.camera_from_world->translation;
    const Projection P =
        Matrix<3>{{lens.focal.x(), 0, lens.principal.x()}, {0, lens.focal.y(), lens.principal.y()}, {0, 0, 1}} * pose;
    write_text(folder / fmt::format("camera{}.Pmat.cal", i + 1), matrix_text(P));
    write_text(folder / fmt::format("basename{}.rad", i + 1), rad_text(lens));
    all += matrix_text(P);
    sizes += fmt::format("{} {}\n", camera.size->width, camera.size->height);
    names += camera.name + "\n";
  }
  write_text(folder / "Pmatrices.dat", all);
  write_text(folder / "Res.dat", sizes);
  write_text(folder / "camera_order.txt", names);
  write_text(folder / "calibration_units.txt", "meters\n");
}

Format self_cal_format() {
  return {.name = "multicamselfcal",
          .title = "a folder of MultiCamSelfCal",
          .endings = "/",
          .holds = Content::rig,
          .detail = "m as its units say; a folder: lenses, projections, and what the cameras saw",
          .is = [](const Beginning& file) { return file.folder && rig::SelfCalFolder::is_one(file.path); },
          .read_rig = rig::read_self_cal_rig,
          .write_rig = rig::write_self_cal_rig};
}

}  // namespace marey::format::rig
