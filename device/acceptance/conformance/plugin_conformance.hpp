/// \file The conformance checks of a plug-in: the checks of every driver, and checks of its C
///   interface.
#pragma once

#include "device/acceptance/conformance/conformance.hpp"
#include "device/drivers/plugin/plugin_device.hpp"

#include <functional>
#include <vector>

namespace touchtrial::device {

/// Runs the checks on the calling thread, and measures the plug-in's calls on a ServoThread. Motor
/// commands can be observed if the plug-in exports touchtrial_device_observe_v1.
/// \param make_options  called for each opened PluginDevice, so that tests control time
/// \return one entry for each check
[[nodiscard]] std::vector<ConformanceCheck> check_plugin_conformance(
    const PluginSettings& settings, ServoClock& clock, const ConformanceOptions& options,
    const std::function<PluginOptions()>& make_options = [] { return PluginOptions{}; });

}  // namespace touchtrial::device
