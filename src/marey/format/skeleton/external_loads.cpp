#include "marey/format/skeleton/external_loads.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/files/whole_file.h"
#include "marey/format/read_file.h"
#include "marey/format/skeleton/motion_table.h"
#include "marey/format/skeleton/skeleton_file.h"
#include "marey/format/text_rows.h"
#include "marey/format/xml_text.h"

namespace marey::format::skeleton {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 9> kLoadColumns = {"force_{}_vx", "force_{}_vy", "force_{}_vz", "force_{}_px", "force_{}_py",
                                                     "force_{}_pz", "torque_{}_x", "torque_{}_y", "torque_{}_z"};

std::string text_in(pugi::xml_node node, const char* element) {
  std::string text = plain_text(node.child_value(element));
  text.erase(0, std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  text.erase(text.find_last_not_of(" \t\r\n") + 1);
  return text;
}

/// "/bodyset/calcn_r" is called "calcn_r".
std::string body_in(pugi::xml_node node, const char* element) {
  const std::string path = text_in(node, element);
  return path.substr(path.find_last_of('/') + 1);
}

class LoadTable {
 public:
  LoadTable(const std::string& path, const MotionTable& table) : path_(path), table_(table), z_up_(z_up_from(UpAxis::y)) {}

  /// Three columns of an identifier; zeros if there is no identifier. Cells without a number are 0.
  std::vector<Vector<3>> vectors(const std::string& identifier) const {
    std::vector<Vector<3>> result(table_.rows.size(), Vector<3>::Zero());
    if (identifier.empty()) return result;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const std::string name = identifier + "xyz"[axis];
      const auto column = std::find(table_.columns.begin(), table_.columns.end(), name);
      if (column == table_.columns.end()) throw Error("{}: has no column {}, which its external loads name", path_, name);
      for (std::size_t r = 0; r < result.size(); ++r)
        result[r][axis] = table_.rows[r][static_cast<std::size_t>(column - table_.columns.begin())].value_or(0);
    }
    for (Vector<3>& vector : result) vector = z_up_ * vector;
    return result;
  }

 private:
  std::string path_;
  const MotionTable& table_;
  Matrix<3> z_up_;
};

ExternalLoad load_of(pugi::xml_node node, const std::string& path, const MotionTable& table, const LoadTable& columns) {
  ExternalLoad load;
  load.body = body_in(node, "applied_to_body");
  for (const char* frame : {"force_expressed_in_body", "point_expressed_in_body"}) {
    const std::string body = body_in(node, frame);
    if (!body.empty() && body != "ground")
      throw Error("{}: {} of {} is {}; only ground is supported", path, frame, shown(load.body), shown(body));
  }
  load.times = table.times;
  load.forces = columns.vectors(text_in(node, "force_identifier"));
  load.points = columns.vectors(text_in(node, "point_identifier"));
  load.moments = columns.vectors(text_in(node, "torque_identifier"));
  return load;
}

}  // namespace

std::vector<ExternalLoad> read_external_loads(const std::string& path) {
  const pugi::xml_document document = parse_xml(read_file(path), path);
  const pugi::xml_node root = document.document_element();
  const pugi::xml_node node = std::strcmp(root.name(), "ExternalLoads") == 0 ? root : root.child("ExternalLoads");
  if (!node) throw Error("{}: has no <ExternalLoads>", path);
  const std::string named = text_in(node, "datafile");
  if (named.empty()) throw Error("{}: names no <datafile>", path);
  const std::string data = fs::path(named).is_absolute() ? named : (fs::path(path).parent_path() / named).string();
  const MotionTable table = read_motion_table(data);
  if (!std::is_sorted(table.times.begin(), table.times.end())) throw Error("{}: its times do not grow", data);
  const LoadTable columns(data, table);
  std::vector<ExternalLoad> loads;
  for (const pugi::xml_node force : node.child("objects").children("ExternalForce")) {
    if (text_in(force, "isDisabled") == "true" || text_in(force, "appliesForce") == "false") continue;
    loads.push_back(load_of(force, path, table, columns));
  }
  if (loads.empty()) throw Error("{}: has no <ExternalForce>", path);
  return loads;
}

void write_external_loads(const std::string& path, const std::vector<ExternalLoad>& loads) {
  MotionTable table{.title = "ground_reactions", .in_degrees = false, .columns = {}, .times = {}, .rows = {}};
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("OpenSimDocument");
  root.append_attribute("Version") = "40000";
  pugi::xml_node set = root.append_child("ExternalLoads");
  set.append_attribute("name") = "ground_reactions";
  pugi::xml_node objects = set.append_child("objects");
  const Matrix<3> y_up = z_up_from(UpAxis::y).transpose();
  if (!loads.empty()) table.times = loads.front().times;
  table.rows.resize(table.times.size());
  for (const ExternalLoad& load : loads) {
    const char side = load.body.empty() ? 'x' : load.body.back();
    for (const char* column : kLoadColumns) table.columns.push_back("ground_" + fmt::format(fmt::runtime(column), side));
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      for (const auto* vectors : {&load.forces, &load.points, &load.moments}) {
        for (const double value : Vector<3>(y_up * (*vectors)[r])) table.rows[r].emplace_back(value);
      }
    }
    pugi::xml_node force = objects.append_child("ExternalForce");
    force.append_attribute("name") = ("ground_" + load.body).c_str();
    add_text(force, "applied_to_body", load.body);
    for (const char* frame : {"force_expressed_in_body", "point_expressed_in_body"}) add_text(force, frame, "ground");
    add_text(force, "force_identifier", fmt::format("ground_force_{}_v", side));
    add_text(force, "point_identifier", fmt::format("ground_force_{}_p", side));
    add_text(force, "torque_identifier", fmt::format("ground_torque_{}_", side));
  }
  add_text(set, "datafile", fs::path(path).filename().string());
  write_motion_table(path, table);
  WholeFile file(fs::path(path).replace_extension(".xml").string());
  file.write(to_text(document));
  file.finish();
}

}  // namespace marey::format::skeleton
