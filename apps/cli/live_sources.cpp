#include "live_sources.h"

#include <fmt/format.h>

#include "marey/files/source_name.h"
#include "marey/pipeline/live/live_feeds.h"

#include "rig_inputs.h"

namespace marey::cli {

bool is_rig_file(const std::string& source) {
  return scheme_of(source).empty() && source.ends_with(".toml");
}

void add_live_sources(Command& command, std::vector<std::string>& sources) {
  std::string forms;
  for (const auto& kind : pipeline::live::live_kinds()) forms += fmt::format("{}{}", forms.empty() ? "" : "; ", kind.form);
  command
      .input_files(
          "SOURCES", sources,
          "a rig file, with CAMERA=SOURCE in place of its own sources; or sources alone, each a camera: a video that is played; " +
              forms)
      .required();
}

Rig rig_of_live_sources(const std::vector<std::string>& sources) {
  if (!is_rig_file(sources.front())) return pipeline::live::rig_of_sources(sources);
  return rig_of(RigAndSources{sources.front(), {sources.begin() + 1, sources.end()}});
}

}  // namespace marey::cli
