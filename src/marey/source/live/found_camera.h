#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

namespace marey::source::live {

/// A camera that is plugged in.
struct FoundCamera {
  struct Mode {
    std::string format;            ///< "GREY", "YUYV", "MJPG", "Mono8", …
    cv::Size size;                 ///< px
    std::vector<double> rates_hz;  ///< the fastest first; empty if it does not specify
  };
  struct Control {
    std::string name;
    double minimum = 0, maximum = 0, now = 0;
  };
  std::string source;  ///< as a rig names it
  std::string name;    ///< as its maker does
  std::string where;   ///< the bus or address that it hangs on
  std::vector<Mode> modes;
  std::vector<Control> controls;
};

}  // namespace marey::source::live
