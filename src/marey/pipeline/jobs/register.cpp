#include "marey/pipeline/jobs/register.h"

#include <algorithm>
#include <array>

#include <fmt/ranges.h>

#include "marey/pipeline/jobs/augment.h"
#include "marey/pipeline/jobs/batch.h"
#include "marey/pipeline/jobs/live.h"
#include "marey/pipeline/jobs/reconstruct.h"
#include "marey/pipeline/jobs/solve.h"
#include "marey/pipeline/jobs/track_ground.h"
#include "marey/pipeline/jobs/track_image.h"

namespace marey::pipeline::jobs {
namespace {

using UseTable = std::function<void(Table&)>;

void use_table_of(auto job, const UseTable& use) {
  Table table = table_of(job);
  use(table);
}

struct NamedJob {
  const char* name;
  void (*with_table)(const UseTable&);
};

constexpr std::array kJobs{
    NamedJob{"track people", [](const UseTable& use) { use_table_of(TrackPeople{}, use); }},
    NamedJob{"track keypoints", [](const UseTable& use) { use_table_of(TrackPeople{.keypoints = true}, use); }},
    NamedJob{"track markers", [](const UseTable& use) { use_table_of(TrackMarkers{}, use); }},
    NamedJob{"track ground", [](const UseTable& use) { use_table_of(TrackGround{}, use); }},
    NamedJob{"reconstruct markers", [](const UseTable& use) { use_table_of(ReconstructMarkers{}, use); }},
    NamedJob{"reconstruct keypoints", [](const UseTable& use) { use_table_of(ReconstructKeypoints{}, use); }},
    NamedJob{"solve", [](const UseTable& use) { use_table_of(Solve{}, use); }},
    NamedJob{"augment", [](const UseTable& use) { use_table_of(Augment{}, use); }},
    NamedJob{"live", [](const UseTable& use) { use_table_of(Live{}, use); }},
    NamedJob{"batch plan", [](const UseTable& use) { use_table_of(PlanBatch{}, use); }},
    NamedJob{"batch run", [](const UseTable& use) { use_table_of(RunBatch{}, use); }},
    NamedJob{"batch submit", [](const UseTable& use) { use_table_of(SubmitBatch{}, use); }},
};

}  // namespace

std::vector<std::string> job_names() {
  std::vector<std::string> names;
  for (const NamedJob& job : kJobs) names.emplace_back(job.name);
  return names;
}

void with_table(std::string_view job, const std::function<void(Table&)>& use) {
  const auto found = std::find_if(kJobs.begin(), kJobs.end(), [&](const NamedJob& named) { return named.name == job; });
  if (found == kJobs.end()) throw Error("there is no job \"{}\"; use one of {}", job, fmt::join(job_names(), ", "));
  found->with_table(use);
}

}  // namespace marey::pipeline::jobs
