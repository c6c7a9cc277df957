#include "file_checks.h"

#include <filesystem>

#include "marey/files/overwriting.h"

#include "command_line.h"

namespace marey::cli {

void make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw Error("{}: the folder cannot be made ({})", path, error.message());
}

void check_files(std::span<const NamedPath> inputs, std::span<const NamedPath> outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const NamedPath& output = outputs[i];
    if (output.path.empty() || is_stream(output.path)) continue;
    for (const NamedPath& input : inputs) {
      if (!overwrites(output.path, input.path)) continue;
      if (!output.may_replace.empty() && is_one_file(output.may_replace, input.path)) continue;
      throw WrongUsage("{} {}: is an input too ({}) and would be destroyed; name another file", output.option, output.path,
                       input.path);
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (outputs[k].path.empty() || is_stream(outputs[k].path) || !is_one_file(output.path, outputs[k].path)) continue;
      throw WrongUsage("{} {}: is written by {} too; name another file", output.option, output.path, outputs[k].option);
    }
  }
}

}  // namespace marey::cli
