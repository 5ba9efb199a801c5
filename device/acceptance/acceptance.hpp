/// \file The acceptance of a device: the order of runs, what a person does in each, and the
///   results. Source: docs/devices/acceptance.md.
#pragma once

#include "device/acceptance/certificate.hpp"
#include "device/acceptance/measurement.hpp"
#include "device/safety/safety_limits.hpp"
#include "device/servo/servo.hpp"

#include <array>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial::device {

/// The steps in order, by name, so that a person can skip them. Later steps require `push`: a hold
/// pulls a device with a wrong sign away from its place.
inline constexpr std::array<std::string_view, 7> kAcceptanceSteps = {
    "rest", "steps", "push", "strokes", "weights", "shake", "wall"};

/// What a person does with the handle during a run.
enum class Grip {
  lying,     ///< none: it lies or is held still
  moving,    ///< moves it slowly along all axes
  carrying,  ///< carries it by some centimetres in the axis' direction, and holds it there
  holding,   ///< holds it lightly, so that it can give way
  free,      ///< brings it to the middle and lets go
  loaded,    ///< the same with a weight on it
  pressing,  ///< presses it down on a floor
  guarding,  ///< holds it firmly and watches
};

/// The instruction before a run.
struct Prompt {
  std::string_view step;  ///< one of kAcceptanceSteps, or "thermal"
  Grip stance = Grip::lying;
  DeviceAxis axis = DeviceAxis::y;  ///< of the run, where it has one
  std::string text;                 ///< for the person
};

enum class Consent {
  go,
  skip,  ///< this run, or the rest of a row of trials
};

/// The person, or a simulated one. Every function may throw to end the acceptance.
class AcceptancePerson {
 public:
  virtual ~AcceptancePerson() = default;
  /// Asks for the grip, and for consent to the run. No force acts before it returns.
  [[nodiscard]] virtual Consent ready(const Prompt& prompt) = 0;
  /// Asks for a force along an axis: a weight, or the reading of a spring scale.
  /// \return N, in the range; nothing: the person has none
  [[nodiscard]] virtual std::optional<double> weight_n(DeviceAxis axis, double min_n,
                                                       double max_n) = 0;
  /// \return a temperature in degrees Celsius; nothing: there is no thermometer
  [[nodiscard]] virtual std::optional<double> temperature_c(const std::string& question) = 0;
  /// \return the person's observation, in their words; may be empty
  [[nodiscard]] virtual std::string ask_observation(const std::string& question) = 0;
  virtual void show(const std::string& result) = 0;
};

/// The device under its servo.
class AcceptanceBench {
 public:
  virtual ~AcceptanceBench() = default;
  [[nodiscard]] virtual DeviceInfo info() const = 0;
  /// They apply to every run.
  [[nodiscard]] virtual SafetyLimits limits() const = 0;
  /// Sets a stricter force limit than the bench's own for later runs.
  /// \param max_n  > 0
  virtual void limit_force(double max_n) = 0;
  /// \param name  of the run, at most 8 letters
  /// \throws touchtrial::Error if a person or a signal stopped it
  [[nodiscard]] virtual ServoReport run(const std::string& name, Measurement& measurement) = 0;
  /// The same, while the system suspends the program for two seconds.
  /// \return nothing if that is not possible
  [[nodiscard]] virtual std::optional<ServoReport> run_suspended(Measurement& /*measurement*/) {
    return std::nullopt;
  }
};

struct AcceptanceOptions {
  std::set<std::string, std::less<>> skip{};  ///< of kAcceptanceSteps
  bool thermal = false;                       ///< twenty minutes under a load
};

/// Curves of one axis, for pictures.
struct AxisCurves {
  DeviceAxis axis = DeviceAxis::y;
  std::vector<std::pair<double, double>> loop{};      ///< StrokeFigures::loop
  std::vector<std::pair<double, double>> by_delay{};  ///< ShakeFigures::by_delay
};

struct Acceptance {
  Certificate certificate;  ///< the caller sets `program`, `made` and `emulated`
  std::vector<AxisCurves> curves;
};

/// The greatest force of a push, of a shake and of a weight on this device.
struct AcceptanceForces {
  double push_n = 0.0;
  double hold_n = 0.0;    ///< of the norm while the handle is held: 60 % of the peak
  double weight_n = 0.0;  ///< of a weight and the handle's own load together
  HoldGains gains;        ///< below the greatest stiffness and damping that the maker states
};
[[nodiscard]] AcceptanceForces acceptance_forces(const DeviceInfo& device,
                                                 const SafetyLimits& limits) noexcept;

/// Runs the acceptance. A wrong sign or a fault ends it at once, with a certificate that states
/// this.
/// \throws what bench and person throw
[[nodiscard]] Acceptance accept_device(AcceptanceBench& bench, AcceptancePerson& person,
                                       const AcceptanceOptions& options);

}  // namespace touchtrial::device
