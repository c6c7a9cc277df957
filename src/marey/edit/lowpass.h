// Paths of markers through Butterworth's low pass (geometry/butterworth.h), and the cut-off that fits them.
// Source: Winter, "Biomechanics and Motor Control of Human Movement", ch. 2 (residual analysis).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/recording.h"

namespace marey::edit {

/// Smooths places at an even rate. `cutoff_hz` is where both passes together let half of the power through; at
/// `highest_cutoff` or above, and of fewer than four places, nothing is changed.
void lowpass(std::span<Vector<3>> path, double rate_hz, double cutoff_hz);

/// Below it `lowpass` changes something: the cut-off of a single pass lies below half the rate.
double highest_cutoff(double rate_hz);

/// The cut-off that residual analysis proposes: where what is taken away falls to what noise alone would leave. Nothing if the
/// path is too short (a second at least).
std::optional<double> proposed_cutoff(std::span<const Vector<3>> path, double rate_hz);

/// Instants a second between two of them; 1 where they are one.
double rate_between(std::span<const Recording::TimeStep> time_steps, std::int32_t first, std::int32_t last);

}  // namespace marey::edit
