#include "marey/pipeline/people_video.h"

#include <filesystem>
#include <iterator>

#include <fmt/format.h>

#include "marey/core/time.h"
#include "marey/draw/movie_writer.h"
#include "marey/format/whole_file.h"

namespace marey::pipeline {
namespace {

/// COCO's uncompressed run lengths of a mask: columns from the left, each from the top; background first, foreground next, and so
/// on.
std::string run_lengths(const cv::Mat& mask) {
  std::string text = "[";
  bool inside = false;
  int length = 0;
  const auto end_run = [&] {
    fmt::format_to(std::back_inserter(text), "{}{}", text.size() > 1 ? "," : "", length);
    length = 0;
    inside = !inside;
  };
  for (int x = 0; x < mask.cols; ++x) {
    for (int y = 0; y < mask.rows; ++y) {
      if ((mask.at<unsigned char>(y, x) != 0) != inside) end_run();
      ++length;
    }
  }
  end_run();
  return text + "]";
}

class TruthFiles {
 public:
  explicit TruthFiles(const std::filesystem::path& folder)
      : boxes_((folder / "truth.txt").string()),
        positions_((folder / "positions.csv").string()),
        silhouettes_((folder / "silhouettes.jsonl").string()) {
    positions_.write("frame,time,id,team,x,y,foot_x,foot_y,visible\n");
  }

  void write(int frame, double time, const simulate::people::TrueFigure& person, cv::Size size) {
    const Box picture{0, 0, static_cast<double>(size.width), static_cast<double>(size.height)};
    const Box box = geometry::intersection(person.whole.box(), picture);
    if (box.empty()) return;
    boxes_.write(fmt::format("{},{},{:.2f},{:.2f},{:.2f},{:.2f},1,1,{:.3f}\n", frame + 1, person.id, box.left + 1, box.top + 1,
                             box.width, box.height, person.visible_share));
    positions_.write(fmt::format("{},{:.6f},{},{},{:.4f},{:.4f},{:.3f},{:.3f},{:.3f}\n", frame, time, person.id, person.team,
                                 person.ground.x(), person.ground.y(), person.foot.x(), person.foot.y(), person.visible_share));
    silhouettes_.write(fmt::format(R"({{"frame":{},"id":{},"size":[{},{}],"whole":{},"visible":{}}})", frame, person.id,
                                   size.height, size.width, run_lengths(person.whole.pixel_mask(size)),
                                   run_lengths(person.visible.pixel_mask(size))) +
                       "\n");
  }

  void finish() {
    boxes_.finish();
    positions_.finish();
    silhouettes_.finish();
  }

 private:
  format::WholeFile boxes_, positions_, silhouettes_;
};

}  // namespace

void film_people(const simulate::people::PeopleFilm& film, const std::string& folder,
                 const std::function<void(int, int)>& progress) {
  const std::filesystem::path place = folder;
  const simulate::people::PeopleFilmOptions& options = film.options();
  draw::MovieWriter movie((place / "video.mp4").string(), options.size, options.rate_hz, draw::MovieWriter::Quality::to_measure);
  TruthFiles truth(place);
  for (int i = 0; i < film.frames(); ++i) {
    const double time = i / options.rate_hz;
    const simulate::people::RenderedFrame frame = film.render(i);
    movie.write(frame.picture, timestamp_from_seconds(time));
    for (const simulate::people::TrueFigure& person : frame.people) truth.write(i, time, person, options.size);
    if (progress) progress(i + 1, film.frames());
  }
  movie.finish();
  truth.finish();
}

}  // namespace marey::pipeline
