// What every camera of a live run saw, kept, so that it can be done again from files.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "marey/core/sink.h"
#include "marey/draw/movie_writer.h"
#include "marey/pipeline/corridor/recorder.h"

namespace marey::pipeline::live {

/// Writes FOLDER/CAMERA.mp4 of each camera, good enough to measure in, of the instants at which `wanted` is on, and
/// FOLDER/rig.toml: the rig with these videos as its sources, and when each began. Both are there from the first frame on and stay,
/// however the program ends.
class CameraVideos final : public Sink {
 public:
  CameraVideos(std::string folder, std::shared_ptr<const corridor::RecordSwitch> required);
  ~CameraVideos() override;

  /// What it writes into the folder for this rig.
  static std::vector<std::string> files_of(const std::string& folder, const Rig& rig);

  std::string name() const override { return folder_.string(); }
  /// Throws Error if the folder cannot be made.
  SinkRequirements begin(const RecordingHeader& header) override;
  void write(const Instant& instant) override;
  void finish() override;

 private:
  struct SweepVideo {
    std::unique_ptr<draw::MovieWriter> movie;
    Timestamp begin{}, last{};
  };

  std::string file_of(CameraId camera) const;
  SweepVideo open(const Frame& frame) const;
  void write_rig() const;

  std::filesystem::path folder_;
  std::shared_ptr<const corridor::RecordSwitch> required_;
  Rig rig_;
  bool made_ = false;  // the folder was not there before
  std::map<CameraId, SweepVideo> videos_;
};

}  // namespace marey::pipeline::live
