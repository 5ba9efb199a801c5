/// \file The page that shows a device's certificate: verdict, numbers and plots.
#pragma once

#include "device/acceptance/acceptance.hpp"

#include <string>

namespace touchtrial::app {

/// \return one HTML page without references to other files. Without gnuplot its plots are missing,
///   with a warning.
[[nodiscard]] std::string acceptance_page(const device::Acceptance& acceptance);

}  // namespace touchtrial::app
