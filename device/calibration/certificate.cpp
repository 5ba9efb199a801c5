#include "device/calibration/certificate.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "core/utc.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace touchtrial::device {
namespace {

Vec3 direction_of(CalibrationAxis axis) noexcept {
  return {axis == CalibrationAxis::x ? 1.0 : 0.0, axis == CalibrationAxis::y ? 1.0 : 0.0,
          axis == CalibrationAxis::z ? 1.0 : 0.0};
}

/// \return whether the handle stood still
bool is_steady(const HoldFigures& hold) noexcept {
  return hold.measured && hold.noise_mm <= kMostNoiseMm && hold.drift_mm <= kMostDriftMm;
}

constexpr std::string_view kKind = "touchtrial device calibration 1";
constexpr std::array kAxisNames = {Named<CalibrationAxis>{"x", CalibrationAxis::x},
                                   Named<CalibrationAxis>{"y", CalibrationAxis::y},
                                   Named<CalibrationAxis>{"z", CalibrationAxis::z}};
constexpr NumberRange kFigure{.low = 0.0, .high = 1e6};

/// \return the number at this place of the text, or -1
int number_at(const std::string& text, std::size_t at, std::size_t digits) {
  return number_in<int>(std::string_view(text).substr(at, digits)).value_or(-1);
}

std::chrono::sys_seconds read_date(const JsonValue& place) {
  const std::string& text = place.text();
  const std::string form = "0000-00-00T00:00:00Z";
  if (text.size() == form.size()) {
    const std::chrono::year_month_day date{
        std::chrono::year(number_at(text, 0, 4)),
        std::chrono::month(static_cast<unsigned>(number_at(text, 5, 2))),
        std::chrono::day(static_cast<unsigned>(number_at(text, 8, 2)))};
    const auto time = std::chrono::sys_seconds(std::chrono::sys_days(date)) +
                      std::chrono::hours(number_at(text, 11, 2)) +
                      std::chrono::minutes(number_at(text, 14, 2)) +
                      std::chrono::seconds(number_at(text, 17, 2));
    if (date.ok() && utc_text(time.time_since_epoch()) == text) return time;
  }
  place.refuse(in_quotes(text) + " is not a date of the form 2026-01-31T12:00:00Z");
}

bool is_weight_of(double force_n, double mass_g) {
  const double weight_n = 0.001 * mass_g * kStandardGravityMS2;
  return std::abs(force_n - weight_n) <= 1e-6 * weight_n;
}

/// Refuses a result that passed although its measurements do not.
void expect_earned(bool earned, const JsonObject& object) {
  if (!earned && object.at("passed").truth()) {
    object.at("passed").refuse(
        "does not follow from the measurements; the file was changed by hand");
  }
}

AxisResult read_axis(const JsonValue& place) {
  const JsonObject object =
      place.object({"axis", "mass_g", "expected_n", "measured_n", "cross_n", "passed"});
  const AxisResult result{
      object.at("axis").choice(kAxisNames),    object.at("mass_g").number(kFigure),
      object.at("expected_n").number(kFigure), object.at("measured_n").number(kFigure),
      object.at("cross_n").number(kFigure),    object.at("passed").truth()};
  if (!is_weight_of(result.expected_n, result.mass_g)) {
    object.at("expected_n").refuse("is not the weight of mass_g; the file was changed by hand");
  }
  expect_earned(is_within_tolerance(result), object);
  return result;
}

std::vector<AxisResult> read_axes(const JsonValue& place) {
  std::vector<AxisResult> axes;
  for (const JsonValue& item : place.items(kCalibrationAxes.size(), kCalibrationAxes.size())) {
    const AxisResult result = read_axis(item);
    if (std::ranges::find(axes, result.axis, &AxisResult::axis) != axes.end()) {
      item.refuse_below("/axis", "occurs twice; give each of x, y and z once");
    }
    axes.push_back(result);
  }
  return axes;
}

FreeAirResult read_free_air(const JsonValue& place) {
  const JsonObject object = place.object({"noise_mm", "drift_mm", "residual_n", "passed"});
  const FreeAirResult result{object.at("noise_mm").number(kFigure),
                             object.at("drift_mm").number(kFigure),
                             object.at("residual_n").number(kFigure), object.at("passed").truth()};
  expect_earned(result.noise_mm <= kMostNoiseMm && result.drift_mm <= kMostDriftMm, object);
  return result;
}

Certificate read_object(const JsonValue& place) {
  const JsonObject object = place.object({"kind", "driver", "model", "serial", "firmware",
                                          "program", "made", "axes", "free_air", "passed"});
  if (object.at("kind").text() != kKind) {
    object.at("kind").refuse("must be " + in_quotes(kKind) +
                             "; give a file that touchtrial device calibrate wrote");
  }
  Certificate certificate;
  certificate.driver = object.at("driver").text();
  certificate.model = object.at("model").text();
  certificate.serial = object.at("serial").text();
  certificate.firmware = object.at("firmware").text();
  certificate.program = object.at("program").text();
  certificate.made = read_date(object.at("made"));
  certificate.axes = read_axes(object.at("axes"));
  certificate.free_air = read_free_air(object.at("free_air"));
  if (object.at("passed").truth() != certificate.passed()) {
    object.at("passed").refuse("does not follow from the results; the file was changed by hand");
  }
  return certificate;
}

}  // namespace

std::string_view name_of(CalibrationAxis axis) noexcept {
  if (axis == CalibrationAxis::x) return "x";
  return axis == CalibrationAxis::y ? "y" : "z";
}

bool is_within_tolerance(const AxisResult& result) noexcept {
  return result.expected_n > 0.0 &&
         std::abs(result.measured_n / result.expected_n - 1.0) <= kForceTolerance;
}

bool Certificate::passed() const noexcept {
  return axes.size() == kCalibrationAxes.size() && free_air.passed &&
         std::ranges::all_of(axes, [](const AxisResult& result) { return result.passed; });
}

AxisResult judge_axis(CalibrationAxis axis, double mass_g, const HoldFigures& empty,
                      const HoldFigures& loaded) noexcept {
  const Vec3 more_n = loaded.force_n - empty.force_n;
  const double along_n = dot(more_n, direction_of(axis));
  AxisResult result;
  result.axis = axis;
  result.mass_g = mass_g;
  result.expected_n = 0.001 * mass_g * kStandardGravityMS2;
  // Over a pulley the weight pulls to either side.
  result.measured_n = std::abs(along_n);
  result.cross_n = norm(more_n - along_n * direction_of(axis));
  result.passed = is_steady(empty) && is_steady(loaded) && is_within_tolerance(result);
  return result;
}

FreeAirResult judge_free_air(const HoldFigures& rest, const HoldFigures& empty) noexcept {
  return {rest.noise_mm, rest.drift_mm, norm(empty.force_n), is_steady(rest) && empty.measured};
}

std::string check_certificate(const Certificate& certificate, const DeviceInfo& device,
                              std::chrono::sys_seconds now) {
  constexpr const char* kRemedy = "; run touchtrial device calibrate ";
  if (certificate.driver != device.name || certificate.serial != device.serial) {
    throw DeviceError(one_line("the certificate is for " + certificate.driver + " " +
                               certificate.serial + ", the device is " + device.name + " " +
                               device.serial + kRemedy + device.name));
  }
  if (!certificate.passed()) {
    throw DeviceError(one_line(device.name + ": its certificate says that calibration failed" +
                               kRemedy + device.name));
  }
  if (now - certificate.made <= kCertificateAge) return "";
  const auto days = std::chrono::duration_cast<std::chrono::days>(now - certificate.made).count();
  return device.name + ": its certificate is " + std::to_string(days) + " days old" + kRemedy +
         device.name;
}

std::string certificate_json(const Certificate& certificate) {
  using nlohmann::ordered_json;
  ordered_json axes = ordered_json::array();
  for (const AxisResult& r : certificate.axes) {
    axes.push_back({{"axis", name_of(r.axis)},
                    {"mass_g", r.mass_g},
                    {"expected_n", r.expected_n},
                    {"measured_n", r.measured_n},
                    {"cross_n", r.cross_n},
                    {"passed", r.passed}});
  }
  const FreeAirResult& air = certificate.free_air;
  const ordered_json object = {{"kind", kKind},
                               {"driver", certificate.driver},
                               {"model", certificate.model},
                               {"serial", certificate.serial},
                               {"firmware", certificate.firmware},
                               {"program", certificate.program},
                               {"made", utc_text(certificate.made.time_since_epoch())},
                               {"axes", axes},
                               {"free_air",
                                {{"noise_mm", air.noise_mm},
                                 {"drift_mm", air.drift_mm},
                                 {"residual_n", air.residual_n},
                                 {"passed", air.passed}}},
                               {"passed", certificate.passed()}};
  return json_text(object);
}

ReadCertificate read_certificate(const std::filesystem::path& path) {
  constexpr std::uintmax_t kLargest = 1U << 20U;
  const Bytes content = read_file(path, kLargest);
  return {read_object(parse_strict_json(text_of(content), path.string())), sha256(content)};
}

}  // namespace touchtrial::device
