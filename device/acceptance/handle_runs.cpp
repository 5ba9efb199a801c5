#include "device/acceptance/handle_runs.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace touchtrial::device {
namespace {

constexpr double kMoveRunS = 12.0;
constexpr double kSilentRunS = 8.0;
constexpr double kMinWeightN = 0.1;
constexpr double kStrokeReserveN = 0.2;  ///< for strokes, in addition to load and friction

}  // namespace

bool HandleRuns::obtain_consent(const Prompt& prompt) {
  return !skip_.contains(prompt.step) && person_.ready(prompt) == Consent::go;
}

ServoReport HandleRuns::measure(const std::string& name, Measurement& measurement) {
  const ServoReport report = bench_.run(name, measurement);
  require_no_fault(report, name);
  return report;
}

void HandleRuns::require_no_fault(const ServoReport& report, const std::string& name) {
  if (report.end == ServoEnd::fault) throw DeviceFailed{fault_names(report), name};
}

ValueOrReason<Measured> HandleRuns::encoder_step() {
  if (!obtain_consent(
          {"steps",
           Grip::moving,
           {},
           "Move the handle slowly (1 cm per second) to and fro along all three axes; no "
           "force acts for 12 s."})) {
    return {{}, std::string(kLeftOut)};
  }
  PassiveRun moving(kMoveRunS);
  measure("steps", moving);
  return encoder_step_mm(moving.samples());
}

ValueOrReason<StrokeFigures> HandleRuns::empty_strokes(std::string_view step, DeviceAxis axis,
                                                       Vec3 support_n, double step_mm) {
  if (!obtain_consent(
          {step, Grip::free, axis,
           fmt::format("Hold the handle in the middle, without a weight. Let go slowly "
                       "within 2 s of the start: it is held and moved by 5 mm along axis "
                       "{} for 12 s.",
                       name_of(axis))})) {
    return {{}, std::string(kLeftOut)};
  }
  const AcceptanceForces forces = acceptance_forces(bench_.info(), bench_.limits());
  SlowStrokes run(axis, support_n, forces.gains, forces.hold_n);
  measure("stroke " + std::string(name_of(axis)), run);
  return stroke_figures(run, step_mm);
}

ValueOrReason<WeighResult> HandleRuns::weigh(std::string_view step, DeviceAxis axis,
                                             const EmptyHandle& empty, double step_mm) {
  const AcceptanceForces forces = acceptance_forces(bench_.info(), bench_.limits());
  const double max_n = std::min(forces.weight_n, forces.hold_n) - std::abs(empty.load_n) -
                       empty.friction_n - kStrokeReserveN;
  if (max_n < kMinWeightN) {
    return {{}, "the handle's own load and friction leave no room for a weight"};
  }
  if (skip_.contains(step)) return {{}, std::string(kLeftOut)};
  const std::optional<double> weight_n = person_.weight_n(axis, kMinWeightN, max_n);
  if (!weight_n) return {{}, "no weight"};
  if (!obtain_consent(
          {step, Grip::loaded, axis,
           "Hold the handle in the middle with the weight on it. Let go slowly within 2 s of "
           "the start: it is held and moved by 5 mm for 12 s."})) {
    return {{}, std::string(kLeftOut)};
  }
  SlowStrokes run(axis, empty.support_n, forces.gains, forces.hold_n);
  measure("weight " + std::string(name_of(axis)), run);
  const ValueOrReason<StrokeFigures> strokes = stroke_figures(run, step_mm);
  if (!strokes.value) return {{}, strokes.reason};
  const Measured& load_n = strokes.value->load_n;
  // Over a pulley, a weight can pull in either direction.
  const double additional_n = std::abs(load_n.value - empty.load_n);
  const WeighResult result{*weight_n, additional_n, load_n.error};
  const auto scale = AxisResult{.weight = result}.scale();
  if (!scale) return {{}, "the weight made no difference"};
  person_.show(fmt::format(
      "axis {}: {:.3f} N commanded for {:.3f} N: delivers {:.0f} +- {:.0f} % of the command",
      name_of(axis), additional_n, *weight_n, 100.0 * scale->value, 100.0 * scale->error));
  return {result};
}

ValueOrReason<ServoReport> HandleRuns::suspend_program(std::string_view step) {
  if (!obtain_consent(
          {step, Grip::guarding, DeviceAxis::y,
           "Hold the handle firmly: it is pushed down by 0.3 N for 8 s. After about 3 s the "
           "system suspends this program for 2 s."})) {
    return {{}, std::string(kLeftOut)};
  }
  SteadyPush push(kSilentRunS);
  const std::optional<ServoReport> report = bench_.run_suspended(push);
  return {report, report ? "" : "not possible here"};
}

ValueOrReason<ServoReport> HandleRuns::pull_cable(std::string_view step) {
  if (!obtain_consent(
          {step, Grip::guarding, DeviceAxis::y,
           "Hold the handle firmly: it is pushed down by 0.3 N for 8 s. Pull the device's "
           "data cable out within that time. Skip this if the cable must stay connected."})) {
    return {{}, std::string(kLeftOut)};
  }
  SteadyPush push(kSilentRunS);
  const ServoReport report = bench_.run("cable", push);
  if (report.end != ServoEnd::fault) {
    return {{}, "the device answered to the end: the cable was not pulled"};
  }
  return {report};
}

}  // namespace touchtrial::device
