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
/// Of the continuous force, for the twelve seconds of a weight.
constexpr double kWeightShare = 1.5;
constexpr double kShakeMoreN = 0.4;   ///< beyond friction
constexpr double kSoftestWall = 0.1;  ///< N/mm
constexpr double kWallFactor = 1.3;
constexpr double kStiffestWall = 1.0;  ///< where the maker states no limit
constexpr double kStepsOfSwing = 3.0;
constexpr double kNoisesOfSwing = 4.0;
constexpr int kWarmMinutes = 20;
constexpr double kMinuteS = 60.0;

/// Ends an acceptance that must not continue.
struct EndOfAcceptance {
  std::string why;
};

double stiffest_wall_of(const DeviceInfo& device) {
  return device.max_stiffness_n_per_mm > 0.0 ? device.max_stiffness_n_per_mm : kStiffestWall;
}

PushResult push_result(const AxisPush::Push& push, DeviceAxis axis, double sign) {
  const double along_mm = sign * dot(push.moved_mm, direction_of(axis));
  const double across_mm =
      std::sqrt(std::max(dot(push.moved_mm, push.moved_mm) - along_mm * along_mm, 0.0));
  return {push.force_n, push.moved, along_mm, across_mm};
}

std::string push_words(const PushResult& push) {
  if (!push.moved) return fmt::format("no motion at {:.1f} N", push.force_n);
  return fmt::format("moved {:+.1f} mm at {:.1f} N", push.along_mm, push.force_n);
}

std::string words_of(const Measured& measured, int digits, const char* unit) {
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
      listen();
      push();
      stroke();
      weigh();
      shake();
      press();
      if (options_.thermal) warm();
    } catch (const EndOfAcceptance& end) {
      missed("everything that follows", end.why);
    } catch (const DeviceFailed& failed) {
      certificate_.fault = failed.fault + " in the run " + failed.run;
      missed("everything that follows", "the device failed: " + certificate_.fault);
    }
    if (!options_.thermal) missed("force after twenty minutes", "not asked for (--thermal)");
    apply_force_scale();
    return {std::move(certificate_), std::move(curves_)};
  }

 private:
  void missed(const std::string& what, const std::string& why) {
    certificate_.not_measured.push_back({what, why});
    person_.show(what + ": not measured: " + why);
  }

  /// \return whether the run may begin; if not, the certificate records that it was skipped
  bool consents(const Prompt& prompt, const std::string& what) {
    if (runs_.consents(prompt)) return true;
    missed(what, std::string(kLeftOut));
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
  /// Smaller swings are ignored.
  [[nodiscard]] double min_swing_mm() const {
    const double noise_mm = certificate_.rest ? certificate_.rest->noise_mm : 0.0;
    return std::max({kMinSwingMm, kStepsOfSwing * step_mm(), kNoisesOfSwing * noise_mm});
  }
  static std::string on(DeviceAxis axis) { return " on axis " + std::string(name_of(axis)); }

  void listen() {
    if (consents({"rest",
                  Grip::lying,
                  {},
                  "Let the handle lie or hold it still; no force acts for 4 s."},
                 "noise at rest")) {
      Listening rest(kRestRunS);
      runs_.measure("rest", rest);
      certificate_.rest = rest_figures(rest.samples());
      if (certificate_.rest) {
        person_.show(fmt::format("at rest: noise {:.4f} mm, drift {:.3f} mm",
                                 certificate_.rest->noise_mm, certificate_.rest->drift_mm));
      } else {
        missed("noise at rest", "the run ended early");
      }
    }
    const ValueOrReason<Measured> step = runs_.encoder_step();
    certificate_.step_mm = step.value;
    if (step.value) {
      person_.show("encoder step: " + words_of(*step.value, 4, "mm"));
    } else {
      missed("encoder step", step.why);
    }
  }

  void push() {
    for (const DeviceAxis axis : kDeviceAxes) {
      if (!consents({"push", Grip::holding, axis,
                     fmt::format("Hold the handle lightly in the middle, so that it can give way. "
                                 "It is pushed along axis {} by at most {:.1f} N, in steps of 0.1 "
                                 "N, until it has moved 2 mm; then the other way.",
                                 name_of(axis), forces_.push_n)},
                    "sign" + on(axis))) {
        throw EndOfAcceptance{"no pull before the signs of all axes are known"};
      }
      AxisPush run(axis, forces_.push_n);
      runs_.measure("push " + std::string(name_of(axis)), run);
      take_push(axis, run);
    }
  }

  void take_push(DeviceAxis axis, const AxisPush& run) {
    const AxisPush::Figures& figures = run.figures();
    AxisResult& result = result_of(axis);
    if (figures.plus) result.plus = push_result(*figures.plus, axis, 1.0);
    if (figures.minus) result.minus = push_result(*figures.minus, axis, -1.0);
    const std::string name(name_of(axis));
    if (result.plus) person_.show("push +" + name + ": " + push_words(*result.plus));
    if (result.minus) person_.show("push -" + name + ": " + push_words(*result.minus));
    const bool may_continue = result.plus && result.minus && result.plus->moved &&
                              result.minus->moved &&
                              result.plus->along_mm > result.plus->across_mm &&
                              result.minus->along_mm > result.minus->across_mm;
    if (may_continue) return;
    if (run.ran_away())
      throw EndOfAcceptance{"the handle ran more than 15 mm away from where its push began" +
                            on(axis)};
    if (!figures.reached_rest) throw EndOfAcceptance{"the handle never came to rest" + on(axis)};
    throw EndOfAcceptance{"the handle does not follow a small force" + on(axis)};
  }

  void stroke() {
    for (const DeviceAxis axis : kDeviceAxes) {
      const ValueOrReason<StrokeFigures> strokes =
          runs_.empty_strokes("strokes", axis, support_n_, step_mm());
      if (!strokes.value) {
        missed("friction and load" + on(axis), strokes.why);
        continue;
      }
      AxisResult& result = result_of(axis);
      result.load_n = strokes.value->load_n.value;
      result.friction_n = strokes.value->friction_n;
      support_n_ =
          support_n_ + (*result.load_n - dot(support_n_, direction_of(axis))) * direction_of(axis);
      curves_of(axis).loop = strokes.value->loop;
      person_.show(fmt::format("axis {}: friction {}, the handle's own load {:.2f} N",
                               name_of(axis), words_of(*result.friction_n, 2, "N"),
                               *result.load_n));
    }
  }

  void weigh() {
    for (const DeviceAxis axis : kDeviceAxes) {
      AxisResult& result = result_of(axis);
      const std::string what = "size of the force" + on(axis);
      if (!result.load_n) {
        missed(what, "the empty handle was not measured");
        continue;
      }
      const EmptyHandle empty{support_n_, *result.load_n, result.friction_n->value};
      const ValueOrReason<WeighResult> weighed = runs_.weigh("weights", axis, empty, step_mm());
      result.weight = weighed.value;
      if (!weighed.value) missed(what, weighed.why);
    }
  }

  void shake() {
    for (const DeviceAxis axis : kDeviceAxes) {
      const std::string what = "mass and delay" + on(axis);
      AxisResult& result = result_of(axis);
      if (!result.friction_n) {
        missed(what, "friction was not measured, which determines how hard to push");
        continue;
      }
      const double push_n = std::min(result.friction_n->value + kShakeMoreN, forces_.push_n);
      if (!consents({"shake", Grip::free, axis,
                     fmt::format("Hold the handle in the middle. Let go slowly within 2 s of the "
                                 "start: it is pushed to and fro along axis {} by {:.1f} N for 12 "
                                 "s. Keep clear of it.",
                                 name_of(axis), push_n)},
                    what)) {
        result.delay_left_out = true;
        continue;
      }
      ShakenStrokes run(axis, support_n_, push_n, forces_.gains, forces_.hold_n);
      runs_.measure("shake " + std::string(name_of(axis)), run);
      const ValueOrReason<ShakeFigures> shaken =
          shake_figures(run, result.friction_n->value, step_mm());
      if (!shaken.value) {
        missed(what, shaken.why);
        continue;
      }
      take_shake(*shaken.value, result);
    }
  }

  void take_shake(const ShakeFigures& figures, AxisResult& result) {
    result.mass_kg = figures.mass_kg;
    result.viscous_n_s_per_m = figures.viscous_n_s_per_m;
    // Slow strokes take what damping adds at their speed for friction.
    result.friction_n->value -=
        0.001 * SlowStrokes::kSpeedMmS * std::max(figures.viscous_n_s_per_m.value, 0.0);
    std::string no_delay = figures.no_delay;
    if (figures.delay_ms && verdict_on_delay(*figures.delay_ms) == DelayVerdict::unclear) {
      no_delay =
          "unclear: " + words_of(*figures.delay_ms, 1, "ms") +
          "; slow motors or soft arms round the turns of the push: switch off filters of the "
          "force in driver and amplifier, tighten the arms, and shake it again";
    } else {
      result.delay_ms = figures.delay_ms;
    }
    curves_of(result.axis).by_delay = figures.by_delay;
    person_.show(fmt::format("axis {}: mass {}, {:.0f} % of the motion unexplained",
                             name_of(result.axis), words_of(figures.mass_kg, 3, "kg"),
                             100.0 * figures.unexplained));
    if (result.delay_ms) {
      person_.show(fmt::format("axis {}: delay {}", name_of(result.axis),
                               words_of(*result.delay_ms, 1, "ms")));
    } else {
      missed("delay" + on(result.axis), no_delay);
    }
  }

  void press() {
    const double stiffest = stiffest_wall_of(info_);
    WallResult wall;
    wall.ended = info_.max_stiffness_n_per_mm > 0.0 ? "the maker's limit" : "the program's limit";
    double stiffness = std::min(kSoftestWall, stiffest);
    bool tried = false;
    while (true) {
      const Prompt prompt{
          "wall", Grip::pressing, DeviceAxis::y,
          fmt::format("Hold the handle lightly in the middle. 3 mm below it is a floor of {:.2f} "
                      "N/mm: press on it as in a stroke for 6 s, and do not lift the handle. It is "
                      "switched off if it begins to swing or throws the handle up again and again.",
                      stiffness)};
      if (!runs_.consents(prompt)) {
        wall.ended = kLeftOut;
        break;
      }
      WallTrial run(stiffness, min_swing_mm(), forces_.hold_n);
      runs_.measure("wall", run);
      if (run.oscillated()) {
        wall.oscillates_n_per_mm = stiffness;
        wall.ended = "oscillation";
        tried = true;
        break;
      }
      if (run.contact_s() < kMinContactS) {
        wall.ended = "the floor was not pressed";
        break;
      }
      tried = true;
      wall.stable_n_per_mm = stiffness;
      if (stiffness >= stiffest) break;
      stiffness = std::min(stiffness * kWallFactor, stiffest);
    }
    if (!tried) {
      missed("stiffest wall", wall.ended);
      return;
    }
    certificate_.wall = wall;
    person_.show(fmt::format("wall: stable at {:.2f} N/mm{}; ended by {}", wall.stable_n_per_mm,
                             wall.oscillates_n_per_mm > 0.0
                                 ? fmt::format(", swings at {:.2f} N/mm", wall.oscillates_n_per_mm)
                                 : "",
                             wall.ended));
  }

  /// Holds a load along y for twenty minutes; the change of its force shows what warm motors lose.
  void warm() {
    const std::string what = "force after twenty minutes";
    AxisResult& result = result_of(DeviceAxis::y);
    if (!result.weight) {
      missed(what, "needs the weight on axis y");
      return;
    }
    WarmResult warm;
    if (!consents({"thermal", Grip::loaded, DeviceAxis::y,
                   "Hang the weight of axis y on the handle again, and let go within 2 s of the "
                   "start of each run. It hangs for twenty minutes; stay with it."},
                  what)) {
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
        missed(what, strokes.why);
        return;
      }
      warm.after_n = strokes.value->load_n.value;
      if (minute == 0) warm.before_n = warm.after_n;
    }
    warm.after_c = person_.temperature_c("temperature of the motors' housing now");
    person_.show(fmt::format("the load took {:.3f} N at first, and {:.3f} N after twenty minutes",
                             warm.before_n, warm.after_n));
    certificate_.warm = warm;
  }

  /// Converts measurements from commanded newtons to newtons at the handle.
  void apply_force_scale() {
    for (AxisResult& result : certificate_.axes) {
      const auto scale = result.scale();
      if (!scale) {
        if (result.friction_n) {
          missed("newtons at the handle" + on(result.axis),
                 "friction and mass count commanded newtons, as the size of the force is unknown");
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
  Vec3 support_n_;  ///< commanded, for the handle's own load
  Certificate certificate_;
  std::vector<AxisCurves> curves_;
};

}  // namespace

AcceptanceForces acceptance_forces(const DeviceInfo& device, const SafetyLimits& limits) noexcept {
  const SafetyLimits all = limits_on(device, limits);
  const double continuous_n =
      all.continuous_force_n > 0.0 ? all.continuous_force_n : all.max_force_n;
  AcceptanceForces forces;
  forces.hold_n = kPeakShare * all.max_force_n;
  forces.push_n = std::min({AxisPush::kMaxN, continuous_n, forces.hold_n});
  forces.weight_n = std::min(forces.hold_n, kWeightShare * continuous_n);
  if (device.max_stiffness_n_per_mm > 0.0) {
    forces.gains.spring_n_per_mm =
        std::min(forces.gains.spring_n_per_mm, 0.75 * device.max_stiffness_n_per_mm);
  }
  forces.gains.damper_n_s_per_mm =
      within_share(forces.gains.damper_n_s_per_mm, device.max_damping_n_s_per_mm);
  return forces;
}

Acceptance accept_device(AcceptanceBench& bench, AcceptancePerson& person,
                         const AcceptanceOptions& options) {
  return Procedure(bench, person, options).run();
}

}  // namespace touchtrial::device
