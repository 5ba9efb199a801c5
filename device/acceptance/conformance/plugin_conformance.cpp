#include "device/acceptance/conformance/plugin_conformance.hpp"

#include "core/errors.hpp"
#include "device/drivers/plugin/plugin_library.hpp"
#include "device/platform/realtime.hpp"
#include "device/servo/duration_histogram.hpp"
#include "device/servo/servo_thread.hpp"

#include <chrono>
#include <optional>

#include <fmt/format.h>

namespace touchtrial::device {
namespace {

constexpr double kMaxCallUs = 10'000.0;
/// Share of the period; the rest is for the device and the host.
constexpr double kMaxCallShare = 0.5;

ConformanceId check_of(plugin::PluginFault plugin_fault) noexcept {
  switch (plugin_fault) {
    case plugin::PluginFault::sequence_decreased:
      return ConformanceId::numbering;
    case plugin::PluginFault::wrote_past:
      return ConformanceId::memory;
    case plugin::PluginFault::not_finite:
    case plugin::PluginFault::absurd:
    case plugin::PluginFault::unknown_readiness:
      return ConformanceId::values;
    default:
      return ConformanceId::staying;
  }
}

std::optional<DriverFailure> driver_failure_of(const HapticDevice& device) {
  const auto* const plugin = dynamic_cast<const PluginDevice*>(&device);
  if (plugin == nullptr) return std::nullopt;
  const plugin::PluginFault plugin_fault = plugin->plugin_fault();
  if (plugin_fault == plugin::PluginFault::none) return std::nullopt;
  return DriverFailure{check_of(plugin_fault), plugin::fault_text(plugin_fault)};
}

/// Runs one step of the checks.
/// \return whether it succeeded; else the check fails with the error's message
template <typename Step>
bool run_conformance_step(ConformanceId id, ConformanceRecord& record, const Step& step) {
  try {
    step();
    return true;
  } catch (const Error& error) {
    record.fail(id, error.what());
    return false;
  }
}

/// Loads, opens and describes the plug-in; each step is a separate check.
/// \return the description; nothing if a step failed
std::optional<DeviceInfo> try_interface(const PluginSettings& settings, ConformanceRecord& record) {
  std::optional<plugin::Library> library;
  std::optional<plugin::OpenDevice> opened;
  std::optional<DeviceInfo> info;
  const bool all_passed =
      run_conformance_step(ConformanceId::library, record,
                           [&] {
                             check_loads(settings.library, plugin::kRemedy);
                             library.emplace(settings.library);
                           }) &&
      run_conformance_step(ConformanceId::opening, record,
                           [&] { opened.emplace(*library, settings.settings); }) &&
      run_conformance_step(ConformanceId::description, record, [&] { info = opened->info(); });
  if (library) {
    record.pass(ConformanceId::library, "driver " + library->name());
  }
  return all_passed ? info : std::nullopt;
}

/// Measures calls of the plug-in as its thread makes them, without force.
void measure_calls(const PluginSettings& settings, double rate_hz, ServoClock& clock,
                   const ConformanceOptions& options, DurationHistogram& durations) {
  const plugin::Library library(settings.library);
  plugin::OpenDevice device(library, settings.settings);
  const ServoClock::Time period(static_cast<std::int64_t>(1e9 / rate_hz));
  const auto ticks = static_cast<std::int64_t>(options.seconds * rate_hz);
  ServoClock::Time next = clock.now();
  for (std::int64_t i = 0; i < ticks; ++i) {
    if (options.stopped && options.stopped()) return;
    next += period;
    clock.wait_until(next);
    const ServoClock::Time start = monotonic_now();
    const plugin::PluginFault plugin_fault = device.sample().plugin_fault;
    if (plugin_fault != plugin::PluginFault::none || device.force({}) != plugin::PluginFault::none)
      return;
    durations.add(monotonic_now() - start);
  }
}

void check_calls(const PluginSettings& settings, double rate_hz, ServoClock& clock,
                 const ConformanceOptions& options, ConformanceRecord& record) {
  DurationHistogram durations;
  const bool opened = run_conformance_step(ConformanceId::reopening, record, [&] {
    ServoThread thread;
    thread.run([&] { measure_calls(settings, rate_hz, clock, options, durations); });
  });
  if (!opened || durations.count() == 0) {
    return record.set_not_observed(ConformanceId::calls, "an earlier check failed");
  }
  const double p99_us = durations.percentile_us(0.99);
  const double worst_us = 1e-3 * static_cast<double>(durations.worst().count());
  const std::string finding =
      fmt::format("99 % within {:.0f} us, worst {:.0f} us", p99_us, worst_us);
  if (!options.judges_calls) {
    record.set_not_observed(ConformanceId::calls, finding + "; not judged");
  } else if (p99_us <= kMaxCallShare * 1e6 / rate_hz && worst_us < kMaxCallUs) {
    record.pass(ConformanceId::calls, finding);
  } else {
    record.fail(ConformanceId::calls, finding);
  }
}

}  // namespace

std::vector<ConformanceCheck> check_plugin_conformance(
    const PluginSettings& settings, ServoClock& clock, const ConformanceOptions& options,
    const std::function<PluginOptions()>& make_options) {
  ConformanceRecord record;
  const std::optional<DeviceInfo> info = try_interface(settings, record);
  if (!info) {
    record.set_remaining_not_observed("an earlier check failed", true);
    return record.checks(true);
  }
  const plugin::Library library(settings.library);
  ConformanceSubject subject;
  subject.open = [&] { return std::make_unique<PluginDevice>(settings, make_options()); };
  subject.motor_force_n = [&] { return library.observed_force_n(); };
  subject.find_failure = driver_failure_of;
  record.add(check_conformance(subject, clock, options));
  if (options.stopped && options.stopped()) {
    record.set_remaining_not_observed("the check was stopped", true);
    return record.checks(true);
  }
  if (!record.has(ConformanceId::memory)) record.pass(ConformanceId::memory);
  check_calls(settings, info->max_rate_hz, clock, options, record);
  return record.checks(true);
}

}  // namespace touchtrial::device
