#pragma once

#include <string>

#include "marey/stream/channel_layout.h"

namespace marey::stream {

/// Which parts of the settings a client asked for.
struct QtmSettings {
  bool general = false, points = false, bodies = false, skeletons = false;
};

/// The settings as XML, which the Qualisys C++ SDK reads. To version 1.20 bodies had another form (`minor` is what follows "1.").
std::string qtm_parameters_xml(const RecordingHeader& header, const ChannelLayout& channel_layout, const QtmSettings& required,
                               int minor);

}  // namespace marey::stream
