// Another host's clock by round trips. An answer was given between question and arrival, so that half the round trip is what it can
// be off; clocks of two hosts drift apart in the meantime. Of the last few round trips the one with the least of both gives the
// time (F. Cristian, "Probabilistic clock synchronization", Distributed Computing 3, 1989).
#pragma once

#include <deque>
#include <optional>

#include "marey/core/time.h"

namespace marey::source::live {

class NodeClock {
 public:
  /// It was asked at `asked` and its answer came at `came`, both by the clock here; it said `told` by its own.
  void learn(Timestamp requested, Timestamp reported, Timestamp came);

  /// A time of that clock by the clock here; nothing before the first answer.
  std::optional<Timestamp> here(Timestamp there) const;

  /// What `here` may be off, s, at `now` by the clock here.
  double uncertainty(Timestamp now) const;

 private:
  struct RoundTrip {
    Timestamp came{};
    Duration ahead{};  ///< of the clock here before that one
    double half_s = 0;
  };
  std::optional<RoundTrip> best(Timestamp now) const;

  std::deque<RoundTrip> last_;
  std::optional<RoundTrip> best_;
};

}  // namespace marey::source::live
