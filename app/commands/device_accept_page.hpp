/// \file A device's certificate as a page with verdict, numbers and plots, and as text.
#pragma once

#include "device/acceptance/acceptance.hpp"

#include <cstddef>
#include <string>

namespace touchtrial::app {

/// \return one HTML page without references to other files. Without gnuplot it has no plots, and a
///   warning is printed.
[[nodiscard]] std::string acceptance_page(const device::Acceptance& acceptance);

/// \return verdict and numbers
/// \param width  width of a line, columns
[[nodiscard]] std::string acceptance_text(const device::Certificate& certificate,
                                          std::size_t width);

}  // namespace touchtrial::app
