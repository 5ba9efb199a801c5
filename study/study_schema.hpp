/// \file The JSON Schema of study files.
#pragma once

#include <string>

namespace touchtrial::study {

/// The schema in the form of annotated_schema(), with the sections of the registered protocols.
[[nodiscard]] std::string study_schema();

}  // namespace touchtrial::study
