#include "device/acceptance/bring_up/bring_up.hpp"

#include "core/text.hpp"
#include "device/acceptance/bring_up/findings.hpp"
#include "device/acceptance/handle_runs.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::device {
namespace {

constexpr double kBringUpRestS = 10.0;
/// Ticks at the start of the rest, until the hand has let go.
constexpr std::size_t kReleaseTicks = 4000;
constexpr double kDirectionRunS = 7.0;
constexpr std::size_t kEndTicks = 500;  ///< at the start and the end of a motion
constexpr double kMinPathMm = 10.0;
constexpr double kPushRunS = 2.5;
constexpr double kBringUpReachMm = 30.0;
constexpr double kRangeRunS = 20.0;
constexpr double kSoftWall = 0.2;  ///< N/mm
constexpr double kMaxStiffnessShare = 0.5;
constexpr std::int64_t kWallMs = 2000;  ///< duration of the recorded contact

/// Ends a bring-up that must not continue.
struct WrongSignFound {
  std::string reason;
};

Vec3 mean_position_mm(std::span<const ServoSample> samples) {
  Vec3 sum;
  for (const ServoSample& sample : samples) sum = sum + sample.position_mm;
  return samples.empty() ? sum : (1.0 / static_cast<double>(samples.size())) * sum;
}

std::string_view direction_text(DeviceAxis axis) {
  if (axis == DeviceAxis::x) return "to the right";
  return axis == DeviceAxis::y ? "up" : "towards you";
}

Workspace reach_of(std::span<const ServoSample> samples) {
  Workspace reach{samples.front().position_mm, samples.front().position_mm};
  for (const ServoSample& sample : samples) {
    const Vec3 position_mm = sample.position_mm;
    reach.min_mm = {std::min(reach.min_mm.x, position_mm.x),
                    std::min(reach.min_mm.y, position_mm.y),
                    std::min(reach.min_mm.z, position_mm.z)};
    reach.max_mm = {std::max(reach.max_mm.x, position_mm.x),
                    std::max(reach.max_mm.y, position_mm.y),
                    std::max(reach.max_mm.z, position_mm.z)};
  }
  return reach;
}

/// \return the handle's motion while it was pushed
Vec3 pushed_motion_mm(const Measurement& run) {
  const auto pushed = [](const ServoSample& sample) { return norm(sample.force_n) > 0.0; };
  const auto samples = run.samples();
  const auto first = std::ranges::find_if(samples, pushed);
  if (first == samples.end()) return {};
  const auto last = std::find_if(samples.rbegin(), samples.rend(), pushed);
  return last->position_mm - first->position_mm;
}

/// Records two seconds of the wall trial, from the first contact on.
void add_wall(std::span<const ServoSample> samples, BringUp& record) {
  std::vector<double> ms;
  std::vector<double> height_um;
  std::vector<double> force_mn;
  const auto first_contact = std::ranges::find_if(
      samples, [](const ServoSample& sample) { return sample.force_n.y > 0.0; });
  for (auto sample = first_contact; sample != samples.end(); ++sample) {
    const std::int64_t elapsed = sample->tick - first_contact->tick;
    if (elapsed >= kWallMs) break;
    ms.push_back(static_cast<double>(elapsed));
    height_um.push_back(std::round(1e3 * sample->position_mm.y));
    force_mn.push_back(std::round(1e3 * sample->force_n.y));
  }
  record.note("time_ms", ms);
  record.note("height_um", height_um);
  record.note("force_up_mn", force_mn);
}

void add_servo_figures(const ServoReport& report, const PassiveRun& run, BringUp& record) {
  const auto ticks = static_cast<double>(report.ticks + report.overruns);
  const double seconds = ticks / (report.rate_hz > 0.0 ? report.rate_hz : kServoRateHz);
  record.note("ticks_hz", {report.rate_hz});
  if (seconds > 0.0 && run.new_readings() > 0) {
    record.note("new_readings_hz", {static_cast<double>(run.new_readings()) / seconds});
  }
  record.note("longest_gap_ms", {run.longest_gap_ticks() * 1e3 * kServoTickS});
  record.note("late_p50_us", {report.lateness.p50_us});
  record.note("late_p99_us", {report.lateness.p99_us});
  record.note("late_worst_us", {report.lateness.worst_us});
  record.note("overruns", {static_cast<double>(report.overruns)});
}

class Steps {
 public:
  Steps(AcceptanceBench& bench, AcceptancePerson& person, const std::vector<UnverifiedFact>& facts,
        BringUp& record, const std::function<void()>& save)
      : bench_(bench),
        person_(person),
        facts_(facts),
        record_(record),
        save_(save),
        runs_(bench, person) {}

  void run() {
    try {
      bench_.limit_force(kSecondPushN);
      run_step(BringUpStep::rest, [&] { return measure_rest(); });
      run_step(BringUpStep::ways, [&] { return check_readings(); });
      run_step(BringUpStep::push, [&] { return check_pushes(); });
      run_step(BringUpStep::steps, [&] { return find_step(); });
      run_step(BringUpStep::range, [&] { return find_range(); });
      if (record_.signs_confirmed()) {
        bench_.limit_force(kConfirmedN);
        run_step(BringUpStep::weight, [&] { return weigh(); });
        run_step(BringUpStep::wall, [&] { return press(); });
        bench_.limit_force(kSecondPushN);
      } else {
        person_.show("weight and wall are skipped: not all signs are confirmed");
        record_.outcome(BringUpStep::weight) = StepOutcome::left_out;
        record_.outcome(BringUpStep::wall) = StepOutcome::left_out;
      }
      run_step(BringUpStep::program, [&] {
        return record_force_end(BringUpStep::program,
                                runs_.suspend_program(name_of(BringUpStep::program)));
      });
      run_step(BringUpStep::cable, [&] { return pull_cable(); });
      run_step(BringUpStep::questions, [&] { return ask_questions(); });
      record_.ended = BringUpEnd::complete;
    } catch (const WrongSignFound& sign) {
      end(BringUpEnd::wrong_sign, sign.reason);
    } catch (const DeviceFailed& failed) {
      end(BringUpEnd::fault, "the device failed: " + failed.fault);
    }
    save_();
  }

 private:
  void end(BringUpEnd ended, const std::string& reason) {
    record_.ended = ended;
    record_.reason = reason;
    person_.show("ended: " + reason);
  }

  template <typename Work>
  void run_step(BringUpStep step, const Work& work) {
    StepOutcome& outcome = record_.outcome(step);
    outcome = StepOutcome::interrupted;  // remains if the work throws
    outcome = work();
    save_();
  }

  StepOutcome fail(const std::string& reason) {
    person_.show("not measured: " + reason);
    return reason == kLeftOut ? StepOutcome::left_out : StepOutcome::failed;
  }

  /// \return the index of an answer; nothing if the person cannot tell
  template <typename Words>
  [[nodiscard]] std::optional<std::size_t> choose(const std::string& question, const Words& words) {
    std::string text = "\n" + question;
    for (std::size_t i = 0; i < std::size(words); ++i) {
      text += fmt::format(" {} {}{}", i + 1, words[i], i + 1 < std::size(words) ? "," : "");
    }
    const auto number =
        number_between<std::size_t>(text + " (Enter: unknown; q: end): ", 1, std::size(words));
    if (!number) return std::nullopt;
    return *number - 1;
  }

  /// \return the number; nothing if the person enters none
  template <typename Number>
  [[nodiscard]] std::optional<Number> number_between(const std::string& question, Number low,
                                                     Number high) {
    while (true) {
      const std::string answer = person_.ask_observation(question);
      if (answer.empty()) return std::nullopt;
      const auto number = number_in<Number>(answer);
      if (number && *number >= low && *number <= high) return number;
      person_.show(fmt::format("enter a number from {} to {}", low, high));
    }
  }

  StepOutcome measure_rest() {
    if (!runs_.obtain_consent(
            {"rest",
             Grip::lying,
             {},
             "Hold the handle in the middle, and let go of it slowly within 3 s of the start. "
             "Keep your hands close: it may sink or rise. The program sends no force for 10 s."})) {
      return StepOutcome::left_out;
    }
    PassiveRun run(kBringUpRestS);
    const ServoReport report = bench_.run("rest", run);
    const std::span<const ServoSample> samples = run.samples();
    // The rate of readings before a fault helps to explain it.
    add_servo_figures(report, run, record_);
    HandleRuns::require_no_fault(report, "rest");
    const auto figures = samples.size() > kReleaseTicks
                             ? rest_figures(samples.subspan(kReleaseTicks))
                             : std::nullopt;
    if (!figures) return StepOutcome::failed;
    record_.note("noise_mm", {figures->noise_mm});
    record_.note("drift_mm", {figures->drift_mm});
    person_.show(
        fmt::format("noise {:.4f} mm, drift {:.3f} mm; {:.0f} new readings per second, "
                    "99 % of ticks within {:.0f} us",
                    figures->noise_mm, figures->drift_mm, record_.number("new_readings_hz"),
                    report.lateness.p99_us));
    return StepOutcome::done;
  }

  StepOutcome check_readings() {
    bool all_done = true;
    for (const DeviceAxis axis : kDeviceAxes) all_done = check_reading(axis) && all_done;
    return all_done ? StepOutcome::done : StepOutcome::left_out;
  }

  bool check_reading(DeviceAxis axis) {
    const std::string name(name_of(axis));
    while (true) {
      if (!runs_.obtain_consent(
              {"ways", Grip::carrying, axis,
               fmt::format("Hold the handle still in the middle. One second after the start, move "
                           "it straight {} by 3 to 5 cm, along a ruler if you have one, and "
                           "hold it there until 7 s are over. No force acts.",
                           direction_text(axis))})) {
        return false;
      }
      PassiveRun run(kDirectionRunS);
      runs_.measure("way " + name, run);
      const auto samples = run.samples();
      const std::size_t end_ticks = std::min(kEndTicks, samples.size() / 3);
      const Vec3 moved =
          mean_position_mm(samples.last(end_ticks)) - mean_position_mm(samples.first(end_ticks));
      person_.show(
          fmt::format("the readings moved by {:+.1f}, {:+.1f}, {:+.1f} mm (x right, y up, z "
                      "towards you)",
                      moved.x, moved.y, moved.z));
      if (norm(moved) < kMinPathMm) {
        person_.show("that is too little; move it further");
        continue;
      }
      record_.note("carried_mm " + name, {moved.x, moved.y, moved.z});
      if (!followed_axis(record_, axis)) {
        throw WrongSignFound{fmt::format(
            "the handle was moved {}, but the readings moved differently; no force was sent",
            direction_text(axis))};
      }
      const auto ruler_mm = number_between<double>(
          "\nBy how many mm did it move along the ruler? (Enter: no ruler; q: end): ", 1.0, 500.0);
      if (ruler_mm) record_.note("ruler_mm " + name, {*ruler_mm});
      return true;
    }
  }

  StepOutcome check_pushes() {
    bool all_done = true;
    for (const DeviceAxis axis : kDeviceAxes) {
      for (const int sign : {1, -1}) all_done = check_push_direction(axis, sign) && all_done;
    }
    return all_done ? StepOutcome::done : StepOutcome::left_out;
  }

  /// \return whether the person felt the push; else its sign is not confirmed
  bool check_push_direction(DeviceAxis axis, int sign) {
    const std::string name = signed_name(sign, axis);
    for (const double force_n : {kFirstPushN, kSecondPushN}) {
      if (!runs_.obtain_consent(
              {"push", Grip::holding, axis,
               fmt::format("Hold the handle lightly in the middle, so that it can give way. The "
                           "device pushes it with {:.1f} N for 2.5 s.",
                           force_n)})) {
        return false;
      }
      SteadyPush run(kPushRunS, (sign * force_n) * direction_of(axis), kBringUpReachMm);
      runs_.measure("push " + std::string(name_of(axis)), run);
      const auto direction = choose("In which direction did it push?", kPushDirections);
      if (!direction) return false;
      const Vec3 moved = pushed_motion_mm(run);
      record_.note("push_n " + name, {force_n});
      record_.note("felt " + name, kPushDirections.at(*direction));
      record_.note("moved_mm " + name, {moved.x, moved.y, moved.z});
      switch (sign_of_push(record_, axis, sign)) {
        case PushSign::correct:
          return true;
        case PushSign::wrong:
          throw WrongSignFound{
              fmt::format("a force along {} was felt or read in another direction: a sign is "
                          "wrong, or axes are exchanged; no larger force was sent",
                          name)};
        case PushSign::not_felt:
          break;
      }
    }
    return false;
  }

  StepOutcome find_step() {
    const ValueOrReason<Measured> step = runs_.encoder_step();
    if (!step.value) return fail(step.reason);
    step_mm_ = step.value->value;
    record_.note("encoder_step_mm", {step_mm_});
    person_.show(fmt::format("encoder step: {:.4f} mm", step_mm_));
    return StepOutcome::done;
  }

  StepOutcome find_range() {
    if (!runs_.obtain_consent(
            {"range",
             Grip::moving,
             {},
             "Move the handle slowly to its ends: left, right, down, up, away and towards you; "
             "no force acts for 20 s."})) {
      return StepOutcome::left_out;
    }
    PassiveRun run(kRangeRunS);
    runs_.measure("range", run);
    if (run.samples().empty()) return StepOutcome::failed;
    const Workspace reach = reach_of(run.samples());
    const Vec3 size = reach.max_mm - reach.min_mm;
    if (std::min({size.x, size.y, size.z}) < kMinPathMm) {
      return fail("the handle was moved by less than 1 cm along an axis");
    }
    add_extent(record_, "reach_mm ", reach);
    return StepOutcome::done;
  }

  StepOutcome weigh() {
    const ValueOrReason<StrokeFigures> empty =
        runs_.empty_strokes("weight", DeviceAxis::y, {}, step_mm_);
    if (!empty.value) return fail(empty.reason);
    const double load_n = empty.value->load_n.value;
    const double friction_n = empty.value->friction_n.value;
    record_.note("load_n", {load_n});
    record_.note("friction_n", {friction_n});
    const ValueOrReason<WeighResult> weighed =
        runs_.weigh("weight", DeviceAxis::y, {{0.0, load_n, 0.0}, load_n, friction_n}, step_mm_);
    if (!weighed.value) return fail(weighed.reason);
    const auto scale = AxisResult{.weight = weighed.value}.scale();
    record_.note("weight_n", {weighed.value->expected_n});
    record_.note("commanded_for_it_n", {weighed.value->measured_n});
    record_.note("force_scale_and_error", {scale->value, scale->error});
    return StepOutcome::done;
  }

  StepOutcome press() {
    const DeviceInfo info = bench_.info();
    const double stiffness_n_per_mm =
        info.max_stiffness_n_per_mm > 0.0
            ? std::min(kSoftWall, kMaxStiffnessShare * info.max_stiffness_n_per_mm)
            : kSoftWall;
    if (!runs_.obtain_consent(
            {"wall", Grip::pressing, DeviceAxis::y,
             fmt::format("Hold the handle lightly in the middle. 3 mm below it is a soft floor of "
                         "{:.2f} N/mm: press on it for 6 s, and do not lift the handle. The floor "
                         "is switched off if it oscillates.",
                         stiffness_n_per_mm)})) {
      return StepOutcome::left_out;
    }
    WallTrial run(stiffness_n_per_mm, kMinSwingMm, acceptance_forces(info, bench_.limits()).hold_n);
    const ServoReport report = runs_.measure("wall", run);
    if (!run.has_oscillated() && run.contact_s() < kMinContactS) {
      return fail("the floor was not pressed");
    }
    record_.note("stiffness_n_per_mm", {stiffness_n_per_mm});
    record_.note("wall", run.has_oscillated() ? "swung" : "steady");
    record_.note("contact_s", {run.contact_s()});
    if (report.delivered_share > 0.0) record_.note("delivered_share", {report.delivered_share});
    add_wall(run.samples(), record_);
    return StepOutcome::done;
  }

  StepOutcome pull_cable() {
    if (!has_device_failed_) return record_force_end(BringUpStep::cable, runs_.pull_cable("cable"));
    person_.show("the device has failed and must be reopened: repeat the bring-up for the cable");
    return StepOutcome::left_out;
  }

  /// These runs provoke a fault, so it does not end the bring-up.
  StepOutcome record_force_end(BringUpStep step, const ValueOrReason<ServoReport>& run) {
    if (!run.value) return fail(run.reason);
    has_device_failed_ = run.value->device_fault != DeviceFault::none;
    const auto force = choose("What did the force do?", kForceEndings);
    if (!force) return StepOutcome::failed;
    const std::string suffix = "without_" + std::string(name_of(step));
    const DeviceFault fault = run.value->device_fault;
    record_.note("force_" + suffix, kForceEndings.at(*force));
    record_.note("fault_" + suffix,
                 fault == DeviceFault::none ? name_of(run.value->fault) : name_of(fault));
    return StepOutcome::done;
  }

  StepOutcome ask_questions() {
    for (const UnverifiedFact& fact : facts_) {
      if (fact.question.empty()) continue;
      const auto answer = choose(fact.question, fact.answers);
      if (answer) record_.note(fact.id, fact.answers.at(*answer));
    }
    return StepOutcome::done;
  }

  AcceptanceBench& bench_;
  AcceptancePerson& person_;
  const std::vector<UnverifiedFact>& facts_;
  BringUp& record_;
  const std::function<void()>& save_;
  HandleRuns runs_;
  double step_mm_ = 0.0;            ///< 0: unknown
  bool has_device_failed_ = false;  ///< the fault lasts until the device is reopened
};

}  // namespace

void bring_up(AcceptanceBench& bench, AcceptancePerson& person,
              const std::vector<UnverifiedFact>& facts, BringUp& record,
              const std::function<void()>& save) {
  Steps(bench, person, facts, record, save).run();
}

}  // namespace touchtrial::device
