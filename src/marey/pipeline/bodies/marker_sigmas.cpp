#include "marey/pipeline/bodies/marker_sigmas.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

namespace marey::pipeline::bodies {
namespace {

/// A label without its side and without what is not a letter begins so, or is so.
struct MarkerKind {
  std::string_view word;
  double sigma_m;
};

constexpr double kCluster_m = 0.05;  // anywhere on the limb; unswept

/// Between examiners, root mean square by axis: pelvis 6 to 21 mm, knee 11 to 22, ankle 8 to 15, foot 7 to 16 (Della Croce,
/// Leardini, Chiari, Cappozzo 2005, Gait & Posture 21, table 2); shoulder, elbow and wrist 7 to 15 (de Groot 1997, Clinical
/// Biomechanics 12). Clusters are on no landmark: their place is the limb's length by its width. Longer words come before their
/// beginnings.
constexpr std::array<MarkerKind, 58> kKinds = {
    {{"asis", 0.012},       {"asi", 0.012},      {"psis", 0.012},    {"psi", 0.012},        {"vsacral", 0.015},  {"sacr", 0.015},
     {"sacral", 0.015},     {"hjc", 0.01},       {"kneelat", 0.012}, {"kneemed", 0.012},    {"knee", 0.012},     {"knm", 0.012},
     {"kne", 0.012},        {"kjc", 0.01},       {"lfc", 0.012},     {"mfc", 0.012},        {"anklelat", 0.01},  {"anklemed", 0.01},
     {"ankle", 0.01},       {"anm", 0.01},       {"ank", 0.01},      {"ajc", 0.01},         {"lmal", 0.01},      {"mmal", 0.01},
     {"heel", 0.012},       {"hee", 0.012},      {"cal", 0.012},     {"toe", 0.012},        {"mt", 0.012},       {"midfoot", 0.015},
     {"acromium", 0.015},   {"acr", 0.015},      {"sho", 0.015},     {"ash", 0.02},         {"psh", 0.02},       {"sjc", 0.01},
     {"elbow", 0.012},      {"elb", 0.012},      {"lel", 0.012},     {"mel", 0.012},        {"ejc", 0.01},       {"wrist", 0.012},
     {"wra", 0.012},        {"wrb", 0.012},      {"fin", 0.015},     {"sternum", 0.015},    {"strn", 0.015},     {"clav", 0.015},
     {"thigh", kCluster_m}, {"thi", kCluster_m}, {"th", kCluster_m}, {"shank", kCluster_m}, {"tib", kCluster_m}, {"tb", kCluster_m},
     {"bicep", kCluster_m}, {"ua", kCluster_m},  {"fa", kCluster_m}, {"upa", kCluster_m}}};
constexpr double kOther_m = 0.02;  // the loosest landmark of the table; unswept

/// Letters alone, small; the side's first letter is omitted: "R.Knee.Lat" is "kneelat".
std::string bare_label(std::string_view label) {
  label = label.substr(label.find_last_of(':') + 1);
  std::string letters;
  for (const char c : label) {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  const bool side = !label.empty() && (label[0] == 'L' || label[0] == 'R' || label[0] == 'l' || label[0] == 'r');
  return side && letters.size() > 1 ? letters.substr(1) : letters;
}

}  // namespace

double marker_sigma(std::string_view label) {
  const std::string bare = bare_label(label);
  for (const MarkerKind& kind : kKinds) {
    if (bare.starts_with(kind.word)) return kind.sigma_m;
  }
  return kOther_m;
}

std::vector<double> marker_sigmas(const Skeleton& skeleton) {
  std::vector<double> sigmas;
  for (const SkeletonMarker& marker : skeleton.markers) sigmas.push_back(marker_sigma(marker.label));
  return sigmas;
}

}  // namespace marey::pipeline::bodies
