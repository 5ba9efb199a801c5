/// \file The JSON Schema of subject files.
#pragma once

#include <string>

namespace touchtrial::simulation {

/// The schema in the form of annotated_schema().
[[nodiscard]] std::string subject_model_schema();

}  // namespace touchtrial::simulation
