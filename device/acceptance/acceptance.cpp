#include "device/acceptance/acceptance.hpp"

#include "device/acceptance/handle_runs.hpp"
#include "device/model/workspace_fit.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

namespace touchtrial::device {
namespace {

constexpr double kRestRunS = 4.0;
constexpr double kPeakShare = 0.6;
/// A weight may need this share of the continuous force for its twelve seconds.
constexpr double kWeightShare = 1.5;
constexpr double kShakeExcessN = 0.4;  ///< force in excess of friction
constexpr double kMinWall = 0.1;       ///< N/mm
constexpr double kWallFactor = 1.3;
constexpr double kDefaultMaxWall = 1.0;  ///< N/mm, if the maker states no limit
constexpr double kMinSwingSteps = 3.0;
constexpr double kMinSwingNoises = 4.0;
constexpr int kWarmMinutes = 20;
constexpr double kMinuteS = 60.0;

/// Ends an acceptance that must not continue.
struct AcceptanceEnded {
  std::string reason;
};

double max_wall_stiffness(const DeviceInfo& device) {
  return device.max_stiffness_n_per_mm > 0.0 ? device.max_stiffness_n_per_mm : kDefaultMaxWall;
}

PushResult push_result(const AxisPush::Push& push, DeviceAxis axis, double sign) {
  const double along_mm = sign * dot(push.moved_mm, direction_of(axis));
  const double across_mm =
      std::sqrt(std::max(dot(push.moved_mm, push.moved_mm) - along_mm * along_mm, 0.0));
  return {push.force_n, push.moved, along_mm, across_mm};
}

std::string push_text(const PushResult& push) {
  if (!push.moved) return fmt::format("no motion at {:.1f} N", push.force_n);
  return fmt::format("moved {:+.1f} mm at {:.1f} N", push.along_mm, push.force_n);
}

std::string measured_text(const Measured& measured, int digits, const char* unit) {
  return fmt::format("{:.{}f} +- {:.{}f} {}", measured.value, digits, measured.error, digits, unit);
}

void scale_by(std::optional<Measured>& measured, const Measured& scale) {
  if (!measured) return;
  const double value = measured->value * scale.value;
  measured =
      Measured{value, measured->error * scale.value + std::abs(measured->value) * scale.error};
}

class Procedure {
 public:
  Procedure(AcceptanceBench& bench, AcceptancePerson& person, const AcceptanceOptions& options)
      : bench_(bench),
        person_(person),
        options_(options),
        info_(bench.info()),
        forces_(acceptance_forces(info_, bench.limits())),
        runs_(bench, person, options.skip) {
    certificate_.driver = info_.name;
    certificate_.model = info_.model;
    certificate_.serial = info_.serial;
    certificate_.firmware = info_.firmware;
    certificate_.scale = info_.scale;
  }

  Acceptance run() {
    try {
      measure_rest();
      push();
      stroke();
      weigh();
      shake();
      press();
      if (options_.thermal) measure_warming();
    } catch (const AcceptanceEnded& end) {
      add_not_measured("all later steps", end.reason);
    } catch (const DeviceFailed& failed) {
      certificate_.fault = failed.fault + " in the run " + failed.run;
      add_not_measured("all later steps", "the device failed: " + certificate_.fault);
    }
    if (!options_.thermal)
      add_not_measured("force after twenty minutes", "not requested (--thermal)");
    apply_force_scale();
    return {std::move(certificate_), std::move(curves_)};
  }

 private:
  void add_not_measured(const std::string& measurement, const std::string& reason) {
    certificate_.not_measured.push_back({measurement, reason});
    person_.show(measurement + ": not measured: " + reason);
  }

  /// \return whether the run may begin; if not, the certificate records that it was skipped
  bool obtain_consent(const Prompt& prompt, const std::string& measurement) {
    if (runs_.obtain_consent(prompt)) return true;
    add_not_measured(measurement, std::string(kLeftOut));
    return false;
  }

  AxisResult& result_of(DeviceAxis axis) {
    const auto found = std::ranges::find(certificate_.axes, axis, &AxisResult::axis);
    if (found != certificate_.axes.end()) return *found;
    certificate_.axes.push_back({.axis = axis});
    return certificate_.axes.back();
  }
  AxisCurves& curves_of(DeviceAxis axis) {
    const auto found = std::ranges::find(curves_, axis, &AxisCurves::axis);
    if (found != curves_.end()) return *found;
    curves_.push_back({.axis = axis});
    return curves_.back();
  }
  [[nodiscard]] double step_mm() const {
    return certificate_.step_mm ? certificate_.step_mm->value : 0.0;
  }
  /// \return the minimum swing that counts as oscillation
  [[nodiscard]] double min_swing_mm() const {
    const double noise_mm = certificate_.rest ? certificate_.rest->noise_mm : 0.0;
    return std::max({kMinSwingMm, kMinSwingSteps * step_mm(), kMinSwingNoises * noise_mm});
  }
  static std::string axis_suffix(DeviceAxis axis) {
    return " on axis " + std::string(name_of(axis));
  }

  void measure_rest() {
    if (obtain_consent({"rest",
                        Grip::lying,
                        {},
                        "Leave the handle lying or hold it still; no force acts for 4 s."},
                       "noise at rest")) {
      PassiveRun rest(kRestRunS);
      runs_.measure("rest", rest);
      certificate_.rest = rest_figures(rest.samples());
      if (certificate_.rest) {
        person_.show(fmt::format("at rest: noise {:.4f} mm, drift {:.3f} mm",
                                 certificate_.rest->noise_mm, certificate_.rest->drift_mm));
      } else {
        add_not_measured("noise at rest", "the run ended early");
      }
    }
    const ValueOrReason<Measured> step = runs_.encoder_step();
    certificate_.step_mm = step.value;
    if (step.value) {
      person_.show("encoder step: " + measured_text(*step.value, 4, "mm"));
    } else {
      add_not_measured("encoder step", step.reason);
    }
  }

  void push() {
    for (const DeviceAxis axis : kDeviceAxes) {
      if (!obtain_consent(
              {"push", Grip::holding, axis,
               fmt::format("Hold the handle lightly in the middle, so that it can give way. "
                           "It is pushed along axis {} by at most {:.1f} N, in steps of 0.1 "
                           "N, until it has moved 2 mm; then in the opposite direction.",
                           name_of(axis), forces_.push_n)},
              "sign" + axis_suffix(axis))) {
        throw AcceptanceEnded{"later steps require the signs of all axes"};
      }
      AxisPush run(axis, forces_.push_n);
      runs_.measure("push " + std::string(name_of(axis)), run);
      add_push(axis, run);
    }
  }

  void add_push(DeviceAxis axis, const AxisPush& run) {
    const AxisPush::Figures& figures = run.figures();
    AxisResult& result = result_of(axis);
    if (figures.plus) result.plus = push_result(*figures.plus, axis, 1.0);
    if (figures.minus) result.minus = push_result(*figures.minus, axis, -1.0);
    const std::string name(name_of(axis));
    if (result.plus) person_.show("push +" + name + ": " + push_text(*result.plus));
    if (result.minus) person_.show("push -" + name + ": " + push_text(*result.minus));
    const bool may_continue = result.plus && result.minus && result.plus->moved &&
                              result.minus->moved &&
                              result.plus->along_mm > result.plus->across_mm &&
                              result.minus->along_mm > result.minus->across_mm;
    if (may_continue) return;
    if (run.has_run_away())
      throw AcceptanceEnded{"the handle moved more than 15 mm from the start of its push" +
                            axis_suffix(axis)};
    if (!figures.reached_rest)
      throw AcceptanceEnded{"the handle never came to rest" + axis_suffix(axis)};
    throw AcceptanceEnded{"the handle does not follow a small force" + axis_suffix(axis)};
  }

  void stroke() {
    for (const DeviceAxis axis : kDeviceAxes) {
      const ValueOrReason<StrokeFigures> strokes =
          runs_.empty_strokes("strokes", axis, support_n_, step_mm());
      if (!strokes.value) {
        add_not_measured("friction and load" + axis_suffix(axis), strokes.reason);
        continue;
      }
      AxisResult& result = result_of(axis);
      result.load_n = strokes.value->load_n.value;
      result.friction_n = strokes.value->friction_n;
      support_n_ =
          support_n_ + (*result.load_n - dot(support_n_, direction_of(axis))) * direction_of(axis);
      curves_of(axis).loop = strokes.value->loop;
      person_.show(fmt::format("axis {}: friction {}, the handle's own load {:.2f} N",
                               name_of(axis), measured_text(*result.friction_n, 2, "N"),
                               *result.load_n));
    }
  }

  void weigh() {
    for (const DeviceAxis axis : kDeviceAxes) {
      AxisResult& result = result_of(axis);
      const std::string measurement = "size of the force" + axis_suffix(axis);
      if (!result.load_n) {
        add_not_measured(measurement, "the empty handle was not measured");
        continue;
      }
      const EmptyHandle empty{support_n_, *result.load_n, result.friction_n->value};
      const ValueOrReason<WeighResult> weighing = runs_.weigh("weights", axis, empty, step_mm());
      result.weight = weighing.value;
      if (!weighing.value) add_not_measured(measurement, weighing.reason);
    }
  }

  void shake() {
    for (const DeviceAxis axis : kDeviceAxes) {
      const std::string measurement = "mass and delay" + axis_suffix(axis);
      AxisResult& result = result_of(axis);
      if (!result.friction_n) {
        add_not_measured(measurement, "the push depends on friction, which was not measured");
        continue;
      }
      const double push_n = std::min(result.friction_n->value + kShakeExcessN, forces_.push_n);
      if (!obtain_consent(
              {"shake", Grip::free, axis,
               fmt::format("Hold the handle in the middle. Let go slowly within 2 s of the "
                           "start: it is pushed to and fro along axis {} by {:.1f} N for 12 "
                           "s. Keep clear of it.",
                           name_of(axis), push_n)},
              measurement)) {
        result.delay_left_out = true;
        continue;
      }
      ShakenStrokes run(axis, support_n_, push_n, forces_.gains, forces_.hold_n);
      runs_.measure("shake " + std::string(name_of(axis)), run);
      const ValueOrReason<ShakeFigures> shaking =
          shake_figures(run, result.friction_n->value, step_mm());
      if (!shaking.value) {
        add_not_measured(measurement, shaking.reason);
        continue;
      }
      add_shake(*shaking.value, result);
    }
  }

  void add_shake(const ShakeFigures& figures, AxisResult& result) {
    result.mass_kg = figures.mass_kg;
    result.viscous_n_s_per_m = figures.viscous_n_s_per_m;
    // The friction of slow strokes includes damping at their speed.
    result.friction_n->value -=
        0.001 * SlowStrokes::kSpeedMmS * std::max(figures.viscous_n_s_per_m.value, 0.0);
    std::string no_delay_reason = figures.no_delay_reason;
    if (figures.delay_ms && verdict_on_delay(*figures.delay_ms) == DelayVerdict::unclear) {
      no_delay_reason =
          "unclear: " + measured_text(*figures.delay_ms, 1, "ms") +
          "; slow motors or soft arms round the path at reversals: switch off force filters in "
          "driver and amplifier, tighten the arms, and repeat the step shake";
    } else {
      result.delay_ms = figures.delay_ms;
    }
    curves_of(result.axis).bend_by_delay = figures.bend_by_delay;
    person_.show(fmt::format("axis {}: mass {}, {:.0f} % of the motion unexplained",
                             name_of(result.axis), measured_text(figures.mass_kg, 3, "kg"),
                             100.0 * figures.unexplained));
    if (result.delay_ms) {
      person_.show(fmt::format("axis {}: delay {}", name_of(result.axis),
                               measured_text(*result.delay_ms, 1, "ms")));
    } else {
      add_not_measured("delay" + axis_suffix(result.axis), no_delay_reason);
    }
  }

  void press() {
    const double max_stiffness = max_wall_stiffness(info_);
    WallResult wall;
    wall.ended = info_.max_stiffness_n_per_mm > 0.0 ? "the maker's limit" : "the program's limit";
    double stiffness = std::min(kMinWall, max_stiffness);
    bool has_trial = false;
    while (true) {
      const Prompt prompt{
          "wall", Grip::pressing, DeviceAxis::y,
          fmt::format("Hold the handle lightly in the middle. 3 mm below it is a floor of {:.2f} "
                      "N/mm: press on it as in a stroke for 6 s, and do not lift the handle. The "
                      "floor is switched off if it oscillates or throws the handle up repeatedly.",
                      stiffness)};
      if (!runs_.obtain_consent(prompt)) {
        wall.ended = kLeftOut;
        break;
      }
      WallTrial run(stiffness, min_swing_mm(), forces_.hold_n);
      runs_.measure("wall", run);
      if (run.has_oscillated()) {
        wall.oscillates_n_per_mm = stiffness;
        wall.ended = "oscillation";
        has_trial = true;
        break;
      }
      if (run.contact_s() < kMinContactS) {
        wall.ended = "the floor was not pressed";
        break;
      }
      has_trial = true;
      wall.stable_n_per_mm = stiffness;
      if (stiffness >= max_stiffness) break;
      stiffness = std::min(stiffness * kWallFactor, max_stiffness);
    }
    if (!has_trial) {
      add_not_measured("stiffest wall", wall.ended);
      return;
    }
    certificate_.wall = wall;
    person_.show(
        fmt::format("wall: stable at {:.2f} N/mm{}; ended by {}", wall.stable_n_per_mm,
                    wall.oscillates_n_per_mm > 0.0
                        ? fmt::format(", oscillates at {:.2f} N/mm", wall.oscillates_n_per_mm)
                        : "",
                    wall.ended));
  }

  /// Holds a load along y for twenty minutes; the change of its force shows the effect of warm
  /// motors.
  void measure_warming() {
    const std::string measurement = "force after twenty minutes";
    AxisResult& result = result_of(DeviceAxis::y);
    if (!result.weight) {
      add_not_measured(measurement, "needs the weight on axis y");
      return;
    }
    WarmResult warm;
    if (!obtain_consent(
            {"thermal", Grip::loaded, DeviceAxis::y,
             "Hang the weight of axis y on the handle again, and let go within 2 s of the "
             "start of each run. It hangs for twenty minutes; do not leave it."},
            measurement)) {
      return;
    }
    warm.before_c = person_.temperature_c("temperature of the motors' housing in degrees Celsius");
    for (int minute = 0; minute < kWarmMinutes; ++minute) {
      const double strokes_s = SlowStrokes::kPeriods * SlowStrokes::kPeriodS;
      SlowStrokes run(DeviceAxis::y, support_n_, forces_.gains, forces_.hold_n,
                      kMinuteS - strokes_s);
      runs_.measure("warm " + std::to_string(minute + 1), run);
      const ValueOrReason<StrokeFigures> strokes = stroke_figures(run, step_mm());
      if (!strokes.value) {
        add_not_measured(measurement, strokes.reason);
        return;
      }
      warm.after_n = strokes.value->load_n.value;
      if (minute == 0) warm.before_n = warm.after_n;
    }
    warm.after_c = person_.temperature_c("temperature of the motors' housing now");
    person_.show(fmt::format("the load needed {:.3f} N at first, {:.3f} N after twenty minutes",
                             warm.before_n, warm.after_n));
    certificate_.warm = warm;
  }

  /// Converts measurements from commanded newtons to newtons at the handle.
  void apply_force_scale() {
    for (AxisResult& result : certificate_.axes) {
      const auto scale = result.scale();
      if (!scale) {
        if (result.friction_n) {
          add_not_measured(
              "newtons at the handle" + axis_suffix(result.axis),
              "the size of the force is unknown, so friction and mass are in commanded newtons");
        }
        continue;
      }
      scale_by(result.friction_n, *scale);
      scale_by(result.mass_kg, *scale);
      scale_by(result.viscous_n_s_per_m, *scale);
    }
  }

  AcceptanceBench& bench_;
  AcceptancePerson& person_;
  const AcceptanceOptions& options_;
  DeviceInfo info_;
  AcceptanceForces forces_;
  HandleRuns runs_;
  Vec3 support_n_;  ///< commanded force that supports the empty handle
  Certificate certificate_;
  std::vector<AxisCurves> curves_;
};

}  // namespace

AcceptanceForces acceptance_forces(const DeviceInfo& device, const SafetyLimits& limits) noexcept {
  const SafetyLimits device_limits = limits_on(device, limits);
  const double continuous_n = device_limits.continuous_force_n > 0.0
                                  ? device_limits.continuous_force_n
                                  : device_limits.max_force_n;
  AcceptanceForces forces;
  forces.hold_n = kPeakShare * device_limits.max_force_n;
  forces.push_n = std::min({AxisPush::kMaxN, continuous_n, forces.hold_n});
  forces.weight_n = std::min(forces.hold_n, kWeightShare * continuous_n);
  if (device.max_stiffness_n_per_mm > 0.0) {
    forces.gains.spring_n_per_mm =
        std::min(forces.gains.spring_n_per_mm, 0.75 * device.max_stiffness_n_per_mm);
  }
  forces.gains.damper_n_s_per_mm =
      limit_to_share(forces.gains.damper_n_s_per_mm, device.max_damping_n_s_per_mm);
  return forces;
}

Acceptance accept_device(AcceptanceBench& bench, AcceptancePerson& person,
                         const AcceptanceOptions& options) {
  return Procedure(bench, person, options).run();
}

}  // namespace touchtrial::device
