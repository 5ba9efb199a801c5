/// \file What shows a device's certificate: a page with verdict, numbers and plots, and a text.
#pragma once

#include "device/acceptance/acceptance.hpp"

#include <cstddef>
#include <string>

namespace touchtrial::app {

/// \return one HTML page without references to other files. Without gnuplot its plots are missing,
///   with a warning.
[[nodiscard]] std::string acceptance_page(const device::Acceptance& acceptance);

/// \return verdict and numbers
/// \param width  of a line, columns
[[nodiscard]] std::string acceptance_text(const device::Certificate& certificate,
                                          std::size_t width);

}  // namespace touchtrial::app
