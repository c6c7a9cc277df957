#pragma once

#include <string>

#include "marey/analyse/measure.h"

namespace marey::pipeline {

/// The people's figures as CSV: id,label,team,distance_m,mean_mps,top_mps,sprints, then the rest; a row for each person.
std::string measurement_csv(const analyse::Measurement& measured, const analyse::MeasureOptions& options);

/// Writes `folder`/report.html: one page with plots, tables, heat maps and ways. The folder is made. Throws Error where that cannot
/// be.
void write_report(const analyse::Measurement& measured, const analyse::MeasureOptions& options, const std::string& title,
                  const std::string& folder);

}  // namespace marey::pipeline
