#include "rig_inputs.h"

#include <filesystem>

#include "marey/core/rig_sources.h"
#include "marey/format/observations.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/take/take_file.h"
#include "marey/format/take_observations.h"

namespace marey::cli {

std::vector<std::string> files_of_rig(const std::string& rig) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(rig, error) || format::take::is_take(rig)) return {};
  std::vector<std::string> files;
  for (const RigCamera& camera : format::rig::read_rig(rig).cameras) {
    files.push_back(camera.source);
    files.push_back(camera.detections);
  }
  return files;
}

Option add_rig(Command& command, RigAndSources& inputs, const std::string& meaning) {
  const Option rig = command.input_file("RIG", inputs.rig, meaning);
  command.input_files("SOURCES", inputs.sources, "CAMERA=VIDEO, CAMERA=FOLDER or CAMERA=PATTERN in place of the rig's own sources");
  command.also_reads([&inputs] { return files_of_rig(inputs.rig); });
  return rig;
}

Rig rig_of(const RigAndSources& inputs) {
  Rig rig = format::take::is_take(inputs.rig) ? format::rig_of_take(inputs.rig) : format::rig::read_rig(inputs.rig);
  set_sources(rig, inputs.sources);
  return rig;
}

Option add_rig_inputs(Command& command, RigInputs& inputs) {
  const Option rig = add_rig(command, inputs.rig,
                             "the rig file, or a take: then what its own cameras saw is used again; may be omitted where "
                             "--observations names the cameras");
  command.input_file("--observations", inputs.observations,
                     "in place of videos, blobs that another program found: a CSV with header camera,frame,x,y[,marker], or a "
                     "MultiCamSelfCal folder; or those of a take");
  return rig;
}

Rig rig_of(const RigInputs& inputs) {
  if (inputs.rig.rig.empty() && inputs.observations.empty()) throw WrongUsage("RIG: give a rig file, or --observations");
  return inputs.rig.rig.empty() ? format::rig_of_observations(inputs.observations) : rig_of(inputs.rig);
}

std::string observations_of(const RigInputs& inputs) {
  const bool own = inputs.observations.empty() && inputs.rig.sources.empty() && format::take::is_take(inputs.rig.rig);
  return own ? inputs.rig.rig : inputs.observations;
}

}  // namespace marey::cli
