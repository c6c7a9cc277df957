#include "skeleton_option.h"

#include <vector>

#include "marey/pipeline/markers/skeleton_in_space.h"

namespace marey::cli {

void add_skeleton_option(Command& command, std::string& skeleton) {
  command.input_file(
      "--skeleton", skeleton,
      "solve the pose of this skeleton from the named markers, with every instant: skeleton.toml or .osim, fitted to "
      "the person (marey solve --write-skeleton)");
}

std::shared_ptr<const Skeleton> skeleton_of(const std::string& path) {
  if (path.empty()) return nullptr;
  std::vector<std::string> warnings;
  auto skeleton = pipeline::markers::skeleton_with_markers(path, warnings);
  warn(warnings);
  return skeleton;
}

}  // namespace marey::cli
