// The one corridor that every job walks: a clock gives what the cameras saw at one instant, a stage makes of it the state of
// that instant, sinks take it where the user wants it. What a job does is its stage; where results go are its sinks; nothing else
// differs.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/core/instant.h"
#include "marey/core/recording.h"
#include "marey/core/sink.h"
#include "marey/pipeline/corridor/clock.h"
#include "marey/pipeline/corridor/foreground_sink.h"
#include "marey/pipeline/corridor/summary.h"

namespace marey::pipeline::corridor {

/// Instants, one after the other.
class InstantSource {
 public:
  virtual ~InstantSource() = default;
  /// Nothing at the end.
  virtual std::optional<Instant> next() = 0;
};

/// One job's order of steps, from what the cameras saw at an instant to the state at it.
class Stage {
 public:
  virtual ~Stage() = default;
  virtual RecordingHeader header() const = 0;
  /// Sinks want `Instant::boxes`. Before the first step.
  virtual void need_boxes() {}
  /// Sinks want the foreground of each frame that is searched, in `step` and in `finish`: `give` takes it. Before the first step.
  virtual void need_foregrounds(std::function<void(FrameForeground)> /*give*/) {
  }  // NOLINT(performance-unnecessary-value-param): stages keep it
  /// The results after this instant, mostly of it, sometimes of earlier ones that waited; valid until the next call. A job with a
  /// second pass keeps all for that.
  virtual std::span<const Instant> step(const FrameSet& frames) = 0;
  /// What a person who watches should know at once of what the steps since the last call found out, one sentence each.
  virtual std::vector<std::string> news() { return {}; }
  /// Results available only after the cameras have ended: instants that waited, or the whole recording after a second pass. Nothing
  /// where all was reported.
  virtual std::unique_ptr<InstantSource> finish(const Hooks& /*hooks*/) { return nullptr; }
  /// Puts in what it counted and what it found out.
  virtual void report(Summary& summary) const = 0;
};

/// The sinks of a run. Each is written behind a bounded queue of its own, so that one that waits (a video, a socket) holds no
/// person up before its queue is full. One that fails is closed and named: the run then ends, after the others have finished what
/// there was.
class Sinks {
 public:
  /// What happens where a sink is slower than the run.
  enum class Slow {
    waited_for,  ///< the run waits; one that fails ends it
    skipped,     ///< it is given no more before it has caught up, and that is counted; one that fails is closed, the run continues
  };
  explicit Sinks(Slow slow = Slow::waited_for);
  ~Sinks();
  Sinks(Sinks&&) noexcept;
  Sinks& operator=(Sinks&&) noexcept;

  void add(std::unique_ptr<Sink> sink);
  void begin(const RecordingHeader& header);
  bool need_images() const;
  bool need_boxes() const;
  bool need_foregrounds() const;
  /// To those that want foregrounds; false as for `write`.
  bool write(FrameForeground foreground);
  /// To all others. Whether the run may continue: that all still take what they are given, where they are waited for.
  bool write(Instant instant);
  /// Of sinks that are skipped: what they missed, and which of them failed, one sentence each.
  std::vector<std::string> troubles() const;
  bool failed() const;
  /// Drops those that want images: they leave nothing behind. Returns their names.
  std::vector<std::string> drop_images();
  /// Commits all that did not fail. Throws Error, with the sink's name, where one has failed and is not a trouble().
  void finish();

 private:
  class Lane;
  template <typename Work>
  bool hand_to(Lane& lane, const Work& work) const;

  Slow slow_;
  std::vector<std::unique_ptr<Lane>> lanes_;
};

/// Runs a job from its cameras' first frame to its sinks' last. Where a second pass reports instants that are past and a sink wants
/// their images, the clock is asked for them again. A run that is asked to stop writes the results until then, but for sinks
/// whose images would have to be asked for again: they leave nothing, and a warning names them. Throws Error if not one frame
/// could be read, or a sink has failed; Stopped where nothing was tracked before it was asked to stop.
Summary run(Stage& stage, Clock& clock, Sinks& sinks, const Hooks& hooks = {});

}  // namespace marey::pipeline::corridor
