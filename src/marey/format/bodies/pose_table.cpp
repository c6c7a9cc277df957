// Where bodies are and how they are turned, as a table: a row for each body and frame.
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/files/whole_file.h"
#include "marey/format/format.h"
#include "marey/format/read_file.h"
#include "marey/format/text_rows.h"

namespace marey::format::bodies {
namespace {

constexpr std::string_view kHead = "frame,time,skeleton,body,x,y,z,qw,qx,qy,qz,state,residual_mm";

class PoseTable final : public Sink {
 public:
  explicit PoseTable(const std::string& path) : file_(path), path_(path) {}

  std::string name() const override { return path_; }

  SinkRequirements begin(const RecordingHeader& header) override {
    if (header.bodies.empty())
      throw Error("{}: the recording holds no bodies, so that there are no poses; `marey body track` finds them", path_);
    for (const Body& body : header.bodies) names_[body.id] = quoted_field(body.skeleton) + ',' + quoted_field(body.label);
    file_.write(fmt::format("{}\n", kHead));
    return {};
  }

  void write(const Instant& instant) override {
    lines_.clear();
    for (const BodyPose& pose : instant.bodies) {
      const Vector<3>& at = pose.world_from_body.translation;
      Eigen::Quaterniond q(pose.world_from_body.rotation);
      if (q.w() < 0) q.coeffs() = -q.coeffs();
      fmt::format_to(std::back_inserter(lines_), "{},{:.6f},{},{:.7g},{:.7g},{:.7g},{:.9f},{:.9f},{:.9f},{:.9f},{},", instant.index,
                     seconds(instant.time), names_[pose.body], at.x(), at.y(), at.z(), q.w(), q.x(), q.y(), q.z(),
                     pose.tracked ? "measured" : "predicted");
      if (pose.residual_m) fmt::format_to(std::back_inserter(lines_), "{:.4g}", 1000 * *pose.residual_m);
      lines_ += '\n';
    }
    file_.write(lines_);
  }

  void finish() override { file_.finish(); }

 private:
  WholeFile file_;
  std::string path_;
  std::map<BodyId, std::string> names_;  // its skeleton and its label, as cells
  std::string lines_;
};

std::vector<Fact> facts_of_poses(const std::string& path) {
  const std::string text = read_file(path);
  TextLines lines(text);
  std::string_view line;
  lines.next(line);
  std::int64_t rows = 0;
  std::set<std::string> bodies;
  std::vector<std::string_view> fields;
  while (lines.next(line)) {
    if (line.empty()) continue;
    split_fields(line, ',', fields);
    if (fields.size() != 13) throw Error("{}:{}: has {} columns; poses have 13", path, lines.number(), fields.size());
    bodies.insert(plain_text(unquoted(fields[3])));
    ++rows;
  }
  return {{"bodies", std::vector<std::string>(bodies.begin(), bodies.end())}, {"poses", rows}};
}

}  // namespace

Format poses_format() {
  return {.name = "poses",
          .title = "a CSV file of bodies' poses, one row each",
          .endings = "",
          .holds = Content::space,
          .detail =
              "`--format poses`; one row a body and frame: `frame,time,skeleton,body,x,y,z,qw,qx,qy,qz,state,residual_mm`; m, z "
              "up; the "
              "unit quaternion turns the body's frame into the world. Points are not in it",
          .is = [](const Beginning& file) { return file.first_line() == kHead; },
          .facts = facts_of_poses,
          .create = [](const std::string& path, const WritePlan&) -> std::unique_ptr<Sink> {
            return std::make_unique<PoseTable>(path);
          },
          .while_recording = true,
          .poses = true,
          .z_up = true};
}

}  // namespace marey::format::bodies
