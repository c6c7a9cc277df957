// Cameras from labelled elements of the pitch: how many labels are explained, and how well each is predicted by the others.
//
//   element_camera LABELS.json [every=N] [from=N] [mirrors=0] [left_out=0] [details=1] [OPTION=VALUE ...]
//
// An OPTION is a number of ElementCameraOptions, as label_sigma=0.002; place_sigma_x, _y, _z are the place's.
// Prints JaC@5 and @10 at 960x540 as SoccerNet's evaluator counts, completeness, each element scored with the camera fitted
// without it, and how often a mirrored pitch goes undetected.
#include "marey/calibrate/pitch/element_camera.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "marey/calibrate/pitch/element_score.h"
#include "marey/core/error.h"
#include "marey/format/pitch_labels.h"

namespace {

using namespace marey;
using calibrate::pitch::ElementCamera;
using geometry::LabelledElement;

const cv::Size kSize(960, 540);

calibrate::pitch::ElementCameraOptions options;

std::map<std::string, double*> settings() {
  return {{"roll_sigma", &options.roll_sigma},
          {"place_sigma_x", &options.position_sigma.x()},
          {"place_sigma_y", &options.position_sigma.y()},
          {"place_sigma_z", &options.position_sigma.z()},
          {"bend", &options.bend},
          {"bend_sigma", &options.bend_sigma},
          {"focal_sigma", &options.focal_sigma},
          {"label_sigma", &options.label_sigma},
          {"points_of_element", &options.points_of_element},
          {"outlier", &options.outlier},
          {"mirror_margin", &options.mirror_margin}};
}

bool predicted(const geometry::Camera& camera, const LabelledElement& label) {
  const auto distances = calibrate::pitch::element_distances(camera, label, {});
  return std::all_of(distances.begin(), distances.end(), [](const auto& distance) { return distance && *distance < 5; });
}

void print_fit(const std::vector<format::LabelledImage>& images, bool details) {
  double jac5 = 0, jac10 = 0;
  int found = 0;
  for (const auto& image : images) {
    const ElementCamera fitted = calibrate::pitch::camera_from_elements(image.elements, kSize, options);
    if (!fitted.camera) {
      if (details) std::printf("%s: %s\n", image.name.c_str(), std::string(element_verdict_name(fitted.verdict)).c_str());
      continue;
    }
    ++found;
    const auto score = calibrate::pitch::score_elements(*fitted.camera, image.elements, {}, 5);
    jac5 += score.jaccard();
    jac10 += calibrate::pitch::score_elements(*fitted.camera, image.elements, {}, 10).jaccard();
    if (!details) continue;
    std::printf("%s: JaC %.2f (%d %d %d)", image.name.c_str(), score.jaccard(), score.right, score.wrong, score.missed);
    for (const double p : fitted.view.p) std::printf(" %.4f", p);
    for (std::size_t i = 0; i < fitted.used.size(); ++i) {
      if (!fitted.used[i])
        std::printf(" [%s %.0f px]", std::string(geometry::pitch_elements({})[image.elements[i].element].name).c_str(),
                    fitted.error_px[i]);
    }
    std::printf("\n");
  }
  const double n = static_cast<double>(images.size());
  std::printf("JaC@5 %.2f %% of those found, JaC@10 %.2f %%, complete %.2f %%, JaC@5 x complete %.2f %%\n", 100 * jac5 / found,
              100 * jac10 / found, 100 * found / n, 100 * jac5 / n);
}

void print_excluded(const std::vector<format::LabelledImage>& images) {
  int right = 0, all = 0;
  for (const auto& image : images) {
    for (std::size_t i = 0; i < image.elements.size(); ++i) {
      std::vector<LabelledElement> others = image.elements;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      const ElementCamera fitted = calibrate::pitch::camera_from_elements(others, kSize, options);
      right += fitted.camera && predicted(*fitted.camera, image.elements[i]) ? 1 : 0;
      ++all;
    }
  }
  std::printf("each element by the camera fitted without it, within 5 px: %.2f %% of %d\n", 100.0 * right / all, all);
}

void print_mirrored(const std::vector<format::LabelledImage>& images) {
  for (const auto& [what, mirror] : {std::pair{"left and right", geometry::PitchMirror{.left_right = true}},
                                     {"near and far", geometry::PitchMirror{.near_far = true}},
                                     {"both", geometry::PitchMirror{.left_right = true, .near_far = true}}}) {
    int undetected = 0, all = 0;
    for (const auto& image : images) {
      if (image.elements.size() < 5) continue;
      std::vector<LabelledElement> mirrored = image.elements;
      for (LabelledElement& label : mirrored) label.element = geometry::mirrored_element(label.element, mirror);
      undetected += calibrate::pitch::camera_from_elements(mirrored, kSize, options).camera ? 1 : 0;
      ++all;
    }
    std::printf("%s exchanged, undetected: %d of %d\n", what, undetected, all);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: element_camera LABELS.json [every=N] [OPTION=VALUE ...]\n"), 2;
  std::map<std::string, double*> known = settings();
  double every = 1, from = 0, mirrors = 1, details = 0, excluded = 1;
  known["every"] = &every, known["from"] = &from, known["mirrors"] = &mirrors, known["details"] = &details,
  known["left_out"] = &excluded;
  for (int i = 2; i < argc; ++i) {
    const std::string text = argv[i];
    const auto equals = text.find('=');
    const auto found = known.find(text.substr(0, equals));
    if (equals == std::string::npos || found == known.end()) return std::fprintf(stderr, "%s: no such setting\n", argv[i]), 2;
    *found->second = std::atof(text.c_str() + equals + 1);
  }
  try {
    const auto all = format::read_pitch_labels(argv[1], kSize);
    std::vector<format::LabelledImage> some;
    for (auto i = static_cast<std::size_t>(from); i < all.size(); i += static_cast<std::size_t>(std::max(1.0, every)))
      some.push_back(all[i]);
    print_fit(some, details > 0);
    if (mirrors > 0) print_mirrored(some);
    if (excluded > 0) print_excluded(some);
  } catch (const Error& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
  return 0;
}
