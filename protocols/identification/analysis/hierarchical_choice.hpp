/// \file The hierarchical choice model as a Stan program, and its data, for export beside the mixed
/// model. Format: docs/exports.md.
#pragma once

#include "analysis/outcomes.hpp"

#include <string>
#include <string_view>

namespace touchtrial::analysis::identification {

/// The part of the program that is the same for every study: choice_model_program.stan, built in.
[[nodiscard]] std::string_view choice_model_program() noexcept;

/// The text of choice_model.stan: the program, and what the study's numbers stand for.
[[nodiscard]] std::string choice_model_script(const Outcomes& outcomes);

/// The text of choice_model.json: the program's data. One block of K rows for each method and
/// participant with an answer, by method, participants in the order of sessions; trials that count
/// and have a response.
[[nodiscard]] std::string choice_model_data(const Outcomes& outcomes);

}  // namespace touchtrial::analysis::identification
