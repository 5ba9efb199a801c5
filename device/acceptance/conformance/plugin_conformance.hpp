/// \file The checks of a plug-in: those of every driver, and those of its C interface.
#pragma once

#include "device/acceptance/conformance/conformance.hpp"
#include "device/drivers/plugin/plugin_device.hpp"

#include <functional>
#include <vector>

namespace touchtrial::device {

/// Runs the checks on the calling thread, and measures the plug-in's calls on a ServoThread. Motor
/// commands are known if the plug-in exports touchtrial_device_observe_v1.
/// \param options_of_opening  for each opened PluginDevice, so that tests control time
/// \return one entry for each check
[[nodiscard]] std::vector<ConformanceCheck> check_plugin_conformance(
    const PluginSettings& settings, ServoClock& clock, const ConformanceOptions& options,
    const std::function<PluginOptions()>& options_of_opening = [] { return PluginOptions{}; });

}  // namespace touchtrial::device
