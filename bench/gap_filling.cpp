// How well gaps in markers' paths are filled: holes cut into observed real walks, filled with the method that is chosen by
// itself, with a polynomial alone and with rigid neighbours alone; medians over holes of the RMS error, of what it was expected to
// be in the middle, how much of the truth lies within two of the deviations that were reported, and how many holes the limits of
// "fill all" leave open.
//
//   gap_filling FILE ... [--labels A,B,C|all] [--holes N] [--seconds S]
//
// N holes of each length in each file; seeded, the same every time. With --seconds only this much of each file, out of its middle.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/error.h"
#include "marey/core/recording_reader.h"
#include "marey/edit/fill_gap.h"
#include "marey/edit/tracks.h"
#include "marey/format/recording_file.h"
#include "marey/geometry/median.h"

namespace {

using namespace marey;
using edit::FillMethod;
using edit::Tracks;

/// Markers that stick to the skin, of the Plug-in Gait set: what else such files hold is computed from them.
const std::set<std::string> kMarkers{"LFHD", "RFHD", "LBHD", "RBHD", "C7",   "T10",  "CLAV", "STRN", "RBAK", "LSHO",
                                     "LUPA", "LELB", "LFRM", "LWRA", "LWRB", "LFIN", "RSHO", "RUPA", "RELB", "RFRM",
                                     "RWRA", "RWRB", "RFIN", "LASI", "RASI", "LPSI", "RPSI", "SACR", "LTHI", "LKNE",
                                     "LTIB", "LANK", "LHEE", "LTOE", "RTHI", "RKNE", "RTIB", "RANK", "RHEE", "RTOE"};
constexpr double kLengths_s[] = {0.1, 0.25, 0.5, 1.0, 2.0};

struct Score {
  std::vector<double> rms, expected;  // of each hole, m
  int covered = 0, locations = 0, open = 0, holes = 0;
};

bool is_marker(const std::string& label, const std::set<std::string>& labels) {
  return labels.contains("all") ? !label.empty() : labels.contains(label);
}

/// The middle of a recording.
Recording middle_of(const Recording& recording, double seconds) {
  const auto frames = static_cast<std::size_t>(seconds * recording.header.rate_hz);
  if (frames >= recording.instants().size()) return recording;
  const std::size_t begin = (recording.instants().size() - frames) / 2;
  Recording middle(recording.header);
  for (const TrackColumns& track : recording.tracks()) middle.set_name(track.name);
  InstantsOf instants(recording);
  for (std::size_t i = 0; i < begin + frames; ++i) {
    const auto instant = instants.next();
    if (instant && i >= begin) middle.add(*instant);
  }
  return middle;
}

Tracks tracks_of(const Recording& recording, const std::set<std::string>& labels) {
  std::vector<TrackName> names;
  for (const TrackColumns& track : recording.tracks()) {
    if (is_marker(track.name.label, labels)) names.push_back(track.name);
  }
  return Tracks(recording.instants(), names, [&recording](TrackId track) { return *recording.find(track); });
}

/// Cuts the hole, fills it, and compares.
void try_hole(const Recording& recording, const std::set<std::string>& labels, TrackId marker, const edit::FrameRange& hole,
              std::optional<FillMethod> method, Score& score) {
  Tracks tracks = tracks_of(recording, labels);
  tracks.apply({.kind = edit::Operation::Kind::remove, .tracks = {marker}, .frames = hole});
  const auto fills = edit::decide_fills(tracks, marker, hole, {.method = method, .longest_s = 3, .within_m = 1000});
  ++score.holes;
  score.open += fills.empty() || fills.front().expected_m > edit::FillOptions{}.within_m;
  if (fills.empty()) return;
  score.expected.push_back(fills.front().expected_m);
  const TrackColumns& truth = *recording.find(marker);
  double squares = 0;
  const Tracks::Rows rows = edit::rows_in_gap(tracks, fills.front());
  for (const Tracks::Row& row : rows) {
    const double error = (row.sample.position - truth.position(*truth.row_at(row.at))).norm();
    squares += error * error;
    score.covered += error * error <= 4 * row.sample.covariance->trace();
    ++score.locations;
  }
  score.rms.push_back(std::sqrt(squares / static_cast<double>(rows.size())));
}

struct Location {
  TrackId marker{};
  edit::FrameRange hole;
};

/// Somewhere in a marker's path that is seen throughout, two frames beyond included.
std::optional<Location> somewhere(const Recording& recording, const std::set<std::string>& labels, std::size_t length,
                                  std::mt19937& random) {
  std::vector<const TrackColumns*> tracks;
  for (const TrackColumns& track : recording.tracks()) {
    if (is_marker(track.name.label, labels) && track.size() > length + 20) tracks.push_back(&track);
  }
  for (int attempt = 0; attempt < 200 && !tracks.empty(); ++attempt) {
    const TrackColumns& track = *tracks[random() % tracks.size()];
    const std::size_t first = 8 + random() % (track.size() - length - 16);
    if (track.at()[first + length + 1] - track.at()[first - 2] != static_cast<std::int32_t>(length) + 3) continue;
    const auto index = [&](std::size_t row) { return recording.instants()[static_cast<std::size_t>(track.at()[row])].index; };
    return Location{track.id(), {index(first), index(first + length - 1)}};
  }
  return std::nullopt;
}

int run(const std::vector<std::string>& files, const std::set<std::string>& labels, int holes, double seconds) {
  constexpr std::pair<const char*, std::optional<FillMethod>> kMethods[] = {
      {"chosen", std::nullopt}, {"spline", FillMethod::spline}, {"rigid", FillMethod::rigid}, {"pattern", FillMethod::pattern}};
  std::printf("%-8s %-8s %8s %10s %10s %12s %8s %8s\n", "gap", "method", "holes", "median mm", "90 %  mm", "expected mm", "in 2 sd",
              "open");
  for (const double length_s : kLengths_s) {
    Score scores[4];
    std::mt19937 random(1);
    for (const std::string& file : files) {
      const Recording recording = middle_of(read_all(*format::open_recording(file)), seconds);
      const auto length = static_cast<std::size_t>(std::lround(length_s * recording.header.rate_hz));
      for (int i = 0; i < holes; ++i) {
        const auto location = somewhere(recording, labels, length, random);
        if (!location) continue;
        for (std::size_t method = 0; method < 4; ++method)
          try_hole(recording, labels, location->marker, location->hole, kMethods[method].second, scores[method]);
      }
    }
    for (std::size_t method = 0; method < 4; ++method) {
      Score& score = scores[method];
      std::sort(score.rms.begin(), score.rms.end());
      if (score.rms.empty()) continue;
      std::printf("%-8g %-8s %8d %10.2f %10.2f %12.2f %7.1f%% %7.1f%%\n", length_s, kMethods[method].first, score.holes,
                  1e3 * geometry::median(std::vector(score.rms)), 1e3 * score.rms[score.rms.size() * 9 / 10],
                  1e3 * geometry::median(score.expected), 100.0 * score.covered / score.locations,
                  100.0 * score.open / score.holes);
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> files;
  std::set<std::string> labels = kMarkers;
  int holes = 40;
  double seconds = 1e9;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--holes" && i + 1 < argc) {
      holes = std::atoi(argv[++i]);
    } else if (argument == "--seconds" && i + 1 < argc) {
      seconds = std::atof(argv[++i]);
    } else if (argument == "--labels" && i + 1 < argc) {
      labels.clear();
      std::string_view list = argv[++i];
      while (!list.empty()) {
        labels.emplace(list.substr(0, list.find(',')));
        list.remove_prefix(std::min(list.size(), list.find(',') == std::string_view::npos ? list.size() : list.find(',') + 1));
      }
    } else {
      files.emplace_back(argument);
    }
  }
  try {
    return run(files, labels, holes, seconds);
  } catch (const Error& error) {
    std::fprintf(stderr, "gap_filling: %s\n", error.what());
    return 1;
  }
}
