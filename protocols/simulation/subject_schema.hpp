/// \file The JSON Schema of subject files.
#pragma once

#include <string>

namespace touchtrial::simulation {

/// \return as annotated_schema() makes it
[[nodiscard]] std::string subject_model_schema();

}  // namespace touchtrial::simulation
