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
class NexusHead {
 public:
  NexusHead(std::string_view text, std::string name) : name_(std::move(name)), lines_(text) {}

  std::unique_ptr<MotionReader> reader(std::unique_ptr<MappedFile> file) {
    do {
      next_line("a line \"Trajectories\"");
    } while (fields_.front() != "Trajectories");
    next_line("the rate");
    const auto rate = number_of(fields_.front());
    if (!rate || *rate <= 1e-6 || *rate > 1e9) fail(fmt::format("{} is no rate in frames per second", shown(fields_.front())));
    info_.header.rate_hz = *rate;
    info_.header.made_by.program = "Nexus";
    next_line("the names of its markers");
    const std::vector<std::string_view> names = fields_;
    next_line("its line of axes");
    if (fields_.front() != "Frame") fail("begins not with \"Frame\"");
    const std::vector<std::string_view> axes = fields_;
    next_line("its units");
    for (std::size_t i = 2; i + 2 < axes.size(); i += 3) {
      if (axes[i] != "X" || axes[i + 1] != "Y" || axes[i + 2] != "Z") break;
      table_.x_columns.push_back(i);
      const auto id = static_cast<int>(info_.tracks.size()) + 1;
      info_.tracks.push_back({TrackId(id), i < names.size() ? unquoted(names[i]) : std::string(), {}});
    }
    const auto unit = fields_.size() > 2 ? metres_of_unit(fields_[2]) : std::nullopt;
    table_.unit_m = unit.value_or(0.001);
    table_.rows = part(lines_.rest());
    table_.first_line = lines_.number() + 1;
    return std::make_unique<WideTableReader>(std::move(file), name_, std::move(table_), std::move(info_),
                                             std::vector<std::string>());
  }

 private:
  void next_line(const char* which) {
    std::string_view line;
    if (!lines_.next(line)) throw Error("{}: ends before {}; it is cut off, or no file of Nexus's", name_, which);
    split_fields(line, ',', fields_);
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
  [[noreturn]] void fail(const std::string& what) const { throw Error("{}:{}: {}", name_, lines_.number(), what); }

  std::string name_;
  TextLines lines_;
  std::vector<std::string_view> fields_;
  WideTable table_;
  MotionInfo info_;
};

}  // namespace

std::unique_ptr<MotionReader> open_nexus_csv(const std::string& path) {
  auto file = std::make_unique<MappedFile>(path);
  return NexusHead(file->text(), path).reader(std::move(file));
}
std::unique_ptr<MotionReader> read_nexus_csv(std::string_view text, const std::string& name) {
  return NexusHead(text, name).reader(nullptr);
}

}  // namespace marey::format::motion
