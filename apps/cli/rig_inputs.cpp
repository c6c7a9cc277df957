#include "rig_inputs.h"

#include <algorithm>
#include <cmath>

#include "marey/core/error.h"
#include "marey/format/observations.h"
#include "marey/format/rig/rig_file.h"

namespace marey::cli {

void add_rig_inputs(CLI::App& command, RigInputs& inputs) {
  command.add_option("RIG", inputs.rig, "the rig file; may be left out where --observations tells of the cameras");
  command.add_option("VIDEOS", inputs.videos, "CAMERA=VIDEO: a camera's source, in place of the rig's");
  command.add_option("--observations", inputs.observations,
                     "in place of videos, blobs that another program found: a CSV with header camera,frame,x,y[,marker], or a "
                     "MultiCamSelfCal folder");
}

Rig rig_of(const RigInputs& inputs) {
  if (inputs.rig.empty() && inputs.observations.empty()) throw CLI::ValidationError("RIG", "give a rig file, or --observations");
  Rig rig = inputs.rig.empty() ? format::rig_of_observations(inputs.observations) : format::rig::read_rig(inputs.rig);
  for (const std::string& video : inputs.videos) {
    const auto equal = video.find('=');
    if (equal == std::string::npos) throw Error("\"{}\" names no camera: write CAMERA=VIDEO", video);
    const std::string name = video.substr(0, equal);
    const auto camera =
        std::find_if(rig.cameras.begin(), rig.cameras.end(), [&](const RigCamera& one) { return one.name == name; });
    if (camera == rig.cameras.end()) throw Error("{} has no camera \"{}\", which {} names", inputs.rig, name, video);
    camera->source = video.substr(equal + 1);
  }
  return rig;
}

std::vector<double> numbers_in(const std::string& text, const char* option, const char* form) {
  std::vector<double> values;
  for (std::size_t at = 0; at <= text.size();) {
    const std::string part = text.substr(at, text.find(',', at) - at);
    std::size_t used = 0;
    double value = 0;
    try {
      value = std::stod(part, &used);
    } catch (const std::exception&) {
      used = std::string::npos;
    }
    if (used != part.size() || !std::isfinite(value)) throw Error("{} {}: \"{}\" is no number; write {}", option, text, part, form);
    values.push_back(value);
    at += part.size() + 1;
  }
  return values;
}

}  // namespace marey::cli
