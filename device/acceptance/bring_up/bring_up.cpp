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
constexpr std::size_t kSettledTicks = 4000;  ///< of the rest: the hand has let go
constexpr double kDirectionRunS = 7.0;
constexpr std::size_t kEndTicks = 500;  ///< at the start and the end of a motion
constexpr double kMinPathMm = 10.0;
constexpr double kPushRunS = 2.5;
constexpr double kBringUpReachMm = 30.0;
constexpr double kRangeRunS = 20.0;
constexpr double kSoftWall = 0.2;  ///< N/mm
constexpr double kShareOfStiffest = 0.5;
constexpr std::int64_t kWallMs = 2000;  ///< of its record

/// Ends a bring-up that must not continue.
struct WrongSign {
  std::string why;
};

Vec3 mean_place_mm(std::span<const ServoSample> samples) {
  Vec3 sum;
  for (const ServoSample& sample : samples) sum = sum + sample.position_mm;
  return samples.empty() ? sum : (1.0 / static_cast<double>(samples.size())) * sum;
}

std::string_view towards(DeviceAxis axis) {
  if (axis == DeviceAxis::x) return "to the right";
  return axis == DeviceAxis::y ? "up" : "towards you";
}

Workspace reach_of(std::span<const ServoSample> samples) {
  Workspace reach{samples.front().position_mm, samples.front().position_mm};
  for (const ServoSample& sample : samples) {
    const Vec3 at = sample.position_mm;
    reach.min_mm = {std::min(reach.min_mm.x, at.x), std::min(reach.min_mm.y, at.y),
                    std::min(reach.min_mm.z, at.z)};
    reach.max_mm = {std::max(reach.max_mm.x, at.x), std::max(reach.max_mm.y, at.y),
                    std::max(reach.max_mm.z, at.z)};
  }
  return reach;
}

/// How far the handle moved while it was pushed.
Vec3 moved_by(const Measurement& run) {
  const auto pushed = [](const ServoSample& sample) { return norm(sample.force_n) > 0.0; };
  const auto samples = run.samples();
  const auto first = std::ranges::find_if(samples, pushed);
  if (first == samples.end()) return {};
  const auto last = std::find_if(samples.rbegin(), samples.rend(), pushed);
  return last->position_mm - first->position_mm;
}

/// The first two seconds from the first contact on.
void note_wall(std::span<const ServoSample> samples, BringUp& record) {
  std::vector<double> ms;
  std::vector<double> height_um;
  std::vector<double> force_mn;
  const auto touched = std::ranges::find_if(
      samples, [](const ServoSample& sample) { return sample.force_n.y > 0.0; });
  for (auto at = touched; at != samples.end(); ++at) {
    const std::int64_t since = at->tick - touched->tick;
    if (since >= kWallMs) break;
    ms.push_back(static_cast<double>(since));
    height_um.push_back(std::round(1e3 * at->position_mm.y));
    force_mn.push_back(std::round(1e3 * at->force_n.y));
  }
  record.note("time_ms", ms);
  record.note("height_um", height_um);
  record.note("force_up_mn", force_mn);
}

void note_loop(const ServoReport& report, const Listening& run, BringUp& record) {
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
      take(BringUpStep::rest, [&] { return rest(); });
      take(BringUpStep::ways, [&] { return carry(); });
      take(BringUpStep::push, [&] { return push(); });
      take(BringUpStep::steps, [&] { return find_step(); });
      take(BringUpStep::range, [&] { return find_range(); });
      if (record_.signs_confirmed()) {
        bench_.limit_force(kConfirmedN);
        take(BringUpStep::weight, [&] { return weigh(); });
        take(BringUpStep::wall, [&] { return press(); });
        bench_.limit_force(kSecondPushN);
      } else {
        person_.show("weight and wall are left out: not all signs are confirmed");
        record_.outcome(BringUpStep::weight) = StepOutcome::left_out;
        record_.outcome(BringUpStep::wall) = StepOutcome::left_out;
      }
      take(BringUpStep::program, [&] {
        return watch(BringUpStep::program, runs_.suspend_program(name_of(BringUpStep::program)));
      });
      take(BringUpStep::cable, [&] { return pull_cable(); });
      take(BringUpStep::questions, [&] { return ask_questions(); });
      record_.ended = BringUpEnd::complete;
    } catch (const WrongSign& sign) {
      end(BringUpEnd::wrong_sign, sign.why);
    } catch (const DeviceFailed& failed) {
      end(BringUpEnd::fault, "the device failed: " + failed.fault);
    }
    save_();
  }

 private:
  void end(BringUpEnd how, const std::string& why) {
    record_.ended = how;
    record_.why = why;
    person_.show("ended: " + why);
  }

  template <typename Work>
  void take(BringUpStep step, const Work& work) {
    StepOutcome& outcome = record_.outcome(step);
    // Unchanged if the work throws.
    outcome = StepOutcome::interrupted;
    outcome = work();
    save_();
  }

  StepOutcome fail(const std::string& why) {
    person_.show("not measured: " + why);
    return why == kLeftOut ? StepOutcome::left_out : StepOutcome::failed;
  }

  /// \return the number of an answer; nothing: the person does not know
  template <typename Words>
  [[nodiscard]] std::optional<std::size_t> choose(const std::string& question, const Words& words) {
    std::string text = "\n" + question;
    for (std::size_t i = 0; i < std::size(words); ++i) {
      text += fmt::format(" {} {}{}", i + 1, words[i], i + 1 < std::size(words) ? "," : "");
    }
    const auto number =
        number_between<std::size_t>(text + " (Enter: not known; q: end): ", 1, std::size(words));
    if (!number) return std::nullopt;
    return *number - 1;
  }

  /// \return nothing: the person has none
  template <typename Number>
  [[nodiscard]] std::optional<Number> number_between(const std::string& question, Number low,
                                                     Number high) {
    while (true) {
      const std::string answer = person_.ask_observation(question);
      if (answer.empty()) return std::nullopt;
      const auto number = number_in<Number>(answer);
      if (number && *number >= low && *number <= high) return number;
      person_.show(fmt::format("type a number from {} to {}", low, high));
    }
  }

  StepOutcome rest() {
    if (!runs_.consents(
            {"rest",
             Grip::lying,
             {},
             "Hold the handle in the middle, and let go of it slowly within 3 s of the start. "
             "Keep your hands close: it may sink or rise. The program sends no force for 10 s."})) {
      return StepOutcome::left_out;
    }
    Listening run(kBringUpRestS);
    const ServoReport report = bench_.run("rest", run);
    const std::span<const ServoSample> samples = run.samples();
    // The rate of readings before a fault helps to explain it.
    note_loop(report, run, record_);
    HandleRuns::require_no_fault(report, "rest");
    const auto figures = samples.size() > kSettledTicks
                             ? rest_figures(samples.subspan(kSettledTicks))
                             : std::nullopt;
    if (!figures) return StepOutcome::failed;
    record_.note("noise_mm", {figures->noise_mm});
    record_.note("drift_mm", {figures->drift_mm});
    person_.show(
        fmt::format("noise {:.4f} mm, drift {:.3f} mm; {:.0f} new readings in a second, "
                    "99 % of ticks within {:.0f} us",
                    figures->noise_mm, figures->drift_mm, record_.number("new_readings_hz"),
                    report.lateness.p99_us));
    return StepOutcome::done;
  }

  StepOutcome carry() {
    bool all = true;
    for (const DeviceAxis axis : kDeviceAxes) all = measure_carry(axis) && all;
    return all ? StepOutcome::done : StepOutcome::left_out;
  }

  bool measure_carry(DeviceAxis axis) {
    const std::string name(name_of(axis));
    while (true) {
      if (!runs_.consents(
              {"ways", Grip::carrying, axis,
               fmt::format("Hold the handle still in the middle. A second after the start carry "
                           "it straight {} by 3 to 5 cm, along a ruler if you have one, and "
                           "hold it there until 7 s are over. No force acts.",
                           towards(axis))})) {
        return false;
      }
      Listening run(kDirectionRunS);
      runs_.measure("way " + name, run);
      const auto samples = run.samples();
      const std::size_t ends = std::min(kEndTicks, samples.size() / 3);
      const Vec3 moved = mean_place_mm(samples.last(ends)) - mean_place_mm(samples.first(ends));
      person_.show(
          fmt::format("the readings moved by {:+.1f}, {:+.1f}, {:+.1f} mm (x right, y up, z "
                      "towards you)",
                      moved.x, moved.y, moved.z));
      if (norm(moved) < kMinPathMm) {
        person_.show("that is too little; carry it further");
        continue;
      }
      record_.note("carried_mm " + name, {moved.x, moved.y, moved.z});
      if (!followed_axis(record_, axis)) {
        throw WrongSign{fmt::format(
            "the handle was carried {}, and the readings say otherwise; no force was sent",
            towards(axis))};
      }
      const auto ruler_mm = number_between<double>(
          "\nBy how many mm did it move along the ruler? (Enter: no ruler; q: end): ", 1.0, 500.0);
      if (ruler_mm) record_.note("ruler_mm " + name, {*ruler_mm});
      return true;
    }
  }

  StepOutcome push() {
    bool all = true;
    for (const DeviceAxis axis : kDeviceAxes) {
      for (const int sign : {1, -1}) all = feel_push(axis, sign) && all;
    }
    return all ? StepOutcome::done : StepOutcome::left_out;
  }

  /// \return whether the person felt the push; else its sign is not confirmed
  bool feel_push(DeviceAxis axis, int sign) {
    const std::string name = signed_name(sign, axis);
    for (const double force_n : {kFirstPushN, kSecondPushN}) {
      if (!runs_.consents(
              {"push", Grip::holding, axis,
               fmt::format("Hold the handle lightly in the middle, so that it can give way. "
                           "Something pushes it with {:.1f} N for 2.5 s.",
                           force_n)})) {
        return false;
      }
      SteadyPush run(kPushRunS, (sign * force_n) * direction_of(axis), kBringUpReachMm);
      runs_.measure("push " + std::string(name_of(axis)), run);
      const auto side = choose("Towards which side did it push?", kSides);
      if (!side) return false;
      const Vec3 moved = moved_by(run);
      record_.note("push_n " + name, {force_n});
      record_.note("felt " + name, kSides.at(*side));
      record_.note("moved_mm " + name, {moved.x, moved.y, moved.z});
      switch (sign_of_push(record_, axis, sign)) {
        case PushSign::right:
          return true;
        case PushSign::wrong:
          throw WrongSign{
              fmt::format("a force along {} was felt or read as another one: a sign is "
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
    if (!step.value) return fail(step.why);
    step_mm_ = step.value->value;
    record_.note("encoder_step_mm", {step_mm_});
    person_.show(fmt::format("encoder step: {:.4f} mm", step_mm_));
    return StepOutcome::done;
  }

  StepOutcome find_range() {
    if (!runs_.consents(
            {"range",
             Grip::moving,
             {},
             "Move the handle slowly to its ends: left, right, down, up, away and towards you; "
             "no force acts for 20 s."})) {
      return StepOutcome::left_out;
    }
    Listening run(kRangeRunS);
    runs_.measure("range", run);
    if (run.samples().empty()) return StepOutcome::failed;
    const Workspace reach = reach_of(run.samples());
    const Vec3 size = reach.max_mm - reach.min_mm;
    if (std::min({size.x, size.y, size.z}) < kMinPathMm) {
      return fail("the handle was moved by less than 1 cm along an axis");
    }
    note_extent(record_, "reach_mm ", reach);
    return StepOutcome::done;
  }

  StepOutcome weigh() {
    const ValueOrReason<StrokeFigures> empty =
        runs_.empty_strokes("weight", DeviceAxis::y, {}, step_mm_);
    if (!empty.value) return fail(empty.why);
    const double load_n = empty.value->load_n.value;
    const double friction_n = empty.value->friction_n.value;
    record_.note("load_n", {load_n});
    record_.note("friction_n", {friction_n});
    const ValueOrReason<WeighResult> weighed =
        runs_.weigh("weight", DeviceAxis::y, {{0.0, load_n, 0.0}, load_n, friction_n}, step_mm_);
    if (!weighed.value) return fail(weighed.why);
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
            ? std::min(kSoftWall, kShareOfStiffest * info.max_stiffness_n_per_mm)
            : kSoftWall;
    if (!runs_.consents(
            {"wall", Grip::pressing, DeviceAxis::y,
             fmt::format("Hold the handle lightly in the middle. 3 mm below it is a soft floor of "
                         "{:.2f} N/mm: press on it for 6 s, and do not lift the handle. It is "
                         "switched off if it begins to swing.",
                         stiffness_n_per_mm)})) {
      return StepOutcome::left_out;
    }
    WallTrial run(stiffness_n_per_mm, kMinSwingMm, acceptance_forces(info, bench_.limits()).hold_n);
    const ServoReport report = runs_.measure("wall", run);
    if (!run.oscillated() && run.contact_s() < kMinContactS) {
      return fail("the floor was not pressed");
    }
    record_.note("stiffness_n_per_mm", {stiffness_n_per_mm});
    record_.note("wall", run.oscillated() ? "swung" : "steady");
    record_.note("contact_s", {run.contact_s()});
    if (report.delivered_share > 0.0) record_.note("delivered_share", {report.delivered_share});
    note_wall(run.samples(), record_);
    return StepOutcome::done;
  }

  StepOutcome pull_cable() {
    if (!device_failed_) return watch(BringUpStep::cable, runs_.pull_cable("cable"));
    person_.show("the device has failed and must be reopened: run this again for the cable");
    return StepOutcome::left_out;
  }

  /// These runs provoke a fault, so it does not end the bring-up.
  StepOutcome watch(BringUpStep step, const ValueOrReason<ServoReport>& run) {
    if (!run.value) return fail(run.why);
    device_failed_ = run.value->device_fault != DeviceFault::none;
    const auto force = choose("What did the force do meanwhile?", kSilences);
    if (!force) return StepOutcome::failed;
    const std::string without = "without_" + std::string(name_of(step));
    const DeviceFault fault = run.value->device_fault;
    record_.note("force_" + without, kSilences.at(*force));
    record_.note("fault_" + without,
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
  double step_mm_ = 0.0;        ///< 0: not known
  bool device_failed_ = false;  ///< its fault lasts until it is reopened
};

}  // namespace

void bring_up(AcceptanceBench& bench, AcceptancePerson& person,
              const std::vector<UnverifiedFact>& facts, BringUp& record,
              const std::function<void()>& save) {
  Steps(bench, person, facts, record, save).run();
}

}  // namespace touchtrial::device
