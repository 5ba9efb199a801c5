/// \file The enrolment number of a participant who has no session yet.
#pragma once

#include "app/run/run_options.hpp"
#include "protocols/design/study.hpp"
#include "protocols/store/study_store.hpp"

namespace touchtrial::app {

/// What was asked for; else what the participant inherits from somebody; else the station's next
/// number of the study's plan, or without any plan the smallest that is free.
/// \throws UsageError if there is a plan, and the station is not named, or the other way round (a
///   pilot needs no plan); or the database has numbers of another station
/// \throws as load_plan and next_of_station
[[nodiscard]] int enrolment_of(const RunOptions& options, const design::Study& study,
                               const store::StudyStore& store);

}  // namespace touchtrial::app
