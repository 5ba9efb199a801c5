#include "device/bring_up/bring_up.hpp"

#include "core/hash.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::device {
namespace {

constexpr double kRestRunS = 10.0;
constexpr std::size_t kSettledTicks = 4000;  ///< of the rest: the hand has let go
constexpr double kWayRunS = 7.0;
constexpr std::size_t kEndTicks = 500;  ///< of a way, at its beginning and at its end
constexpr double kLeastWayMm = 10.0;
constexpr double kPushRunS = 2.5;
constexpr double kPushReachMm = 30.0;
constexpr double kAgainstMm = 2.0;
constexpr double kStepsRunS = 12.0;
constexpr double kRangeRunS = 20.0;
constexpr double kSilentRunS = 8.0;
constexpr double kSoftWall = 0.2;  ///< N/mm
constexpr double kShareOfStiffest = 0.5;
constexpr double kLeastSwingMm = 0.15;
constexpr double kLeastContactS = 1.0;
constexpr double kLeastWeightN = 0.3;
constexpr double kStrokeShareN = 0.2;    ///< that strokes need beside load and friction
constexpr std::size_t kLeastSerial = 4;  ///< digits of a serial number that texts must not have
constexpr int kBeforeContactMs = 200;    ///< of a wall's record

constexpr std::array<std::string_view, 7> kSides = {"right",       "left", "up",     "down",
                                                    "towards you", "away", "nothing"};

constexpr std::array<std::string_view, 4> kSilenceAnswers = {"gone at once", "gone within a second",
                                                             "stayed longer", "became stronger"};

/// Ends a bring-up that must not go on.
struct EndOfBringUp {
  BringUpEnd end;
  std::string why;
};

Vec3 mean_place_mm(std::span<const ServoSample> samples) {
  Vec3 sum;
  for (const ServoSample& sample : samples) sum = sum + sample.position_mm;
  return samples.empty() ? sum : (1.0 / static_cast<double>(samples.size())) * sum;
}

double across_mm(Vec3 moved_mm, DeviceAxis axis) {
  return norm(moved_mm - dot(moved_mm, direction_of(axis)) * direction_of(axis));
}

std::string_view towards(DeviceAxis axis) {
  if (axis == DeviceAxis::x) return "to the right";
  return axis == DeviceAxis::y ? "up" : "towards you";
}

Workspace reach_of(std::span<const ServoSample> samples) {
  Workspace reach{samples.front().position_mm, samples.front().position_mm};
  for (const ServoSample& sample : samples) {
    const Vec3 at = sample.position_mm;
    reach.least_mm = {std::min(reach.least_mm.x, at.x), std::min(reach.least_mm.y, at.y),
                      std::min(reach.least_mm.z, at.z)};
    reach.greatest_mm = {std::max(reach.greatest_mm.x, at.x), std::max(reach.greatest_mm.y, at.y),
                         std::max(reach.greatest_mm.z, at.z)};
  }
  return reach;
}

/// From shortly before the first contact on.
void record_wall(std::span<const ServoSample> samples, PressedWall& wall) {
  const auto touched = std::ranges::find_if(
      samples, [](const ServoSample& sample) { return sample.force_n.y > 0.0; });
  if (touched == samples.end()) return;
  const std::int64_t begin = touched->tick - kBeforeContactMs;
  for (const ServoSample& sample : samples) {
    const std::int64_t ms = sample.tick - begin;
    if (ms < 0 || ms >= static_cast<std::int64_t>(PressedWall::kMostTicks)) continue;
    wall.ms.push_back(static_cast<int>(ms));
    wall.height_um.push_back(static_cast<int>(std::lround(1e3 * sample.position_mm.y)));
    wall.force_mn.push_back(static_cast<int>(std::lround(1e3 * sample.force_n.y)));
  }
}

LoopFigures loop_figures(const ServoReport& report, const Listening& run) {
  const auto ticks = static_cast<double>(report.ticks + report.overruns);
  const double seconds = ticks / (report.rate_hz > 0.0 ? report.rate_hz : kServoRateHz);
  LoopFigures loop;
  loop.rate_hz = report.rate_hz;
  if (seconds > 0.0) loop.readings_hz = static_cast<double>(run.new_readings()) / seconds;
  loop.longest_gap_ms = run.longest_gap_ticks() * 1e3 * kServoTickS;
  loop.p50_us = report.lateness.p50_us;
  loop.p99_us = report.lateness.p99_us;
  loop.worst_us = report.lateness.worst_us;
  loop.overruns = report.overruns;
  return loop;
}

class Steps {
 public:
  Steps(AcceptanceBench& bench, AcceptancePerson& person, const std::vector<UnverifiedFact>& facts,
        BringUp& record, const std::function<void()>& save)
      : bench_(bench), person_(person), facts_(facts), record_(record), save_(save) {}

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
        person_.tell("weight and wall are left out: not all signs are confirmed");
        record_.outcome(BringUpStep::weight) = StepOutcome::left_out;
        record_.outcome(BringUpStep::wall) = StepOutcome::left_out;
      }
      take(BringUpStep::program, [&] { return stop_program(); });
      take(BringUpStep::cable, [&] { return pull_cable(); });
      take(BringUpStep::questions, [&] { return ask_questions(); });
      record_.ended = BringUpEnd::complete;
    } catch (const EndOfBringUp& end) {
      record_.ended = end.end;
      record_.why = end.why;
      person_.tell("ended: " + end.why);
    }
    save_();
  }

 private:
  template <typename Work>
  void take(BringUpStep step, const Work& work) {
    StepOutcome& outcome = record_.outcome(step);
    // Stays if the work throws.
    outcome = StepOutcome::interrupted;
    outcome = work();
    save_();
  }

  [[nodiscard]] bool consents(BringUpStep step, Stance stance, DeviceAxis axis,
                              const std::string& text) {
    return person_.ready({name_of(step), stance, axis, text}) == Consent::go;
  }

  ServoReport measure(const std::string& name, Measurement& measurement) {
    const ServoReport report = bench_.run(name, measurement);
    require_no_fault(report);
    return report;
  }

  static void require_no_fault(const ServoReport& report) {
    if (report.end != ServoEnd::fault) return;
    std::string why = "the device failed: " + std::string(name_of(report.fault));
    if (report.device_fault != DeviceFault::none) {
      why += " (" + std::string(name_of(report.device_fault)) + ")";
    }
    throw EndOfBringUp{BringUpEnd::fault, why};
  }

  /// \return the number of an answer; nothing: the person does not know
  template <typename Words>
  [[nodiscard]] std::optional<std::size_t> choose(const std::string& question, const Words& words) {
    std::string text = "\n" + question;
    for (std::size_t i = 0; i < std::size(words); ++i) {
      text += fmt::format(" {} {}{}", i + 1, words[i], i + 1 < std::size(words) ? "," : "");
    }
    while (true) {
      const std::string answer = person_.saw(text + " (Enter: not known; q: end): ");
      if (answer.empty()) return std::nullopt;
      const auto number = number_in<std::size_t>(answer);
      if (number && *number >= 1 && *number <= std::size(words)) return *number - 1;
      person_.tell(fmt::format("type a number from 1 to {}", std::size(words)));
    }
  }

  StepOutcome rest() {
    if (!consents(BringUpStep::rest, Stance::lying, {},
                  "Hold the handle in the middle, and let go of it slowly within 3 s of the start. "
                  "Keep your hands close: it may sink or rise. The program sends no force for 10 "
                  "s.")) {
      return StepOutcome::left_out;
    }
    Listening run(kRestRunS);
    const ServoReport report = bench_.run("rest", run);
    const std::span<const ServoSample> samples = run.samples();
    // A fault is of interest with the rate of readings before it.
    record_.loop = loop_figures(report, run);
    require_no_fault(report);
    if (samples.size() > kSettledTicks) record_.rest = rest_figures(samples.subspan(kSettledTicks));
    if (!record_.rest) return StepOutcome::failed;
    person_.tell(
        fmt::format("noise {:.4f} mm, drift {:.3f} mm; {:.0f} new readings in a second, "
                    "99 % of ticks within {:.0f} us",
                    record_.rest->noise_mm, record_.rest->drift_mm, record_.loop->readings_hz,
                    record_.loop->p99_us));
    return StepOutcome::done;
  }

  StepOutcome carry() {
    bool all = true;
    for (const DeviceAxis axis : kDeviceAxes) all = carry_along(axis) && all;
    return all ? StepOutcome::done : StepOutcome::left_out;
  }

  bool carry_along(DeviceAxis axis) {
    while (true) {
      if (!consents(
              BringUpStep::ways, Stance::carrying, axis,
              fmt::format("Hold the handle still in the middle. A second after the start carry "
                          "it straight {} by 3 to 5 cm, along a ruler if you have one, and "
                          "hold it there until 7 s are over. No force acts.",
                          towards(axis)))) {
        return false;
      }
      Listening run(kWayRunS);
      measure("way " + std::string(name_of(axis)), run);
      const auto samples = run.samples();
      const std::size_t ends = std::min(kEndTicks, samples.size() / 3);
      const CarriedWay way{axis,
                           mean_place_mm(samples.last(ends)) - mean_place_mm(samples.first(ends))};
      const Vec3 moved = way.moved_mm;
      person_.tell(
          fmt::format("the readings moved by {:+.1f}, {:+.1f}, {:+.1f} mm (x right, y up, z "
                      "towards you)",
                      moved.x, moved.y, moved.z));
      if (norm(moved) < kLeastWayMm) {
        person_.tell("that is too little to tell; carry it further");
        continue;
      }
      record_.ways.push_back(way);
      if (!way.is_right()) {
        throw EndOfBringUp{
            BringUpEnd::wrong_sign,
            fmt::format("the handle was carried {}, and the readings say otherwise; no "
                        "force was sent",
                        towards(axis))};
      }
      record_.ways.back().ruler_mm = ruler_mm();
      return true;
    }
  }

  std::optional<double> ruler_mm() {
    while (true) {
      const std::string answer =
          person_.saw("\nBy how many mm did it move along the ruler? (Enter: no ruler; q: end): ");
      if (answer.empty()) return std::nullopt;
      const auto mm = number_in<double>(answer);
      if (mm && *mm >= 1.0 && *mm <= 500.0) return mm;
      person_.tell("type a number from 1 to 500");
    }
  }

  StepOutcome push() {
    bool all = true;
    for (const DeviceAxis axis : kDeviceAxes) {
      for (const int sign : {1, -1}) all = feel_push(axis, sign) && all;
    }
    return all ? StepOutcome::done : StepOutcome::left_out;
  }

  /// \return whether the person felt it; else its sign is not confirmed
  bool feel_push(DeviceAxis axis, int sign) {
    for (const double force_n : {kFirstPushN, kSecondPushN}) {
      if (!consents(BringUpStep::push, Stance::holding, axis,
                    fmt::format("Hold the handle lightly in the middle, so that it can give way. "
                                "Something pushes it with {:.1f} N for 2.5 s.",
                                force_n))) {
        return false;
      }
      SteadyPush run(kPushRunS, (sign * force_n) * direction_of(axis), kPushReachMm);
      measure("push " + std::string(name_of(axis)), run);
      FeltPush felt{axis, sign * force_n, FeltSide::nothing, moved_by(run)};
      const auto side = choose("Towards which side did it push?", kSides);
      if (!side) return false;
      felt.felt = static_cast<FeltSide>(*side);
      record_.pushes.push_back(felt);
      if (felt.is_wrong()) {
        throw EndOfBringUp{
            BringUpEnd::wrong_sign,
            fmt::format(
                "a force along {}{} was felt or read as another one: a sign is wrong, or axes "
                "are exchanged; no larger force was sent",
                sign > 0 ? "+" : "-", name_of(axis))};
      }
      if (felt.felt != FeltSide::nothing) return true;
    }
    return false;
  }

  static Vec3 moved_by(const Measurement& run) {
    const auto pushed = [](const ServoSample& sample) { return norm(sample.force_n) > 0.0; };
    const auto samples = run.samples();
    const auto first = std::ranges::find_if(samples, pushed);
    if (first == samples.end()) return {};
    auto last = first;
    for (auto at = first; at != samples.end(); ++at) {
      if (pushed(*at)) last = at;
    }
    return last->position_mm - first->position_mm;
  }

  StepOutcome find_step() {
    if (!consents(BringUpStep::steps, Stance::moving, {},
                  "Move the handle slowly (1 cm in a second) to and fro along all three axes; no "
                  "force acts for 12 s.")) {
      return StepOutcome::left_out;
    }
    Listening run(kStepsRunS);
    measure("steps", run);
    const MeasuredOrWhy step = encoder_step_mm(run.samples());
    record_.step_mm = step.measured;
    person_.tell(step.measured ? fmt::format("encoder step: {:.4f} mm", step.measured->value)
                               : "encoder step: not measured: " + step.why);
    return step.measured ? StepOutcome::done : StepOutcome::failed;
  }

  StepOutcome find_range() {
    if (!consents(
            BringUpStep::range, Stance::moving, {},
            "Move the handle slowly to its ends: left, right, down, up, away and towards you; "
            "no force acts for 20 s.")) {
      return StepOutcome::left_out;
    }
    Listening run(kRangeRunS);
    measure("range", run);
    if (run.samples().empty()) return StepOutcome::failed;
    const Workspace reach = reach_of(run.samples());
    const Vec3 size = reach.greatest_mm - reach.least_mm;
    if (std::min({size.x, size.y, size.z}) < kLeastWayMm) {
      return fail("the handle was moved by less than 1 cm along an axis");
    }
    record_.reached = reach;
    return StepOutcome::done;
  }

  StepOutcome weigh() {
    if (!consents(
            BringUpStep::weight, Stance::free, DeviceAxis::y,
            "Hold the handle in the middle, without a weight. Let go slowly within 2 s of the "
            "start: it is held and moved by 5 mm up and down for 12 s.")) {
      return StepOutcome::left_out;
    }
    const AcceptanceForces forces = acceptance_forces(bench_.info(), bench_.limits());
    const double step_mm = record_.step_mm ? record_.step_mm->value : 0.0;
    SlowStrokes empty(DeviceAxis::y, {}, forces.gains, forces.hold_n);
    measure("empty", empty);
    const StrokesOrWhy without = stroke_figures(empty, step_mm);
    if (!without.figures) return fail("the empty handle: " + without.why);
    const double load_n = without.figures->load_n.value;
    record_.weight = HungWeight{load_n, without.figures->friction_n};
    const double most_n = std::min(forces.weight_n, forces.hold_n) - std::abs(load_n) -
                          record_.weight->friction_n.value - kStrokeShareN;
    if (most_n < kLeastWeightN) return fail("load and friction leave no room for a weight");
    const auto weight_n = person_.weight_n(DeviceAxis::y, kLeastWeightN, most_n);
    if (!weight_n) return StepOutcome::left_out;
    if (!consents(BringUpStep::weight, Stance::loaded, DeviceAxis::y,
                  "The same with the weight on it.")) {
      return StepOutcome::left_out;
    }
    SlowStrokes loaded(DeviceAxis::y, {0.0, load_n, 0.0}, forces.gains, forces.hold_n);
    measure("loaded", loaded);
    const StrokesOrWhy with = stroke_figures(loaded, step_mm);
    if (!with.figures) return fail("the weight: " + with.why);
    const Measured& load = with.figures->load_n;
    record_.weight->weight = WeighResult{*weight_n, std::abs(load.value - load_n), load.error};
    const auto scale = record_.weight->scale();
    if (!scale) {
      record_.weight->weight.reset();
      return fail("the weight made no difference");
    }
    person_.tell(fmt::format("delivers {:.0f} +- {:.0f} % of the command", 100.0 * scale->value,
                             100.0 * scale->error));
    return StepOutcome::done;
  }

  StepOutcome fail(const std::string& why) {
    person_.tell("not measured: " + why);
    return StepOutcome::failed;
  }

  StepOutcome press() {
    const DeviceInfo info = bench_.info();
    PressedWall wall;
    wall.stiffness_n_per_mm =
        info.max_stiffness_n_per_mm > 0.0
            ? std::min(kSoftWall, kShareOfStiffest * info.max_stiffness_n_per_mm)
            : kSoftWall;
    if (!consents(
            BringUpStep::wall, Stance::pressing, DeviceAxis::y,
            fmt::format("Hold the handle lightly in the middle. 3 mm below it is a soft floor of "
                        "{:.2f} N/mm: press on it for 6 s, and do not lift the handle. It is "
                        "switched off if it begins to swing.",
                        wall.stiffness_n_per_mm))) {
      return StepOutcome::left_out;
    }
    WallTrial run(wall.stiffness_n_per_mm, kLeastSwingMm,
                  acceptance_forces(info, bench_.limits()).hold_n);
    const ServoReport report = measure("wall", run);
    wall.swung = run.oscillated();
    wall.contact_s = run.contact_s();
    wall.delivered_share = report.delivered_share;
    record_wall(run.samples(), wall);
    record_.wall = wall;
    if (!wall.swung && wall.contact_s < kLeastContactS) return fail("nobody pressed on the floor");
    return StepOutcome::done;
  }

  StepOutcome stop_program() {
    return watch(
        BringUpStep::program,
        "Hold the handle firmly: it is pushed down by 0.3 N for 8 s. After 3 s the system "
        "stops this program for 2 s.",
        [&](Measurement& run) { return bench_.run_suspended(run); }, record_.program_silent);
  }

  StepOutcome pull_cable() {
    return watch(
        BringUpStep::cable,
        "Hold the handle firmly: it is pushed down by 0.3 N for 8 s. Pull the device's data "
        "cable out within that time. Leave this step out if the cable must stay.",
        [&](Measurement& run) { return std::optional(bench_.run("cable", run)); },
        record_.cable_silent);
  }

  /// A fault is what these runs are for, so it does not end the bring-up.
  template <typename Run>
  StepOutcome watch(BringUpStep step, const std::string& text, const Run& run,
                    std::optional<SilenceSeen>& seen) {
    if (!consents(step, Stance::guarding, DeviceAxis::y, text)) return StepOutcome::left_out;
    if (device_failed_) {
      person_.tell("the device has failed and must be opened anew: run this again for the cable");
      return StepOutcome::left_out;
    }
    SteadyPush push(kSilentRunS);
    const std::optional<ServoReport> report = run(push);
    if (!report) return fail("not possible here");
    device_failed_ = report->device_fault != DeviceFault::none;
    if (step == BringUpStep::cable && report->end != ServoEnd::fault) {
      return fail("the device answered to the end: nobody pulled the cable");
    }
    const auto force = choose("What did the force do meanwhile?", kSilenceAnswers);
    if (!force) return StepOutcome::failed;
    seen = SilenceSeen{static_cast<SilentForce>(*force), std::string(name_of(report->end)),
                       std::string(name_of(report->fault)),
                       std::string(name_of(report->device_fault))};
    return StepOutcome::done;
  }

  StepOutcome ask_questions() {
    for (const UnverifiedFact& fact : facts_) {
      if (fact.evidence != Evidence::answer) continue;
      const auto answer = choose(fact.question, fact.answers);
      if (answer) record_.answers[fact.id] = fact.answers.at(*answer);
    }
    return StepOutcome::done;
  }

  AcceptanceBench& bench_;
  AcceptancePerson& person_;
  const std::vector<UnverifiedFact>& facts_;
  BringUp& record_;
  const std::function<void()>& save_;
  bool device_failed_ = false;  ///< its fault lasts until it is opened anew
};

}  // namespace

std::string_view name_of(BringUpStep step) noexcept {
  constexpr std::array<std::string_view, kBringUpSteps> kNames = {
      "rest", "ways", "push", "steps", "range", "weight", "wall", "program", "cable", "questions"};
  return kNames.at(static_cast<std::size_t>(step));
}

bool CarriedWay::is_right() const noexcept {
  return dot(moved_mm, direction_of(axis)) > across_mm(moved_mm, axis);
}

std::optional<Measured> HungWeight::scale() const {
  return AxisResult{.weight = weight}.scale();
}

FeltSide FeltPush::expected() const noexcept {
  const bool plus = force_n > 0.0;
  if (axis == DeviceAxis::x) return plus ? FeltSide::right : FeltSide::left;
  if (axis == DeviceAxis::y) return plus ? FeltSide::up : FeltSide::down;
  return plus ? FeltSide::towards : FeltSide::away;
}

bool FeltPush::is_wrong() const noexcept {
  if (felt == FeltSide::nothing) return false;
  const double along_mm = std::copysign(1.0, force_n) * dot(moved_mm, direction_of(axis));
  return felt != expected() || along_mm < -kAgainstMm;
}

bool BringUp::signs_confirmed() const {
  const auto is_felt = [&](DeviceAxis axis, double sign) {
    return std::ranges::any_of(pushes, [&](const FeltPush& push) {
      return push.axis == axis && sign * push.force_n > 0.0 && push.felt == push.expected();
    });
  };
  return std::ranges::none_of(pushes, &FeltPush::is_wrong) &&
         std::ranges::all_of(kDeviceAxes, [&](DeviceAxis axis) {
           const auto way = std::ranges::find(ways, axis, &CarriedWay::axis);
           return way != ways.end() && way->is_right() && is_felt(axis, 1.0) && is_felt(axis, -1.0);
         });
}

bool BringUp::settles(const UnverifiedFact& fact) const {
  switch (fact.evidence) {
    case Evidence::opened:
    case Evidence::readings:
      return loop.has_value() && loop->readings_hz > 0.0;
    case Evidence::signs:
      return signs_confirmed() || ended == BringUpEnd::wrong_sign;
    case Evidence::lengths:
      return std::ranges::any_of(ways,
                                 [](const CarriedWay& way) { return way.ruler_mm.has_value(); });
    case Evidence::range:
      return reached.has_value();
    case Evidence::weight:
      return weight && weight->weight;
    case Evidence::wall:
      return wall && (wall->swung || wall->contact_s >= kLeastContactS);
    case Evidence::delivered:
      return wall && wall->delivered_share > 0.0;
    case Evidence::limits:
      return stated.max_stiffness_n_per_mm > 0.0 && stated.max_damping_n_s_per_mm > 0.0;
    case Evidence::program_silent:
      return program_silent.has_value();
    case Evidence::cable_silent:
      return cable_silent.has_value();
    case Evidence::answer:
      return answers.contains(fact.id);
    case Evidence::none:
      break;
  }
  return false;
}

BringUp bring_up_of(const DeviceInfo& device) {
  const auto anonymous = [&](std::string text) {
    for (std::size_t at = 0;
         !device.serial.empty() && (at = text.find(device.serial, at)) != std::string::npos;) {
      text.replace(at, device.serial.size(), "#");
    }
    return text;
  };
  BringUp record;
  record.driver = device.name;
  record.model = anonymous(device.model);
  record.firmware = anonymous(device.firmware);
  record.library = anonymous(device.library);
  record.stated = device;
  record.stated.serial.clear();
  if (!device.serial.empty()) {
    FieldHasher hasher;
    hasher.add("touchtrial bring-up");
    hasher.add(device.name);
    hasher.add(device.serial);
    record.device_mark = to_hex(hasher.finish()).substr(0, 4);
  }
  return record;
}

void bring_up(AcceptanceBench& bench, AcceptancePerson& person,
              const std::vector<UnverifiedFact>& facts, BringUp& record,
              const std::function<void()>& save) {
  Steps(bench, person, facts, record, save).run();
}

}  // namespace touchtrial::device
