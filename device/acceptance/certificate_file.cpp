/// \file Reads and writes certificates.
#include "core/describe.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/text.hpp"
#include "core/utc.hpp"
#include "device/acceptance/certificate.hpp"
#include "device/servo/scaled_device.hpp"
#include "device/settings_schemas.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

namespace touchtrial::device {
namespace {

constexpr std::string_view kCertificateKind = "touchtrial device acceptance 3";
constexpr auto kAxisWords = std::to_array<Named<DeviceAxis>>(
    {{"x", DeviceAxis::x}, {"y", DeviceAxis::y}, {"z", DeviceAxis::z}});
constexpr NumberRange kSize{.low = 0.0, .high = 1e6};
constexpr NumberRange kAboveZero{.low = 0.0, .high = 1e6, .open_low = true};
constexpr NumberRange kSigned{.low = -1e6, .high = 1e6};
constexpr NumberRange kScale{.low = kMinScale, .high = kMaxScale};
constexpr std::size_t kMaxEntries = 1000;
constexpr const char* kEdited = "the file was changed by hand";

KeyInfo required_key(std::string_view meaning) {
  return {.meaning = meaning, .required = true};
}

template <typename Part, typename Describe>
void optional_part(ObjectIo& io, std::string_view key, std::optional<Part>& part,
                   const KeyInfo& key_info, const Describe& describe) {
  io.optional(key, part, key_info,
              [&](ValueIo& value, Part& member) { value.part(member, describe); });
}

void describe_measured(ObjectIo& io, std::string_view key, std::optional<Measured>& measured,
                       std::string_view meaning, const NumberRange& range = kSigned) {
  optional_part(io, key, measured, {.meaning = meaning}, [&](ObjectIo& part, Measured& number) {
    part.number("value", number.value, range, required_key(meaning));
    part.number("error", number.error, kSize,
                required_key("half-width of its interval of about 95 %"));
  });
}

void describe_push(ObjectIo& io, PushResult& push) {
  io.number("force_n", push.force_n, kSize, required_key("of the last step"));
  io.boolean("moved", push.moved, required_key("whether the handle moved by 2 mm"));
  io.number("along_mm", push.along_mm, kSigned, required_key("moved in the force's direction"));
  io.number("across_mm", push.across_mm, kSize, required_key("moved across it"));
}

void describe_weight(ObjectIo& io, WeighResult& weight) {
  io.number("expected_n", weight.expected_n, kAboveZero, required_key("of the weight or scale"));
  io.number("measured_n", weight.measured_n, kSize,
            required_key("additional force commanded with the weight"));
  io.number("error_n", weight.error_n, kSize, required_key("of `measured_n`"));
}

/// The stated scale must match the weight.
void describe_scale(ObjectIo& io, const AxisResult& axis) {
  std::optional<Measured> stated_scale = axis.scale();
  describe_measured(io, "scale", stated_scale,
                    "delivered over commanded force, after correction by `force_scale`: "
                    "`expected_n` over `measured_n`");
  io.rule([&](const JsonValue& place, const JsonObject& object) {
    if (!object.find("scale")) stated_scale.reset();
    const std::optional<Measured> scale = axis.scale();
    const bool agrees = stated_scale.has_value() == scale.has_value() &&
                        (!scale || (std::abs(stated_scale->value - scale->value) < 1e-6 &&
                                    std::abs(stated_scale->error - scale->error) < 1e-6));
    if (!agrees) {
      place.refuse_below("/scale", std::string("does not follow from the weight; ") + kEdited);
    }
  });
}

void describe_axis(ObjectIo& io, AxisResult& axis) {
  io.choice("axis", axis.axis, kAxisWords, required_key("of the device frame"));
  optional_part(io, "plus", axis.plus, {"the push along the axis"}, describe_push);
  optional_part(io, "minus", axis.minus, {"the push against it"}, describe_push);
  optional_part(io, "weight", axis.weight, {"a known force that the device held"}, describe_weight);
  io.number("load_n", axis.load_n, kSigned, {"commanded for the empty handle"});
  describe_scale(io, axis);
  describe_measured(io, "friction_n", axis.friction_n,
                    "from slow strokes; this and the next two are in newtons at the handle if "
                    "there is a `scale`, else in commanded newtons");
  describe_measured(io, "mass_kg", axis.mass_kg, "apparent mass", kAboveZero);
  describe_measured(io, "viscous_n_s_per_m", axis.viscous_n_s_per_m,
                    "friction proportional to speed");
  describe_measured(io, "delay_ms", axis.delay_ms, "from a command to its force");
  io.boolean(
      "delay_left_out", axis.delay_left_out,
      {.meaning =
           "the person skipped the shaking, so that a missing delay does not fail the device",
       .written = axis.delay_left_out});
}

void describe_rest(ObjectIo& io, RestFigures& rest) {
  io.number("noise_mm", rest.noise_mm, kSize,
            required_key("standard deviation, norm over the three axes"));
  io.number("drift_mm", rest.drift_mm, kSize,
            required_key("from the first to the second half of the run"));
}

void describe_wall(ObjectIo& io, WallResult& wall) {
  io.number("stable_n_per_mm", wall.stable_n_per_mm, kSize,
            required_key("the stiffest wall that did not oscillate; 0: none"));
  io.number("oscillates_n_per_mm", wall.oscillates_n_per_mm, kSize,
            required_key("the first wall that oscillated; 0: none"));
  io.text("ended", wall.ended, {}, required_key("why the trials ended"));
  io.rule([&](const JsonValue& /*place*/, const JsonObject& object) {
    if (wall.oscillates_n_per_mm > 0.0 && wall.stable_n_per_mm >= wall.oscillates_n_per_mm) {
      object.at("stable_n_per_mm")
          .refuse(std::string("must be less than oscillates_n_per_mm; ") + kEdited);
    }
  });
}

void describe_warm(ObjectIo& io, WarmResult& warm) {
  io.number("before_n", warm.before_n, kSigned, required_key("force for the load"));
  io.number("after_n", warm.after_n, kSigned,
            required_key("force for the same load twenty minutes later"));
  io.number("before_c", warm.before_c, kSigned,
            {.meaning = "temperature of the motors' housing, as entered", .unit = "°C"});
  io.number("after_c", warm.after_c, kSigned, {.meaning = "likewise", .unit = "°C"});
}

void describe_not_measured(ObjectIo& io, NotMeasured& entry) {
  io.text("what", entry.measurement, {}, required_key("that is missing"));
  io.text("why", entry.reason, {}, required_key("the reason"));
}

int digits_at(const std::string& text, std::size_t start, std::size_t digits) {
  return number_in<int>(std::string_view(text).substr(start, digits)).value_or(-1);
}

std::chrono::sys_seconds creation_time(const JsonValue& place) {
  const std::string& text = place.text();
  const std::string example_text = "0000-00-00T00:00:00Z";
  if (text.size() == example_text.size()) {
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

void describe_origin(ObjectIo& io, Certificate& certificate) {
  std::string kind(kCertificateKind);
  io.text("kind", kind, {.description = "`touchtrial device acceptance 3`"},
          required_key("of the file"));
  io.text("driver", certificate.driver, {}, required_key("name of the driver"));
  io.text("model", certificate.model, {}, required_key("as the device reports it"));
  io.text("serial", certificate.serial, {}, required_key("likewise"));
  io.text("firmware", certificate.firmware, {}, required_key("likewise"));
  io.text("program", certificate.program, {}, required_key("version of the program"));
  std::string made = utc_text(certificate.made.time_since_epoch());
  io.text("made", made, {.description = "`2026-01-31T12:00:00Z`"}, required_key("UTC"));
  io.rule([&](const JsonValue& /*place*/, const JsonObject& object) {
    certificate.made = creation_time(object.at("made"));
  });
  io.text("emulated", certificate.emulated, {},
          required_key("the device model of a rehearsal; empty: a device"));
  io.member("force_scale", required_key("of the device settings, applied to all measurements"),
            true, [&](ValueIo& value) { value.axes(certificate.scale.force, kScale); });
  io.member("length_scale", required_key("likewise"), true,
            [&](ValueIo& value) { value.axes(certificate.scale.length, kScale); });
  io.text("fault", certificate.fault, {},
          required_key("the device fault that ended the acceptance; empty: none"));
}

void describe_axes(ValueIo& io, std::vector<AxisResult>& axes) {
  io.list(axes, {.max = kDeviceAxes.size()},
          [](ValueIo& value, AxisResult& axis) { value.part(axis, describe_axis); });
  io.rule([&](const JsonValue& place) {
    const std::vector<JsonValue> items = place.items(0, kDeviceAxes.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
      const auto current = axes.begin() + static_cast<std::ptrdiff_t>(i);
      if (std::find_if(axes.begin(), current, [&](const AxisResult& axis) {
            return axis.axis == current->axis;
          }) != current) {
        items[i].refuse_below("/axis", "occurs twice; give each of x, y and z once");
      }
    }
  });
}

void describe_certificate(ObjectIo& io, Certificate& certificate) {
  describe_origin(io, certificate);
  optional_part(io, "rest", certificate.rest, {"the handle lying still"}, describe_rest);
  describe_measured(io, "step_mm", certificate.step_mm, "encoder step");
  io.member("axes", required_key("the axes that were tested, as below"), true,
            [&](ValueIo& value) { describe_axes(value, certificate.axes); });
  optional_part(io, "wall", certificate.wall, {"trials with walls of increasing stiffness"},
                describe_wall);
  optional_part(io, "warm", certificate.warm,
                {"the force for a load, before and after twenty minutes"}, describe_warm);
  io.list("not_measured", certificate.not_measured, {.max = kMaxEntries},
          required_key("`what` was not measured, and `why`"),
          [](ValueIo& value, NotMeasured& entry) { value.part(entry, describe_not_measured); });
  std::vector<std::string> failures = certificate.failures();
  io.list("failures", failures, {.max = kMaxEntries},
          required_key(
              "reasons for a failure, one per line; for people only: `passed` is computed from "
              "the results"),
          [](ValueIo& value, std::string& line) { value.text(line, {}); });
  bool passed = certificate.passed();
  io.boolean("passed", passed, required_key("whether there is none"));
  io.rule([&](const JsonValue& /*place*/, const JsonObject& object) {
    if (passed != certificate.passed()) {
      object.at("passed").refuse(std::string("does not follow from the results; ") + kEdited);
    }
  });
}

/// Checks the kind before the keys, because an earlier kind may have other keys.
void require_kind(const JsonValue& place) {
  Certificate example;
  std::vector<std::string_view> keys =
      keys_of([&](ObjectIo& io) { describe_certificate(io, example); });
  keys.push_back("observed");
  const JsonValue kind = place.object(keys).at("kind");
  if (kind.text() == kCertificateKind) return;
  kind.refuse("must be " + in_quotes(kCertificateKind) +
              "; make a certificate with touchtrial device accept");
}

}  // namespace

Certificate parse_certificate(const std::string& text, const std::string& source) {
  const JsonValue place = parse_strict_json(text, source);
  require_kind(place);
  Certificate certificate;
  read_settings(place, [&](ObjectIo& io) { describe_certificate(io, certificate); });
  return certificate;
}

HashedCertificate read_certificate(const std::filesystem::path& path) {
  constexpr std::uintmax_t kMaxFileBytes = 1U << 20U;
  const Bytes content = read_file(path, kMaxFileBytes);
  return {parse_certificate(text_of(content), path.string()), sha256(content)};
}

std::string certificate_json(const Certificate& certificate) {
  Certificate copy = certificate;
  return json_text(nlohmann::ordered_json::parse(
      described_json([&](ValueIo& io) { io.part(copy, describe_certificate); })));
}

std::string certificate_schema() {
  Certificate defaults;
  return annotated_schema("Touchtrial certificate",
                          "What `device accept` measured of a device. `passed` and `scale` follow "
                          "from the results.",
                          "[]", [&](ObjectIo& io) { describe_certificate(io, defaults); });
}

}  // namespace touchtrial::device
