// Cameras of the host's own kernel: USB webcams, and whatever else Linux has a driver for.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/source/live/address.h"
#include "marey/source/live/connection.h"
#include "marey/source/live/found_camera.h"
#include "marey/source/live/kernel.h"

namespace marey::source::live {

/// What a name asks for; what is not asked for stays as the camera has it.
struct V4l2Options {
  std::string device;         ///< "/dev/video0", or a name below /dev/v4l/by-id that stays with the camera
  int width = 0, height = 0;  ///< px
  std::optional<double> rate_hz;
  std::string format;  ///< "GREY", "YUYV", "MJPG"; empty: the first of these that it has
  std::optional<double> exposure_ms, gain;
};

/// Of "v4l2:/dev/video0?size=640x480&rate=30&format=GREY&exposure=5&gain=20". Throws Error.
V4l2Options v4l2_options(const Address& address, std::optional<double> rate_hz);

/// Frames are copied out of the driver's memory, so that it has its buffers back at once. Times are the driver's where it stamps by
/// the host's clock (as uvcvideo does, with the start of exposure), gaps in its numbers are frames lost.
Connect connect_v4l2(const V4l2Options& options, std::shared_ptr<Kernel> kernel = system_kernel());

/// Those that are plugged in and give images.
std::vector<FoundCamera> find_v4l2(Kernel& kernel);

}  // namespace marey::source::live
