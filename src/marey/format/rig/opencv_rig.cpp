// OpenCV has a format for matrices (cv::FileStorage) and no agreed names. Read are the names that its own samples and most
// programs write: one camera (camera_matrix, distortion_coefficients), a stereo pair (M1 D1 M2 D2 with R T, in the same file or in
// extrinsics.yml beside it), and a list `cameras` of the former, which is the output.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <limits>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/core/persistence.hpp>

#include "marey/core/error.h"
#include "marey/files/whole_file.h"
#include "marey/format/read_file.h"
#include "marey/format/rig/file_storage.h"
#include "marey/format/rig/imported_rig.h"

namespace marey::format::rig {
namespace {

using Json = nlohmann::json;
using Names = std::initializer_list<const char*>;

/// The first of these that is there and holds something, or null.
const Json& child(const Json& node, Names names) {
  static const Json kNothing;
  if (!node.is_object()) return kNothing;
  for (const char* name : names) {
    if (const auto found = node.find(name); found != node.end() && !found->is_null()) return *found;
  }
  return kNothing;
}

/// A whole number that an int holds.
std::optional<int> whole(const Json& node) {
  if (!node.is_number()) return std::nullopt;
  const double value = node.get<double>();
  const bool fits = std::abs(value) <= std::numeric_limits<int>::max() && value == std::floor(value);
  return fits ? std::optional(static_cast<int>(value)) : std::nullopt;
}

/// Numbers, whether a matrix or a list of numbers (of lists).
std::optional<std::vector<double>> numbers(const Json& node) {
  std::vector<double> values;
  if (node.is_object()) {  // rows, cols, dt and data
    const std::optional<int> rows = whole(child(node, {"rows"})), cols = whole(child(node, {"cols"}));
    const Json& data = child(node, {"data"});
    if (!rows || !cols) return std::nullopt;
    values = data.is_number() ? std::vector{data.get<double>()} : numbers(data).value_or(values);
    const bool complete = std::ssize(values) == std::int64_t{*rows} * *cols;
    return complete && !values.empty() ? std::optional(values) : std::nullopt;
  }
  if (!node.is_array()) return std::nullopt;
  for (const Json& each : node) {
    if (each.is_number()) {
      values.push_back(each.get<double>());
    } else if (const auto row = each.is_array() ? numbers(each) : std::nullopt) {
      values.insert(values.end(), row->begin(), row->end());
    } else {
      return std::nullopt;
    }
  }
  return values;
}

std::vector<double> as_many(const Json& node, std::size_t count, const std::string& path, const std::string& what) {
  const auto values = numbers(node);
  if (!values || values->size() != count) throw Error("{}: {} must hold {} numbers", path, what, count);
  return *values;
}

Matrix<3> matrix_of(const Json& node, const std::string& path, const std::string& what) {
  const auto values = as_many(node, 9, path, what);
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data());
}

/// A rotation matrix or Rodrigues' vector.
Matrix<3> rotation_at(const Json& node, const std::string& path) {
  const auto values = numbers(node);
  if (values && values->size() == 3) return geometry::rotation_from({(*values)[0], (*values)[1], (*values)[2]});
  return matrix_of(node, path, "the rotation");
}

geometry::Lens lens_at(const Json& K_node, const Json& D_node, bool fisheye, const std::string& path) {
  const Matrix<3> K = matrix_of(K_node, path, "the camera matrix");
  auto k = D_node.is_null() ? std::vector<double>{} : numbers(D_node).value_or(std::vector<double>(99));
  while (!k.empty() && k.back() == 0) k.pop_back();  // 12 and 14 coefficients, the last of which are mostly not used
  const auto filled = [&](auto lens) -> geometry::Lens {
    if (k.size() > lens.distortion.size()) {
      throw Error("{}: {} coefficients of distortion; the model {} has {} (thin prisms and tilted sensors are not known)", path,
                  k.size(), lens.name, lens.distortion.size());
    }
    lens.focal = {K(0, 0), K(1, 1)};
    lens.principal = {K(0, 2), K(1, 2)};
    std::copy(k.begin(), k.end(), lens.distortion.begin());
    return lens;
  };
  return fisheye ? filled(geometry::FisheyeLens{}) : filled(geometry::BrownLens{});
}

std::optional<cv::Size> size_at(const Json& node) {
  const Json &width = child(node, {"image_width", "imageWidth", "width"}),
             &height = child(node, {"image_height", "imageHeight", "height"});
  if (width.is_number() && height.is_number())
    return cv::Size(cv::saturate_cast<int>(width.get<double>()), cv::saturate_cast<int>(height.get<double>()));
  const auto both = numbers(child(node, {"image_size", "imageSize", "size", "image_resolution"}));
  if (!both || both->size() != 2) return std::nullopt;
  return cv::Size(cv::saturate_cast<int>((*both)[0]), cv::saturate_cast<int>((*both)[1]));
}

RigCamera camera_at(const Json& node, const std::string& path) {
  RigCamera camera;
  if (const Json& name = child(node, {"name", "camera_name"}); name.is_string()) camera.name = name.get<std::string>();
  camera.size = size_at(node);
  const Json& model = child(node, {"distortion_model", "model", "camera_model"});
  const bool fisheye = model == "fisheye" || model == "equidistant" || !child(node, {"fisheye_model"}).is_null();
  const Json& K = child(node, {"camera_matrix", "cameraMatrix", "Camera_Matrix", "K", "mtx", "intrinsic_matrix"});
  if (!K.is_null()) {
    camera.lens =
        lens_at(K, child(node, {"distortion_coefficients", "Distortion_Coefficients", "distCoeffs", "dist_coeffs", "D", "dist"}),
                fisheye, path);
  }
  const Json &R = child(node, {"rotation", "R", "rvec"}), &t = child(node, {"translation", "T", "t", "tvec"});
  if (!R.is_null() && !t.is_null()) {
    const auto at = as_many(t, 3, path, "the translation");
    camera.camera_from_world = Rigid3{rotation_at(R, path), {at[0], at[1], at[2]}};
  }
  if (const Json& error = child(node, {"avg_reprojection_error", "rms", "reprojection_error"}); error.is_number())
    camera.rms_px = error.get<double>();
  return camera;
}

Rig stereo(const Json& root, const std::string& path) {
  Rig rig;
  rig.cameras.resize(2);
  const std::array<Names, 2> K{
      {{"M1", "K1", "cameraMatrix1", "camera_matrix_1"}, {"M2", "K2", "cameraMatrix2", "camera_matrix_2"}}};
  const std::array<Names, 2> D{{{"D1", "distCoeffs1", "dist_coeffs_1"}, {"D2", "distCoeffs2", "dist_coeffs_2"}}};
  for (std::size_t i = 0; i < 2; ++i) {
    rig.cameras[i].name = i == 0 ? "left" : "right";
    rig.cameras[i].size = size_at(root);
    rig.cameras[i].lens = lens_at(child(root, K[i]), child(root, D[i]), false, path);
  }
  Json extrinsics;
  if (child(root, {"R"}).is_null()) {
    const auto name = std::filesystem::path(path).parent_path() / ("extrinsics" + std::filesystem::path(path).extension().string());
    if (std::filesystem::exists(name)) extrinsics = parse_file_storage(read_file(name.string()), name.string());
  }
  const Json& poses = extrinsics.is_null() ? root : extrinsics;
  if (child(poses, {"R"}).is_null() || child(poses, {"T"}).is_null()) return rig;
  const auto t = as_many(child(poses, {"T"}), 3, path, "T");
  rig.cameras[0].camera_from_world = Rigid3{};
  rig.cameras[1].camera_from_world = Rigid3{rotation_at(child(poses, {"R"}), path), {t[0], t[1], t[2]}};
  return rig;
}

cv::Mat as_mat(const Eigen::MatrixXd& m) {
  cv::Mat result(static_cast<int>(m.rows()), static_cast<int>(m.cols()), CV_64F);
  for (int i = 0; i < result.rows; ++i) {
    for (int j = 0; j < result.cols; ++j) result.at<double>(i, j) = m(i, j);
  }
  return result;
}

void write_camera(cv::FileStorage& file, const RigCamera& camera) {
  file << "name" << camera.name;
  if (camera.size) file << "image_width" << camera.size->width << "image_height" << camera.size->height;
  if (camera.lens) {
    // OpenCV has these two models; any other becomes the nearest of the first.
    geometry::Lens lens = *camera.lens;
    const bool known = std::holds_alternative<geometry::BrownLens>(lens) || std::holds_alternative<geometry::FisheyeLens>(lens);
    if (!known) lens = as_brown(camera, geometry::BrownLens::coefficients, "OpenCV");
    file << "camera_matrix"
         << as_mat(Matrix<3>{{geometry::focal_of(lens).x(), 0, geometry::principal_of(lens).x()},
                             {0, geometry::focal_of(lens).y(), geometry::principal_of(lens).y()},
                             {0, 0, 1}});
    const bool fisheye = std::holds_alternative<geometry::FisheyeLens>(lens);
    file << "distortion_model" << (fisheye ? "fisheye" : "rational_polynomial");
    file << "distortion_coefficients"
         << std::visit(
                [](const auto& model) {
                  return as_mat(Eigen::Map<const Eigen::RowVectorXd>(model.distortion.data(), std::ssize(model.distortion)));
                },
                lens);
  }
  if (camera.camera_from_world) {
    file << "rotation" << as_mat(camera.camera_from_world->rotation);
    file << "translation" << as_mat(camera.camera_from_world->translation);
  }
}

}  // namespace

Rig parse_opencv_rig(const std::string& text, const std::string& path) {
  const Json root = parse_file_storage(text, path);
  Rig rig;
  if (const Json& cameras = child(root, {"cameras"}); cameras.is_array()) {
    for (const Json& each : cameras) rig.cameras.push_back(camera_at(each, path));
  } else if (!child(root, {"M1", "K1", "cameraMatrix1", "camera_matrix_1"}).is_null()) {
    rig = stereo(root, path);
  } else {
    rig.cameras.push_back(camera_at(root, path));
    if (!rig.cameras.front().lens) throw Error("{}: there is no camera_matrix in it, nor M1 and M2, nor a list of cameras", path);
  }
  check_imported(rig, path);
  return rig;
}

Rig read_opencv_rig(const std::string& path) {
  return parse_opencv_rig(read_file(path), path);
}

void write_opencv_rig(const Rig& rig, const std::string& path) try {
  if (std::none_of(rig.cameras.begin(), rig.cameras.end(), [](const RigCamera& camera) { return camera.lens.has_value(); }))
    throw Error("{}: OpenCV's format holds cameras with a lens, and the rig has none; calibrate one first", path);
  const bool json = path.ends_with(".json");
  cv::FileStorage file(json ? ".json" : ".yml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
  if (rig.cameras.size() == 1) {
    write_camera(file, rig.cameras.front());  // as OpenCV's own calibration sample
  } else {
    file << "cameras"
         << "[";
    for (const RigCamera& camera : rig.cameras) {
      file << "{";
      write_camera(file, camera);
      file << "}";
    }
    file << "]";
  }
  WholeFile whole(path);
  whole.write(file.releaseAndGetString());
  whole.finish();
} catch (const cv::Exception&) {
  throw Error("{}: OpenCV's format cannot hold this rig; are its cameras' names longer than 4,000 bytes?", path);
}

Format opencv_format() {
  return {.name = "opencv",
          .title = "a calibration of OpenCV",
          .endings = ".yml .yaml .json",
          .holds = Content::rig,
          .detail = "OpenCV's FileStorage: YAML, XML or JSON; lenses and poses",
          .is =
              [](const Beginning& file) {
                if (!file.is_text()) return false;
                if (file.has("<opencv_storage") || file.bytes.starts_with("%YAML") || file.bytes.starts_with("---")) return true;
                const bool yaml = file.path.ends_with(".yml") || file.path.ends_with(".yaml");
                return !rig::is_xml(file) && (yaml || (file.path.ends_with(".json") && file.has("matrix")));
              },
          .read_rig = rig::read_opencv_rig,
          .write_rig = rig::write_opencv_rig};
}

}  // namespace marey::format::rig
