#include "marey/pipeline/bodies/gait_reference.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/input_hash.h"
#include "marey/pipeline/bodies/measure_gait.h"

namespace marey::pipeline::bodies {
namespace {

namespace fs = std::filesystem;
namespace gait = analyse::gait;

// Six children's twelve walks (bench/tuning.md): cycles of straight walks turn by less, those within a turn by more.
constexpr double kMaxReferenceTurn = 10 * std::numbers::pi / 180;  // rad

struct PersonFiles {
  std::string name;
  std::string static_trial;
  std::vector<std::string> walks;
};

/// Neither hidden files nor folders, by name. Throws Error if the folder cannot be read.
std::vector<fs::path> entries_of(const fs::path& folder, bool folders) {
  std::vector<fs::path> entries;
  std::error_code problem;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, problem)) {
    if (entry.path().filename().string().starts_with('.')) continue;
    if (folders ? entry.is_directory() : entry.is_regular_file()) entries.push_back(entry.path());
  }
  if (problem) throw Error("{}: cannot be read: {}", folder.string(), problem.message());
  std::sort(entries.begin(), entries.end());
  return entries;
}

bool is_static_trial(const fs::path& file) {
  std::string name = file.filename().string();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name.find("static") != std::string::npos || name.find("standing") != std::string::npos;
}

std::vector<PersonFiles> people_in(const std::string& folder) {
  std::vector<PersonFiles> people;
  for (const fs::path& own : entries_of(folder, true)) {
    PersonFiles person{.name = own.filename().string(), .static_trial = {}, .walks = {}};
    for (const fs::path& file : entries_of(own, false)) {
      if (!is_static_trial(file)) {
        person.walks.push_back(file.string());
      } else if (person.static_trial.empty()) {
        person.static_trial = file.string();
      }
    }
    if (!person.walks.empty()) people.push_back(std::move(person));
  }
  for (const fs::path& file : entries_of(folder, false))
    people.push_back({.name = file.stem().string(), .static_trial = {}, .walks = {file.string()}});
  return people;
}

/// Further cycles of the same person. Which cycles they are counts on, so that those of two walks do not meet.
void add_walk(gait::ReferencePerson& person, const GaitMeasure& walk) {
  if (person.curves.empty()) {
    person.curves = walk.cycles.curves;
    person.figures = walk.cycles.figures;
  } else {
    for (std::size_t c = 0; c < person.curves.size(); ++c) {
      gait::CycleCurve& curve = person.curves[c];
      const gait::CycleCurve& more = walk.cycles.curves[c];
      curve.cycles.insert(curve.cycles.end(), more.cycles.begin(), more.cycles.end());
      for (const std::size_t cycle : more.cycle_of) curve.cycle_of.push_back(person.cycles + cycle);
    }
    for (std::size_t f = 0; f < person.figures.size(); ++f) {  // of the walks' means, each as often as it has cycles
      for (std::size_t side = 0; side < 2; ++side) {
        auto& mean = person.figures[f].mean[side];
        const auto& more = walk.cycles.figures[f].mean[side];
        const auto before = static_cast<double>(person.cycles), now = static_cast<double>(walk.cycles.cycles.size());
        if (mean && more) mean = (before * *mean + now * *more) / (before + now);
        if (!mean) mean = more;
      }
    }
  }
  person.cycles += walk.cycles.cycles.size();
  person.signals.insert(person.signals.end(), walk.ground.begin(), walk.ground.end());
  person.signals.insert(person.signals.end(), walk.kinetics.curves.begin(), walk.kinetics.curves.end());
}

class ReferenceReader {
 public:
  ReferenceReader(GaitReference& reference, const GaitOptions& options, const Hooks& hooks) : reference_(reference), hooks_(hooks) {
    own_.up = options.up;
    own_.events = options.events;
    own_.cycles.max_turn = kMaxReferenceTurn;
  }

  void read(const PersonFiles& files) {
    gait::ReferencePerson person{.name = files.name, .curves = {}, .figures = {}};
    own_.static_trial = files.static_trial;
    for (const std::string& walk : files.walks) {
      hooks_.advance({.step = "reading the reference", .done = ++read_, .total = {}});
      try {
        add(person, walk);
      } catch (const Error& error) {
        omit(walk, error.what());
      }
    }
    if (person.cycles > 0) reference_.people.push_back(std::move(person));
  }

 private:
  void add(gait::ReferencePerson& person, const std::string& walk) {
    const GaitMeasure measure = measure_gait(walk, own_, {.stop = hooks_.stop});
    reference_.curved += measure.cycles.curved;
    if (measure.events.empty()) return omit(walk, "no steps were found");
    if (measure.cycles.cycles.empty())
      return omit(walk, measure.cycles.curved > 0 ? "all its cycles turn" : "no whole gait cycle was found");
    add_walk(person, measure);
    ++reference_.walks;
    reference_.cycles += measure.cycles.cycles.size();
  }

  /// Messages begin with the file's name already, most of them.
  void omit(const std::string& walk, const std::string& reason) {
    reference_.warnings.push_back(reason.starts_with(walk) ? fmt::format("{}; omitted of the reference", reason)
                                                           : fmt::format("{}: {}; omitted of the reference", walk, reason));
  }

  GaitReference& reference_;
  const Hooks& hooks_;
  GaitOptions own_;
  std::int64_t read_ = 0;
};

}  // namespace

std::optional<std::string> walker_in_reference(const std::string& folder, const std::string& recording) {
  const std::string hash = format::input_of(recording).hash;
  std::error_code problem;
  const fs::path own = fs::weakly_canonical(recording, problem).parent_path(), group = fs::weakly_canonical(folder, problem);
  for (const PersonFiles& person : people_in(folder)) {
    for (const std::string& walk : person.walks) {
      const fs::path of_person = fs::weakly_canonical(walk, problem).parent_path();
      if (of_person != group && of_person == own) return person.name;
      if (!hash.empty() && format::input_of(walk).hash == hash) return person.name;
    }
  }
  return std::nullopt;
}

double max_reference_turn() {
  return kMaxReferenceTurn;
}

GaitReference read_gait_reference(const std::string& folder, const GaitOptions& options, const Hooks& hooks) {
  std::error_code problem;
  if (!fs::is_directory(folder, problem))
    throw Error("{}: is not a folder; --reference is the control group's: a folder for each person, with walks and a static trial",
                folder);
  GaitReference reference;
  reference.folder = folder;
  ReferenceReader reader(reference, options, hooks);
  for (const PersonFiles& person : people_in(folder)) reader.read(person);
  if (reference.people.empty() && reference.warnings.empty())
    throw Error("{}: is empty; a folder for each person is wanted, with walks and a static trial (static….c3d)", folder);
  if (reference.people.empty())
    throw Error("{}: has no walk that can be a reference, of {} files; the first: {}", folder, reference.warnings.size(),
                reference.warnings.front());
  reference.bands = gait::reference_bands(reference.people);
  reference.signals = gait::reference_signals(reference.people);
  reference.figures = gait::reference_figures(reference.people);
  reference.scores = gait::reference_scores(reference.people);
  if (reference.people.size() == 1)
    reference.warnings.push_back(fmt::format("{}: is of one person; a band needs two people, scores of the group three", folder));
  return reference;
}

}  // namespace marey::pipeline::bodies
