// A muscle's activity over the gait cycle: the linear envelope of its electromyogram (Winter 2009, section 10.3.2). The mean and
// what is below 20 Hz (movement of the cables) are removed, the rest is rectified and low-passed at 6 Hz, forwards and backwards.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "marey/analyse/gait/gait_cycles.h"

namespace marey::analyse::gait {

struct EmgOptions {
  double high_pass_hz = 20;
  double envelope_hz = 6;
};

/// Of an electromyogram at a rate of 60 Hz or more; empty below it, which cannot hold one.
std::vector<double> emg_envelope(std::span<const double> signal, double rate_hz, const EmgOptions& options = {});

/// The side that a channel's label names: "Voltage.L Rect", "RGastroc", "left_tibialis"; nothing if it names none.
std::optional<Side> side_of_label(std::string_view label);

}  // namespace marey::analyse::gait
