#pragma once

#include <string>
#include <string_view>

#include "marey/core/instant.h"
#include "marey/core/recording.h"
#include "marey/stream/channel_layout.h"
#include "marey/stream/stream_clock.h"

namespace marey::stream {

/// A text as JSON holds it, with its quotation marks.
std::string json_quoted(std::string_view text);

/// The line sent once: `{"type":"header",…}` with the frame, the unit, the rate and the bodies. One line, without its end.
std::string json_header(const RecordingHeader& header, const ChannelLayout& channel_layout);
/// An instant: `{"type":"frame",…}`, all points and bodies with their names.
std::string json_frame(const RecordingHeader& header, const ChannelLayout& channel_layout, const Instant& instant,
                       const FrameTimes& times);

}  // namespace marey::stream
