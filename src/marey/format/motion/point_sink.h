#pragma once

#include <string>
#include <utility>

#include "marey/format/format.h"

namespace marey::format::motion {

/// A file of points in space, written instant by instant; it is there atomically.
class PointSink : public Sink {
 public:
  explicit PointSink(std::string path) : path_(std::move(path)) {}
  std::string name() const override { return path_; }
  /// Throws Error if the recording is not of points in space.
  SinkRequirements begin(const RecordingHeader& header) final;

 protected:
  virtual void start(const RecordingHeader& header) = 0;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace marey::format::motion
