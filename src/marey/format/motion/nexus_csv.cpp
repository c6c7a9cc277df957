#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/motion/length_unit.h"
#include "marey/format/motion/motion_csv.h"
#include "marey/format/motion/wide_table.h"

namespace marey::format::motion {
namespace {

/// "Trajectories", the rate, the names over their X columns, the axes, the units, the rows. Other parts (joints, devices) may come
/// before.
class NexusHead : private WideTableHead {
 public:
  using WideTableHead::WideTableHead;

  std::unique_ptr<FileReader> reader(std::unique_ptr<MappedFile> file) {
    do {
      need("a line \"Trajectories\"");
    } while (fields_.front() != "Trajectories");
    need("the rate");
    set_rate(number_of(fields_.front()), fmt::format("{} is not a rate in frames per second", shown(fields_.front())));
    info_.header.made_by.program = "Nexus";
    need("the names of its markers");
    const std::vector<std::string_view> names = fields_;
    need("its line of axes");
    if (fields_.front() != "Frame") fail("begins not with \"Frame\"");
    const std::vector<std::string_view> axes = fields_;
    need("its units");
    for (std::size_t i = 2; i + 2 < axes.size(); i += 3) {
      if (axes[i] != "X" || axes[i + 1] != "Y" || axes[i + 2] != "Z") break;
      add_marker(i < names.size() ? unquoted(names[i]) : std::string(), i);
    }
    const auto unit = fields_.size() > 2 ? metres_of_unit(fields_[2]) : std::nullopt;
    table_.unit_m = unit.value_or(0.001);
    table_.rows = part(lines_.rest());
    return rows_of(std::move(file));
  }

 private:
  void need(const char* which) {
    if (!next_line()) throw Error("{}: ends before {}; it is cut off, or no file of Nexus's", name_, which);
  }
  /// The rows up to the blank line that ends them.
  static std::string_view part(std::string_view rows) {
    TextLines lines(rows);
    std::string_view line;
    std::string_view before = lines.rest();
    while (lines.next(line)) {
      if (line.find_first_not_of(", \t") == std::string_view::npos) return rows.substr(0, rows.size() - before.size());
      before = lines.rest();
    }
    return rows;
  }
};

}  // namespace

std::unique_ptr<FileReader> open_nexus_csv(const std::string& path) {
  auto file = std::make_unique<MappedFile>(path);
  return NexusHead(file->text(), path).reader(std::move(file));
}
std::unique_ptr<FileReader> read_nexus_csv(std::string_view text, const std::string& name) {
  return NexusHead(text, name).reader(nullptr);
}

Format nexus_format() {
  return {.name = "nexus",
          .title = "a CSV file of Nexus's",
          .endings = {},
          .holds = Content::space,
          .detail = "mm; points, as Vicon's Nexus exports them",
          .is =
              [](const Beginning& file) {
                for (const char* part : {"Trajectories", "Joints", "Devices", "Model Outputs"}) {
                  if (file.text().starts_with(part)) return true;
                }
                return false;
              },
          .open = [](const std::string& path, const ReadOptions&) { return motion::open_nexus_csv(path); }};
}

}  // namespace marey::format::motion
