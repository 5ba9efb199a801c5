#include "device/acceptance/certificate.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "core/utc.hpp"
#include "device/acceptance/measurement.hpp"
#include "device/servo/scaled_device.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::device {
namespace {

using nlohmann::ordered_json;

constexpr std::string_view kCertificateKind = "touchtrial device acceptance 3";
constexpr auto kAxisWords = std::to_array<Named<DeviceAxis>>(
    {{"x", DeviceAxis::x}, {"y", DeviceAxis::y}, {"z", DeviceAxis::z}});
constexpr NumberRange kPositive{.low = 0.0, .high = 1e6};
constexpr NumberRange kSigned{.low = -1e6, .high = 1e6};
constexpr std::size_t kMaxEntries = 1000;
/// A number that prints like its limit (three digits, whole percents) does not exceed it.
constexpr double kAlikeShare = 0.004;
constexpr double kAlikePercent = 0.5;

std::string axis_words(const AxisResult& axis) {
  return "axis " + std::string(name_of(axis.axis));
}

void judge_push(const AxisResult& axis, const std::optional<PushResult>& push, const char* way,
                std::vector<std::string>& failures) {
  const std::string where = axis_words(axis) + ": ";
  if (!push) {
    failures.push_back(where + "the push " + way + " was not measured");
  } else if (!push->moved) {
    failures.push_back(
        fmt::format("{}the handle did not move at {:.1f} N {}", where, push->force_n, way));
  } else if (push->along_mm <= 0.0) {
    failures.push_back(
        fmt::format("{}the handle moved against a force of {:.1f} N {}: the sign is "
                    "wrong",
                    where, push->force_n, way));
  } else if (push->across_mm > push->along_mm) {
    failures.push_back(
        fmt::format("{}the handle moved across a force of {:.1f} N {}: axes are exchanged", where,
                    push->force_n, way));
  }
}

void judge_above(const std::string& where, const char* what, double value, double most,
                 const char* unit, std::vector<std::string>& failures) {
  if (value <= most * (1.0 + kAlikeShare)) return;
  failures.push_back(
      fmt::format("{}{} is {:.3g} {}, more than {:g} {}", where, what, value, unit, most, unit));
}

/// \return ": " and the reason, if one was noted for this axis
std::string why_no_delay(DeviceAxis axis, const std::vector<NotMeasured>& not_measured) {
  const std::string what = "delay on axis " + std::string(name_of(axis));
  const auto found = std::ranges::find_if(
      not_measured, [&](const NotMeasured& one) { return one.what.ends_with(what); });
  return found == not_measured.end() ? "" : ": " + found->why;
}

void judge_delay(const AxisResult& axis, const std::vector<NotMeasured>& not_measured,
                 std::vector<std::string>& failures) {
  const std::string where = axis_words(axis) + ": ";
  if (!axis.delay_ms) {
    if (axis.delay_left_out) return;
    failures.push_back(where + "the delay was not measured" +
                       why_no_delay(axis.axis, not_measured));
    return;
  }
  const Measured& delay = *axis.delay_ms;
  const auto refuse = [&](const char* why) {
    failures.push_back(fmt::format("{}the delay is {:.3g} +- {:.2g} ms, {} {:g} ms", where,
                                   delay.value, delay.error, why, kMaxDelayMs));
  };
  switch (verdict_on_delay(delay)) {
    case DelayVerdict::below:
      break;
    case DelayVerdict::above:
      refuse("more than");
      break;
    case DelayVerdict::not_shown:
      refuse("not shown to be at most");
      break;
    case DelayVerdict::unclear:
      refuse("too unclear to be shown to be at most");
      break;
  }
}

/// \param force_scale  in force on this axis
void judge_axis_result(const AxisResult& axis, double force_scale,
                       const std::vector<NotMeasured>& not_measured,
                       std::vector<std::string>& failures) {
  const std::string where = axis_words(axis) + ": ";
  judge_push(axis, axis.plus, "along it", failures);
  if (axis.plus && axis.plus->moved && axis.plus->along_mm > 0.0) {
    judge_push(axis, axis.minus, "against it", failures);
  }
  if (const auto scale = axis.scale()) {
    if (std::abs(scale->value - 1.0) > kForceTolerance + 0.01 * kAlikePercent) {
      failures.push_back(fmt::format(
          "{}delivers {:.0f} % of the commanded force, more than {:.0f} % off; if the "
          "weight was right, set force_scale on this axis to {:.2f} in the device "
          "settings",
          where, 100.0 * scale->value, 100.0 * kForceTolerance, force_scale * scale->value));
    }
  } else {
    failures.push_back(where + "the size of its force was not measured");
  }
  if (axis.friction_n) {
    judge_above(where, "friction", axis.friction_n->value, kMaxFrictionN, "N", failures);
  }
  judge_delay(axis, not_measured, failures);
}

/// \name Writing
///@{
ordered_json json_of(const Measured& measured) {
  return {{"value", measured.value}, {"error", measured.error}};
}

ordered_json json_of(Vec3 axes) {
  return {axes.x, axes.y, axes.z};
}

ordered_json json_of(const PushResult& push) {
  return {{"force_n", push.force_n},
          {"moved", push.moved},
          {"along_mm", push.along_mm},
          {"across_mm", push.across_mm}};
}

ordered_json json_of(const WeighResult& weight) {
  return {{"expected_n", weight.expected_n},
          {"measured_n", weight.measured_n},
          {"error_n", weight.error_n}};
}

ordered_json json_of(const RestFigures& rest) {
  return {{"noise_mm", rest.noise_mm}, {"drift_mm", rest.drift_mm}};
}

ordered_json json_of(const WallResult& wall) {
  return {{"stable_n_per_mm", wall.stable_n_per_mm},
          {"oscillates_n_per_mm", wall.oscillates_n_per_mm},
          {"ended", wall.ended}};
}

ordered_json json_of(const WarmResult& warm) {
  ordered_json object = {{"before_n", warm.before_n}, {"after_n", warm.after_n}};
  if (warm.before_c) object["before_c"] = *warm.before_c;
  if (warm.after_c) object["after_c"] = *warm.after_c;
  return object;
}

template <typename Value>
void put_if(ordered_json& object, const char* key, const std::optional<Value>& value) {
  if (!value) return;
  if constexpr (std::is_same_v<Value, double>) {
    object[key] = *value;
  } else {
    object[key] = json_of(*value);
  }
}

ordered_json json_of(const AxisResult& axis) {
  ordered_json object = {{"axis", name_of(axis.axis)}};
  put_if(object, "plus", axis.plus);
  put_if(object, "minus", axis.minus);
  put_if(object, "weight", axis.weight);
  put_if(object, "load_n", axis.load_n);
  put_if(object, "scale", axis.scale());
  put_if(object, "friction_n", axis.friction_n);
  put_if(object, "mass_kg", axis.mass_kg);
  put_if(object, "viscous_n_s_per_m", axis.viscous_n_s_per_m);
  put_if(object, "delay_ms", axis.delay_ms);
  if (axis.delay_left_out) object["delay_left_out"] = true;
  return object;
}

///@}

/// \name Reading
///@{
int digits_at(const std::string& text, std::size_t at, std::size_t digits) {
  return number_in<int>(std::string_view(text).substr(at, digits)).value_or(-1);
}

std::chrono::sys_seconds read_creation_time(const JsonValue& place) {
  const std::string& text = place.text();
  const std::string form = "0000-00-00T00:00:00Z";
  if (text.size() == form.size()) {
    const std::chrono::year_month_day date{
        std::chrono::year(digits_at(text, 0, 4)),
        std::chrono::month(static_cast<unsigned>(digits_at(text, 5, 2))),
        std::chrono::day(static_cast<unsigned>(digits_at(text, 8, 2)))};
    const auto time = std::chrono::sys_seconds(std::chrono::sys_days(date)) +
                      std::chrono::hours(digits_at(text, 11, 2)) +
                      std::chrono::minutes(digits_at(text, 14, 2)) +
                      std::chrono::seconds(digits_at(text, 17, 2));
    if (date.ok() && utc_text(time.time_since_epoch()) == text) return time;
  }
  place.refuse(in_quotes(text) + " is not a date of the form 2026-01-31T12:00:00Z");
}

Measured read_measured(const JsonValue& place) {
  const JsonObject object = place.object({"value", "error"});
  return {object.at("value").number(kSigned), object.at("error").number(kPositive)};
}

Measured read_measured_above_zero(const JsonValue& place) {
  const JsonObject object = place.object({"value", "error"});
  return {object.at("value").number({.low = 0.0, .high = 1e6, .open_low = true}),
          object.at("error").number(kPositive)};
}

Vec3 read_scale(const JsonValue& place) {
  constexpr NumberRange kScale{.low = kMinScale, .high = kMaxScale};
  const std::vector<JsonValue> axes = place.items(3, 3);
  return {axes[0].number(kScale), axes[1].number(kScale), axes[2].number(kScale)};
}

PushResult read_push(const JsonValue& place) {
  const JsonObject object = place.object({"force_n", "moved", "along_mm", "across_mm"});
  return {object.at("force_n").number(kPositive), object.at("moved").truth(),
          object.at("along_mm").number(kSigned), object.at("across_mm").number(kPositive)};
}

WeighResult read_weight(const JsonValue& place) {
  const JsonObject object = place.object({"expected_n", "measured_n", "error_n"});
  return {object.at("expected_n").number({.low = 0.0, .high = 1e6, .open_low = true}),
          object.at("measured_n").number(kPositive), object.at("error_n").number(kPositive)};
}

double read_signed(const JsonValue& place) {
  return place.number(kSigned);
}

template <typename Read>
auto read_if(const JsonObject& object, std::string_view key, Read read)
    -> std::optional<decltype(read(object.at(key)))> {
  const auto place = object.find(key);
  if (!place) return std::nullopt;
  return read(*place);
}

AxisResult read_axis_result(const JsonValue& place) {
  const JsonObject object =
      place.object({"axis", "plus", "minus", "weight", "load_n", "scale", "friction_n", "mass_kg",
                    "viscous_n_s_per_m", "delay_ms", "delay_left_out"});
  AxisResult axis;
  axis.axis = object.at("axis").choice(kAxisWords);
  axis.plus = read_if(object, "plus", read_push);
  axis.minus = read_if(object, "minus", read_push);
  axis.weight = read_if(object, "weight", read_weight);
  axis.load_n = read_if(object, "load_n", read_signed);
  axis.friction_n = read_if(object, "friction_n", read_measured);
  axis.mass_kg = read_if(object, "mass_kg", read_measured_above_zero);
  axis.viscous_n_s_per_m = read_if(object, "viscous_n_s_per_m", read_measured);
  axis.delay_ms = read_if(object, "delay_ms", read_measured);
  if (const auto left_out = object.find("delay_left_out")) axis.delay_left_out = left_out->truth();
  const auto stated = read_if(object, "scale", read_measured);
  const auto scale = axis.scale();
  const bool agrees = stated.has_value() == scale.has_value() &&
                      (!scale || (std::abs(stated->value - scale->value) < 1e-6 &&
                                  std::abs(stated->error - scale->error) < 1e-6));
  if (!agrees) {
    place.refuse_below("/scale", "does not follow from the weight; the file was changed by hand");
  }
  return axis;
}

RestFigures read_rest(const JsonValue& place) {
  const JsonObject object = place.object({"noise_mm", "drift_mm"});
  return {object.at("noise_mm").number(kPositive), object.at("drift_mm").number(kPositive)};
}

WallResult read_wall(const JsonValue& place) {
  const JsonObject object = place.object({"stable_n_per_mm", "oscillates_n_per_mm", "ended"});
  WallResult wall{object.at("stable_n_per_mm").number(kPositive),
                  object.at("oscillates_n_per_mm").number(kPositive), object.at("ended").text()};
  if (wall.oscillates_n_per_mm > 0.0 && wall.stable_n_per_mm >= wall.oscillates_n_per_mm) {
    object.at("stable_n_per_mm")
        .refuse("must be less than oscillates_n_per_mm; the file was changed by hand");
  }
  return wall;
}

WarmResult read_warm(const JsonValue& place) {
  const JsonObject object = place.object({"before_n", "after_n", "before_c", "after_c"});
  return {object.at("before_n").number(kSigned), object.at("after_n").number(kSigned),
          read_if(object, "before_c", read_signed), read_if(object, "after_c", read_signed)};
}

std::vector<AxisResult> read_axis_results(const JsonValue& place) {
  std::vector<AxisResult> axes;
  for (const JsonValue& item : place.items(0, kDeviceAxes.size())) {
    const AxisResult result = read_axis_result(item);
    if (std::ranges::find(axes, result.axis, &AxisResult::axis) != axes.end()) {
      item.refuse_below("/axis", "occurs twice; give each of x, y and z once");
    }
    axes.push_back(result);
  }
  return axes;
}

Certificate read_acceptance(const JsonValue& place) {
  // The last key is of the former kind, which is then refused by its kind.
  const JsonObject object = place.object(
      {"kind",     "driver",      "model",        "serial",   "firmware", "program", "made",
       "emulated", "force_scale", "length_scale", "fault",    "rest",     "step_mm", "axes",
       "wall",     "warm",        "not_measured", "failures", "passed",   "observed"});
  if (object.at("kind").text() != kCertificateKind) {
    object.at("kind").refuse("must be " + in_quotes(kCertificateKind) +
                             "; make a certificate with touchtrial device accept");
  }
  Certificate certificate;
  certificate.driver = object.at("driver").text();
  certificate.model = object.at("model").text();
  certificate.serial = object.at("serial").text();
  certificate.firmware = object.at("firmware").text();
  certificate.program = object.at("program").text();
  certificate.made = read_creation_time(object.at("made"));
  certificate.emulated = object.at("emulated").text();
  certificate.scale = {read_scale(object.at("force_scale")), read_scale(object.at("length_scale"))};
  certificate.fault = object.at("fault").text();
  certificate.rest = read_if(object, "rest", read_rest);
  certificate.step_mm = read_if(object, "step_mm", read_measured);
  certificate.axes = read_axis_results(object.at("axes"));
  certificate.wall = read_if(object, "wall", read_wall);
  certificate.warm = read_if(object, "warm", read_warm);
  for (const JsonValue& item : object.at("not_measured").items(0, kMaxEntries)) {
    const JsonObject one = item.object({"what", "why"});
    certificate.not_measured.push_back({one.at("what").text(), one.at("why").text()});
  }
  for (const JsonValue& item : object.at("failures").items(0, kMaxEntries)) {
    static_cast<void>(item.text());
  }
  if (object.at("passed").truth() != certificate.passed()) {
    object.at("passed").refuse("does not follow from the results; the file was changed by hand");
  }
  return certificate;
}
///@}

/// Long names are cut.
std::string identity_words(const std::string& driver, const std::string& model,
                           const std::string& serial) {
  return in_quotes(driver) + (model.empty() ? "" : ", model " + in_quotes(model)) +
         (serial.empty() ? "" : ", serial number " + in_quotes(serial));
}

}  // namespace

std::optional<Measured> AxisResult::scale() const {
  if (!weight || !(weight->measured_n > 0.0)) return std::nullopt;
  const double scale = weight->expected_n / weight->measured_n;
  // Two hundredths for the weight itself, the string and the pulley.
  return Measured{scale, scale * (weight->error_n / weight->measured_n + 0.02)};
}

DelayVerdict verdict_on_delay(const Measured& delay_ms) noexcept {
  if (delay_ms.value - delay_ms.error > kMaxDelayMs) return DelayVerdict::above;
  if (!(delay_ms.error <= kMaxDelayErrorMs)) return DelayVerdict::unclear;
  return delay_ms.value + delay_ms.error <= kMaxDelayMs ? DelayVerdict::below
                                                        : DelayVerdict::not_shown;
}

std::vector<std::string> Certificate::failures() const {
  std::vector<std::string> failures;
  if (!fault.empty()) failures.push_back("the device failed: " + fault);
  if (rest) {
    judge_above("at rest: ", "noise", rest->noise_mm, kMaxNoiseMm, "mm", failures);
    judge_above("at rest: ", "drift", rest->drift_mm, kMaxDriftMm, "mm", failures);
  } else {
    failures.emplace_back("noise at rest was not measured");
  }
  if (step_mm) {
    judge_above("", "the encoder step", step_mm->value, kMaxStepMm, "mm", failures);
  }
  for (const DeviceAxis axis : kDeviceAxes) {
    const auto found = std::ranges::find(axes, axis, &AxisResult::axis);
    if (found == axes.end()) {
      failures.push_back("axis " + std::string(name_of(axis)) + ": was not measured");
    } else {
      const double force_scale = dot(scale.force, direction_of(axis));
      judge_axis_result(*found, force_scale, not_measured, failures);
    }
  }
  if (wall && wall->oscillates_n_per_mm > 0.0 && wall->stable_n_per_mm <= 0.0) {
    failures.push_back(fmt::format("the softest wall that was tried, {:.2g} N/mm, swings",
                                   wall->oscillates_n_per_mm));
  }
  if (warm && std::abs(warm->before_n) > 0.0) {
    judge_above("", "the change of the load's force over twenty minutes",
                std::abs(warm->after_n / warm->before_n - 1.0), kMaxWarmDrift, "of it", failures);
  }
  return failures;
}

double Certificate::largest_scale() const {
  double largest = 0.0;
  for (const AxisResult& axis : axes) {
    if (const auto delivered = axis.scale()) largest = std::max(largest, delivered->value);
  }
  return largest > 0.0 ? largest : 1.0;
}

std::optional<Measured> Certificate::mean_of(std::optional<Measured> AxisResult::*part) const {
  Measured sum;
  int n = 0;
  for (const AxisResult& axis : axes) {
    const std::optional<Measured>& one = axis.*part;
    if (!one) continue;
    sum.value += one->value;
    sum.error += one->error;
    ++n;
  }
  if (n == 0) return std::nullopt;
  return Measured{sum.value / n, sum.error / n};
}

std::string certificate_json(const Certificate& certificate) {
  ordered_json axes = ordered_json::array();
  for (const AxisResult& axis : certificate.axes) axes.push_back(json_of(axis));
  ordered_json not_measured = ordered_json::array();
  for (const NotMeasured& one : certificate.not_measured) {
    not_measured.push_back({{"what", one.what}, {"why", one.why}});
  }
  ordered_json object = {{"kind", kCertificateKind},
                         {"driver", certificate.driver},
                         {"model", certificate.model},
                         {"serial", certificate.serial},
                         {"firmware", certificate.firmware},
                         {"program", certificate.program},
                         {"made", utc_text(certificate.made.time_since_epoch())},
                         {"emulated", certificate.emulated},
                         {"force_scale", json_of(certificate.scale.force)},
                         {"length_scale", json_of(certificate.scale.length)},
                         {"fault", certificate.fault}};
  put_if(object, "rest", certificate.rest);
  put_if(object, "step_mm", certificate.step_mm);
  object["axes"] = axes;
  put_if(object, "wall", certificate.wall);
  put_if(object, "warm", certificate.warm);
  object["not_measured"] = not_measured;
  object["failures"] = certificate.failures();
  object["passed"] = certificate.passed();
  return json_text(object);
}

ReadCertificate read_certificate(const std::filesystem::path& path) {
  constexpr std::uintmax_t kLargest = 1U << 20U;
  const Bytes content = read_file(path, kLargest);
  return {read_acceptance(parse_strict_json(text_of(content), path.string())), sha256(content)};
}

std::string check_certificate(const Certificate& certificate, const DeviceInfo& device,
                              std::chrono::sys_seconds now) {
  const std::string remedy = "; run touchtrial device accept " + device.name;
  if (!certificate.emulated.empty()) {
    throw DeviceError(one_line(device.name + ": its certificate is of a rehearsal on an emulated " +
                               in_quotes(certificate.emulated) + ", which proves no device" +
                               remedy));
  }
  if (certificate.driver != device.name || certificate.serial != device.serial ||
      certificate.model != device.model) {
    throw DeviceError(one_line(
        "the certificate is for " +
        identity_words(certificate.driver, certificate.model, certificate.serial) +
        "; the device is " + identity_words(device.name, device.model, device.serial) + remedy));
  }
  if (certificate.scale != device.scale) {
    throw DeviceError(device.name + ": its certificate was made with " +
                      scale_text(certificate.scale) + ", and the device settings have " +
                      scale_text(device.scale) + remedy);
  }
  if (const auto failures = certificate.failures(); !failures.empty()) {
    throw DeviceError(one_line(device.name + ": its certificate states that it failed (" +
                               failures.front() + ")" + remedy));
  }
  if (certificate.made > now + kCertificateLead) {
    throw DeviceError(device.name + ": its certificate was made at " +
                      utc_text(certificate.made.time_since_epoch()) +
                      ", which is still to come; set the clock of this machine" + remedy);
  }
  if (now - certificate.made > kCertificateAge) {
    const auto days = std::chrono::duration_cast<std::chrono::days>(now - certificate.made).count();
    return device.name + ": its certificate is " + std::to_string(days) + " days old" + remedy;
  }
  if (certificate.firmware != device.firmware) {
    return one_line(device.name + ": its certificate is for firmware " +
                    in_quotes(certificate.firmware) + ", the device has " +
                    in_quotes(device.firmware) + remedy);
  }
  return "";
}

void require_stable(const Certificate& certificate, double stiffness_n_per_mm) {
  if (!certificate.wall || certificate.wall->oscillates_n_per_mm <= 0.0) return;
  if (stiffness_n_per_mm < certificate.wall->oscillates_n_per_mm) return;
  if (certificate.wall->stable_n_per_mm <= 0.0) {
    throw DeviceError(fmt::format(
        "{}: even the softest wall of its acceptance, {:.2g} N/mm, oscillated, and no wall was "
        "stable; find out why (delay, gains, a loose joint), and run touchtrial device accept {} "
        "again",
        certificate.driver, certificate.wall->oscillates_n_per_mm, certificate.driver));
  }
  throw DeviceError(fmt::format(
      "{}: a wall of {:.2g} N/mm oscillated in its acceptance, and the study's wall has {:.2g} "
      "N/mm; give the study's rendering a stiffness of at most {:.2g} N/mm",
      certificate.driver, certificate.wall->oscillates_n_per_mm, stiffness_n_per_mm,
      certificate.wall->stable_n_per_mm));
}

DeviceModel model_of(const Certificate& certificate, const DeviceInfo& device) {
  DeviceModel model;
  model.name = certificate.driver + (certificate.serial.empty() ? "" : "-" + certificate.serial);
  model.title = certificate.model;
  const std::string source =
      (certificate.emulated.empty() ? std::string("device accept")
                                    : "a rehearsal on the model " + certificate.emulated) +
      ", " + utc_text(certificate.made.time_since_epoch());
  const auto take = [&](const char* key, double value, double most, double& into) {
    into = std::clamp(value, 0.0, most);
    if (into == 0.0) return;
    model.provenance[key] = {
        source, certificate.emulated.empty() ? Confidence::measured : Confidence::derived};
  };
  if (const auto mass = certificate.mean_of(&AxisResult::mass_kg)) {
    take("mass_kg", mass->value, 5.0, model.mass_kg);
  }
  if (const auto viscous = certificate.mean_of(&AxisResult::viscous_n_s_per_m)) {
    take("viscous_n_s_per_m", viscous->value, 100.0, model.viscous_n_s_per_m);
  }
  if (const auto friction = certificate.mean_of(&AxisResult::friction_n)) {
    take("coulomb_n", friction->value, 10.0, model.coulomb_n);
  }
  if (certificate.step_mm) {
    take("position_step_mm", certificate.step_mm->value, 1.0, model.position_step_mm);
  }
  if (const auto delay = certificate.mean_of(&AxisResult::delay_ms)) {
    double ticks = 0.0;
    take("delay_ticks", std::round(delay->value), 100.0, ticks);
    model.delay_ticks = static_cast<int>(ticks);
  }
  // It is not measured, but without it a model's walls would be more stable than any device's.
  model.zero_order_hold = true;
  model.provenance["zero_order_hold"] = {"every device holds a force until the next tick",
                                         Confidence::guess};
  model.max_force_n = std::clamp(device.max_force_n, 0.0, 100.0);
  model.continuous_force_n = std::clamp(device.continuous_force_n, 0.0, 100.0);
  model.workspace = device.workspace;
  model.max_stiffness_n_per_mm = std::clamp(device.max_stiffness_n_per_mm, 0.0, 100.0);
  return model;
}

}  // namespace touchtrial::device
