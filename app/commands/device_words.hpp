/// \file Messages about a device and its servo for its user.
#pragma once

#include "device/model/workspace_fit.hpp"
#include "device/servo/servo.hpp"
#include "engine/rendering/rendering_options.hpp"

#include <string>

namespace touchtrial::app {

/// The fault, and the remedy: "the device no longer answers; check its cable and power".
[[nodiscard]] std::string fault_in_words(const device::ServoReport& report);

/// What the user must do before force may be sent; empty if nothing.
[[nodiscard]] std::string readiness_in_words(device::DeviceReadiness readiness);

/// \return the stiffness of a study's rendering, for device::check_stiffness
[[nodiscard]] device::RenderedStiffness rendered_stiffness(
    const engine::RenderingOptions& rendering);

}  // namespace touchtrial::app
