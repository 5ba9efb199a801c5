/// \file What is said of a subject model's changes from trial to trial: in an assumption, and in a
/// warning of what a fit leaves out.
#pragma once

#include "protocols/simulation/subject_model.hpp"

#include <string>

namespace touchtrial::planning {

/// Each change that the model has, with a comma before it, its numbers, and whether power ignores
/// it; "" if there is none.
[[nodiscard]] std::string words_of_changes(const simulation::SubjectModel& subject);

/// What a fit, which takes all trials of all people as alike, ignores of the model: the keys with
/// commas between them; "" if it ignores nothing.
[[nodiscard]] std::string keys_that_fits_ignore(const simulation::SubjectModel& subject);

}  // namespace touchtrial::planning
