/// \file The acceptance of a device: its steps, the person's part in each, and the results. Source:
///   docs/devices/acceptance.md.
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

/// The names of the steps, in order; a person can skip steps by name. Later steps require `push`,
/// because with a wrong sign, holding would push the handle away.
inline constexpr std::array<std::string_view, 7> kAcceptanceSteps = {
    "rest", "steps", "push", "strokes", "weights", "shake", "wall"};

/// A person's action on the handle during a run.
enum class Grip {
  lying,     ///< leaves it lying or holds it still
  moving,    ///< moves it slowly along all axes
  carrying,  ///< moves it some centimetres along the axis and holds it there
  holding,   ///< holds it lightly, so that it can yield
  free,      ///< brings it to the middle and lets go
  loaded,    ///< the same, with a weight on the handle
  pressing,  ///< presses it down on a floor
  guarding,  ///< holds it firmly and watches
};

/// The instruction before a run.
struct Prompt {
  std::string_view step;  ///< one of kAcceptanceSteps, or "thermal"
  Grip grip = Grip::lying;
  DeviceAxis axis = DeviceAxis::y;  ///< of the run, if it has one
  std::string text;                 ///< for the person
};

enum class Consent {
  go,
  skip,  ///< this run, or the remaining trials of a series
};

/// A real or simulated person. Every function may throw to end the acceptance.
class AcceptancePerson {
 public:
  virtual ~AcceptancePerson() = default;
  /// Asks for the grip, and for consent to the run. No force acts before it returns.
  [[nodiscard]] virtual Consent ready(const Prompt& prompt) = 0;
  /// Requests a weight, or a force measured by a spring scale, along an axis.
  /// \return N, in the range; nothing: the person has no weight
  [[nodiscard]] virtual std::optional<double> weight_n(DeviceAxis axis, double min_n,
                                                       double max_n) = 0;
  /// \return a temperature in degrees Celsius; nothing: there is no thermometer
  [[nodiscard]] virtual std::optional<double> temperature_c(const std::string& question) = 0;
  /// \return the person's observation, in their words; may be empty
  [[nodiscard]] virtual std::string ask_observation(const std::string& question) = 0;
  virtual void show(const std::string& result) = 0;
};

/// A device and its servo.
class AcceptanceBench {
 public:
  virtual ~AcceptanceBench() = default;
  [[nodiscard]] virtual DeviceInfo info() const = 0;
  /// \return the limits of every run
  [[nodiscard]] virtual SafetyLimits limits() const = 0;
  /// Sets a stricter force limit for later runs.
  /// \param max_n  > 0
  virtual void limit_force(double max_n) = 0;
  /// \param name  of the run, at most 8 characters
  /// \throws touchtrial::Error if a person or a signal stopped it
  [[nodiscard]] virtual ServoReport run(const std::string& name, Measurement& measurement) = 0;
  /// The same, while the system suspends the program for two seconds.
  /// \return nothing if suspending is not possible
  [[nodiscard]] virtual std::optional<ServoReport> run_suspended(Measurement& /*measurement*/) {
    return std::nullopt;
  }
};

struct AcceptanceOptions {
  std::set<std::string, std::less<>> skip{};  ///< of kAcceptanceSteps
  bool thermal = false;                       ///< twenty minutes under a load
};

/// Curves of one axis, for plots.
struct AxisCurves {
  DeviceAxis axis = DeviceAxis::y;
  std::vector<std::pair<double, double>> loop{};           ///< StrokeFigures::loop
  std::vector<std::pair<double, double>> bend_by_delay{};  ///< ShakeFigures::bend_by_delay
};

struct Acceptance {
  Certificate certificate;  ///< the caller sets `program`, `made` and `emulated`
  std::vector<AxisCurves> curves;
};

/// Maximum forces of an acceptance on one device.
struct AcceptanceForces {
  double push_n = 0.0;    ///< of a push or a shake
  double hold_n = 0.0;    ///< norm while the handle is held: 60 % of the peak force
  double weight_n = 0.0;  ///< of a weight and the handle's own load together
  HoldGains gains;        ///< below the maker's maximum stiffness and damping
};
[[nodiscard]] AcceptanceForces acceptance_forces(const DeviceInfo& device,
                                                 const SafetyLimits& limits) noexcept;

/// Runs the acceptance. A wrong sign or a fault ends it at once; the certificate then states the
/// reason.
/// \throws what bench and person throw
[[nodiscard]] Acceptance accept_device(AcceptanceBench& bench, AcceptancePerson& person,
                                       const AcceptanceOptions& options);

}  // namespace touchtrial::device
