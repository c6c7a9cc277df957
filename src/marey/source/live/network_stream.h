// Cameras on a network that send a coded video: RTSP, and HTTP (MJPEG and whatever else FFmpeg reads).
#pragma once

#include <optional>
#include <string>

#include "marey/source/live/connection.h"

namespace marey::source::live {

struct NetworkOptions {
  std::string url;
  double open_s = 5;    ///< a host that does not answer for this long is tried again
  double silent_s = 3;  ///< a stream that brings nothing for this long is opened again
  bool udp = false;     ///< RTSP's images by UDP: later frames do not wait for a lost one, which is damaged instead. Else by TCP.
};

/// FFmpeg at its least delay: nothing is kept back, one thread decodes, and frames not decodable without the lost ones are left
/// out until the next key frame. If the sender reports its clock (RTCP) a frame's time is when it was taken, by that clock; else
/// it is when the frame came.
Connect connect_network(const NetworkOptions& options);

}  // namespace marey::source::live
