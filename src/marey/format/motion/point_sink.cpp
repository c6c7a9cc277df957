#include "marey/format/motion/point_sink.h"

#include "marey/core/error.h"

namespace marey::format::motion {

Sink::SinkRequirements PointSink::begin(const RecordingHeader& header) {
  if (header.frame.kind != FrameOfReference::Kind::space)
    throw Error("{}: such a file holds points in space, and these positions are {}", path_, to_string(header.frame));
  start(header);
  return {};
}

}  // namespace marey::format::motion
