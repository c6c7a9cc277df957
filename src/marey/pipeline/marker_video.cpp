#include "marey/pipeline/marker_video.h"

#include <fmt/format.h>

#include "marey/draw/canvas.h"
#include "marey/draw/movie_writer.h"
#include "marey/format/whole_file.h"
#include "marey/source/video_source.h"

namespace marey::pipeline {

void film_markers(const simulate::markers::MarkerScene& scene, const std::string& path) {
  draw::MovieWriter movie(path, scene.options.size, scene.options.rate_hz, draw::MovieWriter::Quality::to_measure);
  for (int i = 0; i < std::ssize(scene.frames); ++i) {
    movie.write(draw::Canvas(Picture(simulate::markers::render_frame(scene, i))).take(),
                timestamp_from_seconds(i / scene.options.rate_hz));
  }
  movie.finish();
}

void write_marker_truth(const simulate::markers::MarkerScene& scene, const std::string& path) {
  format::WholeFile file(path);
  file.write("frame,time,label,x,y,visible\n");
  for (std::size_t i = 0; i < scene.frames.size(); ++i) {
    for (const simulate::markers::MarkerTruth& marker : scene.frames[i]) {
      file.write(fmt::format("{},{:.6f},M{},{:.4f},{:.4f},{}\n", i, static_cast<double>(i) / scene.options.rate_hz,
                             marker.marker + 1, marker.position.x(), marker.position.y(), marker.visible ? 1 : 0));
    }
  }
  file.finish();
}

Observation<2> observation_of(const Detection& detection) {
  Observation<2> observation;
  observation.value = detection.centre;
  observation.covariance = detection.covariance;
  observation.score = detection.score;
  observation.box = detection.box;
  return observation;
}

SeenMarkers see_markers(const std::string& path, const detect::markers::MarkerOptions& options) {
  SeenMarkers seen;
  const std::unique_ptr<Source> source = source::open_video(path);
  detect::markers::MarkerDetector detector(options);
  while (const auto frame = source->next()) {
    seen.times.push_back(frame->time);
    auto& observations = seen.frames.emplace_back();
    for (const Detection& detection : detector.detect(*frame, {}).detections) observations.push_back(observation_of(detection));
  }
  return seen;
}

}  // namespace marey::pipeline
