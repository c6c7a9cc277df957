// Rigid bodies out of points in space: defined once from a recording, then followed in others, live or from files.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/core/recording.h"
#include "marey/solve/bodies/body_tracker.h"
#include "marey/solve/bodies/define_body.h"

namespace marey::pipeline::bodies {

/// Puts into each instant where the bodies are: a step of any stage that reports points in space, live too. A track is a body's
/// marker where its label is "BODY:MARKER", or the marker's own and no other body has one of that name; other points are found by
/// how they lie to each other.
class BodiesInSpace {
 public:
  BodiesInSpace(std::vector<Body> bodies, const solve::bodies::TrackingOptions& options = {});

  void name(const TrackName& track);
  /// `instant.bodies` becomes the current state. Of its samples those count that were measured or filled.
  void add_to(Instant& instant);
  const solve::bodies::BodyTracker& tracker() const { return target_tracker_; }

 private:
  solve::bodies::BodyTracker target_tracker_;
  std::map<std::string, std::pair<int, int>, std::less<>> markers_;  // by label
  std::map<TrackId, std::pair<int, int>> named_;
  std::vector<solve::bodies::BodyTrackPoint> points_;
};

struct TrackBodiesOptions {
  solve::bodies::TrackingOptions tracking;
  std::string format;      ///< of the file to be written; empty: its ending says it
  double settle_s = 0.25;  ///< instants wait this long for a symmetric body to be found turned
};

struct TrackBodiesSummary {
  struct OfBody {
    Body body;
    solve::bodies::TrackCounts counts;
    double error_m = 0;  ///< mean over the measured instants of the markers' mean distance from their places
    std::vector<solve::bodies::Symmetry> symmetries;
  };
  /// A return after which a symmetric body may be turned.
  struct InQuestion {
    std::string body;
    std::int64_t frame = 0;  ///< of the recording, from which on
    Timestamp time{};
    double probability = 0;
    std::string turn;  ///< "turned 180° about its z axis"
  };
  std::vector<OfBody> bodies;
  std::vector<InQuestion> in_question;
  std::int64_t instants = 0;
  double noise_m = 0;
  std::vector<std::string> warnings;
  bool stopped = false;
};

/// Follows the bodies of a file (bodies.toml, or a table of places) through a recording of points in space, and writes it with
/// them. Throws Error if a file cannot be read or written, or the recording is not one of space.
TrackBodiesSummary track_bodies(const std::string& recording, const std::string& bodies, const std::string& out,
                                const TrackBodiesOptions& options, const Hooks& hooks = {});

/// The body of these markers of a recording; written to `out`, beside those that are there already where `add` is set: one of its
/// name is replaced.
solve::bodies::DefinedBody define_body(const std::string& recording, const std::string& out, bool add,
                                       const solve::bodies::DefineOptions& options);

/// What a user should know of a body: "turned 180° about its z axis it appears the same; …". One sentence each.
std::vector<std::string> review_items_of(const solve::bodies::DefinedBody& defined);

}  // namespace marey::pipeline::bodies
