/// \file The JSON Schemas of the files that this folder reads, as annotated_schema() makes them.
#pragma once

#include <string>

namespace touchtrial::device {

[[nodiscard]] std::string device_settings_schema();
[[nodiscard]] std::string device_model_schema();
[[nodiscard]] std::string certificate_schema();

}  // namespace touchtrial::device
