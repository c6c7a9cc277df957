// How many people a detection network finds, alone: recall and precision against boxes in MOT text at an intersection over union of
// one half.
//
//   network_people MODEL.toml VIDEO TRUTH.txt [every=12] [first=10] [last=298] [score=S]
//
// Frames are the truth's, from 1. The network searches all of each image; the size of people is learned meanwhile.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "marey/core/error.h"
#include "marey/core/source.h"
#include "marey/detect/network/network_detector.h"
#include "marey/source/open_source.h"

namespace {

using namespace marey;

std::map<int, std::vector<Box>> truth_of(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw Error("{}: cannot be read", path);
  std::map<int, std::vector<Box>> truth;
  std::string line;
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    int frame = 0, id = 0;
    Box box;
    if (words >> frame >> id >> box.left >> box.top >> box.width >> box.height) {
      --box.left, --box.top;
      truth[frame].push_back(box);
    }
  }
  return truth;
}

struct Tally {
  int right = 0, found = 0, people = 0;

  void add(std::vector<Detection> detections, const std::vector<Box>& truth) {
    std::stable_sort(detections.begin(), detections.end(),
                     [](const Detection& a, const Detection& b) { return a.score > b.score; });
    std::vector<char> taken(truth.size(), 0);
    for (const Detection& one : detections) {
      std::size_t best = truth.size();
      double maximum = 0.5;
      for (std::size_t i = 0; i < truth.size(); ++i) {
        const double overlap = geometry::iou(one.box, truth[i]);
        if (!taken[i] && overlap >= maximum) maximum = overlap, best = i;
      }
      if (best < truth.size()) taken[best] = 1, ++right;
    }
    found += static_cast<int>(detections.size()), people += static_cast<int>(truth.size());
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return std::fprintf(stderr, "usage: network_people MODEL.toml VIDEO TRUTH.txt [every=12] [score=S]\n"), 2;
  std::map<std::string, double> settings = {{"every", 12}, {"first", 10}, {"last", 298}};
  for (int i = 4; i < argc; ++i) {
    const std::string text = argv[i];
    settings[text.substr(0, text.find('='))] = std::atof(text.c_str() + text.find('=') + 1);
  }
  try {
    const auto truth = truth_of(argv[3]);
    detect::network::NetworkDetectorOptions options;
    options.model = argv[1];
    options.background = false;
    detect::network::NetworkDetector detector(options);
    const auto source = source::open_source(argv[2]);
    std::map<int, Tally> by_score;
    int frames = 0;
    while (const auto frame = source->next()) {
      const int number = static_cast<int>(frame->index) + 1;
      if (number > settings["last"]) break;
      if (number < settings["first"] || (number - static_cast<int>(settings["first"])) % static_cast<int>(settings["every"]) != 0)
        continue;
      const auto here = truth.find(number);
      if (here == truth.end()) continue;
      ++frames;
      const std::vector<Detection> detected = detector.people_everywhere(*frame);
      for (int percent = 20; percent <= 70; percent += 5) {
        std::vector<Detection> sure;
        std::copy_if(detected.begin(), detected.end(), std::back_inserter(sure),
                     [&](const Detection& one) { return one.score * 100 >= percent; });
        by_score[percent].add(std::move(sure), here->second);
      }
    }
    std::printf("%d frames\nscore  recall  precision\n", frames);
    for (const auto& [percent, tally] : by_score)
      std::printf(" 0.%02d   %.3f   %.3f\n", percent, static_cast<double>(tally.right) / std::max(1, tally.people),
                  static_cast<double>(tally.right) / std::max(1, tally.found));
  } catch (const Error& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
  return 0;
}
