/// \file The template of the studies that `new` writes.
#pragma once

#include <string>

namespace touchtrial::app {

/// The text of app/commands/new_study.json.in, compiled in.
[[nodiscard]] std::string new_study_template();

}  // namespace touchtrial::app
