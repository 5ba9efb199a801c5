/// \file The runs shared by acceptance and bring-up: each asks for consent, and returns its result
///   or the reason why there is none.
#pragma once

#include "device/acceptance/acceptance.hpp"
#include "device/acceptance/motion_figures.hpp"

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace touchtrial::device {

/// Thrown to end an acceptance or a bring-up when the device fails.
struct DeviceFailed {
  std::string fault;  ///< from fault_names, for instance "device (link_lost)"
  std::string run;    ///< the run's name
};

/// The reason recorded for skipped steps.
inline constexpr std::string_view kLeftOut = "left out";

/// The load and friction of an empty handle on an axis.
struct EmptyHandle {
  Vec3 support_n;       ///< commanded force that supports it
  double load_n = 0.0;  ///< part of the support along the axis
  double friction_n = 0.0;
};

/// Smaller swings at a virtual wall do not count as oscillation.
inline constexpr double kMinSwingMm = 0.15;
/// A wall trial with less contact has no result.
inline constexpr double kMinContactS = 1.0;

/// Guides a person through single runs on a bench. Every function may throw DeviceFailed, and
/// exceptions of person and bench. Private to the folders of acceptance and bring-up.
class HandleRuns {
 public:
  /// \param skip  steps to skip without asking
  HandleRuns(AcceptanceBench& bench, AcceptancePerson& person,
             std::set<std::string, std::less<>> skip = {})
      : bench_(bench), person_(person), skip_(std::move(skip)) {}

  /// Shows the prompt and waits for the person.
  /// \return whether the run may begin
  [[nodiscard]] bool obtain_consent(const Prompt& prompt);
  ServoReport measure(const std::string& name, Measurement& measurement);
  static void require_no_fault(const ServoReport& report, const std::string& name);

  /// The person moves the handle slowly along all axes.
  [[nodiscard]] ValueOrReason<Measured> encoder_step();

  /// The handle is held and moved slowly along an axis, without a weight.
  /// \param step  Prompt::step
  /// \param step_mm  encoder step; 0: unknown
  [[nodiscard]] ValueOrReason<StrokeFigures> empty_strokes(std::string_view step, DeviceAxis axis,
                                                           Vec3 support_n, double step_mm);

  /// The same with a known weight on the handle.
  [[nodiscard]] ValueOrReason<WeighResult> weigh(std::string_view step, DeviceAxis axis,
                                                 const EmptyHandle& empty, double step_mm);

  /// Pushes slightly while the system suspends the program.
  [[nodiscard]] ValueOrReason<ServoReport> suspend_program(std::string_view step);
  /// Pushes slightly while the person pulls the cable.
  [[nodiscard]] ValueOrReason<ServoReport> pull_cable(std::string_view step);

 private:
  AcceptanceBench& bench_;
  AcceptancePerson& person_;
  std::set<std::string, std::less<>> skip_;
};

}  // namespace touchtrial::device
