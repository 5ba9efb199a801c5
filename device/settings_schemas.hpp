/// \file The JSON Schemas of device settings, device models and certificates.
#pragma once

#include <string>

namespace touchtrial::device {

[[nodiscard]] std::string device_settings_schema();
[[nodiscard]] std::string device_model_schema();
[[nodiscard]] std::string certificate_schema();

}  // namespace touchtrial::device
