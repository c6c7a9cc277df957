#pragma once

#include <memory>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/format/format.h"

#include "scene.h"
#include "web_server.h"

namespace marey::viewer {

struct ViewOptions {
  ListenAddress location;
  format::ReadOptions read;
  GroundChoice ground;
  std::string video;  ///< whose images lie behind tracks in an image; empty: none
  bool edit = false;  ///< the page may change the take that it shows
};

/// Shows a recording in a file to the one who opens `address()`: any that format::open_recording reads.
class RecordingViewer {
 public:
  /// Opens the file and listens. Throws Error if either cannot be.
  RecordingViewer(const std::string& path, const ViewOptions& options);
  ~RecordingViewer();

  std::string address() const;
  /// Reads the file to its end; read parts are shown meanwhile. Returns its warnings. Throws Error if the file breaks off,
  /// Stopped where it is asked to stop.
  std::vector<std::string> read(const Hooks& hooks);

 private:
  class Core;
  std::unique_ptr<Core> core_;
};

}  // namespace marey::viewer
