#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "marey/core/error.h"
#include "marey/format/mapped_file.h"
#include "marey/format/motion/c3d.h"
#include "marey/format/motion/c3d_auxiliary.h"
#include "marey/format/motion/c3d_layout.h"
#include "marey/format/motion/c3d_parameters.h"
#include "marey/format/motion/c3d_points.h"
#include "marey/format/motion/c3d_zeros.h"
#include "marey/format/motion/theia_segments.h"

namespace marey::format::motion {
namespace {

class C3dReader : public FileReader {
 public:
  C3dReader(std::unique_ptr<MappedFile> file, std::span<const std::byte> bytes, const std::string& name, C3dPoints points,
            const std::optional<UpAxis>& up = {})
      : file_(std::move(file)),
        path_(name),
        head_(read_c3d_head(bytes, name)),
        bytes_(bytes, head_.processor),
        layout_(c3d_layout(head_, bytes.size(), name)),
        points_(bytes_, layout_) {
    for (const auto* sentences : {&head_.warnings, &layout_.warnings}) warn(*sentences);
    reports_measured_ = any_point_reports();
    info_.header.made_by.program = maker();
    info_.header.rate_hz = rate(name);
    info_.frame_count = static_cast<std::int64_t>(layout_.frames);
    const std::string screen = head_.text("POINT:Y_SCREEN");
    if (screen == "+Y" || screen == "+Z") info_.up = screen == "+Y" ? UpAxis::y : UpAxis::z;
    find_tracks(points);
    if (maker() != "Marey") zeros_.emplace(points_, locations());  // which marks all that is missing
    if (zeros_) warn(zeros_->warnings());
    find_bodies();
    if (file_ != nullptr) info_.auxiliary = auxiliary_data(head_, layout_, name);
    info_.auxiliary.rotated = up.value_or(info_.up.value_or(UpAxis::z)) == UpAxis::y;
  }

  const FileInfo& info() const override { return info_; }
  std::vector<std::string> warnings() const override { return warnings_; }

  std::optional<Instant> next() override {
    if (at_ == layout_.frames) return std::nullopt;
    Instant frame;
    frame.index = layout_.first_index + static_cast<std::int64_t>(at_);
    frame.time = timestamp_from_seconds(static_cast<double>(frame.index) / info_.header.rate_hz);
    for (std::size_t i = 0; i < layout_.points; ++i) {
      if (!is_position_[i]) continue;
      if (auto point = point_at(at_, i)) frame.samples.push_back(*point);
    }
    for (std::size_t i = 0; i < layout_.bodies; ++i) {
      if (auto pose = pose_at(at_, i)) frame.bodies.push_back(*pose);
    }
    ++at_;
    return frame;
  }

 private:
  void warn(const std::vector<std::string>& sentences) {
    for (const std::string& message_text : sentences) warnings_.push_back(path_ + ": " + message_text);
  }

  bool any_point_reports() const {
    for (std::size_t frame = 0; frame < layout_.frames; ++frame) {
      for (std::size_t i = 0; i < layout_.points; ++i) {
        if (points_.fourth_word(frame, i) > 0) return true;
      }
    }
    return false;
  }

  std::optional<Sample> point_at(std::size_t frame, std::size_t i) const {
    const int word = points_.fourth_word(frame, i);
    if (word < 0 || (zeros_ && zeros_->missing(frame, i))) return std::nullopt;
    const Vector<3> position = points_.position(frame, i);
    if (!position.allFinite()) return std::nullopt;
    Sample point;
    point.track = TrackId(static_cast<int>(i) + 1);
    point.position = position * layout_.unit_m;
    if (word > 0) {
      point.cameras = static_cast<CameraMask>(word >> 8);
      point.residual_m = (word & 0xff) * layout_.scale * layout_.unit_m;
    } else if (reports_measured_) {
      point.provenance = Provenance::filled;
    }
    return point;
  }

  double rate(const std::string& name) {
    for (const double rate : {head_.number("POINT:RATE").value_or(0), static_cast<double>(head_.rate_hz)}) {
      if (std::isfinite(rate) && rate > 1e-6 && rate < 1e9) return rate;
    }
    warnings_.push_back(name + ": does not specify its rate; 100 frames a second are assumed");
    return 100;
  }

  std::string maker() const {
    const std::string software = head_.text("MANUFACTURER:SOFTWARE"), local_clutter = head_.text("MANUFACTURER:COMPANY");
    if (software.empty() || local_clutter.empty() || software.starts_with(local_clutter))
      return software.empty() ? local_clutter : software;
    return local_clutter + " " + software;
  }

  /// What stands among the points and is not one: angles in degrees, forces in N, …
  std::map<std::string, std::string_view> other_quantities() const {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kGroups{{{"POINT:ANGLES", "angles"},
                                                                                    {"POINT:FORCES", "forces"},
                                                                                    {"POINT:MOMENTS", "moments"},
                                                                                    {"POINT:POWERS", "powers"},
                                                                                    {"POINT:SCALARS", "scalars"}}};
    std::map<std::string, std::string_view> quantities;
    for (const auto& [parameter, quantity] : kGroups) {
      for (const std::string& label : head_.texts(parameter)) quantities.emplace(label, quantity);
    }
    return quantities;
  }

  void find_tracks(C3dPoints points) {
    std::vector<std::string> labels = head_.texts("POINT:LABELS");
    labels.resize(layout_.points);
    const auto quantities = points == C3dPoints::all ? std::map<std::string, std::string_view>() : other_quantities();
    std::map<std::string_view, int> excluded;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const auto other = labels[i].empty() ? quantities.end() : quantities.find(labels[i]);
      is_position_.push_back(other == quantities.end());
      if (is_position_.back()) {
        info_.tracks.push_back({TrackId(static_cast<int>(i) + 1), std::move(labels[i]), {}});
      } else {
        ++excluded[other->second];
      }
    }
    if (excluded.empty()) return;
    std::string counts;
    for (const auto& [quantity, count] : excluded) counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, quantity);
    warnings_.push_back(fmt::format("{}: {} stand among its points and are not places; they are omitted", path_, counts));
  }

  /// The tracks whose points are positions: an angle of 0 is not one.
  std::vector<TrackName> locations() const {
    const auto others = other_quantities();
    std::vector<TrackName> tracks;
    std::copy_if(info_.tracks.begin(), info_.tracks.end(), std::back_inserter(tracks),
                 [&](const TrackName& track) { return track.label.empty() || !others.contains(track.label); });
    return tracks;
  }

  void find_bodies() {
    std::vector<std::string> labels = head_.texts("ROTATION:LABELS");
    labels.resize(layout_.bodies);
    for (std::size_t i = 0; i < layout_.bodies; ++i) {
      std::string& label = labels[i];
      if (label.ends_with(kC3dMatrixEnding)) label.resize(label.size() - kC3dMatrixEnding.size());
      if (label.empty()) label = fmt::format("body {}", i + 1);
      Body body;
      body.id = BodyId(static_cast<int>(i) + 1);
      body.label = std::move(label);
      info_.header.bodies.push_back(std::move(body));
    }
    hang_theia_segments(info_.header.bodies, layout_.frames, [this](std::size_t frame, std::size_t i) -> std::optional<Rigid3> {
      const auto pose = pose_at(frame, i);
      return pose ? std::optional(pose->world_from_body) : std::nullopt;
    });
  }

  /// The first of a frame's matrices of this body; nothing if it is absent, or it is not a rigid motion.
  std::optional<BodyPose> pose_at(std::size_t frame, std::size_t i) const {
    constexpr double kStretched = 1e-3;
    const std::size_t at = layout_.bodies_begin + frame * layout_.bodies_bytes() + i * layout_.body_bytes();
    if (!(bytes_.real(at + 4 * 16) >= 0)) return std::nullopt;
    BodyPose pose;
    pose.body = BodyId(static_cast<int>(i) + 1);
    const auto element = [&](Eigen::Index row, Eigen::Index column) {
      return static_cast<double>(bytes_.real(at + 4 * static_cast<std::size_t>(4 * column + row)));
    };
    Matrix<3> rotated;
    for (Eigen::Index row = 0; row < 3; ++row) {
      for (Eigen::Index column = 0; column < 3; ++column) rotated(row, column) = element(row, column);
      pose.world_from_body.translation[row] = element(row, 3) * layout_.unit_m;
    }
    if (!pose.world_from_body.translation.allFinite() || !rotated.allFinite() || rotated.determinant() < 0 ||
        (rotated.transpose() * rotated - Matrix<3>::Identity()).norm() > kStretched)
      return std::nullopt;
    pose.world_from_body.rotation = Eigen::Quaterniond(rotated).normalized().toRotationMatrix();
    return pose;
  }

  std::unique_ptr<MappedFile> file_;
  std::string path_;
  C3dHead head_;
  C3dBytes bytes_;
  C3dLayout layout_;
  C3dPointWords points_;
  std::optional<C3dZeros> zeros_;
  bool reports_measured_ = false;
  FileInfo info_;
  std::vector<bool> is_position_;  // of each point
  std::vector<std::string> warnings_;
  std::size_t at_ = 0;
};

}  // namespace

std::unique_ptr<FileReader> open_c3d(const std::string& path, C3dPoints points, const std::optional<UpAxis>& up) {
  auto file = std::make_unique<MappedFile>(path);
  const std::span<const std::byte> bytes = file->bytes();
  return std::make_unique<C3dReader>(std::move(file), bytes, path, points, up);
}

std::unique_ptr<FileReader> read_c3d(std::span<const std::byte> bytes, const std::string& name) {
  return std::make_unique<C3dReader>(nullptr, bytes, name, C3dPoints::locations);
}

}  // namespace marey::format::motion
