/// \file What `prepare` did, stage by stage, and why. Private to app. Codes are not part of it:
/// nothing printed ties a stimulus to its field.
#pragma once

#include "protocols/design/prepare.hpp"

#include <string>

namespace touchtrial::app {

/// A block of stages for each stimulus and one for the study, with a line of totals.
/// \pre the report was made with PrepareOptions::explain
[[nodiscard]] std::string explanation_text(const design::PrepareReport& report);

/// The whole report for programs; stages if there are any. Fields: docs/data-dictionary.md,
/// "prepare --json".
[[nodiscard]] std::string prepare_json(const design::PrepareReport& report,
                                       const design::PackPlace& place);

}  // namespace touchtrial::app
