/// \file The runs shared by acceptance and bring-up: consent, a run, and its result or the reason
///   why there is none.
#pragma once

#include "device/acceptance/acceptance.hpp"
#include "device/acceptance/motion_figures.hpp"

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace touchtrial::device {

/// Ends an acceptance or a bring-up: the device failed.
struct DeviceFailed {
  std::string fault;  ///< its names, for instance "device (link_lost)"
  std::string run;    ///< the run's name
};

/// The reason recorded for skipped steps.
inline constexpr std::string_view kLeftOut = "left out";

/// The support and load of an empty handle on an axis.
struct EmptyHandle {
  Vec3 support_n;       ///< commanded force that carries it
  double load_n = 0.0;  ///< of it, along the axis
  double friction_n = 0.0;
};

/// At a virtual wall: the smallest swing that counts as oscillation, and the shortest time in
/// contact.
inline constexpr double kMinSwingMm = 0.15;
inline constexpr double kMinContactS = 1.0;

/// Guides one person through single runs on one bench. Every function may throw DeviceFailed, and
/// exceptions of person and bench. Private to the folders of acceptance and bring-up.
class HandleRuns {
 public:
  /// \param skip  steps to skip without asking
  HandleRuns(AcceptanceBench& bench, AcceptancePerson& person,
             std::set<std::string, std::less<>> skip = {})
      : bench_(bench), person_(person), skip_(std::move(skip)) {}

  /// \return whether the run may begin
  [[nodiscard]] bool consents(const Prompt& prompt);
  ServoReport measure(const std::string& name, Measurement& measurement);
  static void require_no_fault(const ServoReport& report, const std::string& name);

  /// The person moves the handle slowly along all axes.
  [[nodiscard]] ValueOrReason<Measured> encoder_step();

  /// The handle is held and moved slowly along an axis, without a weight.
  /// \param step  that the prompt names
  /// \param step_mm  encoder step; 0: not known
  [[nodiscard]] ValueOrReason<StrokeFigures> empty_strokes(std::string_view step, DeviceAxis axis,
                                                           Vec3 support_n, double step_mm);

  /// The same with a known weight on it; the result has a scale.
  [[nodiscard]] ValueOrReason<WeighResult> weigh(std::string_view step, DeviceAxis axis,
                                                 const EmptyHandle& empty, double step_mm);

  /// A small push while the system suspends the program.
  [[nodiscard]] ValueOrReason<ServoReport> suspend_program(std::string_view step);
  /// A small push while the person pulls the cable.
  [[nodiscard]] ValueOrReason<ServoReport> pull_cable(std::string_view step);

 private:
  AcceptanceBench& bench_;
  AcceptancePerson& person_;
  std::set<std::string, std::less<>> skip_;
};

}  // namespace touchtrial::device
