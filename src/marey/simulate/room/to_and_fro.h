#pragma once

namespace marey::simulate::room {

/// Of a motion that is shown forwards and backwards, again and again, the time that is shown at `time_s`: it begins at 0 and turns
/// every `length_s`. Before and after each turn it slows down and speeds up evenly for up to half a second, since a tracker that
/// expects bodies with inertia would lose markers whose velocity is reversed from one frame to the next. An even function of time.
double to_and_fro(double time_s, double length_s);

}  // namespace marey::simulate::room
