/// \file The JSON Schema of study files.
#pragma once

#include <string>

namespace touchtrial::study {

/// \return as annotated_schema() makes it, with the sections of the registered protocols
[[nodiscard]] std::string study_schema();

}  // namespace touchtrial::study
